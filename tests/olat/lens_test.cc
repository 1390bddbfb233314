#include "olat/calibrate/lens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "olat/calibrate/undistort.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/image/read.h"
#include "render/image/write.h"
#include "tests/render/temporary_folder.h"

namespace likeness::olat_calibrate {
namespace {

using capture::Camera;
using capture::Lens;
using image::Picture;
using test::TemporaryFolder;
using testing::HasSubstr;

constexpr int kWidth = 320, kHeight = 240;

struct Numbers {
  const char* name;
  Lens lens;
  std::array<double, 8> distortion;
  double skew = 0;
};
const Numbers kLenses[] = {
    {"SIMPLE_RADIAL, barrel", Lens::kBrownConrady, {-0.2}},
    {"RADIAL, pincushion", Lens::kBrownConrady, {0.15, 0.05}},
    {"OPENCV", Lens::kBrownConrady, {-0.25, 0.1, 2e-3, -3e-3}},
    {"five terms", Lens::kBrownConrady, {-0.3, 0.12, 1e-3, 1e-3, -0.02}},
    {"FULL_OPENCV", Lens::kBrownConrady, {0.2, -0.1, 1e-3, -1e-3, 0.02, 0.3, -0.05, 0.01}},
    {"OPENCV_FISHEYE", Lens::kFisheye, {-0.05, 0.02, -0.01, 0.002}},
    {"a fisheye without numbers", Lens::kFisheye, {}},
    {"a skew", Lens::kBrownConrady, {-0.1}, 3.5},
};

Camera camera_with(const Numbers& numbers) {
  Camera out;
  out.id = "c";
  out.width = kWidth;
  out.height = kHeight;
  out.intrinsics = glm::dmat3(260, 0, 0, numbers.skew, 250, 0, 165, 117, 1);
  out.lens = numbers.lens;
  out.distortion = numbers.distortion;
  out.is_undistorted = false;
  return out;
}

// The formulas as they are published, written here a second time: what the pictures are made with.
std::array<double, 2> truth(const Camera& camera, double x, double y) {
  const auto& k = camera.distortion;
  const double r2 = x * x + y * y, r = std::sqrt(r2);
  double bent_x = x, bent_y = y;
  if (camera.lens == Lens::kFisheye) {
    const double t = std::atan(r), t2 = t * t;
    const double scale =
        r > 0 ? t * (1 + k[0] * t2 + k[1] * t2 * t2 + k[2] * t2 * t2 * t2 + k[3] * t2 * t2 * t2 * t2) / r : 1;
    bent_x = scale * x, bent_y = scale * y;
  } else {
    const double radial =
        (1 + k[0] * r2 + k[1] * r2 * r2 + k[4] * r2 * r2 * r2) / (1 + k[5] * r2 + k[6] * r2 * r2 + k[7] * r2 * r2 * r2);
    bent_x = x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x);
    bent_y = y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y;
  }
  const glm::dvec3 at = camera.intrinsics * glm::dvec3(bent_x, bent_y, 1);
  return {at.x, at.y};
}

// The point of the camera that the lens puts there: Newton's steps, slopes by differences.
std::array<double, 2> seen_at(const Camera& camera, double u, double v) {
  const glm::dmat3& k = camera.intrinsics;
  double y = (v - k[2][1]) / k[1][1], x = (u - k[2][0] - k[1][0] * y) / k[0][0];
  for (int step = 0; step < 12; ++step) {
    constexpr double kStep = 1e-6;
    const auto at = truth(camera, x, y), right = truth(camera, x + kStep, y), down = truth(camera, x, y + kStep);
    const double a = (right[0] - at[0]) / kStep, b = (down[0] - at[0]) / kStep, c = (right[1] - at[1]) / kStep,
                 d = (down[1] - at[1]) / kStep, det = a * d - b * c, du = u - at[0], dv = v - at[1];
    x += (d * du - b * dv) / det, y += (a * dv - c * du) / det;
  }
  return {x, y};
}

constexpr int kPitch = 25, kFirst = 20;  // of the dots, in the straight picture [pixel]
constexpr double kSigma = 2;             // [pixel]

double dots(double u, double v) {
  const auto off = [](double x) { return x - kFirst - kPitch * std::round((x - kFirst) / kPitch); };
  return std::exp(-(off(u) * off(u) + off(v) * off(v)) / (2 * kSigma * kSigma));
}

std::array<double, 2> dot_near(const Picture& picture, double u, double v) {
  double sum = 0, at_x = 0, at_y = 0;
  for (int y = static_cast<int>(v) - 9; y <= static_cast<int>(v) + 9; ++y)
    for (int x = static_cast<int>(u) - 9; x <= static_cast<int>(u) + 9; ++x) {
      const auto value = static_cast<double>(picture.at(x, y)[1]);
      sum += value, at_x += value * (x + 0.5), at_y += value * (y + 0.5);
    }
  return {at_x / sum, at_y / sum};
}

TEST(Lens, AGridOfDotsComesBackToATwentiethOfAPixel) {
  for (const Numbers& numbers : kLenses) {
    const Camera camera = camera_with(numbers);
    Picture photo(kWidth, kHeight);
    const glm::dmat3& k = camera.intrinsics;
    struct Dot {
      double u, v;
    };
    std::vector<Dot> inner;
    double moved = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const auto [at_x, at_y] = seen_at(camera, x + 0.5, y + 0.5);
        const double value = dots(k[0][0] * at_x + k[2][0], k[1][1] * at_y + k[2][1]);
        for (float& channel : photo.at(x, y)) channel = static_cast<float>(value);
      }
    for (int v = kFirst; v < kHeight - 12; v += kPitch)
      for (int u = kFirst; u < kWidth - 12; u += kPitch) {
        const auto [x, y] = truth(camera, (u - k[2][0]) / k[0][0], (v - k[2][1]) / k[1][1]);
        if (x < 12 || y < 12 || x > kWidth - 12 || y > kHeight - 12) continue;
        inner.push_back({double(u), double(v)});
        moved = std::max(moved, std::hypot(x - u, y - v));
      }
    const Picture straight = Straightener(camera).smooth(photo);
    double worst = 0;
    for (const Dot& dot : inner) {
      const auto [x, y] = dot_near(straight, dot.u, dot.v);
      worst = std::max(worst, std::hypot(x - dot.u, y - dot.v));
    }
    EXPECT_GT(inner.size(), 50u) << numbers.name;
    EXPECT_GT(moved, 3) << numbers.name << ": a lens that does nothing tests nothing";
    EXPECT_LT(worst, 0.05) << numbers.name;
    RecordProperty(numbers.name, std::to_string(worst));
  }
}

TEST(Lens, PointsLieWhereThePublishedFormulasPutThem) {
  for (const Numbers& numbers : kLenses) {
    const Camera camera = camera_with(numbers);
    for (const auto& [x, y] : {std::array{0.0, 0.0}, std::array{0.3, -0.2}, std::array{-0.5, 0.4}}) {
      const auto got = in_photo(camera, x, y), want = truth(camera, x, y);
      EXPECT_NEAR(got[0], want[0], 1e-9) << numbers.name;
      EXPECT_NEAR(got[1], want[1], 1e-9) << numbers.name;
    }
  }
}

TEST(Lens, AConstantStaysConstantAndTheRestIsOutside) {
  for (const Numbers& numbers : kLenses) {
    const Straightener straightener(camera_with(numbers));
    Picture photo(kWidth, kHeight);
    std::fill(photo.rgb.begin(), photo.rgb.end(), 0.7f);
    const Picture smooth = straightener.smooth(photo), nearest = straightener.nearest(photo);
    for (std::size_t i = 0; i < smooth.rgb.size(); ++i) {
      const bool is_inside = straightener.inside()[i / 3] != 0;
      // Weights of the bicubic are floats whose sum is 1 to rounding.
      ASSERT_NEAR(smooth.rgb[i], is_inside ? 0.7f : 0, 2e-7f) << numbers.name;
      ASSERT_EQ(nearest.rgb[i], is_inside ? 0.7f : 0) << numbers.name;
    }
  }
}

// 1 - 0.6 r^2 turns back at r = 0.745; without a limit the picture's corners would show its middle again.
TEST(Lens, BeyondWhereThePolynomialTurnsBackThereIsNothing) {
  Camera camera = camera_with({"", Lens::kBrownConrady, {-0.6}});
  camera.intrinsics = glm::dmat3(160, 0, 0, 0, 160, 0, 160, 120, 1);
  const Straightener straightener(camera);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double r = std::hypot(x + 0.5 - 160, y + 0.5 - 120) / 160;
      if (std::abs(r - std::sqrt(1 / 1.8)) > 0.01) {
        ASSERT_EQ(straightener.inside()[static_cast<std::size_t>(y * kWidth + x)], r < std::sqrt(1 / 1.8))
            << x << ' ' << y;
      }
    }
}

// Two cameras of two lights: the first is bent, the second is not. Photos are sRGB in 8 bits with a clipped square.
capture::Capture bent_capture(const std::filesystem::path& folder) {
  capture::Capture out;
  out.root = folder;
  out.cameras = {camera_with(kLenses[2]), camera_with(kLenses[2])};
  out.cameras[1].id = "pinhole";
  out.cameras[1].is_undistorted = true;
  out.cameras[1].distortion = {};
  for (const char* id : {"l0", "l1"}) out.lights.push_back({id, "", capture::DistantLight{}, {2, 2, 2}, ""});
  out.variants = {{"render", "renders/{variant}/{camera}/{light}.exr"}};
  for (std::size_t camera = 0; camera < 2; ++camera)
    for (std::size_t light = 0; light < 2; ++light) {
      image::DisplayPicture photo(kWidth, kHeight);
      std::fill(photo.rgb.begin(), photo.rgb.end(), std::uint8_t{128});
      for (int y = 100; y < 120; ++y)
        for (int x = 150; x < 170; ++x) photo.at(x, y)[0] = 255;
      capture::Frame frame;
      frame.camera = camera, frame.light = light;
      frame.file = "photos/" + out.cameras[camera].id + "/" + out.lights[light].id + ".png";
      frame.transfer = capture::Transfer::kSrgb;
      frame.black = 0.02, frame.white = 0.98, frame.clip = 0.99, frame.gain = 1.5;
      image::write_png(folder / frame.file, photo);
      out.frames.push_back(frame);
    }
  Picture flat(kWidth, kHeight);
  std::fill(flat.rgb.begin(), flat.rgb.end(), 0.8f);
  image::write_exr(folder / "flat.exr", flat);
  out.layers = {{0, capture::Layer::kFlatField, "flat.exr"}};
  write_capture(out);
  return out;
}

TEST(Undistort, TheNewCaptureHoldsTheSameLightOfPinholes) {
  const TemporaryFolder folder;
  const capture::Capture before = bent_capture(folder / "bent");
  const Undistorted result = run_undistort(before, (folder / "straight").string(), {});
  EXPECT_EQ(result.files, 2u);
  ASSERT_EQ(result.views.size(), 1u);
  EXPECT_GT(result.views[0].farthest_px, 5);
  const capture::Capture after = capture::read_capture(folder / "straight");
  EXPECT_TRUE(after.cameras[0].is_undistorted);
  EXPECT_EQ(after.cameras[0].distortion, (std::array<double, 8>{}));
  EXPECT_EQ(after.cameras[0].intrinsics, before.cameras[0].intrinsics);
  EXPECT_EQ(after.frames[2].file, folder / "bent/photos/pinhole/l0.png") << "a pinhole's photo stays where it is";
  ASSERT_EQ(after.variants.size(), 1u);

  const capture::Photo old = capture::read_photo(before, 0), now = capture::read_photo(after, 0);
  const auto constant = static_cast<double>(old.light.at(10, 120)[1]);
  std::size_t clipped = 0, outside = 0;
  for (std::size_t i = 0; i < now.flaws.size(); ++i) {
    clipped += (now.flaws[i] & capture::kClipped) != 0 ? 1 : 0;
    outside += (now.flaws[i] & capture::kMasked) != 0 ? 1 : 0;
    if ((now.flaws[i] & capture::kMasked) != 0) continue;
    ASSERT_NEAR(now.light.rgb[3 * i + 1], constant, 1e-6 * constant) << "curve, gain, flat field and intensity, once";
  }
  // 20 x 20 pixels and two around them, in a picture that the barrel makes a little larger here.
  EXPECT_GT(clipped, 400u);
  EXPECT_LT(clipped, 26u * 26);
  EXPECT_EQ(double(outside) / (kWidth * kHeight), result.views[0].outside_share);
}

TEST(Undistort, ABitmapOfNanStaysFlawedWhereItWas) {
  const TemporaryFolder folder;
  capture::Capture before = bent_capture(folder / "bent");
  Picture photo(kWidth, kHeight);
  std::fill(photo.rgb.begin(), photo.rgb.end(), 0.5f);
  photo.at(160, 117)[2] = std::numeric_limits<float>::quiet_NaN();
  before.frames[0].file = "nan.exr";
  image::write_exr(folder / "bent/nan.exr", photo);
  run_undistort(before, (folder / "straight").string(), {});
  const capture::Photo now = capture::read_photo(capture::read_capture(folder / "straight"), 0);
  const auto flawed = std::count_if(now.flaws.begin(), now.flaws.end(),
                                    [](std::uint8_t flaw) { return (flaw & capture::kNotFinite) != 0; });
  EXPECT_GE(flawed, 1);
  EXPECT_LE(flawed, 36) << "the bicubic reads 4 x 4 pixels";
}

std::string refusal(const capture::Capture& capture, const std::string& folder) {
  try {
    run_undistort(capture, folder, {});
  } catch (const files::UsageError& error) {
    return error.what();
  } catch (const files::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Undistort, WhatCannotBeDoneIsSaidInOneLine) {
  const TemporaryFolder folder;
  capture::Capture bent = bent_capture(folder / "bent");
  EXPECT_THAT(refusal(bent, (folder / "bent").string()), HasSubstr("has a capture already"));
  capture::Capture wrong = bent;
  wrong.cameras[0].width = 300;
  EXPECT_THAT(refusal(wrong, (folder / "a").string()),
              HasSubstr("has 320 x 240 pixels; its camera \"c\" has 300 x 240"));
  wrong = bent;
  wrong.cameras[0].is_orthographic = true;
  EXPECT_THAT(refusal(wrong, (folder / "b").string()), HasSubstr("camera \"c\" is orthographic"));
  bent.cameras[0] = straightened(bent.cameras[0]);
  EXPECT_THAT(refusal(bent, (folder / "c").string()), HasSubstr("no camera has distortion or skew"));
}

TEST(Undistort, InterruptedThereIsNoCapture) {
  const TemporaryFolder folder;
  const capture::Capture bent = bent_capture(folder / "bent");
  int calls = 0;
  EXPECT_THROW(run_undistort(bent, (folder / "out").string(), [&](std::string_view, double) { return ++calls < 2; }),
               files::Interrupted);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/capture.json"));
  run_undistort(bent, (folder / "out").string(), {});
  EXPECT_TRUE(std::filesystem::exists(folder / "out/capture.json"));
}

TEST(Undistort, AMissingPhotoIsNamedAndTheRestIsDone) {
  const TemporaryFolder folder;
  const capture::Capture bent = bent_capture(folder / "bent");
  std::filesystem::remove(folder / "bent/photos/c/l1.png");
  const Undistorted result = run_undistort(bent, (folder / "out").string(), {});
  EXPECT_EQ(result.files, 1u);
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_THAT(result.notes[0], HasSubstr("l1.png is not there"));
}

}  // namespace
}  // namespace likeness::olat_calibrate
