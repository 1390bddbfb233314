#include "brdf/fresnel/schlick.h"

#include "brdf/callisto.h"
#include "brdf/fresnel/evaluators.h"
#include "tests/brdf/evaluator_row.h"

// Schlick's approximation, its falloff and its tint.
namespace likeness::brdf {
namespace {

template <class S>
class Schlick : public ::testing::Test {
 protected:
  static double plain(double f0, double c) { return evaluate_row<SchlickFresnel, S>({f0, f0, f0, c})[0]; }
  static double falloff(double f0, double n, double c) {
    return evaluate_row<SchlickFalloff, S>({f0, f0, f0, n, c})[0];
  }
  static double tinted(double f0, double tint, double c) {
    return evaluate_row<F82, S>({f0, f0, f0, tint, tint, tint, c})[0];
  }
  static constexpr double kEpsilon = kIsFloat<S> ? 6e-8 : 1.2e-16;
};
TYPED_TEST_SUITE(Schlick, Kinds, KindNames);

double published(double f0, double c) { return f0 + (1 - f0) * std::pow(1 - c, 5); }

TYPED_TEST(Schlick, IsThePublishedForm) {
  for (const double f0 : {0.0, 0.04, 0.5, 1.0})
    for (int i = 0; i <= 100; ++i) {
      const double c = i / 100.0, want = published(f0, c);
      EXPECT_NEAR(this->plain(f0, c), want, 8 * this->kEpsilon * want) << f0 << " " << c;
    }
}

TYPED_TEST(Schlick, IsExactAtBothEnds) {
  for (const double f0 : {0.0, 0.04, 0.5, 1.0}) {
    const double rounded = double(typename Arithmetic<TypeParam>::Number(f0));
    EXPECT_EQ(this->plain(f0, 1), rounded);
    EXPECT_EQ(this->plain(f0, 0), 1);
    EXPECT_EQ(this->plain(f0, -0.5), 1) << "cosines are clamped";
    EXPECT_EQ(this->plain(f0, 1.5), rounded);
    EXPECT_EQ(this->tinted(f0, 0.3, 1), rounded);
    EXPECT_EQ(this->tinted(f0, 0.3, 0), 1);
  }
}

TYPED_TEST(Schlick, FallsOffAsCallistoDoes) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Geometry<double> pair(random.direction(0.01), random.direction(0.01));
    const auto g = geometry_in<TypeParam>(pair);
    Callisto<TypeParam> model;
    model.specular_fresnel_falloff = constant<TypeParam>(i % 10 < 3 ? 0.5 * (i % 10) : random.uniform());
    const TypeParam weight = schlick_falloff_weight(model.specular_fresnel_falloff, g.versine_d);
    ASSERT_EQ(first(weight), first(model.terms(g).fresnel)) << i;
  }
}

TYPED_TEST(Schlick, HasTheNamedFalloffs) {
  for (const double f0 : {0.0, 0.04, 1.0})
    for (const double c : {0.0, 1e-7, 0.1, 0.5, 0.9, 1 - 1e-7, 1.0}) {
      EXPECT_EQ(this->falloff(f0, 0.5, c), this->plain(f0, c)) << "0.5 is Schlick's, to the last bit";
      EXPECT_EQ(this->falloff(f0, 0, c), double(typename Arithmetic<TypeParam>::Number(f0))) << "0 is no rise";
      EXPECT_EQ(this->falloff(f0, 1, c), 1) << "1 is white, also where 0^0 lurks";
    }
}

TYPED_TEST(Schlick, RisesWithFalloffAndTowardsGrazing) {
  for (int n = 0; n <= 20; ++n) {
    double before = 0;
    for (int i = 50; i >= 0; --i) {
      const double now = this->falloff(0.04, n / 20.0, i / 50.0);
      EXPECT_GE(now, before * (1 - 20 * this->kEpsilon)) << n << " " << i;
      const double duller = this->falloff(0.04, std::max(n - 1, 0) / 20.0, i / 50.0);
      EXPECT_GE(now, duller * (1 - 20 * this->kEpsilon)) << n << " " << i;
      EXPECT_LE(now, 1);
      before = now;
    }
  }
}

TYPED_TEST(Schlick, HasTheTintAt82Degrees) {
  for (const double f0 : {0.3, 0.7, 0.95})
    for (const double tint : {0.0, 0.2, 0.5, 1.0})
      EXPECT_NEAR(this->tinted(f0, tint, 1.0 / 7), tint * published(f0, 1.0 / 7), 16 * this->kEpsilon) << f0 << tint;
}

TYPED_TEST(Schlick, WithoutATintIsSchlick) {
  for (const double f0 : {0.0, 0.04, 0.5, 1.0})
    for (int i = 0; i <= 100; ++i)
      EXPECT_NEAR(this->tinted(f0, 1, i / 100.0), published(f0, i / 100.0), 16 * this->kEpsilon) << f0 << " " << i;
}

// Kutz 2021 as printed: F - b cos (1 - cos)^6.
TYPED_TEST(Schlick, TintsAsPublishedWhereThatIsNotNegative) {
  constexpr double kEdge = 1.0 / 7;
  int negative = 0;
  for (const double f0 : {0.04, 0.3, 0.7, 0.95})
    for (const double tint : {0.0, 0.02, 0.2, 0.5, 0.9, 1.0})
      for (int i = 0; i <= 100; ++i) {
        const double c = i / 100.0, b = published(f0, kEdge) * (1 - tint) / (kEdge * std::pow(1 - kEdge, 6));
        const double want = published(f0, c) - b * c * std::pow(1 - c, 6);
        negative += want < 0;
        EXPECT_NEAR(this->tinted(f0, tint, c), std::max(want, 0.0), 24 * this->kEpsilon)
            << f0 << " " << tint << " " << c;
      }
  EXPECT_GT(negative, 50) << "the clamp is never reached: the test has lost its point";
}

TYPED_TEST(Schlick, NeverLeavesZeroToOneNorJumps) {
  for (const double f0 : {0.0, 0.04, 0.5, 1.0})
    for (const double tint : {0.0, 0.01, 1.0}) {
      double before = 1;
      for (int i = 0; i <= 10000; ++i) {
        const double now = this->tinted(f0, tint, i / 10000.0);
        ASSERT_TRUE(now >= 0 && now <= 1);
        ASSERT_NEAR(now, before, 2e-3) << "steeper than any slope of the formula times the step";
        before = now;
      }
    }
}

}  // namespace
}  // namespace likeness::brdf
