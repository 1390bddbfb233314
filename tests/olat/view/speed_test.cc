#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>
#include <gtest/gtest.h>
#include <half.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
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

struct Storage {
  const char* name;
  Imf::Compression compression;
  Imf::PixelType type;
};
constexpr int kWidth = 2048, kHeight = 1080;
constexpr const char* kChannels[] = {"R", "G", "B"};

void write(const std::filesystem::path& file, const image::Picture& picture, const Storage& storage) {
  Imf::Header header(picture.width, picture.height);
  header.compression() = storage.compression;
  for (const char* name : kChannels) header.channels().insert(name, Imf::Channel(storage.type));
  const std::vector<Imath::half> halves(picture.rgb.begin(), picture.rgb.end());
  const bool is_half = storage.type == Imf::HALF;
  const std::size_t size = is_half ? 2 : 4;
  const char* const from =
      is_half ? reinterpret_cast<const char*>(halves.data()) : reinterpret_cast<const char*>(picture.rgb.data());
  Imf::FrameBuffer pixels;
  for (std::size_t c = 0; c < 3; ++c)
    pixels.insert(kChannels[c], Imf::Slice(storage.type, const_cast<char*>(from) + c * size, 3 * size,
                                           3 * size * static_cast<std::size_t>(picture.width)));
  Imf::OutputFile out(file.c_str(), header, 2);
  out.setFrameBuffer(pixels);
  out.writePixels(picture.height);
}

// The yardstick: both files of a pair by OpenEXR alone with two threads, in its own layout [s].
double decoded_by_openexr(const std::filesystem::path& root, Imf::PixelType type) {
  if (Imf::globalThreadCount() < 2) Imf::setGlobalThreadCount(2);
  std::vector<float> planes(std::size_t{3} * kWidth * kHeight);
  const auto began = std::chrono::steady_clock::now();
  for (const char* file : {"photos/c0/l0.exr", "renders/truth/c0/l0.exr"}) {
    Imf::InputFile in((root / file).c_str(), 2);
    Imf::FrameBuffer pixels;
    const std::size_t size = type == Imf::HALF ? 2 : 4;
    for (std::size_t c = 0; c < 3; ++c)
      pixels.insert(kChannels[c], Imf::Slice(type, reinterpret_cast<char*>(planes.data() + c * kWidth * kHeight), size,
                                             size * kWidth));
    in.setFrameBuffer(pixels);
    in.readPixels(0, kHeight - 1);
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

class Switches {
 public:
  Switches(const std::filesystem::path& folder, const Storage& storage) : storage_(storage), folder_(folder) {
    test::SmallCapture want;
    want.cameras = 1;
    want.lights = 13;
    want.width = kWidth;
    want.height = kHeight;
    want.with_mask = false;
    want.is_repeated = true;
    const capture::Capture capture = test::write_small_capture(folder, want);
    for (const char* kind : {"photos", "renders/truth"}) {
      write(folder / kind / "c0/l0.exr", test::bump(kWidth, kHeight, 0, 1), storage);
      for (int l = 1; l < want.lights; ++l)
        std::filesystem::copy_file(folder / kind / "c0/l0.exr", folder / kind / ("c0/l" + std::to_string(l) + ".exr"),
                                   std::filesystem::copy_options::overwrite_existing);
    }
    served_ = std::make_unique<test::Served>(capture, ViewOptions{.with_scores = false});
  }

  // Pairs that nobody asked for before: `presses` lights from `first` on, with nothing fetched ahead.
  std::vector<double> cold(Browser& browser, const std::string& mode, int first, int presses) {
    browser.open(served_->address("light=l0&mode=" + mode));
    EXPECT_TRUE(browser.wait("document.body.dataset.ready && likeness.complete && !likeness.pictures.running", 30));
    browser.evaluate(kStopwatch);
    browser.evaluate("likeness.pictures.prefetch = () => {}; likeness.pictures.queue = []");
    EXPECT_TRUE(browser.wait("!likeness.pictures.running", 20));
    const std::string start = "l" + std::to_string(first);
    browser.evaluate("likeness.change({light:'" + start + "'})");
    EXPECT_TRUE(browser.wait("likeness.complete && likeness.drawnState.includes('light=" + start + "')", 20));
    times_of(browser);
    for (int i = 0; i < presses; ++i) {
      browser.evaluate("new Promise(done => setTimeout(done, 200))");  // what follows a frame is over
      browser.press("ArrowRight");
      EXPECT_TRUE(browser.wait("window.times.length === " + std::to_string(i + 1), 20));
    }
    std::printf("  %s, %s, the last cold one: %s\n", storage_.name, mode.c_str(),
                browser.evaluate("window.parts()").c_str());
    const std::vector<double> times = times_of(browser);
    std::printf("  %s, %s: cold p50 %.0f, longest %.0f ms; both files by OpenEXR alone, 2 threads: %.0f ms\n",
                storage_.name, mode.c_str(), quantile(times, 0.5), times.back(),
                1000 * decoded_by_openexr(folder_, storage_.type));
    EXPECT_LE(quantile(times, 0.5), kPatience * 500);
    return times;
  }

  // Back and forth between two lights, and then flips, after cold().
  void warm(Browser& browser, const std::string& mode, int presses) {
    for (const bool is_flip : {false, true}) {
      for (int i = 0; i < presses + 2; ++i) {
        if (i == 2) {  // programs of both pictures are compiled
          times_of(browser);
          browser.evaluate("window.waited = 0");
        }
        browser.press(is_flip ? "Space" : i % 2 == 0 ? "ArrowLeft" : "ArrowRight");
        EXPECT_TRUE(browser.wait("window.times.length === " + std::to_string(i < 2 ? i + 1 : i - 1), 20));
      }
      EXPECT_EQ(browser.evaluate("window.waited"), "0") << "frames that were drawn without their pictures";
      const std::vector<double> times = times_of(browser);
      std::printf("  %s, %s: %s p50 %.0f p95 %.0f ms\n", storage_.name, mode.c_str(), is_flip ? "flip" : "warm light",
                  quantile(times, 0.5), quantile(times, 0.95));
      EXPECT_LE(quantile(times, 0.95), kPatience * 100);
    }
  }

 private:
  Storage storage_;
  std::filesystem::path folder_;
  std::unique_ptr<test::Served> served_;
};

TEST(Speed, OfALightSwitchIsThatOfAnEye) {
  if (Browser::program().empty()) GTEST_SKIP() << "no Chromium: ./bootstrap test installs it";
  std::printf("a pair of 2048 x 1080, window 1280 x 720\n");
  for (const Storage& storage :
       {Storage{"float ZIP", Imf::ZIP_COMPRESSION, Imf::FLOAT}, Storage{"half ZIP", Imf::ZIP_COMPRESSION, Imf::HALF},
        Storage{"half PIZ", Imf::PIZ_COMPRESSION, Imf::HALF}}) {
    const test::TemporaryFolder folder;
    Switches switches(folder.path(), storage);
    Browser browser(1280, 720);
    switches.cold(browser, "side", 3, 3);
    if (storage.type == Imf::FLOAT) {
      switches.cold(browser, "photo", 9, 2);
      switches.warm(browser, "photo", 24);
    }
    EXPECT_EQ(browser.faults(), "");
  }
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
