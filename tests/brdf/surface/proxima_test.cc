#include "brdf/proxima.h"

#include "brdf/jet.h"
#include "brdf/surface_evaluators.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/hard_cases.h"
#include "tests/brdf/surface/albedo.h"

// Proxima against its file of 40 digits, at its clamps, and with and without the cosine.
namespace likeness::brdf {
namespace {

using Long = long double;

Long factor(Long alpha, Long cos_i, Long cos_vl) {
  const Long k = std::clamp(-cos_vl, Long(0), Long(1));
  return alpha * (-0.55L + 0.19L / cos_i) * (1 - std::sqrt(k)) + 1;
}

template <class S>
class ProximaIn : public ::testing::Test {
 protected:
  using Cosines = std::tuple_element_t<3, ProximaRow::Forms>;
  static constexpr double kRelative = kIsFloat<S> ? 2e-5 : 1e-12;  // the demand
};
TYPED_TEST_SUITE(ProximaIn, Kinds, KindNames);

TYPED_TEST(ProximaIn, MeetsItsFile) {
  if (read_reference("proxima.csv").empty()) GTEST_SKIP() << "no " LIKENESS_SHARED_DIR "/reference/proxima.csv";
  const double worst = worst_against_file<ProximaRow, TypeParam, typename TestFixture::Cosines>("proxima.csv", {});
  this->RecordProperty("worst_relative_difference", (std::ostringstream() << worst).str());
}

// Opposite directions that both graze: 1 - sqrt(cos_k) vanishes together with the cosine it is divided by; and where
// cos_k leaves 0, its root leaves 0 with an infinite slope.
TYPED_TEST(ProximaIn, KeepsItsDigitsWhereLightAndViewAreOppositeOrAtRightAngles) {
  using S = TypeParam;
  for (const double alpha : {0.01, 0.5, 1.0})
    for (const double cos_i : {1e-7, 1e-4, 0.01, 0.345, 1.0})
      for (const double cos_vl :
           {-1.0, -1 + 1e-15, -1 + 2e-8, -0.9999, -0.5, -1e-4, -1e-9, -1e-16, -1e-30, 0.0, 1e-9, 1.0}) {
        const auto got = evaluate_row<ProximaRow, S, typename TestFixture::Cosines>({cos_i, cos_vl, 1, 1, 1, alpha});
        const Long a = first(constant<S>(alpha)), f = factor(a, cos_i, cos_vl) / std::numbers::pi_v<Long>;
        EXPECT_LE(relative_difference(got[0], double(f)), this->kRelative) << alpha << " " << cos_i << " " << cos_vl;
        EXPECT_LE(relative_difference(got[3], double(f * cos_i)), this->kRelative)
            << alpha << " " << cos_i << " " << cos_vl;
      }
}

// The same directions in each of the ways to name them.
TYPED_TEST(ProximaIn, FormsAgree) {
  using S = TypeParam;
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    const double h = random.uniform(0, 1.5), d = random.uniform(0, 1.5), phi = random.uniform(0, 3.1);
    const auto g = geometry_at(h, d, phi);
    if (g.cos_i < 0.01 || g.cos_o < 0.01) continue;
    const Vec3<double>&l = g.to_light, &v = g.to_view;
    const double rest[]{0.8, 0.5, 0.1, 0.6};
    const auto with = [&](std::vector<double> in) {
      in.insert(in.end(), std::begin(rest), std::end(rest));
      return in;
    };
    const auto half = evaluate_row<ProximaRow, S, std::tuple_element_t<1, ProximaRow::Forms>>(with({h, d, phi}));
    const auto vectors = evaluate_row<ProximaRow, S>(with({l.x, l.y, l.z, v.x, v.y, v.z}));
    const auto cosines = evaluate_row<ProximaRow, S, typename TestFixture::Cosines>(with({g.cos_i, g.cos_vl}));
    const auto polar = evaluate_row<ProximaRow, S, std::tuple_element_t<2, ProximaRow::Forms>>(
        with({std::acos(l.z), std::acos(v.z), std::atan2(v.y, v.x) - std::atan2(l.y, l.x)}));
    for (std::size_t k = 0; k < 6; ++k) {
      // V.L is rounded to 1e-16, and its root is that over 2 sqrt(cos_k) off; the smallest cos_k drawn is 1e-4.
      EXPECT_LE(relative_difference(half[k], vectors[k]), kIsFloat<S> ? 1e-6 : 1e-12);
      EXPECT_LE(relative_difference(half[k], cosines[k]), kIsFloat<S> ? 1e-6 : 1e-12);
      EXPECT_LE(relative_difference(half[k], polar[k]), kIsFloat<S> ? 1e-6 : 1e-11);  // acos and atan2 round once more
    }
  }
}

TYPED_TEST(ProximaIn, WithTheCosineItIsTheSameTimesTheCosine) {
  using S = TypeParam;
  Random random(8);
  for (int i = 0; i < 5000; ++i) {
    const Proxima<double> model{Rgb<double>(random.uniform()), random.uniform()};
    const auto l = random.direction(0.001), v = random.direction(0.001);
    const Geometry<S> g(vector_in<S>(l), vector_in<S>(v));
    const Proxima<S> in = model_in<S>(model);
    const double f = first(in.eval(g).g) * first(g.cos_i), f_cos = first(in.eval_cos(g).g);
    ASSERT_LE(relative_difference(f_cos, f), kIsFloat<S> ? 5e-7 : 1e-15) << i;  // sums in another order
  }
}

// f cos_i goes to 0.19 rho alpha / pi at the light's horizon, and is no larger beside it.
TYPED_TEST(ProximaIn, WithTheCosineItIsBoundedAtTheHorizon) {
  using S = TypeParam;
  const Proxima<S> model = model_in<S>(Proxima<double>{Rgb<double>(1), 1});
  for (const double z : {1e-3, 1e-7, 1e-18, 1e-37, 1.5e-45}) {
    const Geometry<S> g(vector_in<S>(at_height(z, 1)), vector_in<S>({0, 0, 1}));
    EXPECT_NEAR(first(model.eval_cos(g).g), 0.19 * std::numbers::inv_pi, 1e-8 + z) << z;
    EXPECT_TRUE(finite_and_not_negative(channels(model.eval(g)))) << z;
  }
  for (const double z : {0.0, -1e-7}) {
    const Geometry<S> g(vector_in<S>(at_height(z, 1)), vector_in<S>({0, 0, 1}));
    EXPECT_EQ(channels(model.eval_cos(g)), (Channels{0, 0, 0}));
    EXPECT_EQ(channels(model.eval(g)), (Channels{0, 0, 0}));
  }
}

TYPED_TEST(ProximaIn, AlphaZeroIsLambertToTheLastBit) {
  using S = TypeParam;
  auto pairs = hard_pairs();
  for (const Pair& pair : dark_pairs()) pairs.push_back(pair);
  const Rgb<double> rho{0.2, 0.55, 1};
  for (const Pair& pair : pairs)
    EXPECT_EQ(eval_in<S>(Proxima<double>{rho, 0}, pair.to_light, pair.to_view),
              eval_in<S>(Lambert<double>{rho}, pair.to_light, pair.to_view))
        << pair.name;
}

TYPED_TEST(ProximaIn, EndsAreFiniteAndNotNegative) {
  using S = TypeParam;
  for_ends_of<Proxima<double>>({"base_color", "alpha"}, [](const Proxima<double>& model) {
    for (const Pair& pair : hard_pairs()) {
      EXPECT_TRUE(finite_and_not_negative(eval_in<S>(model, pair.to_light, pair.to_view))) << pair.name;
      const Geometry<S> g(vector_in<S>(pair.to_light), vector_in<S>(pair.to_view));
      EXPECT_TRUE(finite_and_not_negative(channels(model_in<S>(model).eval_cos(g)))) << pair.name;
    }
    for (const Pair& pair : dark_pairs())
      EXPECT_EQ(eval_in<S>(model, pair.to_light, pair.to_view), (Channels{0, 0, 0})) << pair.name;
  });
}

// The bracket is negative above cos_i = 0.345; it wins only beyond alpha = 1 / 0.36, which is no GGX alpha.
TEST(Proxima, IsLeastAtTheNormalAndNeverNegativeInItsRange) {
  double least = 2;
  for (int i = 0; i <= 1000; ++i)
    for (int k = 0; k <= 100; ++k) least = std::min(least, proxima_factor(1.0, i / 1000.0, k / 100.0));
  EXPECT_NEAR(least, 0.64, 1e-15);
  EXPECT_EQ(proxima_factor(1.0, 1.0, 1.0), least);
  EXPECT_LT(proxima_factor(2.8, 1.0, 1.0), 0);
}

TEST(Proxima, HasNoJumpWhereItIsClamped) {
  const Proxima<double> model{Rgb<double>(1), 1};
  // cos_k leaves 0: 2e-14 apart in V.L is sqrt(1e-14) in its root, times 0.19 / 0.05.
  const double a = channels(model.eval(at_height(0.05, 0), Random::direction_at(0.9, std::numbers::pi)))[0];
  EXPECT_GT(a, 0);
  const auto at = [&](double cos_vl) { return proxima_factor(1.0, 0.05, proxima_turn(cos_vl, 1 + cos_vl)); };
  EXPECT_NEAR(at(-1e-14), at(1e-14), 1e-6);
  EXPECT_NEAR(at(-1), at(-1 + 1e-14), 1e-12);
  EXPECT_EQ(at(0), at(0.7));
}

// It reads the light's cosine only. Both above 0.1: the one way can be 3.6 times the other.
TEST(Proxima, IsNotReciprocalByUpTo) {
  Random random(9);
  const Proxima<double> model{Rgb<double>(1), 1};
  double worst = 1;
  for (int i = 0; i < 200000; ++i) {
    const auto l = random.direction(0.1), v = random.direction(0.1);
    worst = std::max(worst, channels(model.eval(l, v))[0] / channels(model.eval(v, l))[0]);
  }
  EXPECT_GT(worst, 3.5);
  EXPECT_LE(worst, 2.35 / 0.64);  // alpha 1: 1 - 0.55 + 1.9 over 1 - 0.36
}

TEST(Proxima, ReflectsAtMostItsColor) {
  for (const double alpha : {0.1, 0.5, 1.0})
    for (const double z : {1e-3, 0.1, 0.4, 0.7, 1.0})
      EXPECT_LE(albedo(Proxima<double>{Rgb<double>(1), alpha}, z), 1) << alpha << " " << z;
  EXPECT_NEAR(albedo(Proxima<double>{Rgb<double>(1), 1}, 1), 0.83, 1e-4);      // 1 - 0.17 alpha, by hand
  EXPECT_NEAR(albedo(Proxima<double>{Rgb<double>(1), 1}, 1e-3), 0.871, 6e-4);  // the page's number
  EXPECT_NEAR(albedo(Proxima<double>{Rgb<double>(1), 1}, 0.8), 0.816, 6e-4);   // its least
}

// With respect to the angle between light and view, on both sides of the clamp at right angles.
TEST(Proxima, SlopeInTheTurnIsFiniteAndTheCentralDifference) {
  using S = ceres::Jet<double, 1>;
  for (const double theta : {0.3, 0.7853, 0.7855, 1.0, 1.4, 1.57}) {
    const auto turn = [](auto t) { return proxima_turn(cos(t + t), decltype(t)((cos(t) * cos(t)) + cos(t) * cos(t))); };
    const S got = turn(S(theta, 0));
    const Long step = 1e-7L, by = (turn(theta + step) - turn(theta - step)) / (2 * step);
    EXPECT_NEAR(got.v[0], double(by), 1e-6 * (1 + std::abs(double(by)))) << theta;  // step^2 f''', 0.1 from the kink
  }
  const S flat = proxima_turn(S(0.0, 0), S(1.0, 0));
  EXPECT_EQ(flat.a, 1);
  EXPECT_TRUE(std::isfinite(flat.v[0]));
}

}  // namespace
}  // namespace likeness::brdf
