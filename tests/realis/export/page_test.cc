#include <cmath>
#include <filesystem>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "realis/export/export.h"
#include "render/files/files.h"
#include "tests/olat/view/browser.h"
#include "tests/realis/export/smooth_pictures.h"

namespace likeness::realis {
namespace {

using Json = nlohmann::json;
using likeness::test::Browser;
using likeness::test::TemporaryFolder;

// What the page has drawn, as bytes, top row first.
std::vector<int> drawn(Browser& browser) {
  const std::string text = browser.evaluate(
      "(() => { draw(); const p = new Uint8Array(4 * info.width * info.height), out = [];"
      "gl.readPixels(0, 0, info.width, info.height, gl.RGBA, gl.UNSIGNED_BYTE, p);"
      "for (let y = info.height - 1; y >= 0; --y) for (let x = 0; x < info.width; ++x) for (let c = 0; c < 3; ++c)"
      "out.push(p[4 * (y * info.width + x) + c]); return out; })()");
  return Json::parse(text).get<std::vector<int>>();
}

// From a file, in a browser, without a network: what the program says the planes show. A byte is off by one where a half is
// rounded otherwise, and by one more since the shader's floats are of 24 bits and JPEG may be decoded otherwise by one.
TEST(RelightPage, DrawsWhatThePlanesSay) {
  if (Browser::program().empty()) GTEST_SKIP() << "no Chromium";
  const TemporaryFolder folder;
  Browser browser(900, 700);
  for (const Format format : {Format::kPtm, Format::kHsh, Format::kBilinear, Format::kRbf}) {
    const Planes planes = fit_planes(format, test::smooth_pictures(format, 100), 95, test::goes_on);
    const PageFacts facts{"</script><b>&", {{0, 0, 1}, {0.6, 0, 0.8}}, 30, {}};
    files::write_whole(folder / "page.html", page_of(planes, facts));
    browser.open("file://" + (folder / "page.html").string() + "#0.5,-0.25");
    ASSERT_TRUE(browser.wait("document.body.dataset.ready === 'yes'")) << browser.evaluate("document.body.innerText");
    const Viewer viewer(planes);
    for (const auto& [x, y] : {std::pair{0.5, -0.25}, std::pair{-0.3, 0.8}}) {
      browser.evaluate("move(" + std::to_string(x) + ", " + std::to_string(y) + ")");
      const image::Picture want = viewer.picture({x, y, std::sqrt(1 - x * x - y * y)});
      const std::vector<int> got = drawn(browser);
      ASSERT_EQ(got.size(), want.rgb.size());
      for (std::size_t i = 0; i < got.size(); ++i)
        ASSERT_NEAR(got[i], 255 * static_cast<double>(want.rgb[i]), 2.5) << row_of(format).name << " " << i;
    }
  }
  EXPECT_EQ(browser.faults(), "");
  EXPECT_EQ(browser.evaluate("document.querySelector('h1').textContent"), "\"</script><b>&: move the light\"");
}

TEST(RelightPage, FollowsTheMouseTheKeysAndThePhone) {
  if (Browser::program().empty()) GTEST_SKIP() << "no Chromium";
  const TemporaryFolder folder;
  Browser browser(900, 700);
  const Planes planes = fit_planes(Format::kPtm, test::smooth_pictures(Format::kPtm, 30), 95, test::goes_on);
  files::write_whole(folder / "page.html", page_of(planes, {"subject", {{0, 0, 1}}, 30, 31}));
  browser.open("file://" + (folder / "page.html").string());
  ASSERT_TRUE(browser.wait("document.body.dataset.ready === 'yes'"));
  const Json box = Json::parse(browser.evaluate(
      "(() => { const b = canvas.getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()"));
  const double left = box[0], top = box[1], width = box[2], height = box[3];
  browser.click(left + width / 2 + height / 4, top + height / 2);
  EXPECT_NEAR(std::stod(browser.evaluate("light[0] + 0")), 0.5, 0.02) << "half way to the edge, to the right";
  EXPECT_NEAR(std::stod(browser.evaluate("light[1] + 0")), 0, 0.02);
  browser.click(left + width / 2, top + 2);
  EXPECT_GT(std::stod(browser.evaluate("light[1] + 0")), 0.9) << "upwards";
  EXPECT_NE(browser.evaluate("said.textContent").find("From the top,"), std::string::npos);
  browser.evaluate("pad.focus()");
  browser.press("Home");
  EXPECT_EQ(browser.evaluate("light[2] + 0"), "1");
  browser.press("ArrowLeft");
  EXPECT_NEAR(std::stod(browser.evaluate("light[0] + 0")), -0.05, 1e-9);
  browser.evaluate("move(7, 0)");
  EXPECT_EQ(browser.evaluate("light[0] + 0"), "1") << "not beyond the rim";
  for (const int wide : {320, 400, 1400}) {
    browser.resize(wide, 700);
    EXPECT_LE(std::stod(browser.evaluate("document.documentElement.scrollWidth")), wide) << "scrolls sideways";
  }
  EXPECT_EQ(browser.faults(), "");
}

}  // namespace
}  // namespace likeness::realis
