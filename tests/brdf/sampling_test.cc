#include "brdf/sampling.h"

#include "tests/brdf/kinds.h"
#include "tests/brdf/sampled_cases.h"

// Each sample of every model: what it says of itself is so, in every scalar and at the ends of every range. That samples
// are distributed as their pdf says is sampling_statistics_test.
namespace likeness::brdf {
namespace {

template <class M>
class EveryModelSampled : public ::testing::Test {
  static_assert(Sampled<M>, "a model of AnyBrdf states lobes(), sample() and pdf(), as brdf/sampling.h says");
};
TYPED_TEST_SUITE(EveryModelSampled, TypesOf<AnyBrdf>::Type, ModelNames);

template <class S>
constexpr double epsilon() {
  return double(std::numeric_limits<typename Arithmetic<S>::Number>::epsilon());
}
template <class S>
double below_one() {
  return 1 - 0.5 * epsilon<S>();
}

// A random number as S would be given it: 0 and the last one before 1 are over-weighted.
template <class S>
double random_number(Random& random) {
  switch (random.index(6)) {
    case 0:
      return 0;
    case 1:
      return below_one<S>();
    case 2:
      return 0.5;
    default:
      return std::min(random.uniform(), below_one<S>());
  }
}
Vec3<double> random_view(Random& random) {
  constexpr double kRareHeights[]{1, 1e-3, 1e-7, 1e-19, 1.2e-38, 1.5e-45};
  return random.uniform() < 0.4
             ? Random::direction_at(kRareHeights[random.index(std::size(kRareHeights))], random.uniform(0, 7))
             : random.direction();
}
struct Drawn {
  Vec3<double> to_light;
  double pdf, pdf_again;
  Channels weight, weight_again;
};
template <Scalar S, template <class> class M>
Drawn draw(const M<double>& in_double, const Vec3<double>& view, double choice, double u, double v) {
  const M<S> model = model_in<S>(in_double);
  const Vec3<S> to_view = vector_in<S>(view);
  const Sample<S> sample = model.sample(to_view, constant<S>(choice), constant<S>(u), constant<S>(v));
  const Rgb<S> f = model.eval(sample.to_light, to_view);
  const S pdf = model.pdf(sample.to_light, to_view);
  const Rgb<S> weight{S(f.r * sample.to_light.z / pdf), S(f.g * sample.to_light.z / pdf),
                      S(f.b * sample.to_light.z / pdf)};
  return {{first(sample.to_light.x), first(sample.to_light.y), first(sample.to_light.z)},
          first(sample.pdf),
          first(pdf),
          channels(sample.weight),
          channels(weight)};
}

template <class S, class M>
void expect_consistent_samples(int cases) {
  Random random(31);
  int kept = 0;
  double worst = 0;
  for (int i = 0; i < cases; ++i) {
    const M model = random_edges<M>(random);
    const Vec3<double> view = random_view(random);
    const double choice = random_number<S>(random), u = random_number<S>(random), v = random_number<S>(random);
    const Drawn s = draw<S>(model, view, choice, u, v);
    ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0) << i << ": pdf " << s.pdf;
    ASSERT_TRUE(finite_and_not_negative(s.weight)) << i << ": weight " << s.weight[0];
    // A view is rounded to S before it is mirrored: not quite a unit vector any more.
    ASSERT_NEAR(dot(s.to_light, s.to_light), 1, 12 * epsilon<S>()) << i << ": not a unit vector";
    if (s.pdf == 0) {
      ASSERT_EQ(s.to_light.z, 1) << i;
      ASSERT_EQ(s.weight, (Channels{0, 0, 0})) << i;
      continue;
    }
    ++kept;
    ASSERT_GT(s.to_light.z, 0) << i;
    ASSERT_LE(relative_difference(s.pdf_again, s.pdf), 4 * epsilon<S>()) << i;  // equal to the bit here
    const double zero = std::is_same_v<typename Arithmetic<S>::Number, float> ? 1e-36 : 1e-300;  // f cos may underflow
    for (int c = 0; c < 3; ++c) worst = std::max(worst, relative_difference(s.weight_again[c], s.weight[c], zero));
  }
  EXPECT_LE(worst, 4 * epsilon<S>());  // a product and a quotient in another order: 1.7 epsilon measured
  EXPECT_GT(kept, cases / 2);
}

TYPED_TEST(EveryModelSampled, WeightIsFCosOverPdfSampleBySample) {
  expect_consistent_samples<double, TypeParam>(20000);
  expect_consistent_samples<float, TypeParam>(50000);
  expect_consistent_samples<xsimd::batch<double>, TypeParam>(10000);
  expect_consistent_samples<xsimd::batch<float>, TypeParam>(20000);
}

// Otherwise a renderer that samples the model never finds that light. In float the density of a far tail may be tiny, but
// must not vanish.
template <class S, class M>
void expect_no_light_missed(int cases) {
  Random random(32);
  for (int i = 0; i < cases; ++i) {
    const M in_double = random_edges<M>(random);
    const auto model = model_in<S>(in_double);
    const Vec3<S> l = vector_in<S>(random_view(random)), v = vector_in<S>(random_view(random));
    const Channels f = channels(model.eval(l, v));
    const double pdf = first(model.pdf(l, v));
    ASSERT_TRUE(std::isfinite(pdf)) << i << ": " << pdf;
    const bool above = first(l.z) > 0 && first(v.z) > 0;
    ASSERT_TRUE(pdf > 0 || !above || f[0] + f[1] + f[2] == 0)
        << i << ": f = " << f[0] << " at l.z = " << first(l.z) << ", v.z = " << first(v.z);
  }
}
TYPED_TEST(EveryModelSampled, EveryLightThatIsReflectedCanBeProposed) {
  expect_no_light_missed<double, TypeParam>(20000);
  expect_no_light_missed<float, TypeParam>(20000);
}

TYPED_TEST(EveryModelSampled, NothingIsProposedToAViewBelowTheHorizon) {
  for (const double height : {0.0, -1e-30, -0.5, -1.0}) {
    const Drawn s = draw<float>(TypeParam{}, Random::direction_at(height, 0.3), 0.3, 0.6, 0.7);
    EXPECT_EQ(s.pdf, 0);
    EXPECT_EQ(s.to_light.z, 1);
    EXPECT_EQ(s.weight, (Channels{0, 0, 0}));
  }
}

// Each lane has a view and random numbers of its own.
template <class S, template <class> class M>
void expect_lanes_alone(const M<double>& model, int cases, double near) {
  using Number = typename S::value_type;
  Random random(33);
  for (int i = 0; i < cases; ++i) {
    std::array<std::array<Number, S::size>, 6> in;
    for (std::size_t lane = 0; lane < S::size; ++lane) {
      const Vec3<double> view = random.direction(0.01);
      const double all[]{view.x,           view.y,          view.z, std::min(random.uniform(), below_one<S>()),
                         random.uniform(), random.uniform()};
      for (std::size_t k = 0; k < 6; ++k) in[k][lane] = Number(all[k]);
    }
    const auto column = [&](std::size_t k) { return S::load_unaligned(in[k].data()); };
    const Sample<S> together =
        model_in<S>(model).sample(Vec3<S>(column(0), column(1), column(2)), column(3), column(4), column(5));
    for (std::size_t lane = 0; lane < S::size; ++lane) {
      const Sample<Number> alone = model_in<Number>(model).sample(Vec3<Number>(in[0][lane], in[1][lane], in[2][lane]),
                                                                  in[3][lane], in[4][lane], in[5][lane]);
      ASSERT_NEAR(together.to_light.x.get(lane), alone.to_light.x, near) << i;
      ASSERT_NEAR(together.to_light.y.get(lane), alone.to_light.y, near) << i;
      ASSERT_NEAR(together.to_light.z.get(lane), alone.to_light.z, near) << i;
    }
  }
}
TYPED_TEST(EveryModelSampled, ABatchSamplesWhatEachOfItsLanesSamples) {
  for (const auto& model : parameter_sets<TypeParam>()) {
    expect_lanes_alone<xsimd::batch<double>>(model, 2000, 1e-14);  // sine and cosine to an ulp or two
    expect_lanes_alone<xsimd::batch<float>>(model, 2000, 3e-6);    // the same, stretched by the horizon's 1 / cos
  }
}

// ---- the maps.

// Low-discrepancy points begin in this corner: a direction that is lost there is lost in every pixel.
TEST(CosineHemisphere, KeepsTheEdgesOfTheSquareAboveTheHorizon) {
  for (const double u : {0.0, 0.5, below_one<float>()})
    for (const double v : {0.0, 0.5, below_one<float>()}) {
      const Drawn s = draw<float>(Lambert<double>{Rgb<double>(0.75)}, {0, 0, 1}, 0, u, v);
      EXPECT_GT(s.to_light.z, 0);
      EXPECT_NEAR(s.weight[0], 0.75, 1e-7) << u << " " << v;  // an ulp
    }
}

TEST(CosineHemisphere, KeepsNeighboursTogether) {
  Random random(34);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const double u = random.uniform(0.01, 0.98), v = random.uniform(0.01, 0.98), step = 1e-6;
    const auto a = cosine_hemisphere(u, v), b = cosine_hemisphere(u + step, v);
    worst = std::max(worst, std::hypot(a.x - b.x, a.y - b.y) / step);
  }
  EXPECT_LE(worst, 3);  // 2 along the axes, 2.54 at the diagonals: on the disk, without a seam
}

// Every visible normal mirrors the view somewhere: over the whole sphere their density is 1.
TEST(GgxLobe, IntegratesToOneOverTheSphere) {
  const GaussLegendre polar(128), azimuth(160);
  for (const auto& [alpha_x, alpha_y] : {std::pair{1e-4, 1e-4}, {0.01, 0.01}, {0.3, 0.3}, {1.0, 1.0}, {0.6, 0.06}})
    for (const double height : {1.0, 0.5, 0.05, 0.001}) {
      const Vec3<double> view = view_at(height);
      const double sine = std::sqrt(1 - height * height), turn = std::asinh(0.5 * std::numbers::pi / height);
      double sum = 0;
      for (int fourth = 0; fourth < 4; ++fourth)
        for (std::size_t k = 0; k < azimuth.node.size(); ++k) {
          const double t = (azimuth.node[k] * 2 - 1 + (fourth % 2 ? 1 : -1)) * 0.5 * turn;  // graded to right angles
          const double psi = (fourth < 2 ? -0.5 : 0.5) * std::numbers::pi + height * std::sinh(t);
          const double end = std::atan2(height, -sine * std::cos(psi)), least = std::min(alpha_x, alpha_y);
          const double seen = std::min(end, 0.5 * std::numbers::pi), stretch = std::asinh(seen / least);
          for (std::size_t i = 0; i < polar.node.size(); ++i) {
            const double theta = least * std::sinh(polar.node[i] * stretch), s = std::sin(theta);
            const Vec3<double> h{s * std::cos(psi + 1.1), s * std::sin(psi + 1.1), std::cos(theta)};
            const double jacobian = 4 * dot(view, h) * s * least * stretch * std::cosh(polar.node[i] * stretch) * turn *
                                    height * std::cosh(t);
            sum += polar.weight[i] * azimuth.weight[k] * jacobian *
                   GgxLobe<double>(alpha_x, alpha_y).density(Geometry<double>(mirrored(view, h), view));
          }
        }
      EXPECT_NEAR(sum, 1, 1e-8) << alpha_x << " " << alpha_y << " at height " << height;  // 7e-10 measured
    }
}

}  // namespace
}  // namespace likeness::brdf
