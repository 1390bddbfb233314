#include "brdf/fresnel/conductor.h"

#include <complex>

#include "brdf/fresnel/dielectric.h"
#include "brdf/fresnel/evaluators.h"
#include "tests/brdf/evaluator_row.h"

// Fresnel reflectance of metals.
namespace likeness::brdf {
namespace {

template <class S>
class Conductor : public ::testing::Test {
 protected:
  static double f(double cos_i, double eta, double k) {
    return first(fresnel_conductor(constant<S>(cos_i), constant<S>(eta), constant<S>(k)));
  }
  static constexpr double kEpsilon = kIsFloat<S> ? 6e-8 : 1.2e-16;  // half an ulp of 1
};
TYPED_TEST_SUITE(Conductor, Kinds, KindNames);

using Complex = std::complex<long double>;
long double textbook(long double cos_i, Complex m) {
  const Complex cos_t = std::sqrt(1.0L - (1 - cos_i * cos_i) / (m * m));
  return (std::norm((cos_i - m * cos_t) / (cos_i + m * cos_t)) + std::norm((m * cos_i - cos_t) / (m * cos_i + cos_t))) /
         2;
}

TYPED_TEST(Conductor, IsTheTextbooksFormula) {
  Random random(1);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto c = float(random.uniform()), eta = float(random.uniform(0.05, 4)), k = float(random.uniform(0.05, 8));
    const double got = evaluate_row<FresnelConductor, TypeParam>({c, eta, eta, eta, k, k, k})[1];
    worst = std::max(worst, relative_difference(got, double(textbook(c, {eta, k})), 1e-300));
  }
  EXPECT_LE(worst, kIsFloat<TypeParam> ? 2e-6 : 3e-15);  // measured 4.2e-7 and 7.1e-16
}

TYPED_TEST(Conductor, IsADielectricWhereNothingIsAbsorbed) {
  Random random(2);
  const std::vector<double> indices{0.05, 0.3, 1 / 1.55, 0.9999, 1, 1.0001, 1.33, 2.4, 20};
  for (const double n : indices)
    for (int i = 0; i <= 300; ++i) {
      const double critical = n < 1 ? std::sqrt(1 - n * n) : 0.5;
      const double c = i < 280 ? i / 280.0 : critical * (1 + (i - 290) * 1e-7);
      const double metal = this->f(c, n, 0);
      const double glass = first(fresnel_dielectric(constant<TypeParam>(c), constant<TypeParam>(n)));
      // The sums are ordered differently: 8 roundings, 64 of them where their difference has gone through a root.
      EXPECT_NEAR(metal, glass, 64 * this->kEpsilon * std::max(glass, 1e-6)) << c << " " << n;
    }
}

TYPED_TEST(Conductor, JoinsTheDielectricSmoothly) {  // total reflection becomes attenuated, without a step
  for (const double n : {0.5, 0.9, 1.5})
    for (const double c : {0.0, 0.2, 0.5, 0.9, 1.0}) {
      double before = this->f(c, n, 0);
      for (const double k : {1e-20, 1e-12, 1e-8, 1e-6, 1e-5}) {
        const double now = this->f(c, n, k);
        EXPECT_NEAR(now, before, 20 * k + 16 * this->kEpsilon) << n << " " << c << " " << k;
        before = now;
      }
    }
}

TYPED_TEST(Conductor, HasTheKnownReflectanceAtTheNormal) {
  for (const double eta : {0.05, 0.2, 1.0, 1.44, 4.0})
    for (const double k : {0.0, 0.1, 1.6, 3.9, 20.0}) {
      const double want = ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
      EXPECT_NEAR(this->f(1, eta, k), want, 32 * this->kEpsilon * std::max(want, 1e-2)) << eta << " " << k;
    }
}

TYPED_TEST(Conductor, ReflectsEverythingAtGrazing) {
  for (const double eta : {0.0, 0.05, 1.0, 4.0, 20.0})
    for (const double k : {0.1, 3.9, 20.0}) {
      EXPECT_NEAR(this->f(0, eta, k), 1, 8 * this->kEpsilon) << eta << " " << k;
      EXPECT_EQ(this->f(-0.3, eta, k), this->f(0, eta, k)) << "from inside: as at grazing";
    }
}

TYPED_TEST(Conductor, ReflectsNothingWhereThereIsNoBoundary) {
  for (const double c : {0.0, 1e-30, 1e-18, 1e-7, 0.3, 1.0}) EXPECT_EQ(this->f(c, 1, 0), 0) << c;
}

TYPED_TEST(Conductor, StaysBetweenNothingAndEverything) {
  Random random(3);
  const auto edge = [&](std::initializer_list<double> edges, double low, double high) {
    return random.uniform() < 0.5 ? edges.begin()[random.index(edges.size())] : random.uniform(low, high);
  };
  for (int i = 0; i < 100000; ++i) {
    const double c = edge({0, 1, 1e-7, 1e-19, 1e-38, 1e-45, 0.5}, 0, 1);
    const double eta = edge({0, 1, 0.05, 20, 1.0000001, 0.9999999}, 0, 4), k = edge({0, 1e-38, 1e-10, 1, 20}, 0, 8);
    const double f = this->f(c, eta, k);
    ASSERT_TRUE(f >= 0 && f <= 1) << f << " at " << c << ", " << eta << ", " << k;
  }
}

TYPED_TEST(Conductor, TreatsTheChannelsAlike) {
  const auto rgb = evaluate_row<FresnelConductor, TypeParam>({0.4, 0.14, 0.37, 1.44, 3.98, 2.39, 1.6});  // gold
  const std::array<double, 3> eta{0.14, 0.37, 1.44}, k{3.98, 2.39, 1.6};
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_EQ(rgb[c], (evaluate_row<FresnelConductor, TypeParam>({0.4, eta[c], eta[c], eta[c], k[c], k[c], k[c]})[0]));
  EXPECT_GT(rgb[0], rgb[1]);
  EXPECT_GT(rgb[1], rgb[2]);
}

}  // namespace
}  // namespace likeness::brdf
