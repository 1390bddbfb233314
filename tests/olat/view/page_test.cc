#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "olat/pair/actions.h"
#include "olat/pair/exposure.h"
#include "olat/pair/picture.h"
#include "olat/pair/state.h"
#include "olat/view/report.h"
#include "render/capture/files_of_capture.h"
#include "tests/olat/small_capture.h"
#include "tests/olat/view/browser.h"
#include "tests/olat/view/served.h"
#include "tests/render/temporary_folder.h"

// The real page in a real browser, one browser for all cases.
namespace likeness::olat_view {
namespace {

using olat_pair::Pair;
using test::Browser;
using testing::HasSubstr;

class Page : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (Browser::program().empty()) return;
    folder_ = std::make_unique<test::TemporaryFolder>();
    served_ = std::make_unique<test::Served>(test::write_small_capture(folder_->path()));
    browser_ = std::make_unique<Browser>(1280, 720);
  }
  static void TearDownTestSuite() {
    browser_.reset();
    served_.reset();
    folder_.reset();
  }
  void SetUp() override {
    if (!browser_) GTEST_SKIP() << "no Chromium: ./bootstrap test installs it";
  }
  void TearDown() override {
    if (!browser_) return;
    EXPECT_EQ(browser_->faults(), "");
  }

  void open(const std::string& state = "") {
    browser_->open(served_->address(state));
    ASSERT_TRUE(browser_->wait("document.body.dataset.ready && likeness.complete"))
        << browser_->evaluate("document.body.innerText");
  }
  bool wait(const std::string& expression) { return browser_->wait(expression); }
  std::string evaluate(const std::string& expression) { return browser_->evaluate(expression); }
  std::string state(const std::string& name) { return evaluate("String(likeness.state." + name + ")"); }
  void press(const std::string& key) { browser_->press(key); }

  static std::unique_ptr<test::TemporaryFolder> folder_;
  static std::unique_ptr<test::Served> served_;
  static std::unique_ptr<Browser> browser_;
};
std::unique_ptr<test::TemporaryFolder> Page::folder_;
std::unique_ptr<test::Served> Page::served_;
std::unique_ptr<Browser> Page::browser_;

TEST_F(Page, FlipsBetweenPhotoAndRenderWithTheSpaceBar) {
  open();
  EXPECT_EQ(evaluate("document.querySelector('#tag_left b').textContent"), "\"PHOTO\"");
  press("Space");
  EXPECT_TRUE(wait("likeness.complete && document.querySelector('#tag_left b').textContent === 'RENDER'"));
  press("t");
  EXPECT_TRUE(wait("document.querySelector('#tag_left b').textContent === 'PHOTO'"));
}

TEST_F(Page, WalksThroughLightsAndCamerasWithTheArrows) {
  open("camera=c0&light=l0");
  press("ArrowRight");
  EXPECT_EQ(state("light"), "\"l1\"");
  press("Shift+ArrowRight");
  EXPECT_EQ(state("light"), "\"l4\"") << "no further than the last";
  press("ArrowDown");
  EXPECT_EQ(state("camera"), "\"c1\"");
  press("Home");
  EXPECT_EQ(state("light"), "\"l0\"");
  EXPECT_TRUE(wait("likeness.complete"));
  EXPECT_THAT(evaluate("document.getElementById('live').textContent"), HasSubstr("camera c1, light l0, photo"))
      << "what a screen reader says";
  EXPECT_TRUE(wait("location.search.includes('camera=c1') && location.search.includes('light=l0')"));
}

// Each key of the table is pressed on the page, and each has an effect: on the state, or on what the page shows.
TEST_F(Page, HasAFunctionAndAnEffectForEachActionOfTheTable) {
  open();
  EXPECT_EQ(evaluate("JSON.stringify(Object.keys(likeness.actions).sort())"),
            evaluate("fetch('/api/tables',{headers:{'X-Likeness-Token':location.hash.slice(1)}}).then(r=>r.json())"
                     ".then(t=>JSON.stringify(t.actions.map(a=>a.id).sort()))"));
  // Whose effect is seen elsewhere than in the state.
  const std::set<std::string_view> elsewhere{"variant_next", "worst",     "auto_flip", "pin",   "bookmark_store",
                                             "copy_command", "save_view", "panels",    "hold",  "region",
                                             "region_copy",  "help",      "palette",   "close", "bookmark_recall"};
  for (const olat_pair::Action& action : olat_pair::kActions) {
    if (elsewhere.contains(action.id)) continue;
    for (std::string_view rest = action.keys; !rest.empty();) {
      const std::string key(rest.substr(0, rest.find(' ')));
      rest.remove_prefix(std::min(rest.size(), key.size() + 1));
      // From here every action has somewhere to go.
      evaluate(
          "likeness.change({camera:'c0',light:'l2',mode:'wipe',ev:3,channel:'luma',overlay:'none',zoom:3,metric:'"
          "signed',"
          "view:'khronos',zebra:false,wedge:false,split:0.5})");
      if (action.id == "color") evaluate("likeness.change({channel:'red'})");
      if (action.id == "camera_previous") evaluate("likeness.change({camera:'c1'})");
      if (action.id == "luma") evaluate("likeness.change({channel:'color'})");
      ASSERT_TRUE(wait("likeness.complete")) << action.id;
      const std::string before = evaluate("JSON.stringify(likeness.state)");
      press(key);
      // Exposures are the program's: their keys ask for them.
      EXPECT_TRUE(wait("JSON.stringify(likeness.state) !== " + before)) << action.id << " by " << key;
    }
  }
}

// Without a frame between the two, as when keys come fast.
TEST_F(Page, ZoomsFromTheStateAndNotFromTheLastFrame) {
  open("zoom=3.75");
  EXPECT_EQ(evaluate("likeness.change({zoom:3}); likeness.actions.zoom_out(); String(likeness.state.zoom)"), "\"2.4\"");
  EXPECT_EQ(evaluate("likeness.actions.zoom_in(); likeness.actions.zoom_in(); String(likeness.state.zoom)"),
            "\"3.75\"");
}

TEST_F(Page, ChangesExposureInTheDirectionThatTheTableSays) {
  open("ev=1");
  press("e");
  EXPECT_EQ(state("ev"), "\"1.5\"");
  press("Shift+e");
  press("Shift+e");
  EXPECT_EQ(state("ev"), "\"0.5\"");
  press("]");
  press("}");
  EXPECT_EQ(state("ev"), "\"1.75\"");
  press("0");
  EXPECT_EQ(state("ev"), "\"0\"");
  const capture::Capture capture = capture::read_capture(folder_->path());
  const Pair pair = olat_pair::load_pair(capture, {});
  const auto found = olat_pair::exposures_of(pair.photo, pair.flaws, static_cast<double>(pair.noise));
  ASSERT_TRUE(found && found->average != found->percentile);
  press("n");
  EXPECT_TRUE(wait("likeness.state.ev === " + std::to_string(found->average))) << "the log average on middle grey";
  EXPECT_TRUE(wait("document.getElementById('hud').textContent.includes('(auto, log average)')"));
  press("Shift+n");
  EXPECT_TRUE(wait("likeness.state.ev === " + std::to_string(found->percentile))) << "the 99th percentile on white";
  EXPECT_TRUE(wait("document.getElementById('hud').textContent.includes('(auto)')"));
  press("e");
  EXPECT_TRUE(wait("!document.getElementById('hud').textContent.includes('auto')")) << "chosen by hand now";
  EXPECT_EQ(evaluate("(async () => { const asked = likeness.expose('average'); likeness.change({ev: 7}); await asked;"
                     " return likeness.state.ev; })()"),
            "7")
      << "who chooses while the program looks has the last word";
}

TEST_F(Page, ShowsTheSameHashOnBothPanesAndAsTheProgram) {
  open("mode=side&view=agx&ev=0.25&match=light");
  const std::string hash =
      olat_pair::hash_of(olat_pair::pipeline_of(olat_pair::state_of("view=agx&ev=0.25&match=light")));
  for (const char* tag : {"tag_left", "tag_right"})
    EXPECT_EQ(evaluate("document.querySelector('#" + std::string(tag) + " code').textContent"), "\"" + hash + "\"");
  EXPECT_EQ(evaluate("document.getElementById('alarm').hidden"), "true");
}

TEST_F(Page, OpensHelpAndPaletteAndClosesThem) {
  open("ev=0");
  press("?");
  EXPECT_TRUE(wait("document.getElementById('dialog').open"));
  for (const olat_pair::Action& action : olat_pair::kActions)
    EXPECT_THAT(evaluate("document.getElementById('dialog').textContent"), HasSubstr(std::string(action.text)));
  press("Escape");
  EXPECT_TRUE(wait("!document.getElementById('dialog').open"));
  press("Ctrl+Shift+p");
  EXPECT_TRUE(wait("document.querySelector('#dialog input')"));
  for (const char* key : {"w", "e", "d", "g", "e"}) press(key);
  press("Enter");
  EXPECT_EQ(state("wedge"), "\"true\"") << "found by its name";
  EXPECT_TRUE(wait("document.querySelectorAll('#wedge span').length === 17"));
  EXPECT_THAT(evaluate("document.querySelectorAll('#wedge span')[5].textContent"), HasSubstr("V0117"))
      << "zone, EV, code"
      << "zone V through gt";
}

TEST_F(Page, TakesAnotherKeyUnlessItIsTaken) {
  open();
  const auto change = [&](const std::string& id, const std::string& key) {
    press("?");
    evaluate("[...document.querySelectorAll('#dialog tr')].find(r=>r.textContent.includes(" + id +
             ")).querySelector('button').click()");
    press(key);
    const std::string note = evaluate("document.querySelector('#dialog .note').textContent");
    evaluate("document.getElementById('dialog').close()");
    return note;
  };
  EXPECT_THAT(change("'Wipe'", "s"), HasSubstr("S is taken: Side by side"));
  EXPECT_THAT(change("'Wipe'", "Shift+w"), HasSubstr("Wipe: Shift W"));
  press("Shift+w");
  EXPECT_EQ(state("mode"), "\"wipe\"");
  evaluate("likeness.keys.reset()");
}

TEST_F(Page, SaysWhenThereIsNoRender) {
  open("camera=c1&light=l4&mode=render");
  EXPECT_TRUE(wait("document.querySelector('#tag_left i').textContent === 'no render'"));
}

TEST_F(Page, ProbesTheSameLightAsTheFilesHold) {
  open("camera=c0&light=l2&zoom=4");
  const std::string x = evaluate(
      "likeness.stage.window.origin[0] + 4*40 + document.getElementById('picture').getBoundingClientRect().left + 2");
  const std::string y = evaluate(
      "likeness.stage.window.origin[1] + 4*20 + document.getElementById('picture').getBoundingClientRect().top + 2");
  browser_->click(std::stod(x), std::stod(y));
  press("p");
  const image::Picture photo = test::bump(64, 48, 2, 1);
  EXPECT_NEAR(std::stod(evaluate("likeness.stage.values().photo[0]")), photo.at(40, 20)[0], 1e-3 * photo.at(40, 20)[0]);
  EXPECT_TRUE(wait("document.getElementById('probe').textContent.includes('40, 20')"));
  EXPECT_TRUE(wait("document.getElementById('probe').textContent.includes('log₂ ratio')"));
}

TEST_F(Page, ColorsLightsAndMatrixByTheirErrorAndGoesToTheWorst) {
  open("camera=c0&light=l0");
  ASSERT_TRUE(wait("likeness.scores && likeness.scores.known === likeness.scores.all"));
  EXPECT_TRUE(wait("document.querySelectorAll('#sphere .dot').length === 5"));
  EXPECT_EQ(evaluate("likeness.scores.rows[1][4]"), "null") << "there is no render of it";
  press("h");
  EXPECT_EQ(state("light"), "\"l2\"") << "half a stop too dark";
  EXPECT_TRUE(wait("document.querySelector('#sphere [aria-selected=true]').id === 'light2'"));
  evaluate("document.getElementById('light3').dispatchEvent(new MouseEvent('click',{bubbles:true}))");
  EXPECT_EQ(state("light"), "\"l3\"");
}

TEST_F(Page, KeepsBookmarksAndComesBackToThem) {
  open("light=l3&mode=difference&metric=smape&ev=1.25");
  press("Ctrl+4");
  open("light=l0");
  press("4");
  EXPECT_EQ(state("light"), "\"l3\"");
  EXPECT_EQ(state("metric"), "\"smape\"");
  press("5");
  EXPECT_THAT(evaluate("document.getElementById('toast').textContent"), HasSubstr("bookmark 5 is empty"));
}

TEST_F(Page, NamesTheCommandThatMakesThisPicture) {
  open("light=l3&mode=wipe&split=0.3");
  press("Shift+c");
  EXPECT_TRUE(wait("document.getElementById('toast').textContent.includes('likeness olat picture')"));
  EXPECT_THAT(evaluate("document.getElementById('toast').textContent"),
              HasSubstr("light=l3&variant=truth&mode=wipe&split=0.3"));
}

TEST_F(Page, DoesNotFlipByItselfWhereLessMotionIsAskedFor) {
  browser_->resize(1280, 720, false, true);
  open();
  press("Shift+t");
  EXPECT_THAT(evaluate("document.getElementById('toast').textContent"), HasSubstr("less motion"));
  browser_->resize(1280, 720);
}

TEST_F(Page, IsNamedForWhoDoesNotSeeIt) {
  open("mode=wipe");
  EXPECT_EQ(
      evaluate(
          "[...document.querySelectorAll('button,select,input,canvas:not([aria-hidden]),[role=slider],[role=listbox],["
          "role=application]')].filter(e => "
          "!(e.getAttribute('aria-label') || e.labels?.length || e.textContent.trim())).map(e => e.id || e.outerHTML)"),
      "[]");
  EXPECT_EQ(evaluate("document.getElementById('live').getAttribute('aria-live')"), "\"polite\"");
  evaluate("document.getElementById('split').focus()");
  press("ArrowRight");
  EXPECT_EQ(state("split"), "\"0.51\"") << "the handle has keys of its own";
  press("Tab");
  EXPECT_NE(evaluate("document.activeElement.id"), "\"split\"") << "Tab moves on";
}

TEST_F(Page, FitsWindowsFromTelephoneToDesk) {
  for (const auto& [width, height] : {std::pair{1280, 720}, {1920, 1080}, {390, 844}}) {
    browser_->resize(width, height);
    open("mode=side");
    EXPECT_LE(std::stoi(evaluate("document.documentElement.scrollWidth")), width);
    EXPECT_GT(std::stoi(evaluate("document.getElementById('picture').clientHeight")), height / 3);
  }
  browser_->resize(1280, 720);
}

TEST_F(Page, IsItsOwnReportWithoutAServer) {
  const std::filesystem::path file = folder_->path() / "report.html";
  const capture::Capture capture = capture::read_capture(folder_->path());
  const ReportSummary summary = write_report(capture, ReportOptions{.pairs = 2}, file);
  EXPECT_EQ(summary.compared, 9u) << "of ten pairs one has no render";
  EXPECT_LE(std::filesystem::file_size(file), 30u << 20);
  browser_->open("file://" + file.string());
  ASSERT_TRUE(wait("document.body.dataset.ready && likeness.complete")) << evaluate("document.body.innerText");
  EXPECT_EQ(state("light"), "\"l2\"") << "the first of the worst";
  press("Space");
  EXPECT_EQ(state("mode"), "\"render\"");
  press("w");
  EXPECT_EQ(state("mode"), "\"wipe\"");
  evaluate("likeness.change({ev: 0.5})");
  press("}");
  EXPECT_EQ(state("ev"), "\"1.5\"");
  EXPECT_TRUE(wait("likeness.complete"));
  const image::Picture photo = test::bump(64, 48, 2, 1);
  evaluate("likeness.stage.pointer = {x: 40, y: 20}");
  EXPECT_NEAR(std::stod(evaluate("likeness.stage.values().photo[0]")), photo.at(40, 20)[0], 1e-3 * photo.at(40, 20)[0]);
  EXPECT_EQ(evaluate("performance.getEntriesByType('resource').filter(r => !r.name.startsWith('data:') && "
                     "!r.name.startsWith('blob:')).length"),
            "0")
      << "nothing is asked for";
}

TEST_F(Page, SaysSoWithAWrongToken) {
  std::string address = served_->address();
  address.back() = address.back() == '0' ? '1' : '0';
  browser_->open(address);
  EXPECT_TRUE(wait(
      "!document.getElementById('fault').hidden && document.getElementById('fault').textContent.includes('token')"));
}

}  // namespace
}  // namespace likeness::olat_view
