#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "olat/tev/images.h"
#include "olat/tev/listener.h"
#include "olat/tev/send.h"
#include "olat/view/answers.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "tests/olat/small_capture.h"
#include "tests/render/temporary_folder.h"

// Renders that tev's protocol brings, and pictures that are sent by it.
namespace likeness::olat_view {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Ran {
  int exit_code = -1;
  std::string out;
};
Ran run(const std::string& words) {
  Ran ran;
  FILE* const pipe = popen((LIKENESS_PROGRAM " " + words + " 2>&1").c_str(), "r");
  std::array<char, 4096> part{};
  while (std::fgets(part.data(), part.size(), pipe)) ran.out += part.data();
  const int status = pclose(pipe);
  ran.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ran;
}

class Received : public testing::Test {
 protected:
  Received()
      : capture_(test::write_small_capture(folder_.path())),
        answers_(capture_, {.with_scores = false, .received = &images_}) {}

  void give(const std::string& name, float light, int width = 64, int height = 48) {
    images_.take(olat_tev::Create{name, width, height, {"R", "G", "B"}});
    const std::vector<float> values(static_cast<std::size_t>(width * height), light);
    images_.take(olat_tev::Update{name, {"R", "G", "B"}, 0, 0, width, height, {0, 0, 0}, {1, 1, 1}, values});
  }
  Answer ask(const std::string& path, const std::string& state, const std::string& kind = "render") {
    return answers_.answer(path, {{"state", state}, {"kind", kind}, {"level", "0"}, {"variant", "pbrt"}});
  }
  float first_value(const Answer& answer) { return answer.pixels ? light_of(*answer.pixels).rgb[0] : -1; }

  test::TemporaryFolder folder_;
  capture::Capture capture_;
  olat_tev::Images images_;
  Answers answers_;
};

TEST_F(Received, PicturesAreVariantsOfTheirPairOrOfAll) {
  EXPECT_EQ(ask("/api/pixels", "variant=pbrt").status, 400);
  give("pbrt", 2);
  give("scene/pass 2/c1/l3", 3);
  EXPECT_THAT(ask("/api/capture", "").body, HasSubstr(R"("variants":["truth","pbrt","scene/pass 2"])"));
  EXPECT_EQ(first_value(ask("/api/pixels", "variant=pbrt&camera=c1&light=l4")), 2);
  EXPECT_EQ(first_value(ask("/api/pixels", "variant=scene/pass%202&camera=c1&light=l3")), 3);
  EXPECT_EQ(ask("/api/pixels", "variant=scene/pass%202&camera=c1&light=l2").status, 404);
  EXPECT_THAT(ask("/api/frame", "variant=pbrt").body, HasSubstr("\"render\":\"tev: pbrt\""));
  EXPECT_NE(first_value(ask("/api/pixels", "")), 2) << "the capture's own are what they were";
  images_.take(olat_tev::Close{"pbrt"});
  EXPECT_EQ(ask("/api/pixels", "variant=pbrt").status, 400);
}

TEST_F(Received, PicturesAreNewWheneverMoreOfThemArrives) {
  give("pbrt", 2);
  EXPECT_EQ(first_value(ask("/api/pixels", "variant=pbrt")), 2);
  const std::string before = ask("/api/scores", "").body;
  EXPECT_THAT(before, HasSubstr("\"received\":{\"pbrt\":"));
  EXPECT_THAT(before, Not(HasSubstr("rows"))) << "scores are of renders that stay";
  give("pbrt", 4);
  EXPECT_EQ(first_value(ask("/api/pixels", "variant=pbrt")), 4);
  EXPECT_NE(ask("/api/scores", "").body, before);
}

TEST_F(Received, PicturesPassEveryStateOfTheView) {
  give("pbrt", 0.25f);
  for (const char* state : {"variant=pbrt", "variant=pbrt&mode=difference", "variant=pbrt&match=capture&mode=side",
                            "variant=pbrt&mode=difference&metric=flip", "variant=pbrt&match=channel"}) {
    EXPECT_EQ(ask("/render", state).status, 200) << state;
    EXPECT_EQ(ask("/api/gain", state).status, 200) << state;
    EXPECT_EQ(ask("/api/pixels", state, "flip").status, 200) << state;
  }
  EXPECT_NE(ask("/render", "variant=pbrt&mode=render").body, ask("/render", "mode=render").body);
}

TEST_F(Received, PicturesOfAnotherSizeSayIt) {
  give("pbrt", 1, 32, 48);
  const Answer answer = ask("/api/pixels", "variant=pbrt");
  EXPECT_EQ(answer.status, 422);
  EXPECT_THAT(answer.body, HasSubstr("has 32 x 48 pixels; camera"));
}

// A variant of the capture is not hidden by a picture of its name.
TEST_F(Received, PicturesDoNotTakeTheNameOfARender) {
  give("truth", 9);
  EXPECT_NE(first_value(ask("/api/pixels", "variant=truth")), 9);
}

TEST(Sent, IsThePairThatTheCaptureHas) {
  const test::TemporaryFolder folder;
  const capture::Capture capture = test::write_small_capture(folder.path());
  olat_tev::Images images;
  const olat_tev::Listener listener(images, "127.0.0.1:0");
  const std::string tev = "--tev 127.0.0.1:" + std::to_string(listener.port());
  const Ran ran = run("olat picture " + folder.path().string() + " --state light=l1 --json " + tev);
  EXPECT_EQ(ran.exit_code, 0) << ran.out;
  EXPECT_THAT(ran.out, HasSubstr(R"("sent": ["photo/c0/l1", "truth/c0/l1"])"));
  // Sent and received by two processes: the last packet may be on its way.
  for (int i = 0; i < 2000 && images.bytes() < 2u * 64 * 48 * 12; ++i) usleep(1000);
  usleep(50'000);
  ASSERT_TRUE(images.picture("photo/c0/l1") && images.picture("truth/c0/l1"));
  EXPECT_EQ(images.picture("photo/c0/l1")->rgb, capture::read_photo(capture, 1).light.rgb);
  EXPECT_EQ(images.picture("truth/c0/l1")->rgb, capture::read_render(capture, capture.variants[0], 0, 1).rgb);

  const Ran lost = run("olat picture " + folder.path().string() + " --tev 127.0.0.1:1");
  EXPECT_EQ(lost.exit_code, 3);
  EXPECT_THAT(lost.out, HasSubstr("no tev listens there"));
  EXPECT_EQ(run("olat view " + folder.path().string() + " --tev-listen 0.0.0.0:0").exit_code, 2);
}

// Every state is reproducible by a command line: the server's picture and the program's are the same bytes.
TEST(Render, IsThePictureOfTheCommandLine) {
  const test::TemporaryFolder folder;
  Answers answers(test::write_small_capture(folder.path()), {.with_scores = false});
  for (const char* state :
       {"light=l2", "light=l2&mode=side&ev=1.25&view=agx", "mode=wipe&split=0.3&zebra=1&overlay=curve&wedge=1",
        "camera=c1&light=l2&mode=difference&metric=stops&match=light", "mode=difference&metric=flip&view=khronos"}) {
    const std::string png = (folder.path() / "state.png").string();
    const Ran ran = run("olat picture " + folder.path().string() + " --state '" + state + "' --out " + png);
    ASSERT_EQ(ran.exit_code, 0) << ran.out;
    const Answer answer = answers.answer("/render", {{"state", state}});
    EXPECT_EQ(answer.status, 200);
    EXPECT_TRUE(answer.body == files::read_whole(png, 1 << 24)) << state;
  }
}

}  // namespace
}  // namespace likeness::olat_view
