#include "brdf/lighting/gt_tonemap.h"

#include <limits>

#include "brdf/lighting/evaluators.h"
#include "tests/brdf/evaluator_row.h"

// The Gran Turismo tonemapper and its inverse.
namespace likeness::brdf {
namespace {

struct Curve {
  double P = 1, a = 1, m = 0.22, l = 0.4, c = 1.33, b = 0;
  std::vector<double> with(double x) const { return {x, P, a, m, l, c, b}; }
  GtTonemap<double> model() const { return {P, a, m, l, c, b}; }
};

template <class S>
class Tonemapper : public ::testing::Test {
 protected:
  static double y(double x, const Curve& curve = {}) { return evaluate_row<Tonemap, S>(curve.with(x))[0]; }
  static double part(double x, const Curve& curve = {}) { return evaluate_row<Tonemap, S>(curve.with(x))[1]; }
  static double x(double y, const Curve& curve = {}) { return evaluate_row<TonemapInverse, S>(curve.with(y))[0]; }
  static constexpr double kEpsilon = kIsFloat<S> ? 6e-8 : 1.2e-16;  // half an ulp of 1
};
TYPED_TEST_SUITE(Tonemapper, Kinds, KindNames);

// Curves that rise: the defaults, HDR displays, no shoulder (S1 = P), no line, no toe, steep, soft, with a pedestal.
const std::vector<Curve> kCurves{{},
                                 {.P = 10},
                                 {.P = 100, .a = 1.2},
                                 {.l = 1},
                                 {.l = 1 - 1e-7},
                                 {.l = 0},
                                 {.m = 0},
                                 {.m = 1e-6},
                                 {.m = 0.9, .l = 0.1},
                                 {.a = 2},
                                 {.a = 0.05},
                                 {.c = 1},
                                 {.a = 0.7, .c = 3},
                                 {.b = 0.02},
                                 {.P = 4, .a = 1.3, .m = 0.5, .l = 1, .c = 1.6, .b = 0.01}};

// The form that everybody copies, of x > 0 and parameters at which nothing of it is 0 / 0.
double published(double x, const Curve& k) {
  const double l0 = (k.P - k.m) * k.l / k.a, s0 = k.m + l0, s1 = k.m + k.a * l0, c2 = k.a * k.P / (k.P - s1);
  const double h = std::min(1.0, x / k.m), w0 = 1 - h * h * (3 - 2 * h), w2 = x >= s0 ? 1 : 0, w1 = 1 - w0 - w2;
  const double toe = k.m * std::pow(x / k.m, k.c) + k.b, shoulder = k.P - (k.P - s1) * std::exp(-c2 * (x - s0) / k.P);
  return toe * w0 + (k.m + k.a * (x - k.m)) * w1 + shoulder * w2;
}

TYPED_TEST(Tonemapper, MeetsItsFile) {
  if (read_reference("gt_tonemap.csv").empty()) GTEST_SKIP() << "no reference/gt_tonemap.csv";
  const double worst = worst_against_file<Tonemap, TypeParam>("gt_tonemap.csv", {});
  this->RecordProperty("worst", std::to_string(worst));
  EXPECT_LE(worst, kIsFloat<TypeParam> ? 4e-6 : 4e-15);  // measured 1.2e-6 and 2.3e-15, both in batches
}

TYPED_TEST(Tonemapper, IsThePublishedCurve) {
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const auto number = [&](double low, double high) { return double(float(random.uniform(low, high))); };
    const Curve k{number(1, 20), number(0.3, 1.5), number(0.05, 0.8), number(0, 0.95), number(1, 1.6), number(0, 0.02)};
    const double x = double(float(std::exp(random.uniform(-14, 4)))), want = published(x, k);
    if (std::abs(x - k.m) < 1e-6 * k.m) continue;  // with a pedestal the published weights meet in between
    // 1e-16: in the published form 1 - w0 has lost what the toe's first digits of w were.
    EXPECT_NEAR(this->y(x, k), want, kIsFloat<TypeParam> ? 4e-6 * want : 2e-14 * want + 1e-16) << x << " " << i;
  }
}

TYPED_TEST(Tonemapper, IsDefinedForEveryFloat) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const Curve& k : kCurves) {
    // Without a toe the line itself begins at 0: f(0) = (1 - a) m + ... = 0.
    const double at_0 = k.m > 0 ? double(typename Arithmetic<TypeParam>::Number(k.b)) : 0;
    for (const double x : {nan, -nan, -inf, -1e30, -1.0, -1e-45, -0.0, 0.0}) EXPECT_EQ(this->y(x, k), at_0) << x;
    EXPECT_EQ(this->y(0, {.m = 1e-45, .b = k.b}), double(typename Arithmetic<TypeParam>::Number(k.b)))
        << "b / m is no float";
    for (const double x : {inf, 3e38, 1e31}) EXPECT_EQ(this->y(x, k), k.P) << x;
    for (const double x : {1e-45, 1e-38, 1e-30, 1e-7, k.m, 65504.0})
      EXPECT_TRUE(this->y(x, k) >= 0 && this->y(x, k) <= k.P) << x;
  }
}

TYPED_TEST(Tonemapper, Rises) {
  using Number = typename Arithmetic<TypeParam>::Number;
  for (const Curve& k : kCurves) {
    ASSERT_TRUE(k.model().rises());
    double before = -1;
    for (double e = -100; e < 20; e += 0.01) {
      const double now = this->y(std::exp(e), k);
      ASSERT_GE(now, before * (1 - 4 * this->kEpsilon)) << std::exp(e);
      before = now;
    }
    // Through every float around the joints.
    for (const double joint : {k.m, k.model().shoulder_start(), 0.5 * k.m, k.m / 100}) {
      if (joint == 0) continue;
      Number x = Number(joint) - 200 * std::numeric_limits<Number>::epsilon() * Number(joint);
      before = this->y(double(x), k);
      for (int i = 0; i < 400; ++i) {
        x = std::nextafter(x, Number(1e9));
        const double now = this->y(double(x), k);
        ASSERT_GE(now, before * (1 - 4 * this->kEpsilon)) << joint << " " << i;
        ASSERT_LE(now, before + (2.5 * double(x) + before) * 8 * this->kEpsilon) << "a jump at " << joint;
        before = now;
      }
    }
  }
}

TEST(TonemapperOfSteepCurves, SaysWhereThePublishedBlendDips) {
  EXPECT_TRUE((Curve{.a = 2.2}.model().rises()));
  EXPECT_FALSE((Curve{.a = 2.4}.model().rises()));
  EXPECT_FALSE((Curve{.a = 1.5, .c = 2}.model().rises()));
  EXPECT_FALSE((Curve{.a = 2, .c = 3}.model().rises()));
  EXPECT_FALSE((Curve{.m = 0.05, .b = 0.1}.model().rises())) << "a pedestal above the line";
  const Curve dip{.a = 2, .c = 3};
  EXPECT_LT(published(0.03, dip), 0);
  EXPECT_EQ(dip.model().eval(0.03), 0) << "never negative";
}

TYPED_TEST(Tonemapper, WithoutAShoulderEndsInACorner) {  // S1 = P, where the published form is 0 / 0
  const Curve k{.l = 1};
  for (const double x : {0.3, 0.5, 0.9, 1 - 1e-6}) EXPECT_NEAR(this->y(x, k), x, 4 * this->kEpsilon);
  for (const double x : {1.0, 1 + 1e-6, 2.0, 1e6}) EXPECT_NEAR(this->y(x, k), 1, 2 * this->kEpsilon);
  for (const double x : {0.3, 1.0, 1.1, 3.0})  // and is the limit of shorter lines
    EXPECT_NEAR(this->y(x, {.l = 1 - 1e-7}), this->y(x, k), 2e-7) << x;
}

TYPED_TEST(Tonemapper, KeepsTheDigitsOfASmallValueBesideALargeP) {  // P - (P - S1) exp(...) would lose them
  const Curve k{.P = 100, .m = 1e-6, .l = 0};
  for (const double x : {1e-5, 1e-3, 0.1, 1.0}) {
    const long double m = 1e-6L, want = m - (100 - m) * std::expm1(-(x - m) / (100 - m));
    EXPECT_NEAR(this->y(x, k) / double(want), 1, kIsFloat<TypeParam> ? 1e-6 : 1e-14) << x;
    EXPECT_NEAR(this->x(double(want), k) / x, 1, kIsFloat<TypeParam> ? 1e-6 : 1e-14) << x;
  }
}

TYPED_TEST(Tonemapper, SaysWhichPartOfTheCurveItIs) {
  for (const auto& [x, part] : std::vector<std::pair<double, int>>{
           {-1, 0}, {0, 0}, {0.2199, 0}, {0.2201, 1}, {0.5319, 1}, {0.5321, 2}, {1e9, 2}})
    EXPECT_EQ(this->part(x), part) << x;
  EXPECT_EQ(this->part(std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(this->part(std::numeric_limits<double>::infinity()), 2);
}

TYPED_TEST(Tonemapper, IsUndoneByItsInverse) {
  for (const Curve& k : kCurves) {
    double worst = 0, worst_below = 0;
    for (double e = -60; e < 4; e += 0.05) {
      // Out of y: in double, so that it is the inverse alone that is measured.
      const double x = std::exp(e), y = k.model().eval(x), left = (k.P - y) / k.P;
      if (y <= k.b * (1 + 1e-9) || left < 1e-9 || y < 1e-35) continue;
      const double error = std::abs(this->x(y, k) / x - 1);
      // y stands for x to eps y / (x y'): a pedestal, a flat toe and the shoulder's end lose digits of x.
      const double slope = (k.model().eval(x * 1.0001) - y) / (x * 1e-4);
      const double digits = std::max(1.0, y / (x * slope));
      (k.b > 0 && x < k.m ? worst_below : worst) = std::max(k.b > 0 && x < k.m ? worst_below : worst, error / digits);
    }
    EXPECT_LE(worst, kIsFloat<TypeParam> ? 4e-6 : 2e-14) << k.P << " " << k.a << " " << k.m << " " << k.l << " " << k.c;
    EXPECT_LE(worst_below, kIsFloat<TypeParam> ? 4e-6 : 2e-14) << k.b;
  }
}

TYPED_TEST(Tonemapper, InvertsTheReferenceToItsOwnDigits) {
  for (const Row& row : read_reference("gt_tonemap.csv")) {
    const double x = row.at("x"), y = row.at("ref_y");
    if (x < 1e-30 || x > 4) continue;
    EXPECT_NEAR(this->x(y) / x, 1, kIsFloat<TypeParam> ? 4e-6 : 1e-13 * std::max(1.0, 1 / (1 - y) / 100)) << x;
  }
}

TYPED_TEST(Tonemapper, HasAnInverseOfEveryFloat) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const Curve& k : kCurves) {
    for (const double y : {nan, -inf, -1.0, -0.0, 0.0, k.b}) EXPECT_EQ(this->x(y, k), 0) << y;
    const double top = this->x(k.P, k), log_room = std::log(0x1p53 * (1 - k.l) * (k.P - k.m) / k.P);
    for (const double y : {k.P * (1 + 1e-6), 2 * k.P, 1e30, inf}) EXPECT_EQ(this->x(y, k), top) << y;
    EXPECT_NEAR(top, k.model().shoulder_start() + (1 - k.l) * (k.P - k.m) / k.a * std::max(0.0, log_room), 1e-5 * top);
    double before = 0;
    for (double e = -80; e < 0; e += 0.02) {
      const double now = this->x(k.b + (k.P - k.b) * std::exp(e), k);
      ASSERT_TRUE(std::isfinite(now) && now >= before * (1 - (kIsFloat<TypeParam> ? 2e-6 : 1e-13))) << e << " " << k.b;
      before = now;
    }
  }
  EXPECT_NEAR(this->x(1), 17.37, 0.01) << "the number in the page";
}

// ---- the table.

template <class S>
double from_table(double x, const GtTonemapTable& table) {
  return first(table.eval(constant<S>(x)));
}

TYPED_TEST(Tonemapper, HasATableThatIsNearIt) {
  for (const Curve& k : {Curve{}, Curve{.P = 10}, Curve{.l = 0}, Curve{.a = 1.3}, Curve{.b = 0.02}}) {
    const GtTonemapTable table(k.model());
    double worst = 0, worst_below = 0;
    for (double e = -30; e < 6; e += 0.001) {
      const double x = std::exp(e), y = k.model().eval(x), off = std::abs(from_table<TypeParam>(x, table) - y);
      if (x < GtTonemapTable::kLow) worst_below = std::max(worst_below, off / k.P);
      else worst = std::max(worst, off / y);
    }
    EXPECT_LE(worst, k.P == 1 ? 1.6e-4 : 2.5e-4) << k.P << " " << k.l;  // measured 1.34e-4 at the defaults
    EXPECT_LE(worst_below, 1e-6);                                       // measured 4.3e-7
  }
}

TYPED_TEST(Tonemapper, HasATableThatRisesToItsBrightest) {
  for (const double P : {1.0, 10.0}) {
    const Curve k{.P = P};
    const GtTonemapTable table(k.model());
    double before = 0;
    for (double e = -40; e < 70; e += 0.003) {
      const double y = from_table<TypeParam>(std::exp(e), table);
      ASSERT_GE(y, before * (1 - (kIsFloat<TypeParam> ? 1.2e-7 : 3e-16))) << "at e^" << e;  // an ulp at a point
      ASSERT_LE(y, P);
      before = y;
    }
    EXPECT_NEAR(before, P, 2e-7 * P);
  }
}

TYPED_TEST(Tonemapper, HasATableForEveryFloat) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const GtTonemapTable table(Curve{.b = 0.02}.model());
  for (const double x : {nan, -inf, -1.0, -0.0, 0.0})
    EXPECT_NEAR(from_table<TypeParam>(x, table), 0.02, 1e-9) << x;  // the pedestal, as a float
  EXPECT_NEAR(from_table<TypeParam>(inf, table), 1, 2e-7);
  const double edge = GtTonemapTable::kLow;
  EXPECT_NEAR(from_table<TypeParam>(edge * (1 - 1e-6), table), from_table<TypeParam>(edge, table), 1e-9);
}

}  // namespace
}  // namespace likeness::brdf
