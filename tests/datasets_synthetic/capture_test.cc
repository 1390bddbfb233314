#include "datasets_synthetic/capture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "tests/render/temporary_folder.h"

// Each fault is measured in the files that were written, and is of the size that was asked for.
namespace likeness::datasets_synthetic {
namespace {

using likeness::test::TemporaryFolder;
using testing::HasSubstr;

CaptureOptions small(const std::filesystem::path& folder) {
  CaptureOptions out;
  out.folder = folder;
  out.width = 96;
  out.height = 64;
  out.lights = 4;
  out.has_floats = true;
  return out;
}

struct Made {
  capture::Capture capture;
  std::vector<image::Picture> photos, truths;  // by light; a missing photo is empty
  std::string truth;
};
Made make(const CaptureOptions& options) {
  Made out;
  out.truth = make_capture(options).truth;
  out.capture = capture::read_capture(options.folder);
  const capture::FrameTable table(out.capture);
  for (std::size_t l = 0; l < out.capture.lights.size(); ++l) {
    const std::size_t frame = table.frame(0, l);
    out.photos.push_back(frame == capture::kAbsent ? image::Picture() : capture::read_photo(out.capture, frame).light);
    out.truths.push_back(capture::read_render(out.capture, out.capture.variants[0], 0, l));
  }
  return out;
}

// Of the light in the picture, in pixels.
glm::dvec2 middle_of(const image::Picture& picture) {
  glm::dvec2 sum(0);
  double weight = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const double w = static_cast<double>(picture.at(x, y)[1]);
      sum += w * glm::dvec2(x, y);
      weight += w;
    }
  return sum / weight;
}
double sum_of(const image::Picture& picture) {
  double out = 0;
  for (const float x : picture.rgb) out += static_cast<double>(x);
  return out;
}

TEST(MakeCapture, WithoutFaultsPhotographsAreTheTruth) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  options.cameras = 2;
  const Made made = make(options);
  EXPECT_EQ(made.capture.cameras.size(), 2u);
  EXPECT_EQ(made.capture.frames.size(), 8u);
  for (std::size_t l = 0; l < 4; ++l) EXPECT_EQ(made.photos[l].rgb, made.truths[l].rgb) << l;
  EXPECT_GT(sum_of(made.photos[0]), 1);
  EXPECT_THAT(made.truth, HasSubstr("\"faults\": {}"));
  // Layers fit: normals face the camera where the mask is.
  const auto mask = capture::read_mask(made.capture, 0);
  const image::Picture normals = capture::read_normals(made.capture, 0);
  for (std::size_t i = 0; i < mask.size(); ++i)
    EXPECT_EQ(mask[i] != 0, normals.rgb[3 * i] != 0 || normals.rgb[3 * i + 1] != 0 || normals.rgb[3 * i + 2] != 0);
}

TEST(MakeCapture, TheSameOptionsGiveTheSameBytes) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "a");
  options.faults.read_noise = 3;
  options.faults.missing = 1;
  make(options);
  options.folder = folder / "b";
  make(options);
  for (const char* file : {"frames.json", "truth.json", "photos/c0/l1.exr", "renders/truth/c0/l1.exr"}) {
    if (!std::filesystem::exists(folder / "a" / file)) continue;  // the one that is missing
    EXPECT_EQ(files::read_whole(folder / "a" / file, 1 << 26), files::read_whole(folder / "b" / file, 1 << 26)) << file;
  }
}

TEST(MakeCapture, AShiftMovesTheSubjectByThatMuch) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  const capture::Capture still = make(options).capture;
  // A ball alone in the picture: the floor leaves the frame, so its middle would not move with it. The layer of light
  // on the ball is what differs between two albedos of the floor; here the ball's highlight does: a residue.
  const image::Picture without = shoot(options, still.cameras[0], still.lights[3], {});
  image::Picture glint = shoot(options, still.cameras[0], still.lights[3], {0, 0, 0, 1});
  image::Picture base = shoot(options, still.cameras[0], still.lights[3], {1.5, -0.25, 0, 0});
  image::Picture moved = shoot(options, still.cameras[0], still.lights[3], {1.5, -0.25, 0, 1});
  for (int y = 0; y < glint.height; ++y)
    for (int x = 0; x < glint.width; ++x) {
      // The ball is in the upper half; the floor's glint, below, is left out.
      const bool is_ball = y < 36;
      glint.at(x, y)[1] = is_ball ? glint.at(x, y)[1] - without.at(x, y)[1] : 0;
      moved.at(x, y)[1] = is_ball ? moved.at(x, y)[1] - base.at(x, y)[1] : 0;
    }
  const glm::dvec2 way = middle_of(moved) - middle_of(glint);
  EXPECT_NEAR(way.x, 1.5, 0.05);
  EXPECT_NEAR(way.y, -0.25, 0.05);
  options.faults.shift_x = 1.5;
  options.faults.shift_y = -0.25;
  const Made made = make(options);
  const image::Picture want = shoot(options, still.cameras[0], still.lights[3], {1.5, -0.25, 0, 0});
  EXPECT_EQ(made.photos[3].rgb, want.rgb);
  EXPECT_EQ(made.truths[3].rgb, without.rgb);
}

TEST(MakeCapture, AGainIsOfOneLightAndOfItsStops) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  options.faults.gains = {{2, 0.5}};
  const Made made = make(options);
  EXPECT_NEAR(std::log2(sum_of(made.photos[2]) / sum_of(made.truths[2])), 0.5, 1e-6);
  EXPECT_EQ(made.photos[1].rgb, made.truths[1].rgb);
  EXPECT_THAT(made.truth, HasSubstr("\"l2\": 0.5"));
}

TEST(MakeCapture, SwappedLightsShowEachOther) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  options.faults.swaps = {{1, 3}};
  options.faults.gains = {{1, 1.0}};  // stays with the light, not with the name
  const Made made = make(options);
  EXPECT_NEAR(sum_of(made.photos[3]) / sum_of(made.truths[1]), 2, 1e-6);
  EXPECT_EQ(made.photos[1].rgb, made.truths[3].rgb);
  EXPECT_EQ(made.photos[0].rgb, made.truths[0].rgb);
}

TEST(MakeCapture, NoiseHasTheVarianceOfReadAndShot) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  options.width = options.height = 128;
  options.faults.full_well = 10000;
  options.faults.read_noise = 20;  // electrons: 0.002
  const Made made = make(options);
  double dark = 0, lit = 0, expected = 0, mean = 0;
  std::size_t dark_count = 0, lit_count = 0;
  for (std::size_t l = 0; l < 4; ++l)
    for (std::size_t k = 0; k < made.photos[l].rgb.size(); ++k) {
      const double t = static_cast<double>(made.truths[l].rgb[k]), d = static_cast<double>(made.photos[l].rgb[k]) - t;
      if (t == 0) dark += d * d, mean += d, ++dark_count;
      else lit += d * d, expected += t / 10000 + 0.002 * 0.002, ++lit_count;
    }
  ASSERT_GT(dark_count, 20000u);
  ASSERT_GT(lit_count, 20000u);
  // The variance of n normal numbers is known to sqrt(2 / n): 1 % here; 4 sigma.
  EXPECT_NEAR(dark / double(dark_count), 4e-6, 0.04 * 4e-6);
  EXPECT_NEAR(lit / expected, 1, 0.04);
  EXPECT_NEAR(mean / double(dark_count), 0,
              4 * 0.002 / std::sqrt(double(dark_count)));  // noise about black has both signs
}

TEST(MakeCapture, BlackIsLostAndClippedPixelsAreFlawed) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  options.faults.black = 0.05;
  options.faults.clip = 0.1;
  options.has_floats = false;
  const Made made = make(options);
  const capture::Photo photo = capture::read_photo(made.capture, 0);
  std::size_t clipped = 0, black = 0;
  for (std::size_t i = 0; i < photo.flaws.size(); ++i) {
    double most = 0;
    for (std::size_t c = 0; c < 3; ++c) most = std::max(most, static_cast<double>(made.truths[0].rgb[3 * i + c]));
    if (most > 0.151) {
      EXPECT_TRUE(photo.flaws[i] & capture::kClipped) << most;
      ++clipped;
    }
    if (most < 0.049) {
      EXPECT_TRUE(photo.flaws[i] & capture::kBlack) << most;
      ++black;
    }
    if (most > 0.051 && most < 0.149) {
      EXPECT_FALSE(photo.flaws[i] & capture::kClipped) << most;
    }
  }
  EXPECT_GT(clipped, 50u);
  EXPECT_GT(black, 500u);
}

TEST(MakeCapture, AnObjectIsInOnePhotographAsWideAsAsked) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  options.faults.objects = {{1, 0.5}, {3, 0.25, 0.75, 0.5, 2}};
  const Made made = make(options);
  for (const std::size_t l : {0u, 2u}) EXPECT_EQ(made.photos[l].rgb, made.truths[l].rgb) << l;
  const auto check = [&](std::size_t l, double radius, double x0, double y0, float red) {
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 96; ++x) {
        const bool is_inside = std::hypot(x + 0.5 - x0, y + 0.5 - y0) < radius;
        EXPECT_EQ(made.photos[l].at(x, y)[0], is_inside ? red : made.truths[l].at(x, y)[0]) << x << ", " << y;
      }
  };
  check(1, 16, 0.35 * 96, 0.35 * 64, 0.2f);  // half of 64 wide, left of the middle and above it
  check(3, 8, 72, 32, 0.4f);
  EXPECT_THAT(made.truth, HasSubstr("\"l1\": 0.5"));
}

TEST(MakeCapture, LightBelowTheDarkLevelAndDeadPixelsAreZero) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  options.faults.dark = 0.05;
  options.faults.dead = 0.1;
  const Made made = make(options);
  std::size_t dead = 0, lit = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      bool is_dead = false, is_lit = false;
      for (std::size_t l = 0; l < 4; ++l) {
        const float photo = made.photos[l].at(x, y)[1], truth = made.truths[l].at(x, y)[1];
        if (truth >= 0.05f) is_lit = true, is_dead |= photo == 0;
        else EXPECT_EQ(photo, 0) << x << ", " << y;
      }
      for (std::size_t l = 0; l < 4; ++l) {
        const float truth = made.truths[l].at(x, y)[1];
        if (is_lit && truth >= 0.05f) {
          EXPECT_EQ(made.photos[l].at(x, y)[1], is_dead ? 0 : truth) << "dead under every light, or under none";
        }
      }
      dead += is_dead, lit += is_lit;
    }
  EXPECT_NEAR(static_cast<double>(dead) / static_cast<double>(lit), 0.1, 0.03);  // of some 3000
}

TEST(MakeCapture, ACurveThatNobodyStatesIsInTheNumbers) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  options.faults.curve = capture::Transfer::kSrgb;
  const Made made = make(options);
  for (std::size_t k = 0; k < made.photos[0].rgb.size(); ++k)
    EXPECT_NEAR(capture::linear_of(capture::Transfer::kSrgb, made.photos[0].rgb[k]), made.truths[0].rgb[k], 1e-6f);
  EXPECT_EQ(made.capture.frames[0].transfer, capture::Transfer::kLinear);
}

TEST(MakeCapture, FramesAreMissingAndStandTwiceAsOftenAsAsked) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  options.lights = 20;
  options.width = options.height = 8;
  options.faults.missing = 3;
  const Made missing = make(options);
  EXPECT_EQ(missing.capture.frames.size(), 17u);
  for (const capture::Frame& frame : missing.capture.frames)
    EXPECT_TRUE(std::filesystem::exists(photo_file(missing.capture, frame)));
  options.folder = folder / "d";
  options.faults.missing = 0;
  options.faults.duplicated = 2;
  EXPECT_EQ(make(options).capture.frames.size(), 22u);
}

TEST(MakeCapture, AMirrorTurnsXOfEveryLightRound) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  const capture::Capture straight = make(options).capture;
  options.folder = folder / "d";
  options.faults.is_mirrored = true;
  const capture::Capture mirrored = make(options).capture;
  for (std::size_t l = 0; l < 4; ++l) {
    const glm::dvec3 a = std::get<capture::DistantLight>(straight.lights[l].place).to_light;
    const glm::dvec3 b = std::get<capture::DistantLight>(mirrored.lights[l].place).to_light;
    EXPECT_LT(glm::distance(a * glm::dvec3(-1, 1, 1), b), 1e-12);
  }
}

TEST(MakeCapture, AShadowOffsetChangesOnlyTheFloorAndAResidueOnlyAdds) {
  const TemporaryFolder folder;
  const CaptureOptions options = small(folder / "c");
  const capture::Capture capture = make(options).capture;
  const image::Picture truth = shoot(options, capture.cameras[0], capture.lights[3], {});
  const image::Picture moved = shoot(options, capture.cameras[0], capture.lights[3], {0, 0, 0.02, 0});
  const image::Picture shiny = shoot(options, capture.cameras[0], capture.lights[3], {0, 0, 0, 0.5});
  const image::Picture twice = shoot(options, capture.cameras[0], capture.lights[3], {0, 0, 0, 1.0});
  const image::Picture normals = capture::read_normals(capture, 0);
  std::size_t changed = 0;
  for (std::size_t k = 0; k < truth.rgb.size(); k += 3) {
    if (moved.rgb[k] != truth.rgb[k]) ++changed;
    const double half = static_cast<double>(shiny.rgb[k] - truth.rgb[k]),
                 whole = static_cast<double>(twice.rgb[k] - truth.rgb[k]);
    EXPECT_GE(half, 0);
    EXPECT_NEAR(2 * half, whole, 1e-5 + 1e-5 * whole);
  }
  EXPECT_GT(changed, 20u);
  EXPECT_EQ(moved.at(48, 30)[0], truth.at(48, 30)[0]);  // the middle of the ball
}

TEST(MakeCapture, ATemplateHasRowsForRendersAndNoPicture) {
  const TemporaryFolder folder;
  CaptureOptions options = small(folder / "c");
  options.is_template = true;
  make_capture(options);
  const capture::Capture got = capture::read_capture(folder / "c");
  ASSERT_EQ(got.frames.size(), 4u);
  EXPECT_EQ(photo_file(got, got.frames[2]), render_file(got, got.variants[0], 0, 2));
  EXPECT_FALSE(std::filesystem::exists(folder / "c/renders"));
}

}  // namespace
}  // namespace likeness::datasets_synthetic
