#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "olat/view/report.h"
#include "tests/olat/small_capture.h"
#include "tests/olat/view/browser.h"
#include "tests/render/temporary_folder.h"

namespace likeness::olat_view {
namespace {

image::Picture noise(int side, unsigned seed) {
  image::Picture out(side, side);
  std::mt19937 random(seed);
  for (float& v : out.rgb) v = std::exp2(static_cast<float>(random() % 65536) / 4096 - 8);  // nothing to compress
  return out;
}

TEST(LargeReport, OfThirtyMegabytesOpens) {
  if (test::Browser::program().empty()) GTEST_SKIP() << "no Chromium: ./bootstrap test installs it";
  const test::TemporaryFolder folder;
  test::SmallCapture want;
  want.cameras = 1;
  want.lights = 8;
  want.width = want.height = 512;
  want.with_mask = false;
  want.is_repeated = true;
  const capture::Capture capture = test::write_small_capture(folder.path(), want);
  for (unsigned l = 0; l < 8; ++l) {
    const std::string name = "c0/l" + std::to_string(l) + ".exr";
    image::write_exr(folder.path() / "photos" / name, noise(512, l));
    image::write_exr(folder.path() / "renders/truth" / name, noise(512, 100 + l));
  }
  ReportOptions options;
  options.pairs = 8;
  const ReportSummary summary = write_report(capture, options, folder.path() / "large.html");
  EXPECT_EQ(summary.held, 8u);
  EXPECT_GE(summary.bytes, 30'000'000u);
  test::Browser browser(1000, 700);
  browser.open("file://" + (folder.path() / "large.html").string());
  ASSERT_TRUE(browser.wait("document.body.dataset.ready && likeness.complete", 30));
  browser.press("ArrowRight");
  browser.press("d");
  EXPECT_TRUE(browser.wait("likeness.complete && likeness.drawnState.includes('mode=difference')", 20));
  EXPECT_EQ(browser.evaluate("likeness.stage.shownEntries.render.width"), "512");
  EXPECT_EQ(browser.faults(), "");
}

}  // namespace
}  // namespace likeness::olat_view
