#include "realis/ablation/ablation.h"

#include <gtest/gtest.h>

#include "render/files/files.h"
#include "tests/render/temporary_folder.h"

// The bars of docs/realis_weights.md, with lobes that are chosen anew from each capture, on seeds that nobody tuned to.
namespace likeness::realis {
namespace {

bool always(double, std::string_view) { return true; }

AblationOptions small(const test::TemporaryFolder& folder) {
  AblationOptions out;
  out.folder = folder.path() / "captures";
  out.lights = {16}, out.seeds = 1, out.first_seed = 101, out.side = 48;
  return out;
}

TEST(Ablation, DeadPixelsAndHighlightsAreTakenAway) {
  const test::TemporaryFolder folder;
  AblationOptions options = small(folder);
  options.faults = {"dead pixels", "strong highlight"};
  for (const Trial& t : ablate(options, always).trials) {
    EXPECT_GT(t.false_residual, 0);
    EXPECT_GT(1 - t.left_of_lobes / t.false_of_lobes, 0.8) << kFaults[t.fault].name;
    EXPECT_LT(t.left, 0.5 * t.false_residual) << kFaults[t.fault].name;
    EXPECT_LE(t.best, t.false_residual);
  }
}

// Shadow lies between the contours of two noisy pictures, so that it is given more; noise itself changes 4 to 5 %.
TEST(Ablation, CleanCapturesLoseLessThanNoiseChanges) {
  const test::TemporaryFolder folder;
  AblationOptions options = small(folder);
  options.faults = {"gain"};
  const Ablation a = ablate(options, always);
  EXPECT_EQ(a.costs.size(), 6u);
  for (const Cost& c : a.costs) {
    EXPECT_LT(c.changed, c.weight == "shadow" ? c.noise : 0.01) << c.weight;
    EXPECT_LT(c.held_out_with, 1.02 * c.held_out_without) << c.weight;
    EXPECT_GT(c.noise, 0.01);
  }
}

TEST(Ablation, TheSameSeedsGiveTheSameNumbers) {
  const test::TemporaryFolder folder;
  AblationOptions options = small(folder);
  options.lights = {8}, options.side = 24, options.faults = {"object"};
  EXPECT_EQ(csv_of(ablate(options, always)), csv_of(ablate(options, always)));
}

TEST(Ablation, NamesAFaultThatIsMeant) {
  const test::TemporaryFolder folder;
  AblationOptions options = small(folder);
  options.faults = {"objekt"};
  try {
    ablate(options, always);
    FAIL();
  } catch (const files::UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"object\""), std::string::npos) << error.what();
  }
}

TEST(Ablation, ReportsMedianAndEndsOfTheSeeds) {
  Ablation a;
  for (const double left : {0.1, 0.3, 0.2})
    a.trials.push_back({.fault = 2, .lights = 12, .false_residual = 1, .left = left});
  EXPECT_NE(table_of(a).find("80.0 (70.0 to 90.0)"), std::string::npos) << table_of(a);
  EXPECT_NE(page_of(a, {}).find("80.0 (70.0 to 90.0)"), std::string::npos);
  EXPECT_NE(json_of(a).find("\"fault\": \"shadow\""), std::string::npos);
  EXPECT_EQ(spread_of({}).most, 0);
}

}  // namespace
}  // namespace likeness::realis
