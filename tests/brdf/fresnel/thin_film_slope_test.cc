#include "brdf/fresnel/evaluators.h"
#include "tests/brdf/row_slope.h"

// Derivatives of films by thickness, indices and camera: what a fit of an eye or of a bubble needs.
namespace likeness::brdf {
namespace {

TEST(ThinFilmSlope, OfEveryInput) {
  for (const double d : {1.0, 60.0, 777.0, 5000.0})
    for (const double c : {0.1, 0.5, 0.95})
      for (const double n1 : {1.2, 1.48, 2.4})
        for (std::size_t k = 0; k < 6; ++k) expect_slope<ThinFilmReflectance>({c, 1, n1, 1.337, d, 550}, k, 1e-6, 2e-6);
}

TEST(ThinFilmSlope, OfThicknessWhereTheFilmBegins) {  // R is even in it: the slope is 0
  for (const double c : {0.1, 1.0}) expect_slope<ThinFilmReflectance>({c, 1, 1.48, 1.337, 0, 550}, 4, 1e-9);
}

TEST(ThinFilmSlope, AcrossTheCriticalAngleOfTheFilm) {
  const double critical = std::sqrt(1 - 1 / 2.25);
  for (const double off : {-1e-2, -1e-4, -1e-6, 0.0, 1e-6, 1e-4, 1e-2})
    for (const double d : {20.0, 300.0})
      for (const std::size_t k : {0U, 2U, 4U})
        expect_slope<ThinFilmReflectance>({critical + off, 1.5, 1, 1.5, d, 550}, k, 1e-5, 1e-6);
}

TEST(ThinFilmSlope, OfAnAirGapThatReflectsTotally) {
  for (const double d : {10.0, 200.0, 2000.0})
    for (const std::size_t k : {0U, 2U, 4U, 5U}) expect_slope<ThinFilmReflectance>({0.5, 1.5, 1, 1.5, d, 550}, k, 1e-6);
}

TEST(ThinFilmSlope, OfColors) {
  for (const double d : {0.0, 60.0, 400.0})
    for (std::size_t k = 0; k < 5; ++k) {
      expect_slope<ThinFilmRgb>({0.7, 1, 1.48, 1.337, d}, k, 1e-6);
      expect_slope<ThinFilmCamera>({0.7, 1, 1.48, 1.337, d, 600, 540, 460, 35}, k, 1e-6);
    }
  for (std::size_t k = 5; k < 9; ++k)
    expect_slope<ThinFilmCamera>({0.7, 1, 1.48, 1.337, 300, 600, 540, 460, 35}, k, 1e-6);
}

}  // namespace
}  // namespace likeness::brdf
