#include "brdf/normal_length.h"

#include "brdf/jet.h"
#include "brdf/surface_evaluators.h"
#include "tests/brdf/evaluator_row.h"

// The length of GGX's mean normal, and the roughness that a length stands for.
namespace likeness::brdf {
namespace {

using Long = long double;

// 1 - length, by the sum of w^k / (2 k + 3) with as many terms as it takes, and by logarithms where those are too many.
Long deficit(Long alpha) {
  if (alpha == 0) return 0;
  const Long w = (1 - alpha) * (1 + alpha), s = std::sqrt(w);
  if (w > 0.5L) return alpha * alpha * (std::log((1 + s) / alpha) - s) / (w * s);
  Long sum = 0, power = 1;
  for (int k = 0; k < 70; ++k, power *= w) sum += power / (2 * k + 3);
  return alpha * alpha * sum;
}

// Dense at both ends and around the join of series and logarithm (w = 1/5).
std::vector<double> alphas() {
  std::vector<double> out{0, 1e-300, 1e-30, 1};
  for (int i = 0; i <= 1000; ++i) out.push_back(std::pow(10.0, -12 + 12.0 * i / 1000));
  for (int i = 0; i <= 1000; ++i) out.push_back(i / 1000.0);
  for (int i = 1; i <= 53; ++i) out.push_back(1 - std::ldexp(1.0, -i));
  for (int i = -50; i <= 50; ++i) out.push_back(std::sqrt(0.8) + i * 1e-9);
  for (int i = -50; i <= 50; ++i) out.push_back(std::sqrt(0.8) + i * 1e-16);
  return out;
}

template <class S>
class NormalLengthIn : public ::testing::Test {
 protected:
  static constexpr double kRelative = kIsFloat<S> ? 2e-5 : 1e-12;  // the demand
};
TYPED_TEST_SUITE(NormalLengthIn, Kinds, KindNames);

TYPED_TEST(NormalLengthIn, MeetsItsFile) {
  if (read_reference("normal_length.csv").empty())
    GTEST_SKIP() << "no " LIKENESS_SHARED_DIR "/reference/normal_length.csv";
  const double worst = worst_against_file<NormalLength, TypeParam>("normal_length.csv", {});
  this->RecordProperty("worst_relative_difference", (std::ostringstream() << worst).str());
}

TYPED_TEST(NormalLengthIn, EqualsTheFormulaForEveryAlpha) {
  using S = TypeParam;
  double worst = 0;
  for (const double alpha : alphas()) {
    const double in = first(constant<S>(alpha)), got = first(normal_length(constant<S>(alpha)));
    worst = std::max(worst, relative_difference(got, double(1 - deficit(in))));
    EXPECT_LE(relative_difference(got, double(1 - deficit(in))), this->kRelative) << alpha;
    EXPECT_GE(got, 2.0 / 3 * (1 - this->kRelative)) << alpha;
    EXPECT_LE(got, 1) << alpha;
  }
  EXPECT_LE(worst, kIsFloat<S> ? 6e-7 : 1.5e-15);  // 4.7e-7 and 1.1e-15, beside the join
  EXPECT_EQ(first(normal_length(constant<S>(0))), 1);
  EXPECT_NEAR(first(normal_length(constant<S>(1))), 2.0 / 3, kIsFloat<S> ? 6e-8 : 2e-16);
}

TYPED_TEST(NormalLengthIn, HasNoStepAtTheJoin) {
  using S = TypeParam;
  double last = 1;
  const double rounding = kIsFloat<S> ? 1e-6 : 2.4e-15;  // of both sides
  for (int i = 0; i <= 20000; ++i) {
    const double length = first(normal_length(constant<S>(0.885 + i * 1e-6)));
    EXPECT_LE(length, last + rounding) << i;  // falls by 2.9e-7 a step
    if (i > 0) {
      EXPECT_GE(length, last - 3e-7 - rounding) << i;
    }
    last = length;
  }
}

// Nothing of the closed form: the normals themselves, by Simpson's rule in the logarithm of the tangent.
TEST(NormalLength, IsTheMeanOfTheNormalsOfGgx) {
  for (const double alpha : {1e-3, 0.05, 0.3, 0.8, 0.99, 1.0}) {
    double sum = 0;
    const int steps = 4000;
    const double low = std::log(1e-9 * alpha), high = std::log(1e9);
    for (int i = 0; i <= steps; ++i) {
      const double t = std::exp(low + (high - low) * i / steps), c = 1 / std::sqrt(1 + t * t), s = t * c;
      const double weight = i == 0 || i == steps ? 1 : i % 2 ? 4 : 2;
      // D cos over the hemisphere is the share of the flat surface; cos again is the height of the normal.
      sum += weight * ggx_distribution(alpha, c, s * s) * c * c * 2 * std::numbers::pi * s * (t * c * c);
    }
    EXPECT_NEAR(sum * (high - low) / (3 * steps), normal_length(alpha), 1e-9) << alpha;  // the rule: 1e-11 measured
  }
}

TYPED_TEST(NormalLengthIn, TheInverseGivesTheAlphaBack) {
  using S = TypeParam;
  double worst = 0;
  for (const double alpha : alphas()) {
    if (alpha > 0 && alpha < 1e-12) continue;
    const double d = double(deficit(alpha));
    const double got = first(alpha_of_normal_deficit(constant<S>(d)));
    worst = std::max(worst, relative_difference(got, alpha));
    EXPECT_LE(relative_difference(got, alpha), this->kRelative) << alpha;
  }
  EXPECT_LE(worst, kIsFloat<S> ? 3e-6 : 1e-14);  // 1.4e-6 and 3.7e-15 measured, beside the join
}

// The row: a length in double, then 1 - length in S.
TYPED_TEST(NormalLengthIn, FewerStepsAreAsExactAsThePageSays) {
  using S = TypeParam;
  double one = 0, two = 0;
  for (double e = std::log(1e-12); e <= 0; e += 0.01) {
    const double alpha = std::exp(e), d = double(deficit(alpha));
    one = std::max(one, std::abs(first(alpha_of_normal_deficit<1>(constant<S>(d))) / alpha - 1));
    two = std::max(two, std::abs(first(alpha_of_normal_deficit<2>(constant<S>(d))) / alpha - 1));
  }
  EXPECT_LE(one, 2.4e-4);                     // measured 2.32e-4
  EXPECT_GE(one, 1e-4) << "it is one step";   // as three would be, at rounding
  EXPECT_LE(two, kIsFloat<S> ? 4e-6 : 1e-9);  // measured 6.8e-10 in double
}

TYPED_TEST(NormalLengthIn, TheInverseIsExactForTheLengthThatItIsGiven) {
  using S = TypeParam;
  for (int i = 0; i <= 3000; ++i) {
    const double length = i <= 1000   ? 2.0 / 3 + i / 3000.0
                          : i <= 2000 ? 1 - std::pow(10.0, -(i - 1000) / 66.0)
                                      : 2.0 / 3 + std::pow(10.0, -(i - 1990) / 66.0);
    const auto got = evaluate_row<RoughnessFromNormalLength, S>({length});
    // What would have to change in the length for this alpha, against what 1 - length was.
    const double want = std::clamp(1 - length, 0.0, 1.0 / 3);
    EXPECT_LE(relative_difference(double(deficit(got[1])), want), 2 * this->kRelative) << length;
    EXPECT_LE(relative_difference(got[0] * got[0], got[1]), 1e-6) << length;
  }
}

TYPED_TEST(NormalLengthIn, TheInverseHoldsAtItsEndsAndBeyond) {
  using S = TypeParam;
  for (const double length : {2.0 / 3, 0.6666666, 0.5, 0.0, -1.0})
    EXPECT_NEAR(first(alpha_of_normal_length(constant<S>(length))), 1, kIsFloat<S> ? 4e-7 : 1e-15) << length;
  for (const double length : {1.0, 1.0000001, 2.0}) EXPECT_EQ(first(alpha_of_normal_length(constant<S>(length))), 0);
  // No step at either end.
  EXPECT_NEAR(first(alpha_of_normal_deficit(constant<S>(1.0 / 3 - 1e-6))), 1 - 3.75e-6, kIsFloat<S> ? 5e-7 : 1e-11);
  EXPECT_LE(first(alpha_of_normal_deficit(constant<S>(1e-30))), 1e-15);
}

TYPED_TEST(NormalLengthIn, IsMonotoneInBothDirections) {
  using S = TypeParam;
  double last = 2;
  for (int i = 0; i <= 5000; ++i) {
    const double alpha = first(alpha_of_normal_length(constant<S>(0.6 + 0.4 * i / 5000)));
    EXPECT_LE(alpha, last + (kIsFloat<S> ? 3e-6 : 1e-14)) << i;  // the inverse's error
    last = alpha;
  }
}

// ---- derivatives.

template <class T>
using Dual = ceres::Jet<T, 1>;

TEST(NormalLength, SlopesEqualTheCentralDifference) {
  using S = Dual<double>;
  for (const double alpha : {1e-6, 1e-3, 0.1, 0.5, 0.9, 0.894, 0.895, 0.99, 1 - 1e-6}) {
    const Long step = 1e-7L * alpha;
    const double want = double((deficit(alpha - step) - deficit(alpha + step)) / (2 * step));
    const S got = normal_length(S(alpha, 0));
    EXPECT_NEAR(got.v[0] / want, 1, 1e-8) << alpha;  // step^2 f''' and rounding: 1e-10
    // And of the inverse, 1 / slope.
    const S back = alpha_of_normal_deficit(S(double(deficit(alpha)), 0));
    EXPECT_NEAR(back.v[0] * -want, 1, 1e-8) << alpha;
  }
}

template <class T>
class NormalLengthSlope : public ::testing::Test {};
TYPED_TEST_SUITE(NormalLengthSlope, Kinds, KindNames);
TYPED_TEST(NormalLengthSlope, IsFiniteAtEveryEnd) {
  using T = TypeParam;
  Dual<T> x;
  x.v[0] = T(1);
  for (const double alpha : {0.0, 1e-30, 1e-4, 0.894427191, 0.9999999, 1.0}) {
    x.a = constant<T>(alpha);
    const Dual<T> length = normal_length(x);
    EXPECT_TRUE(std::isfinite(first(length.a)) && std::isfinite(first(length.v[0]))) << alpha;
  }
  for (const double length : {-1.0, 0.0, 0.66, 2.0 / 3, 0.66666669, 0.9, 0.9999999, 1.0, 2.0}) {
    x.a = constant<T>(length);
    const Dual<T> alpha = alpha_of_normal_length(x), roughness = safe_sqrt(alpha);
    for (const Dual<T>& y : {alpha, roughness})
      EXPECT_TRUE(std::isfinite(first(y.a)) && std::isfinite(first(y.v[0]))) << length;
  }
}

}  // namespace
}  // namespace likeness::brdf
