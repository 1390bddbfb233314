#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fit/capture/capture_fit.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "tests/fit/capture/sphere_capture.h"
#include "tests/render/temporary_folder.h"

namespace likeness::capture_fit {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

test::SphereCapture lambert_sphere(std::vector<glm::dvec3> lights) {
  test::SphereCapture out{.size = 24, .material = test::lambert_material(), .lights = std::move(lights)};
  return out;
}

// Everything that a fit returns is finite, unit or 0 where it must be, and its counts add up.
void expect_sound(const Fit& fit) {
  std::size_t without = 0;
  for (std::size_t k = 0; k < fit.normals.rgb.size(); k += 3) {
    double length2 = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_TRUE(std::isfinite(fit.normals.rgb[k + c]));
      ASSERT_TRUE(std::isfinite(fit.base_colors.rgb[k + c]));
      ASSERT_GE(fit.base_colors.rgb[k + c], 0);
      ASSERT_GE(fit.confidence.rgb[k + c], 0);
      ASSERT_LE(fit.confidence.rgb[k + c], 1);
      length2 += static_cast<double>(fit.normals.rgb[k + c]) * static_cast<double>(fit.normals.rgb[k + c]);
    }
    ASSERT_TRUE(length2 == 0 || std::abs(length2 - 1) < 1e-5) << length2;
    without += length2 == 0 ? 1 : 0;
  }
  EXPECT_EQ(fit.counts.without_normal + fit.normals.rgb.size() / 3 - fit.counts.pixels, without);
  EXPECT_TRUE(std::isfinite(fit.residuals.callisto_loss));
  EXPECT_LE(fit.residuals.callisto_loss, fit.residuals.lambert_loss * (1 + 1e-12) + 1e-12);
  for (const fit::Estimate& e : fit.estimates) EXPECT_TRUE(std::isfinite(e.value)) << e.name;
}

TEST(HardCases, OneLightOrTwoGiveNoNormalAndSaySo) {
  const TemporaryFolder folder;
  for (const std::size_t count : {1u, 2u}) {
    const auto want = lambert_sphere(test::spiral_of_lights(count, 30));
    const Fit fit = fit_capture(make_sphere(folder / std::to_string(count), want), 0, kEstimate, kGo);
    expect_sound(fit);
    EXPECT_EQ(fit.counts.without_normal, fit.counts.pixels);
    EXPECT_GT(fit.counts.seen_by_few, 400u);  // of 448 pixels; a few are lit by none
    ASSERT_FALSE(fit.notes.empty());
    EXPECT_THAT(fit.notes.front(), HasSubstr("three are needed"));
  }
}

TEST(HardCases, LightsInOnePlaneGiveNoNormal) {
  const TemporaryFolder folder;
  std::vector<glm::dvec3> lights;
  // A tenth of a degree off it, as measured directions are.
  for (int i = -4; i <= 4; ++i) lights.emplace_back(0.2 * i, i % 2 == 0 ? 0.002 : -0.002, 1);
  const Fit fit = fit_capture(make_sphere(folder / "c", lambert_sphere(lights)), 0, kEstimate, kGo);
  expect_sound(fit);
  EXPECT_EQ(fit.counts.without_normal, fit.counts.pixels);
  EXPECT_GT(fit.counts.in_one_plane, 400u);
}

TEST(HardCases, IdenticalLightsCountOnce) {
  const TemporaryFolder folder;
  std::vector<glm::dvec3> lights(9, glm::dvec3(0.1, 0.2, 1));
  const Fit same = fit_capture(make_sphere(folder / "same", lambert_sphere(lights)), 0, kEstimate, kGo);
  expect_sound(same);
  EXPECT_EQ(same.counts.light_directions, 1u);
  EXPECT_EQ(same.counts.without_normal, same.counts.pixels);
  // Four directions, each five times: as good as four.
  lights.clear();
  for (int i = 0; i < 20; ++i) lights.push_back(test::spiral_of_lights(4, 40)[static_cast<std::size_t>(i % 4)]);
  const Fit four = fit_capture(make_sphere(folder / "four", lambert_sphere(lights)), 0, kEstimate, kGo);
  expect_sound(four);
  EXPECT_EQ(four.counts.light_directions, 4u);
  EXPECT_NEAR(four.normals.at(12, 12)[2], test::sphere_normal(24, 12, 12).z, 1e-5);
}

TEST(HardCases, PixelsThatNoLightOrFewReachAreCounted) {
  const TemporaryFolder folder;
  auto want = lambert_sphere(test::spiral_of_lights(16));
  want.spoil = [](std::size_t light, int x, int y, float* rgb) {
    if ((x == 12 && y == 12) || (x == 13 && y == 12 && light >= 2)) rgb[0] = rgb[1] = rgb[2] = 0;
  };
  const Fit fit = fit_capture(make_sphere(folder / "c", want), 0, kEstimate, kGo);
  expect_sound(fit);
  EXPECT_EQ(fit.counts.seen_by_none, 1u);
  EXPECT_EQ(fit.counts.seen_by_few, 1u);
  EXPECT_EQ(fit.counts.without_normal, 2u);
  EXPECT_EQ(fit.normals.at(12, 12)[2], 0);
  EXPECT_EQ(fit.base_colors.at(12, 12)[0], 0);
  EXPECT_GT(fit.normals.at(11, 12)[2], 0.5f);
}

TEST(HardCases, NotFiniteNegativeAndClippedSamplesAreLeftOutAndCounted) {
  const TemporaryFolder folder;
  auto want = lambert_sphere(test::spiral_of_lights(24));
  want.spoil = [](std::size_t light, int x, int y, float* rgb) {
    if (light == 3) rgb[1] = (x + y) % 2 == 0 ? kNaN : INFINITY;
    if (light == 4) rgb[0] = rgb[1] = rgb[2] = -0.05f;
    if (light == 5) rgb[0] = 30;
  };
  capture::Capture capture = make_sphere(folder / "c", want);
  for (capture::Frame& frame : capture.frames) frame.clip = 20;
  const Fit fit = fit_capture(capture, 0, kEstimate, kGo);
  expect_sound(fit);
  EXPECT_EQ(fit.counts.not_finite, fit.counts.pixels);
  EXPECT_EQ(fit.counts.negative, fit.counts.pixels);
  EXPECT_EQ(fit.counts.clipped, fit.counts.pixels);
  // Two photos are left out and one is wrong; the others have no noise.
  EXPECT_NEAR(fit.normals.at(12, 12)[2], test::sphere_normal(24, 12, 12).z, 1e-5);
}

TEST(HardCases, AFullSensorSaysNothingOfTheLightAboveIt) {
  const TemporaryFolder folder;
  auto want = lambert_sphere(test::spiral_of_lights(24));
  want.spoil = [](std::size_t, int, int, float* rgb) {
    for (int c = 0; c < 3; ++c) rgb[c] = std::min(rgb[c], 0.125f);
  };
  capture::Capture capture = make_sphere(folder / "c", want);
  for (capture::Frame& frame : capture.frames) frame.clip = 0.125;
  const Fit fit = fit_capture(capture, 0, kEstimate, kGo);
  expect_sound(fit);
  EXPECT_GT(fit.counts.clipped, 1000u);  // a tenth of the samples; where they are most, half of the lights
  for (const int at : {6, 12, 14}) EXPECT_NEAR(fit.normals.at(at, 12)[2], test::sphere_normal(24, at, 12).z, 1e-4);
}

TEST(HardCases, OneLightAHundredTimesBrighterDoesNotMoveThem) {
  const TemporaryFolder folder;
  auto want = lambert_sphere(test::spiral_of_lights(12));
  want.spoil = [](std::size_t light, int, int, float* rgb) {
    for (int c = 0; c < 3 && light == 6; ++c) rgb[c] *= 100;
  };
  const Fit fit = fit_capture(make_sphere(folder / "c", want), 0, kEstimate, kGo);
  expect_sound(fit);
  for (const int at : {7, 12, 16}) {
    const auto n = fit.normals.at(at, 12);
    const glm::dvec3 truth = test::sphere_normal(24, at, 12);
    EXPECT_NEAR(n[0], truth.x, 1e-4);  // the weight of the bright photo is 1e-4 of the others' at most
    EXPECT_NEAR(n[2], truth.z, 1e-4);
    EXPECT_NEAR(fit.base_colors.at(at, 12)[0], test::sphere_color(24, at, 12).r, 1e-3);
  }
}

TEST(HardCases, BlackPhotographsAndAnEmptyMaskGiveNothing) {
  const TemporaryFolder folder;
  auto want = lambert_sphere(test::spiral_of_lights(8));
  want.spoil = [](std::size_t, int, int, float* rgb) { rgb[0] = rgb[1] = rgb[2] = 0; };
  capture::Capture capture = make_sphere(folder / "c", want);
  const Fit black = fit_capture(capture, 0, kEstimate, kGo);
  expect_sound(black);
  EXPECT_EQ(black.counts.seen_by_none, black.counts.pixels);
  image::write_exr(folder / "c" / "mask.exr", image::Picture(24, 24));
  const Fit empty = fit_capture(capture, 0, kEstimate, kGo);
  expect_sound(empty);
  EXPECT_EQ(empty.counts.pixels, 0u);
  EXPECT_THAT(empty.notes.front(), HasSubstr("mask"));
}

TEST(HardCases, APictureOfOnePixelIsFitted) {
  const TemporaryFolder folder;
  auto want = lambert_sphere(test::spiral_of_lights(8));
  want.size = 1;
  const Fit fit = fit_capture(make_sphere(folder / "c", want), 0, kEstimate, kGo);
  expect_sound(fit);
  EXPECT_NEAR(fit.normals.at(0, 0)[2], 1, 1e-6);
}

TEST(HardCases, WhatCannotBeFittedIsNamed) {
  const TemporaryFolder folder;
  capture::Capture capture = make_sphere(folder / "c", lambert_sphere(test::spiral_of_lights(4)));
  const auto message = [&](const Options& options) -> std::string {
    try {
      fit_capture(capture, 0, options, kGo);
    } catch (const files::UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message({.normals = NormalSource::kGiven}), HasSubstr("--normals estimate"));
  for (capture::Light& light : capture.lights) light.place = {};
  EXPECT_THAT(message(kEstimate), HasSubstr("lights.json"));
  for (capture::Light& light : capture.lights) light.place = capture::NearLight{{0, 0, 2}};
  capture.cameras[0].is_orthographic = false;
  EXPECT_THAT(message(kEstimate), HasSubstr("layer position"));
}

TEST(HardCases, AFitThatIsToldToStopStopsBetweenAnyTwoPieces) {
  const TemporaryFolder folder;
  const capture::Capture capture = make_sphere(folder / "c", lambert_sphere(test::spiral_of_lights(20)));
  int asked = 0;
  fit_capture(capture, 0, kEstimate, [&](double share, std::string_view) {
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
    ++asked;
    return true;
  });
  EXPECT_GT(asked, 5);
  for (int last = 0; last < asked; ++last) {
    int left = last;
    EXPECT_THROW(fit_capture(capture, 0, kEstimate, [&](double, std::string_view) { return left-- > 0; }),
                 files::Interrupted)
        << last;
  }
}

}  // namespace
}  // namespace likeness::capture_fit
