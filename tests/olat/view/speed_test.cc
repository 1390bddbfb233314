#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "render/capture/files_of_capture.h"
#include "tests/olat/small_capture.h"
#include "tests/olat/view/browser.h"
#include "tests/olat/view/served.h"
#include "tests/render/temporary_folder.h"

// How long a user waits: from a real key press to the drawn frame, with software GL. The numbers of a quiet machine stand
// in docs/olat_view.md; here they are printed, and what is tested does not depend on what else the machine does: that a
// switch between pictures which were seen waits for nothing, and that nobody waits for seconds.
namespace likeness::olat_view {
namespace {

using test::Browser;
constexpr double kPatience = 20;  // times the bar

// From now on the page notes, for each key press, the milliseconds until the complete frame is drawn: rendered, not only
// asked for, since a pixel of it is read back. parts() says where the last of them went.
constexpr const char* kStopwatch = R"js(
  window.times = []; window.pressed = 0; window.waited = 0; window.notes = [];
  performance.setResourceTimingBufferSize(10000);
  const note = (name, began) => window.notes.push([name, began, performance.now()]);
  const draw = likeness.draw.bind(likeness), painter = likeness.painter, gl = painter.gl, texture = painter.texture.bind(painter);
  painter.texture = (width, height, data) => {
    const began = performance.now(), made = texture(width, height, data);
    note(`texture of ${width} x ${height}`, began);
    return made;
  };
  likeness.draw = () => {
    const began = performance.now();
    draw();
    if (!likeness.complete) ++window.waited;
    if (!likeness.complete || !window.pressed) return note('frame without its pictures', began);
    note('frame: words', began);
    const read = performance.now();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    note('frame: drawn', read);
    window.times.push(performance.now() - window.pressed);
    window.last = window.pressed;
    window.pressed = 0;
  };
  document.addEventListener('keydown', e => { window.pressed = e.timeStamp; window.notes = []; note('key heard', e.timeStamp); }, true);
  window.parts = () => {
    const fetched = performance.getEntriesByType('resource').filter(e => e.startTime >= window.last && e.name.includes('pixels'))
      .flatMap(e => { const what = /kind=(\w+)/.exec(e.name)[1]; return [[`${what} made`, e.startTime, e.responseStart], [`${what} sent`, e.responseStart, e.responseEnd]]; });
    return [...fetched, ...window.notes].sort((a, b) => a[1] - b[1])
      .map(([name, from, to]) => `${name} ${Math.round(from - window.last)}..${Math.round(to - window.last)}`).join(', ');
  })js";

std::vector<double> times_of(Browser& browser) {
  std::string text = browser.evaluate("window.times.splice(0).join(' ')");
  std::istringstream in(text.substr(1, text.size() - 2));
  std::vector<double> out;
  for (double t; in >> t;) out.push_back(t);
  std::sort(out.begin(), out.end());
  return out;
}
double quantile(const std::vector<double>& sorted, double share) {
  return sorted.empty() ? 1e9 : sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
}

// The pair of a light that nobody asked for before, side by side so that both pictures are needed, and of lights that were
// seen; then the other of two pictures.
struct Measured {
  double cold = 0;
  std::vector<double> warm, flip;
};
Measured measure(test::Served& served, Browser& browser, const std::string& mode, const std::string& first,
                 int presses) {
  Measured out;
  browser.open(served.address("light=l0&mode=" + mode));
  EXPECT_TRUE(browser.wait("document.body.dataset.ready && likeness.complete && !likeness.pictures.running", 30));
  browser.evaluate(kStopwatch);
  // From now on nothing is fetched ahead.
  browser.evaluate("likeness.pictures.prefetch = () => {}; likeness.pictures.queue = []");
  EXPECT_TRUE(browser.wait("!likeness.pictures.running", 20));
  browser.evaluate("likeness.change({light:'" + first + "'})");
  EXPECT_TRUE(browser.wait("likeness.complete && likeness.drawnState.includes('light=" + first + "')", 20));
  times_of(browser);
  browser.press("ArrowRight");
  EXPECT_TRUE(browser.wait("window.times.length", 20));
  out.cold = times_of(browser).at(0);
  std::printf("  cold %.0f ms: %s\n", out.cold, browser.evaluate("window.parts()").c_str());

  for (int i = 0; i < 4; ++i) {
    browser.press(i % 2 == 0 ? "ArrowLeft" : "ArrowRight");
    EXPECT_TRUE(browser.wait("likeness.complete && window.times.length === " + std::to_string(i + 1), 20));
  }
  times_of(browser);
  browser.evaluate("window.waited = 0");
  for (int i = 0; i < presses; ++i) {
    browser.press(i % 2 == 0 ? "ArrowLeft" : "ArrowRight");
    EXPECT_TRUE(browser.wait("window.times.length === " + std::to_string(i + 1), 20));
  }
  std::printf("  the last warm one: %s\n", browser.evaluate("window.parts()").c_str());
  out.warm = times_of(browser);
  EXPECT_EQ(browser.evaluate("window.waited"), "0") << "frames that were drawn without their pictures";
  for (int i = 0; i < presses / 2; ++i) {
    browser.press("Space");
    EXPECT_TRUE(browser.wait("window.times.length === " + std::to_string(i + 1), 20));
  }
  out.flip = times_of(browser);
  EXPECT_LE(quantile(out.warm, 0.95), kPatience * 100);
  EXPECT_LE(quantile(out.flip, 0.95), kPatience * 100);
  EXPECT_LE(out.cold, kPatience * 500);
  return out;
}

TEST(Speed, OfALightSwitchIsThatOfAnEye) {
  if (Browser::program().empty()) GTEST_SKIP() << "no Chromium: ./bootstrap test installs it";
  const test::TemporaryFolder folder;
  test::SmallCapture want;
  want.cameras = 1;
  want.lights = 12;
  want.width = 2048;
  want.height = 1080;
  want.with_mask = false;
  want.is_repeated = true;
  test::Served served(test::write_small_capture(folder.path(), want), {.with_scores = false});
  for (const char* kind : {"photo", "render"}) {
    const auto began = std::chrono::steady_clock::now();
    served.answers().answer("/api/pixels", {{"kind", kind}, {"state", "light=l11"}, {"level", "1"}});
    std::printf("  the server makes a %s in %.0f ms\n", kind,
                1000 * std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
  }
  Browser browser(1280, 720);
  for (const auto& [mode, first] : {std::pair{"side", "l4"}, {"photo", "l8"}}) {
    const Measured found = measure(served, browser, mode, first, 30);
    std::printf(
        "2048 x 1080, window 1280 x 720, %s: cold %.0f ms; warm light p50 %.0f p95 %.0f ms; flip p50 %.0f p95 %.0f "
        "ms\n",
        mode, found.cold, quantile(found.warm, 0.5), quantile(found.warm, 0.95), quantile(found.flip, 0.5),
        quantile(found.flip, 0.95));
  }
  EXPECT_EQ(browser.faults(), "");
}

// The four files of a capture of 40 cameras and 331 lights, whose pictures do not exist: nothing may open one.
TEST(Speed, OfOpeningALargeCaptureDoesNotDependOnItsPictures) {
  const test::TemporaryFolder folder;
  capture::Capture capture;
  capture.root = folder.path();
  capture.name = "large";
  for (int c = 0; c < 40; ++c) {
    capture::Camera camera;
    camera.id = "c" + std::to_string(c);
    camera.width = camera.height = 2048;
    camera.intrinsics = {2000, 0, 0, 0, 2000, 0, 1024, 1024, 1};
    capture.cameras.push_back(camera);
  }
  for (int l = 0; l < 331; ++l) {
    capture::Light light;
    light.id = "l" + std::to_string(l);
    light.place = capture::DistantLight{{0, 0, 1}};
    capture.lights.push_back(light);
  }
  for (std::size_t c = 0; c < 40; ++c)
    for (std::size_t l = 0; l < 331; ++l) {
      capture::Frame frame;
      frame.camera = c;
      frame.light = l;
      frame.file = "photos/c" + std::to_string(c) + "/l" + std::to_string(l) + ".exr";
      capture.frames.push_back(frame);
    }
  capture.variants.push_back({"v", "renders/v/{camera}/{light}.exr"});
  capture::write_capture(capture);

  const auto began = std::chrono::steady_clock::now();
  test::Served served(capture::read_capture(folder.path()));
  const Answer answer = served.answers().answer("/api/capture", {});
  const double opened = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  EXPECT_EQ(answer.status, 200);
  EXPECT_LE(opened, 2);
  double page = -1;
  if (!Browser::program().empty()) {
    Browser browser(1280, 720);
    browser.open(served.address());
    ASSERT_TRUE(browser.wait("document.body.dataset.ready", 20));
    page = std::stod(browser.evaluate("performance.now()")) / 1000;
    EXPECT_EQ(browser.evaluate("document.querySelectorAll('#sphere .dot').length || (likeness.showMaps(), "
                               "document.querySelectorAll('#sphere .dot').length)"),
              "331");
    EXPECT_LE(page, kPatience * 2);
  }
  std::printf("40 cameras x 331 lights: read and answered in %.2f s, page ready after %.2f s\n", opened, page);
}

}  // namespace
}  // namespace likeness::olat_view
