#include <gtest/gtest.h>

#include <string>

#include "olat/tev/images.h"
#include "tests/olat/small_capture.h"
#include "tests/olat/view/browser.h"
#include "tests/olat/view/served.h"
#include "tests/render/temporary_folder.h"

namespace likeness::olat_view {
namespace {

// A renderer that sends while the page is open: its picture becomes a set of renders, and follows what comes.
TEST(ReceivedPage, ShowsWhatARendererSends) {
  if (test::Browser::program().empty()) GTEST_SKIP() << "no Chromium: ./bootstrap test installs it";
  const test::TemporaryFolder folder;
  olat_tev::Images images;
  test::Served served(test::write_small_capture(folder.path()), {.with_scores = false, .received = &images});
  test::Browser browser(900, 600);
  browser.open(served.address("mode=render"));
  ASSERT_TRUE(browser.wait("document.body.dataset.ready && likeness.complete"));
  const auto give = [&](float light) {
    images.take(olat_tev::Create{"pbrt", 64, 48, {"Y"}});
    images.take(olat_tev::Update{"pbrt", {"Y"}, 0, 0, 64, 48, {0}, {0}, {light}});
  };
  give(0.18f);
  ASSERT_TRUE(browser.wait("likeness.capture.variants.includes('pbrt')", 10));
  browser.press("Shift+q");
  EXPECT_EQ(browser.evaluate("likeness.state.variant"), "\"pbrt\"");
  const std::string shown = "likeness.complete && likeness.stage.shownEntries.render.data?.[0]";
  EXPECT_TRUE(browser.wait(shown + " === 0x31c3", 10)) << browser.evaluate(shown);  // 0.18 as half
  give(1);
  EXPECT_TRUE(browser.wait(shown + " === 0x3c00", 10)) << browser.evaluate(shown);
  EXPECT_EQ(browser.faults(), "");
}

}  // namespace
}  // namespace likeness::olat_view
