#include "olat/view/cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "olat/view/answers.h"
#include "render/capture/pixels.h"
#include "tests/olat/small_capture.h"
#include "tests/render/temporary_folder.h"

namespace likeness::olat_view {
namespace {

HalfPicture of_bytes(std::size_t bytes) {
  return {1, static_cast<int>(bytes / 8), std::vector<std::uint16_t>(bytes / 2)};
}

TEST(Cache, ForgetsWhatNobodyAskedForTheLongest) {
  Cache cache(3000);
  int made = 0;
  const auto ask = [&](const char* key) {
    return cache.find(key, [&] {
      ++made;
      return of_bytes(1000);
    });
  };
  ask("a");
  ask("b");
  ask("c");
  ask("a");
  EXPECT_EQ(made, 3);
  ask("d");  // b goes
  EXPECT_EQ(cache.bytes(), 3000u);
  ask("a");
  ask("c");
  EXPECT_EQ(made, 4);
  ask("b");
  EXPECT_EQ(made, 5);
  EXPECT_EQ(cache.kept("d"), nullptr);
}

TEST(Cache, HandsOutWhatIsLargerThanAllOfIt) {
  Cache cache(100);
  EXPECT_EQ(cache.find("a", [] { return of_bytes(1000); })->bytes(), 1000u);
  EXPECT_EQ(cache.bytes(), 0u);
}

TEST(Cache, MakesAPictureOnceForAllThatAskAtOnce) {
  Cache cache(100000);
  std::atomic<int> made{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 16; ++i)
    threads.emplace_back([&] {
      cache.find("a", [&] {
        ++made;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return of_bytes(800);
      });
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(made, 1);
}

TEST(Cache, TriesAgainAfterAFailure) {
  Cache cache(1000);
  EXPECT_THROW(cache.find("a", []() -> HalfPicture { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_EQ(cache.find("a", [] { return of_bytes(80); })->bytes(), 80u);
}

TEST(Answers, HoldNoMoreThanTheirCacheOfACaptureTwiceAsLarge) {
  const test::TemporaryFolder folder;
  const capture::Capture capture = test::write_small_capture(folder.path());
  // 2 x 5 photos of 64 x 48 x 8 bytes.
  const std::size_t all = 10 * 64 * 48 * 8;
  Answers answers(capture, {.cache_bytes = all / 2, .with_scores = false});
  for (int round = 0; round < 2; ++round)
    for (const capture::Frame& frame : capture.frames) {
      const Answer answer = answers.answer("/api/pixels", {{"kind", "photo"},
                                                           {"state", "camera=" + capture.cameras[frame.camera].id +
                                                                         "&light=" + capture.lights[frame.light].id}});
      ASSERT_EQ(answer.status, 200) << answer.body;
      EXPECT_EQ(answer.pixels->bytes(), 64u * 48 * 8);
      EXPECT_LE(answers.cache().bytes(), all / 2);
    }
  EXPECT_EQ(answers.cache().bytes(), all / 2) << "and uses all of it";
}

TEST(HalfPicture, KeepsLightAndFlawsAndLimitsWhatIsNone) {
  image::Picture picture(2, 1);
  picture.rgb = {0.5f, -0.25f, 1e6f, std::numeric_limits<float>::quiet_NaN(), 2, 3};
  const std::vector<std::uint8_t> flaws{0, 15};
  const HalfPicture half = half_of(picture, flaws);
  const image::Picture light = light_of(half);
  EXPECT_EQ(light.rgb, (std::vector<float>{0.5f, -0.25f, 65504, 0, 2, 3}));
  EXPECT_EQ(flaws_of(half), flaws);
}

TEST(HalfPicture, IsHalvedByMeansOfLight) {
  image::Picture picture(3, 1);
  picture.rgb = {1, 0, 0, 3, 0, 0, 5, 0, 0};
  const HalfPicture half =
      halved(half_of(picture, std::vector<std::uint8_t>{capture::kClipped, capture::kMasked, capture::kMasked}));
  EXPECT_EQ(half.width, 2);
  EXPECT_EQ(half.height, 1);
  EXPECT_EQ(light_of(half).rgb[0], 2);
  EXPECT_EQ(light_of(half).rgb[3], 5);
  EXPECT_EQ(flaws_of(half)[0], capture::kClipped) << "not all of it is masked";
  EXPECT_EQ(flaws_of(half)[1], capture::kMasked);
}

}  // namespace
}  // namespace likeness::olat_view
