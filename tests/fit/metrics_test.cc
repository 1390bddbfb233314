#include "fit/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/fit/known_materials.h"

namespace likeness::fit {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

brdf::AnyBrdf gloss(double roughness) {
  brdf::Callisto<double> m;
  m.base_color = {0.5, 0.3, 0.1};
  m.roughness = roughness;
  return m;
}

// spec: 90 x 90 bin centres, theta_h and theta_d linear, phi_d = 90 deg, both angles within the cut; there
// cos_i = cos_o = cos theta_h cos theta_d.
TEST(Metrics, SliceErrorsAreTheirDefinitions) {
  for (const double cut : {80.0, 60.0}) {
    const test::Evaluated material(gloss(0.2));
    const brdf::AnyBrdf model = gloss(0.35);
    double shown = 0, log = 0;
    std::size_t count = 0;
    for (int h = 0; h < 90; ++h)
      for (int d = 0; d < 90; ++d) {
        const double th = (h + 0.5) * kDegree, td = (d + 0.5) * kDegree, cosine = std::cos(th) * std::cos(td);
        if (cosine < std::cos(cut * kDegree)) continue;
        const measured::Direction l{std::sin(th) * std::cos(td), std::sin(td), cosine}, v{l.x, -l.y, cosine};
        const auto f = test::value_of(gloss(0.2), l, v), g = test::value_of(model, l, v);
        const double pair[3][2] = {{f.r, g.r}, {f.g, g.g}, {f.b, g.b}};
        for (const auto& [a, b] : pair) {
          shown += std::pow(std::min(a, 1.0) - std::min(b, 1.0), 2);
          log += std::pow(std::log1p(a * cosine) - std::log1p(b * cosine), 2);
        }
        ++count;
      }
    const Metrics m = Reference(material, cut).of(model);
    EXPECT_EQ(m.slice_samples, count);
    EXPECT_EQ(m.slice_grid, 8100u);
    const double n = 3 * static_cast<double>(count);
    EXPECT_NEAR(m.slice_error_pct / (100 * std::sqrt(shown / n)), 1, 1e-9);  // directions from angles: 1e-15 at a peak
    EXPECT_NEAR(m.slice_log_rms / std::sqrt(log / n), 1, 1e-9);
    const Metrics slice = slice_metrics(slice_points(material, cut), model);
    EXPECT_EQ(slice.slice_error_pct, m.slice_error_pct);
    EXPECT_EQ(slice.slice_log_rms, m.slice_log_rms);
  }
}

TEST(Metrics, TableErrorAndAlbedoAreTheirDefinitions) {
  const test::Evaluated material(gloss(0.4));
  const brdf::AnyBrdf model = gloss(0.5);
  double squares = 0, weights = 0, flux = 0, model_flux = 0, cosines = 0;
  material.for_each_sample([&](const measured::Sample& s) {
    if (s.to_light.z < std::cos(80 * kDegree) || s.to_view.z < std::cos(80 * kDegree)) return;
    const auto g = test::value_of(model, s.to_light, s.to_view);
    const double pair[3][2] = {{s.f.r, g.r}, {s.f.g, g.g}, {s.f.b, g.b}};
    for (const auto& [a, b] : pair)
      squares += s.weight * std::pow(std::log1p(a * s.to_light.z) - std::log1p(b * s.to_light.z), 2);
    weights += s.weight;
    const double w = s.weight * s.to_light.z * s.to_view.z;
    cosines += w;
    flux += w * s.f.g;
    model_flux += w * g.g;
  });
  const Metrics m = Reference(material, 80).of(model);
  EXPECT_NEAR(m.log_rms_3d / std::sqrt(squares / (3 * weights)), 1, 1e-5);  // single precision
  EXPECT_NEAR(m.albedo_reference.g / (std::numbers::pi * flux / cosines), 1, 1e-9);
  EXPECT_NEAR(m.albedo_model.g / (std::numbers::pi * model_flux / cosines), 1, 1e-5);  // single precision
  EXPECT_GT(m.sphere_psnr, 20);
  EXPECT_LT(m.sphere_psnr, 60);
}

TEST(Metrics, AModelAgainstItselfIsPerfect) {
  const test::Evaluated material(gloss(0.4));
  const Metrics m = Reference(material, 80).of(gloss(0.4));
  EXPECT_LT(m.slice_error_pct, 1e-10);
  EXPECT_LT(m.log_rms_3d, 1e-5);
  EXPECT_NEAR(m.albedo_model.r, m.albedo_reference.r, 1e-6);
  EXPECT_GT(m.sphere_psnr, 60);  // 8-bit display values
  EXPECT_NEAR(m.sphere_ssim, 1, 1e-4);
}

// White Lambert: the bihemispherical reflectance within any cut is the base color.
TEST(Metrics, AlbedoOfLambertIsItsColor) {
  brdf::Lambert<double> white;
  white.base_color = {1, 0.5, 0.25};
  const Metrics m = Reference(test::Evaluated(white), 70).of(white);
  EXPECT_NEAR(m.albedo_reference.r, 1, 1e-12);  // the same weights above and below
  EXPECT_NEAR(m.albedo_model.b, 0.25, 1e-6);    // single precision
}

}  // namespace
}  // namespace likeness::fit
