#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "olat/pair/picture.h"
#include "olat/pair/state.h"
#include "tests/olat/small_capture.h"
#include "tests/olat/view/browser.h"
#include "tests/olat/view/served.h"
#include "tests/render/temporary_folder.h"

// The browser's pictures beside the processor's, over a grid of states.
namespace likeness::olat_view {
namespace {

using test::Browser;

// States with a word of every list, in combinations that matter: every view with every mode of one picture, every metric
// with views that change it, overlays, channels, gains, parameters of gt.
std::vector<std::string> grid() {
  std::vector<std::string> out;
  for (const char* view : {"srgb", "gt", "khronos", "agx", "aces"}) {
    const std::string v = std::string("view=") + view;
    for (const char* ev : {"-4", "0", "2.3", "6"}) out.push_back(v + "&ev=" + ev);
    for (const char* mode : {"render", "wipe&split=0.37", "onion&mix=0.3", "side"})
      out.push_back(v + "&ev=1&mode=" + mode);
    for (const char* rest : {"channel=red", "channel=luma", "overlay=curve", "zebra=1",
                             "mode=difference&metric=delta_e", "mode=difference&metric=flip"})
      out.push_back(v + "&ev=1&" + rest);
  }
  for (const char* metric :
       {"stops", "signed", "absolute", "smape", "hdr_flip", "stops&channel=blue", "stops&range=0.7", "smape&noise=0.01",
        "signed&ev=-2", "stops&match=light", "stops&match=channel"})
    out.push_back(std::string("mode=difference&metric=") + metric);
  for (const char* rest :
       {"overlay=zones", "overlay=zones&ev=-3.5&mode=side", "channel=coverage", "channel=signed&ev=-1", "channel=green",
        "channel=blue", "gt_P=2&gt_a=1.4&gt_m=0.3&gt_l=0.2&gt_c=2&gt_b=0.05&overlay=curve", "gt_l=1&ev=2",
        "gt_m=0&ev=-3", "mode=render&match=capture", "mode=wipe&overlay=curve&zebra=1&ev=3"})
    out.push_back(rest);
  return out;
}

TEST(Parity, OfBrowserAndProcessorIsWithinOneDisplayValue) {
  if (Browser::program().empty()) GTEST_SKIP() << "no Chromium: ./bootstrap test installs it";
  const test::TemporaryFolder folder;
  const capture::Capture capture = test::write_small_capture(folder.path());
  test::Served served(capture, {.with_scores = false});
  Browser browser(300, 300);  // a small window: software draws every pixel of it for every state
  browser.open(served.address());
  ASSERT_TRUE(browser.wait("document.body.dataset.ready && likeness.complete"));

  long pixels = 0, far = 0;
  int states = 0;
  for (const std::string& part : grid()) {
    const std::string text = "camera=c0&light=l2&zoom=1&" + part;
    const olat_pair::State state = olat_pair::state_of(text);
    // The page's own reader of texts, its drawing, and its pixels as hexadecimal.
    browser.evaluate("likeness.change(likeness.parse('" + text + "'))");
    ASSERT_TRUE(browser.wait("likeness.complete && likeness.drawnState === likeness.text()")) << text;
    const image::DisplayPicture want = olat_pair::picture_of(state, olat_pair::load_pair(capture, state));
    std::vector<int> panes{0};
    if (state.mode == olat_pair::Mode::kSide) panes.push_back(1);
    long here = 0;
    for (const int pane : panes) {
      const std::string hex = browser.evaluate(
          "(()=>{const s=likeness.stage,w=s.window; return Array.from(s.read(w.origin[0]+" + std::to_string(pane) +
          "*w.pane, w.origin[1], 64, 48), v=>v.toString(16).padStart(2,'0')).join('')})()");
      ASSERT_EQ(hex.size(), 2u + 2 * 4 * 64 * 48);
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
          const auto wanted = want.at(x + 64 * pane, y);
          bool is_far = false;
          for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t at = 1 + 2 * (4 * static_cast<std::size_t>(y * 64 + x) + c);
            is_far |= std::abs(std::stoi(hex.substr(at, 2), nullptr, 16) - wanted[c]) > 1;
          }
          here += is_far ? 1 : 0;
          ++pixels;
        }
    }
    EXPECT_LE(here, 64 * 48 / 100) << text << ": no state may be far off, whatever the others are";
    far += here;
    ++states;
  }
  EXPECT_LE(static_cast<double>(far), 0.001 * static_cast<double>(pixels)) << "99.9 % of pixels";
  std::printf("%d states, %ld pixels, %ld (%.4f %%) farther than 1 / 255\n", states, pixels, far,
              100.0 * static_cast<double>(far) / static_cast<double>(pixels));
  EXPECT_EQ(browser.faults(), "");
}

TEST(Parity, OfTextsAndHashesIsExact) {
  if (Browser::program().empty()) GTEST_SKIP() << "no Chromium: ./bootstrap test installs it";
  const test::TemporaryFolder folder;
  test::Served served(test::write_small_capture(folder.path()), {.with_scores = false});
  Browser browser(800, 600);
  browser.open(served.address());
  ASSERT_TRUE(browser.wait("document.body.dataset.ready"));
  for (const std::string& part : grid())
    for (const char* more : {"", "&x=0.12345&noise=0.00009", "&mix=0.03125&y=0.9999"}) {
      const std::string text = "camera=a%20b%26c&light=%C3%A9(1)!&variant=it%27s*&" + part + more;
      olat_pair::State state;
      try {
        state = olat_pair::state_of(text);
      } catch (const std::exception&) {
        continue;  // a key twice
      }
      const std::string quoted = "decodeURIComponent(\"" + [&] {
        std::string out;
        for (const char c : text) out += c == '%' ? "%25" : std::string(1, c);
        return out;
      }() + "\")";
      EXPECT_EQ(browser.evaluate("likeness.textAgain(" + quoted + ")"), "\"" + olat_pair::text_of(state) + "\"");
      EXPECT_EQ(browser.evaluate("likeness.hashOfText(" + quoted + ")"),
                "\"" + olat_pair::hash_of(olat_pair::pipeline_of(state)) + "\"");
    }
}

}  // namespace
}  // namespace likeness::olat_view
