#include <limits>

#include "tests/brdf/hard_cases.h"
#include "tests/brdf/kinds.h"

// Each alternative of AnyBrdf: reciprocity, energy, scalars that agree, no NaN. A model added to AnyBrdf is tested here
// without a further line.
namespace likeness::brdf {
namespace {

// A model whose parameters are floats. Through volatile, because g++ 12 at -O2 drops a vectorized rounding.
template <template <class> class M>
M<double> in_float(const M<double>& model) {
  auto values = channels_of(model);
  for (double& x : values) {
    volatile float rounded = float(x);
    x = double(rounded);
  }
  return model_from_channels<M, double>(values.data());
}

template <class M>
class EveryModel : public ::testing::Test {};
TYPED_TEST_SUITE(EveryModel, TypesOf<AnyBrdf>::Type, ModelNames);

constexpr auto kRange = [](const Parameter& row) { return row.range; };
constexpr auto kTypical = [](const Parameter& row) { return row.typical; };

// The worst and the mean of |f(l, v) - f(v, l)| / (f(l, v) + f(v, l)) over pairs of directions, evenly in their cosines.
struct Asymmetry {
  double worst = 0, mean = 0;
};
template <class F>
Asymmetry asymmetry(F&& draw_model) {
  Random random(1);
  Asymmetry found;
  constexpr int kPairs = 20000;
  for (int i = 0; i < kPairs; ++i) {
    const auto model = draw_model(random);
    const auto l = random.direction(), v = random.direction();
    const Channels there = channels(model.eval(l, v)), back = channels(model.eval(v, l));
    for (std::size_t c = 0; c < 3; ++c) {
      const double sum = there[c] + back[c], apart = sum > 0 ? std::abs(there[c] - back[c]) / sum : 0;
      found.worst = std::max(found.worst, apart);
      found.mean += apart / (3 * kPairs);
    }
  }
  return found;
}

TYPED_TEST(EveryModel, IsReciprocalIfItPromisesThat) {
  const Asymmetry found = asymmetry([](Random& random) { return random_model<TypeParam>(random, kRange); });
  if (TypeParam::kPromises.reciprocal) {
    EXPECT_LE(found.worst, 1e-14);  // sums in another order; 1e-15 measured
  } else {
    EXPECT_GT(found.mean, 0.001);  // else it could promise it; how far from it is on the model's page
  }
}

// The terminator reads the light's cosine only: without it the model is reciprocal.
TEST(Callisto, IsReciprocalButForTheTerminator) {
  const Asymmetry found = asymmetry([](Random& random) {
    auto model = random_model<Callisto<double>>(random, kRange);
    model.smooth_terminator = 0;
    return model;
  });
  EXPECT_LE(found.worst, 1e-14);  // as above
}

// The numbers of the pages. The mean of 20000 pairs is within 2 % of that of all.
TEST(Asymmetry, IsAsThePagesSay) {
  const auto with = []<class M>(M model, double terminator) {
    model.smooth_terminator = terminator;
    return asymmetry([&](Random&) { return model; }).mean;
  };
  EXPECT_NEAR(with(Callisto<double>{}, 0.5), 0.080, 2e-3);
  EXPECT_NEAR(with(Callisto<double>{}, 1), 0.197, 3e-3);
  EXPECT_NEAR(with(Callisto<double>{}, -1), 0.106, 3e-3);
  EXPECT_NEAR(with(CallistoProxima<double>{}, 0), 0.077, 2e-3);
  EXPECT_NEAR(with(CallistoProxima<double>{}, 1), 0.157, 3e-3);
  EXPECT_NEAR(asymmetry([](Random&) { return Proxima<double>{Rgb<double>(1), 0.25}; }).mean, 0.080, 2e-3);
  EXPECT_NEAR(asymmetry([](Random&) { return Proxima<double>{Rgb<double>(1), 1}; }).mean, 0.206, 5e-3);
}

// ---- the microfacets of a unit patch project onto exactly that patch.

// Integral of D cos for an isotropic D of (cos, sin^2): Simpson's rule in ln(1 + sin^2 / alpha^2), the peak's own scale.
template <class D>
double projected_area(double alpha, D&& d) {
  const int steps = 2000;
  const double end = std::log1p(1 / (alpha * alpha));
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double s2 = std::min(1.0, alpha * alpha * std::expm1(end * i / steps));
    const double weight = i == 0 || i == steps ? 1 : i % 2 ? 4 : 2;
    sum += weight * d(std::sqrt(1 - s2), s2) * (s2 + alpha * alpha);
  }
  return std::numbers::pi * sum * end / (3 * steps);
}

TEST(Ggx, ProjectedAreaOfNormalsIsOne) {
  for (const double alpha : {1e-4, 1e-3, 0.05, 0.3, 1.0})
    EXPECT_NEAR(projected_area(alpha, [&](double c, double s2) { return ggx_distribution(alpha, c, s2); }), 1, 1e-9)
        << "alpha " << alpha;  // Simpson on an exponential: 1e-11 measured
}

TEST(Disney2012, ProjectedAreaOfTheClearcoatsNormalsIsOne) {
  for (const double alpha : {0.001, 0.01, 0.1})
    EXPECT_NEAR(projected_area(alpha, [&](double c, double s2) { return gtr1_distribution(alpha, c, s2); }), 1, 1e-9)
        << "alpha " << alpha;  // the integrand is constant in this variable
}

TEST(Disney2012, ProjectedAreaOfAnisotropicNormalsIsOne) {
  const double ax = 0.3, ay = 0.6;
  const int rings = 1000, sectors = 1000;
  double sum = 0;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double s2 = (i + 0.5) / rings, phi = 2 * std::numbers::pi * (j + 0.5) / sectors, s = std::sqrt(s2);
      const Vec3<double> h{s * std::cos(phi), s * std::sin(phi), std::sqrt(1 - s2)};
      sum += ggx_distribution_anisotropic(ax, ay, h, h.z);
    }
  EXPECT_NEAR(std::numbers::pi * sum / (rings * sectors), 1, 1e-4);  // midpoint rule in sin^2: 3e-6 measured
}

TEST(Disney2012, IsotropicEqualsTheIsotropicDistributionBitForBit) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const auto g = Geometry<double>(random.direction(), random.direction());
    const double alpha = random.uniform(0.001, 1);
    EXPECT_EQ(ggx_distribution_anisotropic(alpha, alpha, g.half, g.cos_h), ggx_distribution(alpha, g.cos_h, g.sin2_h));
  }
}

TEST(Disney2012, AnisotropyStretchesTheHighlightAlongX) {
  const Disney2012<double> model{.roughness = 0.4, .anisotropic = 0.9};
  const double along_x = channels(model.eval(at_height(0.97, 0), {0, 0, 1}))[0];
  const double along_y = channels(model.eval(at_height(0.97, std::numbers::pi / 2), {0, 0, 1}))[0];
  EXPECT_GT(along_x, 1.5 * along_y);
}

// ---- the scalars agree.

template <class S>
S load_lanes(const std::vector<double>& values) {
  std::array<typename S::value_type, S::size> lanes;
  for (std::size_t i = 0; i < S::size; ++i) lanes[i] = typename S::value_type(values[i]);
  return S::load_unaligned(lanes.data());
}

// Every lane has a model and a pair of its own, and gives what that model alone gives in the lane's number.
template <class S, template <class> class M>
double worst_lane(const M<double>&, int cases) {
  using Number = typename S::value_type;
  Random random(11);
  double worst = 0;
  constexpr std::size_t kChannels = channel_count<M<double>>();
  for (int i = 0; i < cases; ++i) {
    std::vector<M<double>> models;
    std::vector<double> column(S::size);
    std::array<std::vector<double>, 6> xyz;
    for (std::size_t lane = 0; lane < S::size; ++lane) {
      models.push_back(random_model<M<double>>(random, kRange));
      const auto l = random.direction(-0.1), v = random.direction(-0.1);
      const double c[]{l.x, l.y, l.z, v.x, v.y, v.z};
      for (int k = 0; k < 6; ++k) xyz[k].push_back(c[k]);
    }
    std::array<S, kChannels> together;
    for (std::size_t k = 0; k < kChannels; ++k) {
      for (std::size_t lane = 0; lane < S::size; ++lane) column[lane] = channels_of(models[lane])[k];
      together[k] = load_lanes<S>(column);
    }
    const auto at = [&](int k) { return load_lanes<S>(xyz[k]); };
    const Geometry<S> g(Vec3<S>{at(0), at(1), at(2)}, Vec3<S>{at(3), at(4), at(5)});
    const Rgb<S> f = model_from_channels<M, S>(together.data()).eval(g);
    for (std::size_t lane = 0; lane < S::size; ++lane) {
      const Channels want = eval_in<Number>(models[lane], Vec3<double>{xyz[0][lane], xyz[1][lane], xyz[2][lane]},
                                            Vec3<double>{xyz[3][lane], xyz[4][lane], xyz[5][lane]});
      const Channels got{double(f.r.get(lane)), double(f.g.get(lane)), double(f.b.get(lane))};
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, relative_difference(got[c], want[c], std::is_same_v<Number, float> ? 1e-37 : 1e-300));
    }
  }
  return worst;
}

TYPED_TEST(EveryModel, ABatchGivesWhatEachOfItsLanesGives) {
  EXPECT_LE(worst_lane<xsimd::batch<double>>(TypeParam{}, 5000), 2e-14);  // pow by exp and log of an exponent up to 10
  EXPECT_LE(worst_lane<xsimd::batch<float>>(TypeParam{}, 5000), 1e-5);    // the same in float
}

// Parameters are floats already: 1 - metallic has what digits its input has.
TYPED_TEST(EveryModel, FloatIsNearDouble) {
  Random random(2);
  for (int i = 0; i < 100000; ++i) {
    const auto model = in_float(random_model<TypeParam>(random, kTypical));
    const Geometry<double> g(random.direction(0.01), random.direction(0.01));
    const Channels want = eval_in<double>(model, g), got = eval_in<float>(model, g);
    for (int c = 0; c < 3; ++c) ASSERT_LE(relative_difference(got[c], want[c]), 2e-5) << i;  // the demand
  }
}

// ---- no NaN, no infinity, nothing negative, wherever the inputs are allowed.

double edge_height(Random& random) {
  constexpr double kEdgeHeights[]{0, 1, 1e-7, 1e-7, 1e-12, 1e-19, 1.2e-38, 1.5e-45, -1e-7, 0.5};
  return random.uniform() < 0.5 ? kEdgeHeights[random.index(std::size(kEdgeHeights))] : random.uniform(-0.05, 1);
}

struct DirectionPair {
  Vec3<double> l, v;
};
DirectionPair draw_pair(Random& random) {
  const double phi = random.uniform(0, 2 * std::numbers::pi);
  const Vec3<double> l = Random::direction_at(edge_height(random), phi);
  switch (random.index(5)) {
    case 0:
      return {l, l};
    case 1:
      return {l, {-l.x, -l.y, l.z}};
    case 2:
      return {l, {-l.x, -l.y, -l.z}};
    case 3:
      return {l, Random::direction_at(edge_height(random), phi + std::numbers::pi)};
    default:
      return {l, Random::direction_at(edge_height(random), random.uniform(0, 7))};
  }
}
template <class M>
M draw_edge_model(Random& random) {
  return random_model<M>(random, [&](const Parameter& row) -> Interval {
    switch (random.index(4)) {
      case 0:
        return {row.range.low, row.range.low};
      case 1:
        return {row.range.high, row.range.high};
      case 2:
        return {row.initial, row.initial};
      default:
        return row.range;
    }
  });
}

TYPED_TEST(EveryModel, AMillionEdgesInFloatGiveNoNaN) {
  Random random(4);
  for (int i = 0; i < 1000000; ++i) {
    const auto model = draw_edge_model<TypeParam>(random);
    const DirectionPair pair = draw_pair(random);
    const Channels f = eval_in<float>(model, pair.l, pair.v);
    if (finite_and_not_negative(f)) continue;
    std::string parameters;
    for (const double x : channels_of(model)) parameters += std::to_string(x) + " ";
    FAIL() << "case " << i << ": f = " << f[0] << " " << f[1] << " " << f[2] << " at l.z = " << pair.l.z
           << ", v.z = " << pair.v.z << ", parameters " << parameters;
  }
}

TYPED_TEST(EveryModel, EdgesInDoubleAndInBatchesGiveNoNaN) {
  Random random(6);
  for (int i = 0; i < 100000; ++i) {
    const auto model = draw_edge_model<TypeParam>(random);
    const DirectionPair pair = draw_pair(random);
    ASSERT_TRUE(finite_and_not_negative(eval_in<double>(model, pair.l, pair.v))) << i;
    ASSERT_TRUE(finite_and_not_negative(eval_in<xsimd::batch<float>>(model, pair.l, pair.v))) << i;
    ASSERT_TRUE(finite_and_not_negative(eval_in<xsimd::batch<double>>(model, pair.l, pair.v))) << i;
  }
}

}  // namespace
}  // namespace likeness::brdf
