#include "olat/calibrate/find_chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>
#include <string>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "olat/calibrate/calibrate.h"
#include "olat/calibrate/perspective.h"
#include "render/files/files.h"
#include "render/image/read.h"
#include "render/image/tone_curve.h"
#include "render/image/write.h"
#include "tests/render/temporary_folder.h"

namespace likeness::olat_calibrate {
namespace {

using image::Picture;

// The chart's colors as they are often given: sRGB in 8 bits.
constexpr std::array<std::array<int, 3>, kPatches> kColors{
    {{115, 82, 68},   {194, 150, 130}, {98, 122, 157},  {87, 108, 67},   {133, 128, 177}, {103, 189, 170},
     {214, 126, 44},  {80, 91, 166},   {193, 90, 99},   {94, 60, 108},   {157, 188, 64},  {224, 163, 46},
     {56, 61, 150},   {70, 148, 73},   {175, 54, 60},   {231, 199, 31},  {187, 86, 149},  {8, 133, 161},
     {243, 243, 242}, {200, 200, 200}, {160, 160, 160}, {122, 122, 121}, {85, 85, 85},    {52, 52, 52}}};

std::array<double, 3> light_of(std::size_t patch) {
  std::array<double, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = image::srgb_decode(kColors[patch][c] / 255.0);
  return out;
}

const Reference& reference() {
  static const Reference kReference = [] {
    std::string text = "patch,x,y,Y\n";
    const glm::dmat3 to_d50(0.4360747, 0.2225045, 0.0139322, 0.3850649, 0.7168786, 0.0971045, 0.1430804, 0.0606169,
                            0.7141733);  // sRGB to XYZ under D50, Bradford
    for (std::size_t i = 0; i < kPatches; ++i) {
      const auto [r, g, b] = light_of(i);
      const glm::dvec3 xyz = to_d50 * glm::dvec3(r, g, b);
      const double sum = xyz.x + xyz.y + xyz.z;
      text += std::to_string(i + 1) + "," + std::to_string(xyz.x / sum) + "," + std::to_string(xyz.y / sum) + "," +
              std::to_string(xyz.y) + "\n";
    }
    return reference_of(text, "reference");
  }();
  return kReference;
}

constexpr std::array<Point, 4> kCells{{{0, 0}, {kPatchColumns, 0}, {kPatchColumns, kPatchRows}, {0, kPatchRows}}};

// A room with boxes of many sizes, a tile wall and noise: what a detector could take for patches.
Picture room(int width = 900, int height = 640) {
  Picture out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float tile = (x / 31 + y / 31) % 2 == 0 ? 0.35f : 0.25f;
      for (float& v : out.at(x, y)) v = y < height / 3 ? tile : 0.15f + 0.1f * static_cast<float>(x) / float(width);
    }
  return out;
}

// Light on a point of the picture, and the camera's crosstalk.
struct Look {
  std::function<double(double x, double y)> light = [](double, double) { return 1.0; };
  glm::dmat3 crosstalk{1};
};

void draw_chart(Picture& photo, const Corners& corners, const Look& look = {}) {
  const Perspective cells = perspective_of(corners, kCells);
  constexpr int kFine = 3;
  std::array<glm::dvec3, kPatches> light;
  for (std::size_t i = 0; i < kPatches; ++i) light[i] = {light_of(i)[0], light_of(i)[1], light_of(i)[2]};
  for (int y = 0; y < photo.height; ++y)
    for (int x = 0; x < photo.width; ++x) {
      const auto [column, row] = cells(x + 0.5, y + 0.5);
      if (column < -1 || row < -1 || column > kPatchColumns + 1 || row > kPatchRows + 1) continue;
      glm::dvec3 sum(0);
      for (int s = 0; s < kFine * kFine; ++s) {
        const double px = x + (s % kFine + 0.5) / kFine, py = y + (s / kFine + 0.5) / kFine;
        const auto [u, v] = cells(px, py);
        glm::dvec3 color(photo.at(x, y)[0], photo.at(x, y)[1], photo.at(x, y)[2]);
        if (u > -0.35 && v > -0.35 && u < kPatchColumns + 0.35 && v < kPatchRows + 0.35) {
          color = glm::dvec3(0.02);
          const double in_u = u - std::floor(u), in_v = v - std::floor(v);
          if (u > 0 && v > 0 && u < kPatchColumns && v < kPatchRows && std::abs(in_u - 0.5) < 0.42 &&
              std::abs(in_v - 0.5) < 0.42) {
            color = light[static_cast<std::size_t>(u) + kPatchColumns * static_cast<std::size_t>(v)];
          }
          color = look.light(px, py) * (look.crosstalk * color);
        }
        sum += color;
      }
      for (int c = 0; c < 3; ++c) photo.at(x, y)[std::size_t(c)] = static_cast<float>(sum[c] / (kFine * kFine));
    }
}

void add_noise(Picture& photo, double sigma) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, sigma);
  for (float& v : photo.rgb) v += static_cast<float>(noise(random));
}

// Of a chart about a middle, turned, of cells of `cell` pixels.
Corners turned(double x, double y, double cell, double degrees) {
  const double a = degrees * 3.14159265358979 / 180;
  Corners out{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double u = cell * (kCells[i][0] - 3), v = cell * (kCells[i][1] - 2);
    out[i] = {x + std::cos(a) * u - std::sin(a) * v, y + std::sin(a) * u + std::cos(a) * v};
  }
  return out;
}

double farthest(const Corners& got, const Corners& want) {
  double out = 0;
  for (std::size_t i = 0; i < 4; ++i) out = std::max(out, std::hypot(got[i][0] - want[i][0], got[i][1] - want[i][1]));
  return out;
}

void expect_found(const Picture& photo, const Corners& want, double tolerance, const std::string& what) {
  const auto found = find_charts(photo, reference());
  ASSERT_EQ(found.size(), 1u) << what;
  EXPECT_LT(farthest(found[0].corners, want), tolerance) << what;
  testing::Test::RecordProperty(what, std::to_string(farthest(found[0].corners, want)));
}

TEST(FindChart, InEveryTurn) {
  for (const double degrees : {7.0, 90.0, 262.0}) {
    Picture photo = room();
    const Corners corners = turned(450, 330, 62, degrees);
    draw_chart(photo, corners);
    add_noise(photo, 0.004);
    expect_found(photo, corners, 1, "turned by " + std::to_string(degrees));
  }
}

TEST(FindChart, InPerspectiveAndThroughCrosstalkOfTheCamera) {
  const Corners corners{{{230, 120}, {690, 200}, {720, 470}, {190, 560}}};
  Look look;
  look.crosstalk = glm::dmat3(0.6, 0.15, 0.05, 0.25, 0.9, 0.2, 0.05, 0.1, 0.5);
  Picture photo = room();
  draw_chart(photo, corners, look);
  add_noise(photo, 0.004);
  expect_found(photo, corners, 2, "perspective");
}

TEST(FindChart, DimBySixStops) {
  const Corners corners = turned(450, 330, 60, 12);
  Picture photo = room();
  draw_chart(photo, corners);
  for (float& v : photo.rgb) v /= 64;
  add_noise(photo, 0.0003);
  expect_found(photo, corners, 1, "dim");
}

TEST(FindChart, InAVeilOfLightThatFallsOffByTwoStops) {
  const Corners corners = turned(450, 330, 60, -8);
  Look look;
  look.light = [](double x, double) { return std::exp2(-2 * (x - 250) / 400); };
  Picture photo = room();
  draw_chart(photo, corners, look);
  add_noise(photo, 0.002);
  const auto found = find_charts(photo, reference());
  for (const FoundChart& one : found) EXPECT_LT(farthest(one.corners, corners), 2);
  EXPECT_LE(found.size(), 1u);
}

// Found where it is, or not found: never elsewhere.
TEST(FindChart, PartlyInShadowItIsFoundWhereItIsOrNotAtAll) {
  const Corners corners = turned(450, 330, 60, 5);
  for (const double stops : {0.5, 4.0})
    for (const double edge : {330.0, 540.0}) {
      Look look;
      look.light = [=](double x, double y) { return x + 0.4 * y < edge + 130 ? std::exp2(-stops) : 1.0; };
      Picture photo = room();
      draw_chart(photo, corners, look);
      add_noise(photo, 0.003);
      const auto found = find_charts(photo, reference());
      EXPECT_LE(found.size(), 1u);
      for (const FoundChart& one : found) EXPECT_LT(farthest(one.corners, corners), 2) << stops << ' ' << edge;
      if (stops < 1) {
        EXPECT_EQ(found.size(), 1u) << "half a stop on a part is nothing, edge " << edge;
      }
    }
}

TEST(FindChart, SmallAndLarge) {
  for (const double cell : {20.0, 30.0, 135.0}) {
    Picture photo = room();
    const Corners corners = turned(450, 320, cell, 3);
    draw_chart(photo, corners);
    add_noise(photo, 0.003);
    expect_found(photo, corners, 2, "cells of " + std::to_string(cell));
  }
}

TEST(FindChart, OfManyPixelsIsFoundInTheReducedPicture) {
  const Corners corners = turned(1900, 1300, 260, 20);
  Picture photo = room(3600, 2500);
  draw_chart(photo, corners);
  add_noise(photo, 0.005);
  expect_found(photo, corners, 2, "9 megapixels");
}

TEST(FindChart, TwoAreTwo) {
  const Corners left = turned(230, 380, 50, 3), right = turned(660, 330, 60, 160);
  Picture photo = room();
  draw_chart(photo, left);
  draw_chart(photo, right);
  add_noise(photo, 0.003);
  const auto found = find_charts(photo, reference());
  ASSERT_EQ(found.size(), 2u);
  const bool is_first = farthest(found[0].corners, left) < 100;
  EXPECT_LT(farthest(found[is_first ? 0 : 1].corners, left), 2);
  EXPECT_LT(farthest(found[is_first ? 1 : 0].corners, right), 2);
}

TEST(FindChart, WhatIsNoneIsNotFound) {
  EXPECT_TRUE(find_charts(room(), reference()).empty());
  EXPECT_TRUE(find_charts(Picture(1, 1), reference()).empty());
  EXPECT_TRUE(find_charts(Picture(400, 300), reference()).empty()) << "black";
  Picture broken(400, 300);
  std::fill(broken.rgb.begin(), broken.rgb.end(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(find_charts(broken, reference()).empty());
  Picture mirrored = room();
  Corners corners = turned(450, 330, 60, 0);
  std::swap(corners[0], corners[1]), std::swap(corners[2], corners[3]);
  draw_chart(mirrored, corners);
  EXPECT_TRUE(find_charts(mirrored, reference()).empty()) << "a mirrored chart";
  // A grid of 24 patches of other colors.
  Picture other = room();
  Look look;
  look.crosstalk = glm::dmat3(0.33, 0.33, 0.33, 0.33, 0.33, 0.33, 0.33, 0.33, 0.33);
  draw_chart(other, turned(450, 330, 60, 0), look);
  EXPECT_TRUE(find_charts(other, reference()).empty()) << "a chart without colors";
}

std::string refusal(const std::string& photo, const std::string& table) {
  capture::Capture capture;
  capture::Camera camera;
  camera.id = "c";
  camera.width = camera.height = 8;
  capture.cameras = {camera};
  Options options;
  options.chart = photo;
  options.reference = table;
  try {
    const Result result = run_calibrate(capture, options);
    return result.notes.empty() ? "accepted" : result.notes[0];
  } catch (const files::UsageError& error) {
    return error.what();
  }
}

TEST(FindChart, TheCommandSaysWhereOrThatItDoesNotKnow) {
  const test::TemporaryFolder folder;
  std::string table = "patch,L,a,b\n";
  for (std::size_t i = 0; i < kPatches; ++i) {
    const image::Lab& lab = reference().lab[i];
    table += std::to_string(i + 1) + "," + std::to_string(lab.l) + "," + std::to_string(lab.a) + "," +
             std::to_string(lab.b) + "\n";
  }
  files::write_whole(folder / "chart.csv", table);
  const std::string photo = (folder / "chart.exr").string(), csv = (folder / "chart.csv").string();
  Picture picture = room();
  image::write_exr(photo, picture);
  EXPECT_THAT(refusal(photo, csv), testing::HasSubstr("no chart of 24 patches was found; say where it is by four"));
  draw_chart(picture, turned(230, 380, 50, 3));
  image::write_exr(photo, picture);
  EXPECT_THAT(refusal(photo, csv), testing::HasSubstr("the chart was found at --corner "));
  draw_chart(picture, turned(660, 330, 60, 160));
  image::write_exr(photo, picture);
  EXPECT_THAT(refusal(photo, csv), testing::HasSubstr("shows 2 charts; say which: --corner "));
}

TEST(FindChart, OnARealRawPhotoTheCornersAreThoseThatAPersonClicked) {
  const auto folder = std::filesystem::path(LIKENESS_SHARED_DIR) / "data/colour";
  if (!std::filesystem::exists(folder / "colorchart.dng")) GTEST_SKIP() << "no " << folder / "colorchart.dng";
  const Corners clicked{{{664, 573}, {1303, 563}, {1315, 974}, {646, 981}}};
  const Reference table = read_reference(folder / "data_colorchecker2005.csv");
  const auto found = find_charts(image::read_picture(folder / "colorchart.dng"), table);
  ASSERT_EQ(found.size(), 1u);
  // Out of focus, where the outer edge of a cell has no mark that could be clicked: 6.1 pixels at most, of 107 a cell.
  EXPECT_LT(farthest(found[0].corners, clicked), 8);
  const Picture photo = image::read_picture(folder / "colorchart.dng");
  EXPECT_LE(fit_chart(patches_of(photo, found[0].corners), table).stages[2].mean,
            fit_chart(patches_of(photo, clicked), table).stages[2].mean + 0.05);
}

}  // namespace
}  // namespace likeness::olat_calibrate
