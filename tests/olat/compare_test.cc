#include "olat/compare/compare.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "olat/compare/cache.h"
#include "render/files/files.h"
#include "render/image/read.h"
#include "render/image/write.h"
#include "tests/olat/ball_capture.h"
#include "tests/render/temporary_folder.h"

namespace likeness::olat_compare {
namespace {

namespace fs = std::filesystem;
using capture::Capture;
using metric::Metric;
using olat_test::Ball;
using olat_test::Faults;
using olat_test::kBallLights;
using olat_test::Planted;
using olat_test::write_ball_capture;
using test::TemporaryFolder;

Faults bright_light(std::size_t which, double ev) {
  return {.plant = [=](std::size_t light, Ball&, Planted& planted) { planted.gain_ev = light == which ? ev : 0; }};
}

Options light_metrics() {
  Options options;
  options.metrics = {Metric::kStops, Metric::kAbsolute};
  return options;
}

double median_of(const Comparison& comparison, std::size_t row) { return comparison.rows[row].summaries[0].median; }

TEST(Compare, ALightThatIsHalfAStopTooBrightIsThatInStops) {
  const TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path(), bright_light(3, 0.5));
  const Comparison comparison = run_compare(capture, light_metrics());
  ASSERT_EQ(comparison.rows.size(), kBallLights);
  EXPECT_TRUE(comparison.is_complete);
  for (std::size_t i = 0; i < kBallLights; ++i) EXPECT_NEAR(median_of(comparison, i), i == 3 ? 0.5 : 0, 0.02) << i;
  EXPECT_NEAR(comparison.noise_floor[0][1], 1e-3, 2e-4) << "measured, since nobody stated it";
  EXPECT_TRUE(comparison.noise_is_measured[0]);
}

TEST(Compare, MatchGainTakesWhatItSays) {
  const TemporaryFolder folder;
  Faults faults = bright_light(3, 0.5);
  faults.plant = [](std::size_t light, Ball&, Planted& planted) {
    planted.gain_ev = light == 3 ? 0.75 : 0.25;
    planted.channel_ev = {0.2, 0, 0};
  };
  const Capture capture = write_ball_capture(folder.path(), faults);
  Options options = light_metrics();
  options.match = Match::kCapture;
  const Comparison whole = run_compare(capture, options);
  EXPECT_NEAR(whole.rows[3].gain_ev[0], whole.rows[0].gain_ev[2], 1e-12) << "one for all";
  EXPECT_NEAR(whole.rows[0].gain_ev[0], 0.25, 0.08) << "red is higher";
  EXPECT_NEAR(median_of(whole, 3), 0.5, 0.08);
  options.match = Match::kLight;
  const Comparison light = run_compare(capture, options);
  EXPECT_NEAR(light.rows[3].gain_ev[0] - light.rows[0].gain_ev[0], 0.5, 0.02);
  EXPECT_NEAR(median_of(light, 3), 0, 0.05);
  options.match = Match::kChannel;
  const Comparison channel = run_compare(capture, options);
  EXPECT_NEAR(channel.rows[3].gain_ev[0], 0.95, 0.02);
  EXPECT_NEAR(channel.rows[3].gain_ev[1], 0.75, 0.02);
  EXPECT_NEAR(median_of(channel, 3), 0, 0.02);
}

TEST(Compare, CountsOnlyTheMaskAndWhatIsNotClipped) {
  const TemporaryFolder folder;
  Capture capture = write_ball_capture(folder.path());
  const std::vector<float> mask = olat_test::ball_mask(olat_test::rendered_ball());
  const auto inside = static_cast<std::size_t>(std::ranges::count(mask, 1.0f));
  const Comparison all = run_compare(capture, light_metrics());
  EXPECT_EQ(all.rows[8].summaries[0].pixels, inside);
  EXPECT_EQ(all.rows[8].weight, static_cast<double>(inside));
  capture.frames[8].clip = 0.45;
  const Comparison clipped = run_compare(capture, light_metrics());
  EXPECT_GT(clipped.rows[8].clipped, 0u);
  EXPECT_EQ(clipped.rows[8].summaries[0].pixels + clipped.rows[8].clipped, inside);
  Options options = light_metrics();
  options.weight = Weight::kCosine;
  const Comparison cosine = run_compare(capture, options);
  // The mean cosine over a disk seen from its light is 2 / 3.
  EXPECT_NEAR(run_compare(write_ball_capture(folder.path()), options).rows[8].weight / static_cast<double>(inside),
              2 / 3.0, 0.01);
  EXPECT_LT(cosine.rows[0].weight, clipped.rows[0].weight);
  capture.layers.pop_back();  // the normals
  EXPECT_THROW(run_compare(capture, options), files::UsageError);
}

TEST(Compare, EveryMetricIsThereAndBetterWithoutTheFault) {
  const TemporaryFolder good, bad;
  Options options;
  options.lights = {"001", "008"};
  const Capture clean = write_ball_capture(good.path()), faulty = write_ball_capture(bad.path(), bright_light(1, 0.5));
  const Comparison a = run_compare(clean, options), b = run_compare(faulty, options);
  ASSERT_EQ(a.metrics.size(), metric::kMetrics.size());
  ASSERT_EQ(a.rows.size(), 2u);
  for (std::size_t k = 0; k < a.metrics.size(); ++k) {
    EXPECT_LT(1.5 * a.rows[0].summaries[k].rms, b.rows[0].summaries[k].rms) << metric::kMetrics[k].id;
    EXPECT_EQ(a.rows[1].summaries[k].rms, b.rows[1].summaries[k].rms) << metric::kMetrics[k].id;
  }
}

TEST(Compare, IsTheSameOnOneThread) {
  const TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path(), bright_light(2, 1));
  Options options = light_metrics();
  options.metrics.push_back(Metric::kFlip);
  const std::string many = json_of(run_compare(capture, options), capture);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(json_of(run_compare(capture, options), capture), many);
}

TEST(Compare, GoesOnFromItsCacheAndComputesOnlyWhatChanged) {
  const TemporaryFolder folder;
  Capture capture = write_ball_capture(folder.path(), bright_light(2, 1));
  capture.noise_floor = {{1e-3, 1e-3, 1e-3}};  // measured anew, it would change with every photo
  Options options = light_metrics();
  options.cache = (folder / "compare.cache").string();
  // Interrupted after three pairs.
  int left = 3;
  options.keep_going = [&](std::string_view, double) { return --left > 0; };
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Comparison part = run_compare(capture, options);
    EXPECT_FALSE(part.is_complete);
  }
  options.keep_going = {};
  const Comparison rest = run_compare(capture, options);
  EXPECT_EQ(rest.from_cache, 6u) << "two metrics of three pairs";
  EXPECT_TRUE(rest.is_complete);
  Options fresh = light_metrics();
  EXPECT_EQ(json_of(rest, capture), json_of(run_compare(capture, fresh), capture)) << "to the last bit";
  EXPECT_EQ(run_compare(capture, options).from_cache, 2 * kBallLights);

  // Another render, another setting, another row of frames.json: not from the cache.
  const fs::path render = folder / "renders/plain/front/004.exr";
  image::Picture changed = image::read_picture(render);
  changed.at(48, 48)[0] += 1;
  image::write_exr(render, changed);
  EXPECT_EQ(run_compare(capture, options).from_cache, 2 * (kBallLights - 1));
  Capture other = capture;
  other.lights[5].intensity = {2, 1, 1};
  EXPECT_EQ(run_compare(other, options).from_cache, 2 * (kBallLights - 1));
  options.ev = 1;
  EXPECT_EQ(run_compare(capture, options).from_cache, 0u);
  options.ev = 0;
  options.match = Match::kLight;
  EXPECT_EQ(run_compare(capture, options).from_cache, 0u);
}

TEST(Cache, LeavesOutWhatIsNotWhole) {
  const TemporaryFolder folder;
  const std::string file = (folder / "a.cache").string();
  {
    Cache cache(file);
    cache.add("k1", Metric::kStops, {1, 2, 3, 4, 5, 6, 7});
    cache.add("k1", PairFacts{{0.1, 0.2, 0.3}, 4, 5});
  }
  std::ofstream(file, std::ios::app)
      << "k2 stops 1 2 x 4 5 6 7\nk3 stops 1 2 3\nk4 stops 1 nan 3 4 5 6 7\nnonsense\nk5 stops 1 2 3 4 5 6 7";
  const Cache cache(file);
  ASSERT_TRUE(cache.find("k1", Metric::kStops));
  EXPECT_EQ(cache.find("k1", Metric::kStops)->largest, 5);
  EXPECT_EQ(cache.find("k1")->gain_ev[2], 0.3);
  for (const char* key : {"k2", "k3", "k4", "k5", "k6"}) EXPECT_FALSE(cache.find(key, Metric::kStops)) << key;
  EXPECT_FALSE(cache.find("k1", Metric::kFlip));
  EXPECT_TRUE(files::read_whole(file, 1 << 20).ends_with("nonsense\n")) << "the line without its end is gone";
  std::ofstream(file) << "another file\n";
  EXPECT_FALSE(Cache(file).find("k1"));
  EXPECT_FALSE(Cache("").find("k1"));
}

TEST(Compare, SaysWhichPairsCannotBeComparedAndGoesOn) {
  const TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path());
  fs::remove(folder / "renders/plain/front/001.exr");
  std::ofstream(folder / "renders/plain/front/002.exr") << "no picture";
  image::write_exr(folder / "renders/plain/front/003.exr", image::Picture(95, 96));
  fs::remove(folder / "photos/front/004.exr");
  const Comparison comparison = run_compare(capture, light_metrics());
  EXPECT_EQ(comparison.rows[0].state, State::kCompared);
  EXPECT_EQ(comparison.rows[1].state, State::kNoRender);
  EXPECT_EQ(comparison.rows[2].state, State::kUnreadable);
  EXPECT_EQ(comparison.rows[3].state, State::kOtherSize);
  EXPECT_EQ(comparison.rows[4].state, State::kUnreadable);
  EXPECT_EQ(comparison.rows[5].state, State::kCompared);
  EXPECT_EQ(exit_code_of(comparison, {}, {}), kFileError);
  const std::string csv = csv_of(comparison, capture);
  EXPECT_NE(csv.find("front,003,other size,"), std::string::npos);
  const auto commas = [](const std::string& line) { return std::ranges::count(line, ','); };
  const std::size_t first = csv.find('\n');
  std::size_t at = first + 1;
  for (std::size_t end; (end = csv.find('\n', at)) != std::string::npos; at = end + 1)
    EXPECT_EQ(commas(csv.substr(at, end - at)), commas(csv.substr(0, first))) << csv.substr(at, end - at);
}

TEST(Compare, RefusesWhatTheCaptureDoesNotHave) {
  const TemporaryFolder folder;
  Capture capture = write_ball_capture(folder.path());
  Options options = light_metrics();
  options.cameras = {"fronk"};
  EXPECT_THROW(run_compare(capture, options), files::UsageError);
  options = light_metrics();
  options.variant = "plane";
  EXPECT_THROW(run_compare(capture, options), files::UsageError);
  options = light_metrics();
  options.view = "no such view";
  EXPECT_THROW(run_compare(capture, options), files::InputError);
  capture.variants.clear();
  EXPECT_THROW(run_compare(capture, light_metrics()), files::UsageError);
}

Comparison with_summary(double p95, State state = State::kCompared) {
  Comparison comparison;
  comparison.metrics = {Metric::kStops};
  Row row;
  row.state = state;
  if (state == State::kCompared) row.summaries = {{0, -0.4, p95, 0, 0, 1, 0}};
  comparison.rows = {row};
  return comparison;
}

TEST(ExitCodes, AreThoseOfIdiff) {
  const std::vector<Limit> one{limit_of("1")}, half{limit_of("0.5")};
  EXPECT_EQ(exit_code_of(with_summary(0.4), one, half), kWithin);
  EXPECT_EQ(exit_code_of(with_summary(0.5), one, half), kWithin) << "the limit itself is within";
  EXPECT_EQ(exit_code_of(with_summary(0.6), one, half), kWarn);
  EXPECT_EQ(exit_code_of(with_summary(1.1), one, half), kFail);
  EXPECT_EQ(exit_code_of(with_summary(1.1), {}, {}), kWithin);
  EXPECT_EQ(exit_code_of(with_summary(0), {limit_of("stops.median=0.3")}, {}), kFail) << "by magnitude";
  EXPECT_EQ(exit_code_of(with_summary(0, State::kOtherSize), one, half), kSizeDiffers);
  EXPECT_EQ(exit_code_of(with_summary(0, State::kUnreadable), one, half), kFileError);
  EXPECT_EQ(exit_code_of(with_summary(0, State::kNoRender), one, half), kFileError) << "nothing was compared";
}

TEST(Limits, AreReadAsTheyAreWritten) {
  EXPECT_EQ(limit_of("0.25").most, 0.25);
  EXPECT_EQ(limit_of("0.25").metric, Metric::kStops);
  const Limit limit = limit_of("flip.mean=0.1");
  EXPECT_EQ(limit.metric, Metric::kFlip);
  EXPECT_EQ(metric::kStatistics[limit.statistic].id, "mean");
  EXPECT_EQ(metric::kStatistics[limit_of("delta_e=2").statistic].id, "p95");
  for (const char* text : {"", "x", "-1", "nan", "inf", "flip.mean", "flup=1", "flip.men=1", "1 2", "flip.mean="})
    EXPECT_THROW(limit_of(text), files::UsageError) << text;
}

TEST(Totals, WeighPixelsAndTakeTheMedianPair) {
  const metric::Summary a{1, 10, 20, 2, 30, 100, 1}, b{3, 12, 22, 4, 25, 300, 0}, c{0, 0, 0, 0, 0, 0, 5};
  const metric::Summary all = total({&a, &b, &c});
  EXPECT_DOUBLE_EQ(all.mean, 2.5);
  EXPECT_DOUBLE_EQ(all.rms, std::sqrt((100 * 4.0 + 300 * 16.0) / 400));
  EXPECT_DOUBLE_EQ(all.median, 12);
  EXPECT_DOUBLE_EQ(all.largest, 30);
  EXPECT_EQ(all.pixels, 400u);
  EXPECT_EQ(all.not_finite, 6u);
  EXPECT_EQ(total({}).pixels, 0u);
}

}  // namespace
}  // namespace likeness::olat_compare
