#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "fit/capture/capture_fit.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "tests/fit/capture/sphere_capture.h"
#include "tests/render/temporary_folder.h"

namespace likeness::capture_fit {
namespace {

using test::TemporaryFolder;

test::SphereCapture callisto_sphere() {
  test::SphereCapture out{.lights = test::spiral_of_lights(48, 75), .with_normals = true};
  out.material.specular = 0.6;
  out.material.roughness = 0.35;
  out.material.smooth_terminator = 0.5;
  out.material.smooth_terminator_length = 0.6;
  return out;
}

const fit::Estimate& estimate(const Fit& fit, std::string_view name) {
  for (const fit::Estimate& e : fit.estimates)
    if (e.name == name) return e;
  throw std::runtime_error("no estimate of " + std::string(name));
}

TEST(SharedMaterial, IsFoundExactlyFromPhotographsWithoutNoise) {
  const TemporaryFolder folder;
  const auto want = callisto_sphere();
  const Fit fit = fit_capture(make_sphere(folder / "c", want), 0, {}, kGo);
  EXPECT_EQ(fit.normals_from, NormalSource::kGiven);
  // Photos are floats: 6e-8 of each sample; the terminator's length is known ten times worse than the others.
  EXPECT_NEAR(fit.material.specular, 0.6, 1e-6);
  EXPECT_NEAR(fit.material.roughness, 0.35, 1e-6);
  EXPECT_NEAR(fit.material.smooth_terminator, 0.5, 1e-5);
  EXPECT_NEAR(fit.material.smooth_terminator_length, 0.6, 1e-5);
  for (const int at : {10, 20, 30}) {
    const auto color = test::sphere_color(40, at, 20);
    EXPECT_NEAR(fit.base_colors.at(at, 20)[0], color.r, 2e-6);
    EXPECT_NEAR(fit.base_colors.at(at, 20)[1], color.g, 2e-6);
    EXPECT_NEAR(fit.base_colors.at(at, 20)[2], color.b, 2e-6);
  }
  EXPECT_EQ(estimate(fit, "retroreflection").fitted, false);
  EXPECT_FALSE(estimate(fit, "retroreflection").why.empty());
}

TEST(SharedMaterial, RelightingIsThePhotographOfALightThatWasLeftOut) {
  const TemporaryFolder folder;
  const capture::Capture capture = make_sphere(folder / "c", callisto_sphere());
  Options options;
  options.leave_out = {5};
  options.pixels = 400;
  const Fit fit = fit_capture(capture, 0, options, kGo);
  EXPECT_EQ(fit.counts.lights, 47u);
  const image::Picture photo = capture::read_photo(capture, 5).light;
  const Relighting relighting(capture, fit);
  const image::Picture render = relighting.render(5);
  const Shading shading = relighting.shading(5);
  for (std::size_t k = 0; k < photo.rgb.size(); ++k) {
    ASSERT_NEAR(render.rgb[k], photo.rgb[k], 1e-5) << k;  // parameters are right to 1e-5
    ASSERT_NEAR(render.rgb[k], fit.base_colors.rgb[k] * shading.diffuse[k / 3] + shading.specular[k / 3], 1e-6) << k;
  }
}

TEST(SharedMaterial, IsWithinItsUncertaintyUnderNoise) {
  const TemporaryFolder folder;
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 1);
  auto want = callisto_sphere();
  want.spoil = [&](std::size_t, int, int, float* rgb) {
    for (int c = 0; c < 3; ++c) rgb[c] += 0.02f * rgb[c] * noise(random) + 0.0005f * noise(random);
  };
  const Fit fit = fit_capture(make_sphere(folder / "c", want), 0, {}, kGo);
  const auto expect = [&](std::string_view name, double truth, double most_sigma) {
    const fit::Estimate& e = estimate(fit, name);
    ASSERT_TRUE(e.fitted) << name;
    EXPECT_LT(std::abs(e.value - truth), 4 * e.sigma) << name << " = " << e.value << " +- " << e.sigma;
    EXPECT_LT(e.sigma, most_sigma) << name;  // a sigma that is large enough would make the line above say nothing
    EXPECT_GT(e.sigma, 0) << name;
  };
  expect("specular", 0.6, 0.01);
  expect("roughness", 0.35, 0.003);
  expect("smooth_terminator", 0.5, 0.03);
  expect("smooth_terminator_length", 0.6, 0.03);
}

TEST(SharedMaterial, AMatteSurfaceHasNoSpecularAndSaysSo) {
  const TemporaryFolder folder;
  test::SphereCapture want{
      .material = test::lambert_material(), .lights = test::spiral_of_lights(24), .with_normals = true};
  const Fit fit = fit_capture(make_sphere(folder / "c", want), 0, {}, kGo);
  for (const std::string_view name : {"specular", "smooth_terminator", "diffuse_fresnel", "retroreflection"}) {
    EXPECT_FALSE(estimate(fit, name).fitted) << name;
    EXPECT_FALSE(estimate(fit, name).why.empty()) << name;
  }
  EXPECT_EQ(fit.material.specular, 0);
  EXPECT_EQ(fit.material.roughness, 0.5);
}

TEST(SharedMaterial, APhotographInAnotherUnitHasAnExposureAndTheSameRender) {
  const TemporaryFolder folder;
  auto want = callisto_sphere();
  want.spoil = [](std::size_t, int, int, float* rgb) {
    for (int c = 0; c < 3; ++c) rgb[c] *= 100;
  };
  const capture::Capture capture = make_sphere(folder / "c", want);
  const Fit fit = fit_capture(capture, 0, {.pixels = 200}, kGo);
  EXPECT_GT(fit.exposure, 50);
  EXPECT_FALSE(fit.notes.empty());
  for (const float color : fit.base_colors.rgb) EXPECT_LT(color, 1.0f);
  const image::Picture photo = capture::read_photo(capture, 3).light, render = Relighting(capture, fit).render(3);
  EXPECT_NEAR(render.at(20, 20)[0], photo.at(20, 20)[0], 0.01f * photo.at(20, 20)[0]);
}

TEST(SharedMaterial, BandsOfRowsChangeNothing) {
  const TemporaryFolder folder;
  const capture::Capture capture = make_sphere(folder / "c", callisto_sphere());
  Options options{.normals = NormalSource::kEstimate, .pixels = 100};
  const Fit whole = fit_capture(capture, 0, options, kGo);
  options.bytes = 200 * 3 * 4 * 48;  // 200 pixels
  const Fit banded = fit_capture(capture, 0, options, kGo);
  EXPECT_EQ(whole.counts.bands, 1u);
  EXPECT_GT(banded.counts.bands, 4u);
  EXPECT_EQ(whole.normals.rgb, banded.normals.rgb);
  EXPECT_EQ(whole.base_colors.rgb, banded.base_colors.rgb);
  EXPECT_EQ(whole.counts.samples, banded.counts.samples);
}

}  // namespace
}  // namespace likeness::capture_fit
