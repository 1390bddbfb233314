#include "render/photograph/merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "olat/photograph/hdr.h"
#include "olat/photograph/shifts.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/image/write.h"
#include "tests/render/temporary_folder.h"

namespace likeness::photograph {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kWidth = 160, kHeight = 120;

// 13 stops of light, with texture: blobs on a ramp.
image::Picture scene() {
  image::Picture out(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double stops = -8 + 10.0 * x / kWidth + 1.2 * std::sin(0.31 * x + 1) * std::cos(0.23 * y) +
                           0.8 * std::sin(0.07 * y * x / 40.0);
      for (std::size_t c = 0; c < 3; ++c)
        out.at(x, y)[c] = static_cast<float>(std::exp2(stops + 0.2 * static_cast<double>(c) - 0.2));
    }
  return out;
}

// A camera: code of exposure, with a base, a shoulder and a different gamma in each channel; 128 where exposure is 0.216, as
// a recovered response has it.
double code_of(double exposure, std::size_t channel) {
  const double gamma = 0.42 + 0.04 * static_cast<double>(channel);
  return std::clamp(128.0 / 255 * std::pow(exposure / 0.2158605, gamma), 0.0, 1.0);
}

struct Taking {
  double seconds = 1, noise = 0.4;  // [code of 8 bits]
  int dx = 0, dy = 0;
  bool has_ghost = false;
};

image::DisplayPicture photo_of(const image::Picture& light, const Taking& taking, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, taking.noise);
  image::DisplayPicture out(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const int u = std::clamp(x - taking.dx, 0, kWidth - 1), v = std::clamp(y - taking.dy, 0, kHeight - 1);
        double l = static_cast<double>(light.at(u, v)[c]);
        if (taking.has_ghost && x >= 70 && x < 90 && y >= 50 && y < 70) l *= 4;
        const double code = 255 * code_of(l * taking.seconds, c) + noise(random);
        out.at(x, y)[c] = static_cast<std::uint8_t>(std::clamp(std::lround(code), 0L, 255L));
      }
  return out;
}

constexpr std::array<double, 9> kTimes{1.0 / 64, 1.0 / 16, 0.25, 0.5, 1, 2, 4, 16, 64};

class Bracketed : public testing::Test {
 protected:
  MergeOptions options_of(const std::vector<Taking>& takings) {
    MergeOptions out;
    unsigned seed = 1;
    for (const Taking& taking : takings) {
      const fs::path file = folder_ / ("f" + std::to_string(seed) + ".png");
      image::write_png(file, photo_of(light_, taking, seed++));
      out.brackets.push_back({file, {taking.seconds, {}, {}, 0, 0}});
    }
    out.shift_of = olat_photograph::shift_finder();
    return out;
  }
  static std::vector<Taking> nine() {
    std::vector<Taking> out;
    for (const double t : kTimes) out.push_back({.seconds = t});
    return out;
  }
  // Of the pixels that are known well, |log2(merged / truth)|, sorted; all channels.
  std::vector<double> errors_of(const Merged& merged) const {
    std::vector<double> out;
    for (std::size_t i = 0; i < merged.confidence.size(); ++i)
      for (std::size_t c = 0; c < 3 && merged.confidence[i] > 0.3f; ++c)
        out.push_back(std::abs(std::log2(static_cast<double>(merged.light.rgb[3 * i + c] / light_.rgb[3 * i + c]))));
    std::ranges::sort(out);
    return out;
  }
  static std::string warnings_of(const Merged& merged) {
    std::string out;
    for (const std::string& w : merged.warnings) out += w + "\n";
    return out;
  }

  test::TemporaryFolder folder_;
  image::Picture light_ = scene();
};

TEST_F(Bracketed, ResponseAndLightAreRecovered) {
  const Merged merged = merge(options_of(nine()));
  ASSERT_TRUE(merged.recovered);
  double worst = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (int k = 26; k <= 230; ++k) {
      const double exposure = 0.2158605 * std::pow(k / 128.0, 1 / (0.42 + 0.04 * static_cast<double>(c)));
      worst = std::max(worst, std::abs(merged.response.at(c, k / 255.0) - std::log2(exposure)));
    }
  EXPECT_LT(worst, 0.08);  // stops
  const std::vector<double> errors = errors_of(merged);
  ASSERT_GT(errors.size(), light_.rgb.size() * 9 / 10);
  std::printf("response: %.3f stops at worst; light: median %.4f, 95 %% %.4f stops\n", worst, errors[errors.size() / 2],
              errors[errors.size() * 95 / 100]);
  EXPECT_LT(errors[errors.size() / 2], 0.02);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.06);
  EXPECT_EQ(warnings_of(merged), "");
  EXPECT_EQ(merged.ghosts, 0u);
  for (const double error : merged.judgement.errors) EXPECT_LT(std::abs(error), 0.05);
  for (const FrameReport& report : merged.reports)
    EXPECT_LE(report.well_exposed, merged.reports[merged.reference].well_exposed);
}

TEST_F(Bracketed, AStatedResponseIsReadBackAsItWasWrittenAndGivesTheSameLight) {
  MergeOptions options = options_of(nine());
  const Merged first = merge(options);
  options.response = response_of(csv_of(first.response), "r.csv");
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(options.response->log2_exposure[c], first.response.log2_exposure[c]);
    EXPECT_EQ(options.response->black[c], first.response.black[c]);
  }
  EXPECT_EQ(merge(options).light.rgb, first.light.rgb);
}

TEST_F(Bracketed, AWrongTimeIsNamed) {
  MergeOptions options = options_of(nine());
  options.brackets[4].setting.seconds *= std::exp2(-0.4);
  const std::string warnings = warnings_of(merge(options));
  EXPECT_THAT(warnings, HasSubstr("f5.png shows +0."));
  EXPECT_EQ(std::ranges::count(warnings, '\n'), 1) << warnings;
}

TEST_F(Bracketed, AShiftedFrameIsFoundAndPutBack) {
  std::vector<Taking> takings = nine();
  for (std::size_t k = 5; k < takings.size(); ++k) takings[k].dx = 3, takings[k].dy = -2;
  MergeOptions options = options_of(takings);
  const Merged loose = merge(options);
  EXPECT_THAT(warnings_of(loose), HasSubstr("f6.png lies 3.6 pixels beside the frame before it"));
  ASSERT_TRUE(loose.reports[5].shift);
  EXPECT_NEAR(loose.reports[5].shift->dx, 3, 0.1);
  EXPECT_NEAR(loose.reports[5].shift->dy, -2, 0.1);
  EXPECT_NEAR(loose.reports[4].shift->dx, 0, 0.1);
  options.aligns = true;
  const Merged aligned = merge(options);
  EXPECT_LT(aligned.ghosts, loose.ghosts / 5 + 10);
}

TEST_F(Bracketed, FramesAreMovedToTheReferenceWhichStays) {
  std::vector<Taking> takings = nine();
  for (std::size_t k = 2; k < takings.size(); ++k) takings[k].dx = 3, takings[k].dy = -2;
  MergeOptions options = options_of(takings);
  options.aligns = true;
  const Merged merged = merge(options);
  ASSERT_GE(merged.reference, 2u) << "or what follows says nothing";
  EXPECT_EQ(merged.reports[merged.reference].moved_x, 0);
  EXPECT_EQ(merged.reports[merged.reference].moved_y, 0);
  EXPECT_NEAR(merged.reports[1].moved_x, -3, 0.1);
  EXPECT_NEAR(merged.reports[1].moved_y, 2, 0.1);
}

// Frames of light without noise, 40 x 40, whose sums can be done by hand.
class BracketedLight : public testing::Test {
 protected:
  static constexpr int kSide = 40;
  // `change` gets each frame before it is written.
  template <class F>
  Merged merged(const std::vector<double>& seconds, const std::array<float, 3>& light, const F& change) {
    MergeOptions options;
    for (std::size_t k = 0; k < seconds.size(); ++k) {
      image::Picture frame(kSide, kSide);
      for (std::size_t i = 0; i < frame.rgb.size(); ++i) frame.rgb[i] = light[i % 3] * static_cast<float>(seconds[k]);
      change(frame, k);
      const fs::path file = folder_ / (std::to_string(k) + ".exr");
      image::write_exr(file, frame);
      options.brackets.push_back({file, {seconds[k], {}, {}, 0, 0}});
    }
    return merge(options);
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(BracketedLight, IsWeighedByHatAndExposureAndConfidenceIsThatOfTheWorstChannel) {
  // 1 s shows 0.1 and 0.01; 4 s shows 0.41 and 0.04, a fortieth more than it should: which frame counts how much shows.
  const Merged out = merged({1, 4}, {0.1f, 0.1f, 0.01f}, [](image::Picture& frame, std::size_t k) {
    for (std::size_t i = 0; k == 1 && i < frame.rgb.size(); ++i)
      if (i % 3 != 2) frame.rgb[i] = 0.41f;
  });
  const double want = (0.2 * 1 * 0.1 + 0.82 * 4 * 0.1025) / (0.2 * 1 + 0.82 * 4);
  EXPECT_NEAR(out.light.rgb[0], want, 1e-6);
  EXPECT_NEAR(out.confidence[0], 0.08, 1e-6) << "the hat of blue's 0.04";
}

TEST_F(BracketedLight, IsClippedFromCodeOneOn) {
  const Merged out = merged({1, 4}, {0.1f, 0.1f, 0.1f}, [](image::Picture& frame, std::size_t k) {
    for (std::size_t i = 0; i < frame.rgb.size() / 4; ++i) frame.rgb[i] = k == 0 ? 0.6f : 2.4f;
  });
  EXPECT_EQ(out.reports[0].clipped, 0);
  EXPECT_EQ(out.reports[1].clipped, 0.25);
}

TEST_F(BracketedLight, OfALonePixelThatMovedIsNoiseAndOfASquareAGhost) {
  const Merged out = merged({1, 2, 4}, {0.15f, 0.15f, 0.15f}, [](image::Picture& frame, std::size_t k) {
    if (k != 1) return;
    for (std::size_t c = 0; c < 3; ++c) {
      frame.at(10, 10)[c] *= 2;
      for (int y = 20; y < 23; ++y)
        for (int x = 20; x < 23; ++x) frame.at(x, y)[c] *= 2;
    }
  });
  EXPECT_EQ(out.ghost[10 * kSide + 10], 0);
  EXPECT_NE(out.ghost[21 * kSide + 21], 0);
  EXPECT_EQ(out.ghosts, 21u) << "what is around the middles of the square's sides, and its own middle";
}

TEST_F(Bracketed, AGhostIsMarkedAndTakenFromTheReference) {
  std::vector<Taking> takings = nine();
  takings[3].has_ghost = true;
  MergeOptions options = options_of(takings);
  options.deghosts = true;
  const Merged merged = merge(options);
  std::size_t inside = 0, outside = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (merged.ghost[static_cast<std::size_t>(y * kWidth + x)] != 0)
        ++(x >= 69 && x < 91 && y >= 49 && y < 71 ? inside : outside);
  EXPECT_GT(inside, 380u);  // of 400
  EXPECT_LT(outside, 20u);
  ASSERT_NE(merged.reports[merged.reference].bracket.file.filename(), "f4.png");
  const std::size_t middle = 60 * kWidth + 80;
  EXPECT_EQ(merged.ghost[middle], 2);
  EXPECT_NEAR(std::log2(static_cast<double>(merged.light.rgb[3 * middle + 1] / light_.rgb[3 * middle + 1])), 0, 0.1);
}

TEST_F(Bracketed, WhatIsClippedOrBlackInEveryFrameHasABoundAndNoConfidence) {
  for (const float extreme : {1e6f, 0.0f}) {
    std::ranges::fill(light_.rgb, extreme);
    MergeOptions options = options_of({{.seconds = 0.5, .noise = 0}, {.seconds = 2, .noise = 0}});
    options.response = linear_response();
    const Merged merged = merge(options);
    for (std::size_t i = 0; i < merged.confidence.size(); ++i) {
      ASSERT_EQ(merged.confidence[i], 0);
      ASSERT_EQ(merged.frames[i], 0);
      ASSERT_EQ(merged.bound[i], extreme > 0 ? Bound::kLower : Bound::kUpper);
      // Code 1 in 0.5 s; or half a step of 8 bits in 2 s.
      ASSERT_NEAR(merged.light.rgb[3 * i], extreme > 0 ? 2 : 0.5 / 255 / 2, 1e-6);
    }
    options.response.reset();
    EXPECT_THAT(warnings_of(merge(options)), HasSubstr("no response can be recovered"));
  }
}

TEST_F(Bracketed, OneFrameAndEqualTimesAreMergedAndSaid) {
  Merged merged = merge(options_of({{.seconds = 1}}));
  EXPECT_THAT(warnings_of(merged), HasSubstr("one frame is no bracket"));
  EXPECT_EQ(merged.response.name, "srgb");
  MergeOptions options = options_of({{.seconds = 1}, {.seconds = 1}});
  merged = merge(options);
  EXPECT_THAT(warnings_of(merged), HasSubstr("all frames have the same exposure"));
  options.recovers = true;
  EXPECT_THROW(merge(options), files::UsageError);
}

TEST_F(Bracketed, LightThatIsNotFiniteIsLeftOutAndNothingIsNaN) {
  MergeOptions options;
  for (const double t : {0.25, 1.0}) {
    image::Picture frame = light_;
    for (float& v : frame.rgb) v *= static_cast<float>(t);
    for (std::size_t i = 0; i < 900; ++i)
      frame.rgb[i] = i % 3 == 0 ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
    if (t == 1) std::fill_n(frame.rgb.begin() + 1500, 300, -1.0f);
    const fs::path file = folder_ / (std::to_string(t) + ".exr");
    image::write_exr(file, frame);
    options.brackets.push_back({file, {t, {}, {}, 0, 0}});
  }
  const Merged merged = merge(options);
  EXPECT_EQ(merged.weighting, Weighting::kNoise);
  EXPECT_EQ(merged.unknown, 300u);
  for (const float v : merged.light.rgb) ASSERT_TRUE(std::isfinite(v));
  std::size_t known = 0;
  for (std::size_t i = 600; i < merged.confidence.size(); ++i)
    if (merged.bound[i] == Bound::kNone) {
      ++known;
      for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(merged.light.rgb[3 * i + c] / light_.rgb[3 * i + c], 1, 1e-4);
    }
  EXPECT_GT(known, merged.confidence.size() / 2);
}

TEST_F(Bracketed, ABorderOfPureColorIsSuggestedAndLeftOutOnRequest) {
  MergeOptions options = options_of({{.seconds = 1}, {.seconds = 4}});
  image::DisplayPicture blue = photo_of(light_, {.seconds = 4}, 9);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < 3; ++x) blue.at(x, y)[0] = blue.at(x, y)[1] = 0, blue.at(x, y)[2] = 255;
  image::write_png(options.brackets[1].file, blue);
  options.response = srgb_response();
  Merged merged = merge(options);
  EXPECT_THAT(warnings_of(merged), HasSubstr("--ignore-color 0,0,255"));
  options.frame.ignored = Color8{0, 0, 255};
  merged = merge(options);
  EXPECT_EQ(merged.warnings.size(), 0u + static_cast<std::size_t>(std::ranges::count(warnings_of(merged), '\n')));
  EXPECT_THAT(warnings_of(merged), testing::Not(HasSubstr("ignore-color")));
  EXPECT_NEAR(merged.reports[1].ignored, 3.0 / kWidth, 0.01);
}

TEST_F(Bracketed, RefusalsNameTheFileAndStoppingIsAskedBetweenFrames) {
  MergeOptions options = options_of({{.seconds = 1}, {.seconds = 4}});
  options.keep_going = [](std::string_view, double share) { return share < 0.5; };
  EXPECT_THROW(merge(options), files::Interrupted);
  options.keep_going = nullptr;
  image::write_png(options.brackets[1].file, image::DisplayPicture(kWidth, kHeight + 1));
  try {
    merge(options);
    ADD_FAILURE();
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("f2.png: has 160 x 121 pixels; f1.png has 160 x 120"));
  }
  fs::remove(options.brackets[1].file);
  EXPECT_THROW(merge(options), files::InputError);
  EXPECT_THROW(merge({}), files::UsageError);
}

TEST(Brackets, ListsAreReadInBothForms) {
  const auto debevec =
      brackets_of("# Filename exposure 1/shutter\na.png 32 0.03125 8 0 0\nb.png 0.5 2 4 3 0.30103\n", "l", "d");
  ASSERT_EQ(debevec.size(), 2u);
  EXPECT_EQ(debevec[1].file, fs::path("d") / "b.png");
  const std::vector<double> exposures = exposures_of(debevec);
  EXPECT_DOUBLE_EQ(exposures[0], 32);
  EXPECT_NEAR(exposures[1], 0.5 * 4 * 2 / 2, 1e-5);  // f/4 for f/8, 3 dB, a filter of one stop
  const auto simple = brackets_of("name,seconds\r\nmy room.png,1/250\r\nb.png, 2\r\n", "l", "");
  ASSERT_EQ(simple.size(), 2u);
  EXPECT_EQ(simple[0].file, "my room.png");
  EXPECT_DOUBLE_EQ(simple[0].setting.seconds, 1.0 / 250);
}

TEST(Brackets, BadListsAreRefusedWithTheirLine) {
  for (const char* text : {"", "# nothing\n", "a.png\n", "a.png 0\n", "a.png -1\n", "a.png nan\n", "a.png 1/0\n",
                           "a.png 1e9\n", "a.png 1\na.png 2\n", "a.png 1 1 8 0\n", "a.png 1 2 8 0 0\n",
                           "a.png 1 1 0 0 0\n", "a.png 1 1 8 inf 0\n", ",1\n"})
    EXPECT_THROW(brackets_of(text, "l", ""), files::InputError) << text;
  try {
    brackets_of("a.png 1\nb.png x\n", "times.txt", "");
    ADD_FAILURE();
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("times.txt:2: exposure \"x\" is no time"));
  }
}

TEST(Memorial, IsMergedAndItsStatedTimesAreTrue) {
  const fs::path folder = fs::path(LIKENESS_SHARED_DIR) / "data/brackets/memorial";
  if (!fs::exists(folder / "image_list.txt")) GTEST_SKIP() << "no " << folder / "image_list.txt";
  MergeOptions options;
  options.brackets = read_brackets(folder / "image_list.txt");
  options.frame.ignored = Color8{0, 0, 255};
  const Merged merged = merge(options);
  ASSERT_EQ(merged.reports.size(), 16u);
  for (const double error : merged.judgement.errors) EXPECT_FALSE(std::abs(error) > kTimeWarning) << error;
  for (const double rms : merged.recovered->rms_stops) EXPECT_LT(rms, 0.2);  // grain, and what registration left
  for (const double black : merged.response.black) EXPECT_NEAR(255 * black, 18, 5);  // the film's base
  EXPECT_EQ(merged.unknown, 0u);
  EXPECT_LT(merged.clipped_in_all + merged.black_in_all, 10u);
  EXPECT_THAT(olat_photograph::page_of(merged), HasSubstr("memorial0076.png"));
}

}  // namespace
}  // namespace likeness::photograph
