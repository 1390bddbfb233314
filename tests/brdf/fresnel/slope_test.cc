#include "brdf/fresnel/evaluators.h"
#include "tests/brdf/row_slope.h"

// Derivatives of the Fresnel terms by their parameters.
namespace likeness::brdf {
namespace {

TEST(FresnelSlope, OfTheApproximations) {
  for (const double c : {0.05, 1.0 / 7, 0.4, 0.9}) {
    for (const std::size_t k : {0U, 3U}) expect_slope<SchlickFresnel>({0.1, 0.5, 0.9, c}, k, 1e-10);
    for (const double n : {0.2, 0.45, 0.8})
      for (const std::size_t k : {0U, 3U, 4U}) expect_slope<SchlickFalloff>({0.1, 0.5, 0.9, n, c}, k, 1e-9);
    for (const std::size_t k : {0U, 1U, 2U, 3U, 4U, 5U, 6U})
      expect_slope<F82>({0.6, 0.7, 0.9, 0.3, 0.6, 1, c}, k, 1e-9);
  }
}

TEST(FresnelSlope, OfTheDielectric) {
  for (const double n : {0.6, 0.99, 1.01, 1.5, 2.4})
    for (const double c : {0.05, 0.3, 0.85, 0.999})
      for (const std::size_t k : {0U, 1U}) expect_slope<FresnelDielectric>({c, n}, k, 1e-7, 1e-6);
  expect_slope<FresnelDielectric>({0, 1.5}, 1, 1e-9);           // at grazing F is 1 for every index
  expect_slope<FresnelDielectric>({0, 1.5}, 0, 1e-4, 1e-6, 1);  // and falls steeply; the other side belongs to 1 / eta
  expect_slope<FresnelDielectric>({1, 1}, 1, 1e-9, 1e-4);       // no boundary: F has a double zero
  expect_slope<FresnelDielectric>({0.2, 0.5}, 1, 1e-9);         // total reflection
}

TEST(FresnelSlope, OfTheConductor) {
  for (const double eta : {0.2, 1.0, 1.44, 4.0})
    for (const double k : {0.3, 1.6, 3.9, 8.0})
      for (const double c : {0.05, 0.5, 0.999})
        for (const std::size_t at : {0U, 1U, 4U})
          expect_slope<FresnelConductor>({c, eta, eta, eta, k, k, k}, at, 1e-7, 1e-6);
}

TEST(FresnelSlope, OfAbsorptionWhereItSets) {  // k = 0 is the end of the range: to one side
  for (const double c : {0.3, 0.8, 1.0})
    for (const double eta : {0.5, 1.5}) expect_slope<FresnelConductor>({c, eta, eta, eta, 0, 0, 0}, 4, 1e-5, 1e-6, 1);
}

// At the critical angle the slope is infinite, at 0 / 0 it does not exist: what an optimiser gets is a number.
TEST(FresnelSlope, IsFiniteWhereThereIsNone) {
  using Dual = ceres::Jet<double, 2>;
  for (const double eta : {0.5, 1.0, 1.5})
    for (const double c : {0.0, std::sqrt(0.75), 1.0}) {
      const Dual f = fresnel_dielectric(Dual(c, 0), Dual(eta, 1)),
                 m = fresnel_conductor(Dual(c, 0), Dual(eta, 1), Dual(0));
      for (const Dual& x : {f, m})
        EXPECT_TRUE(std::isfinite(x.a) && std::isfinite(x.v[0]) && std::isfinite(x.v[1])) << c << " " << eta;
    }
}

}  // namespace
}  // namespace likeness::brdf
