#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "olat/metric/formulas.h"
#include "olat/pair/exposure.h"
#include "olat/pair/picture.h"
#include "olat/pair/state.h"
#include "olat/view/report.h"
#include "render/capture/files_of_capture.h"
#include "tests/olat/small_capture.h"
#include "tests/olat/view/browser.h"
#include "tests/olat/view/served.h"
#include "tests/render/temporary_folder.h"

// What the page does beside showing a state: exposure at opening, regions, thumbnails, holding, spread lights, and the
// report's small pictures. Real keys, one browser for all cases, and conditions that are waited for.
namespace likeness::olat_view {
namespace {

using olat_pair::Pair;
using olat_pair::State;
using test::Browser;
using testing::HasSubstr;

class PageTools : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!Browser::program().empty()) browser_ = std::make_unique<Browser>(1280, 720);
  }
  static void TearDownTestSuite() { browser_.reset(); }
  void SetUp() override {
    if (!browser_) GTEST_SKIP() << "no Chromium: ./bootstrap test installs it";
  }
  void TearDown() override {
    if (!browser_) return;
    EXPECT_EQ(browser_->faults(), "");
  }

  // A capture, served from here to the end of the case.
  capture::Capture& make(const test::SmallCapture& want = {}) {
    return capture_ = test::write_small_capture(folder_.path(), want);
  }
  void open(const std::string& state = "") {
    if (!served_) served_ = std::make_unique<test::Served>(capture_, ViewOptions{.with_scores = false});
    browser_->open(served_->address(state));
    ASSERT_TRUE(wait("document.body.dataset.ready && likeness.complete")) << evaluate("document.body.innerText");
  }
  bool wait(const std::string& expression) { return browser_->wait(expression); }
  std::string evaluate(const std::string& expression) { return browser_->evaluate(expression); }
  double number(const std::string& expression) { return std::stod(evaluate(expression)); }
  void press(const std::string& key) { browser_->press(key); }
  // "" until the text of an element has that part.
  bool says(const std::string& id, const std::string& part) {
    return wait("document.getElementById('" + id + "').textContent.includes('" + part + "')");
  }
  Pair pair_of(const std::string& state) { return olat_pair::load_pair(capture_, olat_pair::state_of(state)); }
  double percentile_of(const std::string& state) {
    const Pair pair = pair_of(state);
    return olat_pair::exposures_of(pair.photo, pair.flaws, static_cast<double>(pair.noise))->percentile;
  }
  // The middle of a pixel of the picture, in the window.
  std::array<double, 2> place_of(int x, int y) {
    const std::string box = "document.getElementById('picture').getBoundingClientRect()";
    return {number("likeness.stage.window.origin[0] + likeness.stage.window.zoom * " + std::to_string(x + 0.5) + " + " +
                   box + ".left"),
            number("likeness.stage.window.origin[1] + likeness.stage.window.zoom * " + std::to_string(y + 0.5) + " + " +
                   box + ".top")};
  }

  static std::unique_ptr<Browser> browser_;
  test::TemporaryFolder folder_;
  capture::Capture capture_;
  std::unique_ptr<test::Served> served_;
};
std::unique_ptr<Browser> PageTools::browser_;

// The processor's picture of the page's own state, from /render, and what the canvas shows, at a pixel of the picture.
constexpr const char* kBothAt = R"((async () => {
  const answer = await fetch('/render?state=' + encodeURIComponent(likeness.text()), {headers: {'X-Likeness-Token': location.hash.slice(1)}});
  const image = await createImageBitmap(await answer.blob()), canvas = new OffscreenCanvas(image.width, image.height);
  const context = canvas.getContext('2d');
  context.drawImage(image, 0, 0);
  const s = likeness.stage, w = s.window;
  return Math.max(...[[40, 20], [10, 30], [60, 10]].map(([x, y]) => {
    const want = context.getImageData(x, y, 1, 1).data, is = s.read(w.origin[0] + x, w.origin[1] + y, 1, 1);
    return Math.max(...[0, 1, 2].map(c => Math.abs(want[c] - is[c])));
  }));
})())";

TEST_F(PageTools, OpenADarkCaptureWithAnExposureForItsPhoto) {
  make({.gain = 1.0 / 64});
  open();
  const double want = percentile_of("");
  EXPECT_GT(want, 3) << "six stops darker than one whose highlights are above 1";
  EXPECT_EQ(number("likeness.state.ev"), want);
  EXPECT_TRUE(says("hud", "(auto)"));
  EXPECT_TRUE(wait("new URLSearchParams(location.search).get('ev') === likeness.text().match(/ev=([^&]*)/)[1]"));
  press("Shift+c");
  EXPECT_TRUE(says("toast", "ev=" + evaluate("likeness.state.ev"))) << "the command has the number, not a rule";
  evaluate("likeness.change({zoom: 1})");
  ASSERT_TRUE(wait("likeness.complete && likeness.drawnState === likeness.text()"));
  EXPECT_LE(number(kBothAt), 1) << "/render of that state is the picture on the screen";
  press("ArrowRight");
  EXPECT_TRUE(wait("likeness.state.light === 'l1' && likeness.complete"));
  EXPECT_EQ(number("likeness.state.ev"), want) << "one exposure for all lights, else they could not be compared";
}

TEST_F(PageTools, KeepAnExposureThatSomebodyChose) {
  make({.gain = 1.0 / 64}).pipeline.ev = 2.5;
  open("ev=1.25");
  EXPECT_EQ(number("likeness.state.ev"), 1.25) << "of the address";
  open("ev=0&light=l1");
  EXPECT_EQ(number("likeness.state.ev"), 0) << "also where it is 0";
  EXPECT_TRUE(wait("new URLSearchParams(location.search).get('ev') === '0'")) << "and it stays in the address";
  evaluate(
      "URL.createObjectURL = blob => { blob.text().then(text => { window.saved = JSON.parse(text); }); return '#'; };"
      "HTMLAnchorElement.prototype.click = () => {};");
  press("Shift+s");
  EXPECT_TRUE(wait("window.saved.ev === '0' && window.saved.light === 'l1'")) << "and in view.json";
  open("light=l1");
  EXPECT_EQ(number("likeness.state.ev"), 2.5) << "of capture.json";
  EXPECT_EQ(evaluate("document.getElementById('hud').textContent.includes('auto')"), "false");
}

TEST_F(PageTools, OpenWithoutAnExposureWhereThereIsNothingToExposeFor) {
  make({.gain = 0, .with_renders = false});
  open();
  EXPECT_EQ(number("likeness.state.ev"), 0) << "all black";
  EXPECT_EQ(evaluate("document.getElementById('hud').textContent.includes('auto')"), "false");
  press("n");
  EXPECT_TRUE(says("toast", "there is no picture to expose for"));
  std::filesystem::remove_all(folder_.path() / "photos");
  served_.reset();
  open();
  EXPECT_EQ(number("likeness.state.ev"), 0);
  EXPECT_TRUE(wait("document.querySelector('#tag_left i').textContent === 'no photo'"));
}

// Luminance of what counts in a rectangle: mean, and the values at shares of the pixels by nearest rank.
std::vector<double> statistics(std::vector<double> values) {
  double sum = 0;
  for (const double v : values) sum += v;
  std::sort(values.begin(), values.end());
  std::vector<double> out{sum / static_cast<double>(values.size())};
  for (const double share : {0.05, 0.5, 0.95})
    out.push_back(values[static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size()))) - 1]);
  return out;
}

TEST_F(PageTools, MeasureTheRegionThatIsDraggedWithShift) {
  make();
  open("camera=c0&light=l2&zoom=4&ev=0&mode=side");
  browser_->drag(place_of(50, 30), place_of(31, 2), true);
  ASSERT_TRUE(wait("likeness.region.found && likeness.region.rect.width === 20"));
  EXPECT_EQ(evaluate("JSON.stringify(likeness.region.rect)"), R"("{\"x\":31,\"y\":2,\"width\":20,\"height\":29}")")
      << "both corners are in it";
  EXPECT_EQ(number("likeness.state.x"), 0.5) << "the picture was not moved";

  const Pair pair = pair_of("camera=c0&light=l2");
  std::vector<double> photo, render, stops;
  for (int y = 4; y < 31; ++y)  // above is masked
    for (int x = 31; x < 51; ++x) {
      const auto luminance = [](auto p) { return 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2]; };
      const float a = luminance(pair.photo.at(x, y)), b = luminance(pair.render.at(x, y));
      photo.push_back(static_cast<double>(a));
      render.push_back(static_cast<double>(b));
      stops.push_back(static_cast<double>(metric::stops(a, b, pair.noise)));
    }
  EXPECT_EQ(number("likeness.region.found.pixels"), 20 * 27);
  const auto near = [&](const std::string& kind, const std::vector<double>& values, double relative, double absolute) {
    const std::vector<double> want = statistics(values);
    for (std::size_t k = 0; k < want.size(); ++k)
      EXPECT_NEAR(number("likeness.region.found." + kind + "[" + std::to_string(k) + "]"), want[k],
                  relative * std::abs(want[k]) + absolute)
          << kind << " " << k;
  };
  near("photo", photo, 1e-3, 0);  // halves have 11 bits
  near("render", render, 1e-3, 0);
  near("stops", stops, 0, 2e-3);
  EXPECT_NEAR(number("likeness.region.found.stops[2]"), 0.5, 0.05) << "half a stop too dark";
  EXPECT_TRUE(says("region_table", "+0.5"));
  EXPECT_TRUE(says("live", "region 20 × 29 at 31, 2: mean photo")) << "what a screen reader says";
  EXPECT_EQ(evaluate("[...document.querySelectorAll('.region')].filter(e => !e.hidden).length"), "2")
      << "on both panes";
  const std::string found = evaluate("likeness.region.found.photo[0]");
  press("ArrowRight");
  EXPECT_TRUE(wait("likeness.complete && likeness.region.found.photo[0] !== " + found)) << "it follows the light";
  press("Escape");
  EXPECT_TRUE(
      wait("!likeness.region.rect && document.getElementById('region_panel').hidden && "
           "document.getElementById('region').hidden"));
  EXPECT_TRUE(says("live", "no region"));
}

TEST_F(PageTools, DragWithoutShiftToMoveThePicture) {
  make();
  open("zoom=8&ev=0");
  browser_->drag(place_of(30, 20), place_of(20, 20), false);
  EXPECT_TRUE(wait("likeness.state.x > 0.6"));
  EXPECT_EQ(evaluate("likeness.region.rect"), "null");
}

TEST_F(PageTools, MeasureARegionByKeysAlone) {
  make();
  open("camera=c0&light=l2&ev=0");
  press("Shift+r");
  ASSERT_TRUE(wait("document.activeElement.id === 'region' && likeness.region.found"));
  EXPECT_EQ(evaluate("JSON.stringify(likeness.region.rect)"), R"("{\"x\":24,\"y\":18,\"width\":16,\"height\":12}")")
      << "a quarter of the picture in its middle";
  press("ArrowRight");
  press("Ctrl+ArrowUp");
  press("Shift+ArrowRight");
  press("Shift+ArrowUp");
  EXPECT_EQ(evaluate("JSON.stringify(likeness.region.rect)"), R"("{\"x\":25,\"y\":8,\"width\":17,\"height\":11}")");
  EXPECT_EQ(evaluate("likeness.state.light"), "\"l2\"") << "the arrows are the region's now";
  for (int k = 0; k < 6; ++k) press("Ctrl+ArrowLeft");
  EXPECT_EQ(number("likeness.region.rect.x"), 0) << "no further than the picture";
  EXPECT_TRUE(says("live", "region 17 × 11 at 0, 8: mean photo"));
  evaluate(
      "window.copied = ''; navigator.clipboard.writeText = text => { window.copied = text; return Promise.resolve(); "
      "}");
  press("Shift+x");
  EXPECT_TRUE(
      wait("window.copied.startsWith('luminance\\tphoto\\trender\\tstops\\nmean\\t') && "
           "window.copied.includes('\\nregion\\t0\\t8\\t17\\t11\\npair\\tc0\\tl2\\t')"));
  press("Escape");
  EXPECT_TRUE(wait("!likeness.region.rect && document.activeElement.id === 'picture'"));
  press("Shift+x");
  EXPECT_TRUE(says("toast", "there is no region"));
}

TEST_F(PageTools, ShowEachCameraAsTheLargePictureIs) {
  make();
  open("camera=c0&light=l2&ev=0.5&view=agx");
  const auto drawn =
      "likeness.thumbs.all.length === 2 && likeness.thumbs.all.every(t => t.drawn === likeness.thumbs.look())";
  ASSERT_TRUE(wait(drawn));
  const auto compare = [&](const std::string& state) {
    for (int c = 0; c < 2; ++c) {
      const std::string text = "camera=c" + std::to_string(c) + "&light=l2&" + state;
      const image::DisplayPicture want = olat_pair::picture_of(olat_pair::state_of(text), pair_of(text));
      for (const int x : {12, 40, 60})
        for (std::size_t channel = 0; channel < 3; ++channel)
          EXPECT_NEAR(number("likeness.thumbs.all[" + std::to_string(c) + "].canvas.getContext('2d').getImageData(" +
                             std::to_string(x) + ",20,1,1).data[" + std::to_string(channel) + "]"),
                      want.at(x, 20)[channel], 1)
              << text << " at " << x;
    }
  };
  compare("ev=0.5&view=agx");
  press("e");
  ASSERT_TRUE(wait(drawn));
  compare("ev=1&view=agx");
  EXPECT_EQ(evaluate("document.querySelector('#thumbs [aria-pressed=true]').title"), "\"camera c0\"");
  press("ArrowDown");
  EXPECT_TRUE(wait("document.querySelector('#thumbs [aria-pressed=true]').title === 'camera c1'"));
  evaluate("document.querySelector('#thumbs button').focus()");
  press("Enter");
  EXPECT_TRUE(wait("likeness.state.camera === 'c0' && likeness.state.mode === 'photo'"))
      << "a button's Enter is its own";
}

TEST_F(PageTools, LeaveThumbnailsOutForOneCamera) {
  make({.cameras = 1});
  open();
  EXPECT_EQ(evaluate("document.getElementById('thumbs').hidden"), "true");
}

TEST_F(PageTools, ShowTheOtherPictureAsLongAsEnterIsHeld) {
  make();
  open("mode=photo&ev=0");
  const auto shows = [&](const std::string& mode) {
    return wait("likeness.state.mode === '" + mode +
                "' && likeness.complete && likeness.drawnState === likeness.text()");
  };
  browser_->key_down("Enter");
  EXPECT_TRUE(shows("render"));
  browser_->key_repeat("Enter");
  browser_->key_repeat("Enter");
  EXPECT_TRUE(shows("render")) << "a key that repeats does not flicker";
  browser_->key_up("Enter");
  EXPECT_TRUE(shows("photo"));
  press("w");
  browser_->key_down("Enter");
  EXPECT_TRUE(shows("photo")) << "instead of both";
  browser_->key_up("Enter");
  EXPECT_TRUE(shows("wipe"));
  browser_->key_down("Enter");
  evaluate("window.dispatchEvent(new Event('blur'))");
  EXPECT_TRUE(shows("wipe")) << "a window that loses the keyboard is not told of the key";
  browser_->key_up("Enter");
}

TEST_F(PageTools, SpreadLightsOfANarrowConeOverTheDisc) {
  capture::Capture& capture = make({.cameras = 1});
  for (std::size_t l = 0; l < capture.lights.size(); ++l) {
    const double tilt = 0.04 * static_cast<double>(l), angle = 1.3 * static_cast<double>(l);  // up to 9 degrees
    capture.lights[l].place =
        capture::DistantLight{{std::sin(tilt) * std::cos(angle), std::sin(tilt) * std::sin(angle), -std::cos(tilt)}};
  }
  open("ev=0");
  ASSERT_TRUE(wait("document.querySelectorAll('#sphere .dot').length === 5"));
  const auto radius = [&](int light) {
    const std::string dot = "document.getElementById('light" + std::to_string(light) + "')";
    return std::hypot(number("Number(" + dot + ".getAttribute('cx'))"),
                      number("Number(" + dot + ".getAttribute('cy'))"));
  };
  EXPECT_NEAR(radius(4), 0.92, 1e-3) << "the farthest is near the rim";
  for (int l = 0; l < 4; ++l)
    EXPECT_NEAR(radius(l), 0.92 * std::sin(0.02 * l) / std::sin(0.08), 1e-3) << "the others keep their share";
  const double scale = 0.92 / std::sin(0.08);
  EXPECT_THAT(evaluate("document.querySelector('#left .hint').textContent"), HasSubstr("drawn 11.5 × as far"));
  EXPECT_NEAR(scale, 11.5, 0.05);
  press("ArrowRight");
  EXPECT_TRUE(
      wait("document.querySelector('#sphere .current').id === 'light1' && document.querySelector('#sphere "
           "[aria-selected=true]').id === 'light1'"));
  press("End");
  EXPECT_TRUE(wait("document.querySelector('#sphere .current').id === 'light4'"));
  EXPECT_EQ(evaluate("document.getElementById('sphere').getAttribute('aria-activedescendant')"), "\"light4\"");
}

TEST_F(PageTools, ShowSmallPicturesAndFlipInAReport) {
  make({.gain = 1.0 / 64});
  const std::filesystem::path file = folder_.path() / "report.html";
  write_report(capture_, ReportOptions{.pairs = 2}, file);
  browser_->open("file://" + file.string());
  ASSERT_TRUE(wait("document.body.dataset.ready && likeness.complete")) << evaluate("document.body.innerText");
  EXPECT_EQ(evaluate("[...document.querySelectorAll('.pair')].map(p => [...p.querySelectorAll('img')].filter(i => "
                     "i.src.startsWith('data:image/png') && i.naturalWidth === 64 && i.alt).length)"),
            "[4,4]");
  EXPECT_THAT(evaluate("document.querySelector('.intro').textContent"),
              HasSubstr("nearest to the photographs at +0.0"));
  const double want = percentile_of("light=l2");
  EXPECT_EQ(number("likeness.state.ev"), want) << "of the worst photo";
  EXPECT_TRUE(says("hud", "(auto)"));

  for (const std::string& metric : {std::string("flip"), std::string("hdr_flip")}) {
    evaluate("likeness.change({mode: 'difference', metric: '" + metric + "', light: 'l2', camera: 'c0'})");
    ASSERT_TRUE(
        wait("likeness.complete && likeness.stage.shownEntries.flip?.data && likeness.drawnState === likeness.text()"))
        << metric;
    State state = olat_pair::state_of("camera=c0&light=l2&metric=" + metric);
    state.ev = want;
    const std::vector<float> map = olat_pair::flip_map(state, pair_of("camera=c0&light=l2"));
    const double is = number(
        "(() => { const e = likeness.stage.shownEntries.flip, h = e.data[4 * (20 * e.width + 40)]; return (1 + (h & "
        "1023) / 1024) * 2 ** ((h >> 10) - 15); })()");
    EXPECT_NEAR(is, static_cast<double>(map[20 * 64 + 40]), 1e-3) << metric;
  }
  evaluate("likeness.change({metric: 'flip'})");
  ASSERT_TRUE(wait("likeness.complete && likeness.stage.shownEntries.flip?.data"));
  press("e");
  EXPECT_TRUE(says("toast", "this report holds flip without match gain only, at EV ")) << "no map of another exposure";
  evaluate("document.querySelectorAll('.pair')[1].click()");
  EXPECT_TRUE(wait("likeness.text().includes(document.querySelectorAll('.pair')[1].hash.slice(1))"))
      << "a card goes to its pair";
  EXPECT_EQ(evaluate("performance.getEntriesByType('resource').filter(r => !r.name.startsWith('data:') && "
                     "!r.name.startsWith('blob:')).length"),
            "0")
      << "nothing is asked for";
}

TEST_F(PageTools, OpenAReportAtItsWorstPair) {
  make();
  std::filesystem::copy_file(folder_.path() / "photos/c0/l2.exr", folder_.path() / "renders/truth/c0/l2.exr",
                             std::filesystem::copy_options::overwrite_existing);
  const std::filesystem::path file = folder_.path() / "report.html";
  write_report(capture_, ReportOptions{.pairs = 1}, file);
  browser_->open("file://" + file.string());
  ASSERT_TRUE(wait("document.body.dataset.ready && likeness.complete")) << evaluate("document.body.innerText");
  EXPECT_EQ(evaluate("likeness.state.camera + likeness.state.light"), "\"c1l2\"") << "of the first camera it has none";
  EXPECT_EQ(evaluate("document.querySelector('#tag_left i').textContent"), "\"\"") << "and it is there";
  EXPECT_EQ(evaluate("likeness.thumbs.all.length"), "1") << "no thumbnail of a camera that it has not";
}

}  // namespace
}  // namespace likeness::olat_view
