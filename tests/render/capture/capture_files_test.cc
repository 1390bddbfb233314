#include "render/capture/files_of_capture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <fstream>

#include <glm/geometric.hpp>

#include "render/files/files.h"
#include "tests/render/capture/small_capture.h"
#include "tests/render/temporary_folder.h"

namespace likeness::capture {
namespace {

using files::InputError;
using likeness::test::TemporaryFolder;
using test::small_capture;
using testing::HasSubstr;

// The texts of the small capture with `old` in one of them replaced.
CaptureTexts texts_with(std::string CaptureTexts::* file, const std::string& old, const std::string& text) {
  CaptureTexts out = texts_of(small_capture("/c"));
  std::string& in = out.*file;
  const std::size_t at = in.find(old);
  EXPECT_NE(at, in.npos) << old << " is not in " << in;
  if (at != in.npos) in.replace(at, old.size(), text);
  return out;
}

std::string refusal(const CaptureTexts& texts) {
  try {
    capture_of(texts, "/c");
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find('\n'), text.npos) << text;
    return text;
  }
  return "accepted";
}

TEST(CaptureFiles, EveryFieldIsReadAsItWasWritten) {
  const TemporaryFolder folder;
  const Capture want = small_capture(folder.path());
  write_capture(want);
  const Capture got = read_capture(folder.path());
  EXPECT_EQ(got.root, want.root);
  EXPECT_EQ(got.name, want.name);
  EXPECT_EQ(got.up, want.up);
  ASSERT_EQ(got.cameras.size(), want.cameras.size());
  for (std::size_t i = 0; i < want.cameras.size(); ++i) {
    const Camera &g = got.cameras[i], &w = want.cameras[i];
    EXPECT_EQ(g.id, w.id);
    EXPECT_EQ(g.label, w.label);
    EXPECT_EQ(g.width, w.width);
    EXPECT_EQ(g.height, w.height);
    EXPECT_EQ(g.is_orthographic, w.is_orthographic);
    EXPECT_EQ(g.intrinsics, w.intrinsics);
    EXPECT_EQ(g.lens, w.lens);
    EXPECT_EQ(g.distortion, w.distortion);
    EXPECT_EQ(g.is_undistorted, w.is_undistorted);
    EXPECT_EQ(g.world_from_camera, w.world_from_camera);
    EXPECT_EQ(g.rec709_from_camera, w.rec709_from_camera);
  }
  ASSERT_EQ(got.lights.size(), want.lights.size());
  for (std::size_t i = 0; i < want.lights.size(); ++i) {
    EXPECT_EQ(got.lights[i].id, want.lights[i].id);
    EXPECT_EQ(got.lights[i].label, want.lights[i].label);
    EXPECT_EQ(got.lights[i].place.index(), want.lights[i].place.index());
    EXPECT_EQ(got.lights[i].intensity, want.lights[i].intensity);
    EXPECT_EQ(got.lights[i].calibrated_by, want.lights[i].calibrated_by);
  }
  EXPECT_LT(glm::distance(std::get<DistantLight>(got.lights[0].place).to_light, glm::dvec3(0.6, 0, 0.8)), 1e-15);
  EXPECT_EQ(std::get<NearLight>(got.lights[1].place).position, glm::dvec3(0.1, -2, 3));
  ASSERT_EQ(got.frames.size(), want.frames.size());
  for (std::size_t i = 0; i < want.frames.size(); ++i) {
    const Frame &g = got.frames[i], &w = want.frames[i];
    EXPECT_EQ(g.camera, w.camera) << i;
    EXPECT_EQ(g.light, w.light) << i;
    EXPECT_EQ(g.kind, w.kind) << i;
    EXPECT_EQ(g.file, w.file) << i;
    EXPECT_EQ(g.transfer, w.transfer) << i;
    EXPECT_EQ(g.primaries, w.primaries) << i;
    EXPECT_EQ(g.black, w.black) << i;
    EXPECT_EQ(g.white, w.white) << i;
    EXPECT_EQ(g.clip, w.clip) << i;
    EXPECT_EQ(g.gain, w.gain) << i;
    EXPECT_EQ(g.exposure_s, w.exposure_s) << i;
    EXPECT_EQ(g.iso, w.iso) << i;
    EXPECT_EQ(g.f_number, w.f_number) << i;
    EXPECT_EQ(g.sha256, w.sha256) << i;
  }
  ASSERT_EQ(got.layers.size(), want.layers.size());
  for (std::size_t i = 0; i < want.layers.size(); ++i) {
    EXPECT_EQ(got.layers[i].camera, want.layers[i].camera);
    EXPECT_EQ(got.layers[i].layer, want.layers[i].layer);
    EXPECT_EQ(got.layers[i].file, want.layers[i].file);
  }
  ASSERT_EQ(got.variants.size(), want.variants.size());
  for (std::size_t i = 0; i < want.variants.size(); ++i) {
    EXPECT_EQ(got.variants[i].id, want.variants[i].id);
    EXPECT_EQ(got.variants[i].pattern, want.variants[i].pattern);
  }
  EXPECT_EQ(got.pipeline.match_gain, want.pipeline.match_gain);
  EXPECT_EQ(got.pipeline.ev, want.pipeline.ev);
  EXPECT_EQ(got.pipeline.view, want.pipeline.view);
  EXPECT_EQ(got.noise_floor, want.noise_floor);
  EXPECT_EQ(got.flip_first_ev, want.flip_first_ev);
  EXPECT_EQ(got.flip_last_ev, want.flip_last_ev);
  EXPECT_EQ(got.license, want.license);
  EXPECT_EQ(got.citation, want.citation);
  EXPECT_EQ(got.source, want.source);
  EXPECT_EQ(texts_of(got).frames, texts_of(want).frames);  // so that a capture that is only read stays the same to git
}

// A digest of a camera or a light must hold when the files are written again, as olat render does for a new variant.
TEST(CaptureFiles, ReadingAndWritingAgainChangesNoBit) {
  Capture capture = small_capture("/c");
  for (int i = 1; i < 40; ++i) {
    const glm::dvec3 z = glm::normalize(glm::dvec3(0.1 * i, 0.37 * i - 2, 1)),
                     x = glm::normalize(glm::cross(z, capture.up));
    capture.cameras[0].world_from_camera =
        glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(0.1, 0.2, 0.3, 1));
    capture.lights[0].place = DistantLight{z};
    const CaptureTexts want = texts_of(capture), got = texts_of(capture_of(want, "/c"));
    EXPECT_EQ(got.cameras, want.cameras) << i;
    EXPECT_EQ(got.lights, want.lights) << i;
  }
}

TEST(CaptureFiles, TheFirstFrameMayBeTheOneThatNeverClips) {
  Capture capture = small_capture("/c");
  std::swap(capture.frames[0], capture.frames[1]);
  const Capture got = capture_of(texts_of(capture), "/c");
  EXPECT_TRUE(std::isinf(got.frames[0].clip));
  EXPECT_EQ(got.frames[1].clip, 1);
  EXPECT_EQ(got.frames[2].clip, 0.9);
}

TEST(CaptureFiles, APatternMakesAFrameOfEachPairAndARowTakesItsPlace) {
  CaptureTexts texts = texts_of(small_capture("/c"));
  texts.frames = R"({"type": "olat frames", "version": 1, "defaults": {"transfer": "srgb", "gain": 3},
    "patterns": [{"file": "p/{camera}_{light}.png"}, {"file": "q/{light}.png", "cameras": ["front"], "lights": ["l3"], "gain": 4}],
    "frames": [{"camera": "front", "light": "l2", "file": "odd.png"}]})";
  const Capture got = capture_of(texts, "/c");
  ASSERT_EQ(got.frames.size(), 7u);  // 6 pairs - 1 that a row has, + 1 of the second pattern, + the row
  const FrameTable table(got);
  EXPECT_EQ(got.frames[table.frame(1, 0)].file, "p/side view_l1.png");
  EXPECT_EQ(got.frames[table.frame(0, 1)].file, "odd.png");
  EXPECT_EQ(got.frames[table.frame(0, 1)].gain, 3);
  EXPECT_EQ(got.frames[table.frame(0, 1)].transfer, Transfer::kSrgb);
  EXPECT_EQ(got.frames[table.frame(0, 2)].file, "p/front_l3.png");  // of two, the first
  EXPECT_EQ(got.frames[5].gain, 4);
  EXPECT_EQ(photo_file(got, got.frames[5]), "/c/q/l3.png");
}

TEST(CaptureFiles, AFrameThroughCrossedPolarizersStandsBesideThatOfItsLight) {
  Capture capture = small_capture("/c");
  capture.frames.push_back({.camera = 1, .light = 2, .kind = FrameKind::kCrossed, .file = "photos/crossed.exr"});
  const Capture got = capture_of(texts_of(capture), "/c");
  const FrameTable table(got);
  EXPECT_EQ(table.frame(1, 2), 5u);
  ASSERT_EQ(table.crossed(1, 2), got.frames.size() - 1);
  EXPECT_EQ(got.frames.back().kind, FrameKind::kCrossed);
  EXPECT_EQ(got.frames.back().light, 2u);
  EXPECT_EQ(table.crossed(1, 1), kAbsent);
  EXPECT_EQ(table.crossed(1, 3), kAbsent);
}

TEST(CaptureFiles, TheTableHasOnlyFramesOfOneLight) {
  const Capture capture = small_capture("/c");
  const FrameTable table(capture);
  EXPECT_EQ(table.frame(0, 0), 0u);
  EXPECT_EQ(table.frame(1, 2), 5u);
  EXPECT_EQ(table.frame(0, 3), kAbsent);
  EXPECT_EQ(table.frame(2, 0), kAbsent);
  EXPECT_EQ(light_of(capture, "l3"), 2u);
  EXPECT_EQ(camera_of(capture, "side view"), 1u);
  EXPECT_EQ(variant_of(capture, "none"), kAbsent);
}

TEST(CaptureFiles, PatternsTakeIdsAndNothingElse) {
  EXPECT_EQ(filled("{variant}/{camera}/{light}.exr", "c", "{camera}", "v"), "v/c/{camera}.exr");
  EXPECT_EQ(filled("{", "c", "l"), "{");
  EXPECT_EQ(filled("{cam}{camera}{", "c", "l"), "{cam}c{");
  const Capture capture = small_capture("/c");
  EXPECT_EQ(render_file(capture, capture.variants[1], 0, 2), "/c/truth/front_l3.exr");
  EXPECT_EQ(layer_file(capture, 1, Layer::kNormal), "/elsewhere/normal.pfm");
  EXPECT_TRUE(layer_file(capture, 0, Layer::kNormal).empty());
}

// Version 1 holds what version 1 can hold; the rest of the lenses makes a version 2, and comes back as it was.
TEST(CaptureFiles, OnlyLensesThatNeedVersion2AreWrittenSo) {
  Capture capture = small_capture("/c");
  EXPECT_NE(texts_of(capture).cameras.find("\"version\": 1"), std::string::npos);
  EXPECT_NE(texts_of(capture).cameras.find("[0.1,-0.2,0.001,0.002,0.3]"), std::string::npos);
  capture.cameras[0].distortion = {1, 2, 3, 4, 5, 6, 7, 8};
  capture.cameras[1].lens = Lens::kFisheye;
  capture.cameras[1].distortion = {0.1, 0.2, 0.3};
  CaptureTexts texts = texts_of(capture);
  EXPECT_NE(texts.cameras.find("\"version\": 2"), std::string::npos);
  const Capture got = capture_of(texts, "/c");
  EXPECT_EQ(got.cameras[0].distortion, capture.cameras[0].distortion);
  EXPECT_EQ(got.cameras[1].distortion, capture.cameras[1].distortion);
  EXPECT_EQ(got.cameras[1].lens, Lens::kFisheye);
  texts.cameras.replace(texts.cameras.find("\"version\": 2"), 12, "\"version\": 1");
  EXPECT_THROW(capture_of(texts, "/c"), files::InputError);
}

struct Wrong {
  std::string CaptureTexts::* file;
  std::string old, text, message;
};
const auto kCapture = &CaptureTexts::capture, kCameras = &CaptureTexts::cameras, kLights = &CaptureTexts::lights,
           kFrames = &CaptureTexts::frames;

TEST(CaptureFiles, WhatIsWrongIsNamedWithItsFileLineAndWayOut) {
  const std::vector<Wrong> all{
      {kCapture, "\"olat capture\"", "\"olat frames\"",
       "/c/capture.json:2: /type is \"olat frames\"; expected \"olat capture\""},
      {kCapture, "\"version\": 1", "\"version\": 2", "/version = 2 is outside [1, 1]"},
      {kCapture, "\"up\": [\n  0.0,\n  0.0,\n  1.0", "\"up\": [0, 0, 0", "/up has no length"},
      {kCapture, "\"units\": \"m\"", "\"units\": \"mm\"", "/units = \"mm\" is not known"},
      {kCapture, "\"name\"", "\"nam\"", "/nam is not a key of a capture; did you mean \"name\"?"},
      {kCapture, "renders/{variant}/{camera}/{light}.exr", "renders/{light}.exr", "has no {camera}"},
      {kCapture, "renders/{variant}", "../{variant}", "leaves the folder by .."},
      {kCapture, "renders/{variant}", "/etc/{variant}", "is absolute; expected a file below the capture's folder"},
      {kCapture, "\"first_ev\": -2.0", "\"first_ev\": 2.0", "/flip/last_ev = 1 is below first_ev"},
      {kCameras, "\"distortion\":[0.1", "\"distortion\":[9,0.1", "more than 5 need \"version\": 2 of cameras.json"},
      {kCameras, "\"distortion\":[0.1", "\"distortion\":[9,9,9,9,0.1", "has 9 numbers; expected at most 8: k1"},
      {kCameras, "\"distortion\"", "\"lens\":\"fisheye\",\"distortion\"",
       "/cameras/0/lens needs \"version\": 2 of cameras.json"},
      {kCameras, "\"id\":\"side view\"", "\"id\":\"front\"",
       "/c/cameras.json:6: /cameras/1/id = \"front\" stands twice"},
      {kCameras, "\"id\":\"front\"", "\"id\":\"..\"", "cannot be an id"},
      {kCameras, "\"id\":\"front\"", "\"id\":\"a/b\"", "cannot be an id"},
      {kCameras, "\"width\":4", "\"width\":0", "/cameras/0/width = 0 is outside [1, 65536]"},
      {kCameras, "\"width\":4", "\"width\":4.5", "expected a whole number"},
      {kCameras, "\"width\":4", "\"with\":4", "did you mean \"width\"?"},
      {kCameras, "[5.0,6.0]", "[0,6.0]", "/focal_px/0 = 0 is outside (0, 1e+09]"},
      {kCameras, "0.1,-0.2,", "0.1,-0.2,0,", "has 6 numbers; more than 5 need"},
      {kCameras, "[[1.0,0.0", "[[2.0,0.0", "column 0 has the length 2; expected 1"},
      {kCameras, "[[1.0,0.0", "[[-1.0,0.0", "is not a turn (determinant -1; expected 1)"},
      {kCameras, "[2.0,-1.0,", "[2.0,", "has 8 numbers; expected 9, row by row"},
      {kCameras, "aux/front/mask.png", "../mask.png", "an absolute path may name a file elsewhere"},
      {kCameras, "\"mask\"", "\"masc\"", "/layers/masc is not a key of a layers; did you mean \"mask\"?"},
      {kLights, "\"id\":\"l2\"", "\"id\":\"l1\"", "/c/lights.json:6: /lights/1/id = \"l1\" stands twice"},
      {kLights, "[0.6,0.0,0.8]", "[0,0,0]", "/lights/0/direction has no length"},
      {kLights, "\"position\"", "\"direction\":[1,0,0],\"position\"", "are both given; only one of them can hold"},
      {kLights, "[1.0,2.0,3.0]", "[1.0,0,3.0]", "/lights/0/intensity/1 = 0 is outside (0, 1e+09]"},
      {kFrames, "\"light\":\"l1\"", "\"light\":\"l9\"",
       "/frames/0/light = \"l9\" is not in lights.json; did you mean \"l1\"?"},
      {kFrames, "\"camera\":\"front\"", "\"camera\":\"frontt\"", "is not in cameras.json; did you mean \"front\"?"},
      {kFrames, "\"light\":\"l1\",", "", "/light is missing: a frame of one light"},
      {kFrames, "photos/front/l1.exr", "photos/../../l1.exr", "leaves the folder by .."},
      {kFrames, "photos/front/l1.exr", "", "/file is empty"},
      {kFrames, "\"transfer\":\"srgb\"", "\"transfer\":\"srg\"", "is not known; did you mean \"srgb\"?"},
      {kFrames, "\"black\":0.125", "\"black\":0.75", "white = 0.75 is not above black = 0.75"},
      {kFrames, "\"never_clips\":true", "\"never_clips\":true,\"clip\":1", "are both given"},
      {kFrames, std::string(64, 'a'), std::string(63, 'a'), "expected 64 hexadecimal digits"},
      {kFrames, "\"kind\":\"full\"", "\"kind\":\"ful\"", "did you mean \"full\"?"},
  };
  for (const Wrong& one : all)
    EXPECT_THAT(refusal(texts_with(one.file, one.old, one.text)), HasSubstr(one.message)) << one.old;
}

TEST(CaptureFiles, AFolderWithoutACaptureSaysHowToMakeOne) {
  const TemporaryFolder folder;
  try {
    read_capture(folder.path());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has no capture.json (likeness olat import"));
  }
  write_capture(small_capture(folder.path()));
  EXPECT_EQ(read_capture(folder / "capture.json").cameras.size(), 2u);
  std::filesystem::remove(folder / "lights.json");
  EXPECT_THROW(read_capture(folder.path()), InputError);
}

TEST(CaptureFiles, WhatCouldNotBeReadAgainIsNotWritten) {
  const TemporaryFolder folder;
  Capture capture = small_capture(folder.path());
  capture.lights[1].id = capture.lights[0].id;
  EXPECT_THROW(write_capture(capture), std::invalid_argument);
  capture = small_capture(folder.path());
  capture.cameras[0].intrinsics[0][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_capture(capture), std::invalid_argument);
  capture = small_capture(folder.path());
  capture.frames[0].light = 7;
  EXPECT_THROW(write_capture(capture), std::invalid_argument);
  capture = small_capture(folder.path());
  capture.name = "\xff";
  EXPECT_THROW(write_capture(capture), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(CaptureFiles, TooManyPairsAndFramesAreRefusedBeforeTheyCostMemory) {
  CaptureTexts texts = texts_of(small_capture("/c"));
  const auto rows = [](std::size_t count, const std::string& rest) {
    std::string out;
    for (std::size_t i = 0; i < count; ++i)
      out += (i ? ",\n" : "") + ("{\"id\":\"i" + std::to_string(i) + "\"" + rest) + "}";
    return out;
  };
  const std::string camera =
      ",\"width\":1,\"height\":1,\"focal_px\":[1,1],\"world_from_camera\":[[1,0,0,0],[0,1,0,0],[0,0,1,0]]";
  texts.cameras = R"({"type":"olat cameras","version":1,"cameras":[)" + rows(300, camera) + "]}";
  texts.lights = R"({"type":"olat lights","version":1,"lights":[)" + rows(14000, "") + "]}";
  EXPECT_THAT(refusal(texts), HasSubstr("/lights and the cameras make 4200000 pairs; expected at most 4194304"));
  texts.lights = R"({"type":"olat lights","version":1,"lights":[)" + rows(3496, "") + "]}";  // x 300 = 1 048 800
  texts.frames = R"({"type":"olat frames","version":1,"patterns":[{"file":"{camera}{light}"}]})";
  EXPECT_THAT(refusal(texts), HasSubstr("makes more than 1048576 frames"));
}

// 40 cameras x 331 lights, as the largest public captures have: the index alone, as rows and as a pattern.
TEST(CaptureFiles, ACaptureOfFortyCamerasAnd331LightsOpensInAFifthOfASecond) {
  const TemporaryFolder folder;
  Capture capture = small_capture(folder.path());
  const Camera camera = capture.cameras[0];
  capture.cameras.clear();
  capture.lights.clear();
  capture.frames.clear();
  capture.layers.clear();
  capture.noise_floor.clear();
  for (int i = 0; i < 40; ++i) (capture.cameras.emplace_back() = camera).id = "camera_" + std::to_string(i);
  for (int i = 0; i < 331; ++i)
    capture.lights.push_back({"light_" + std::to_string(i), "", DistantLight{}, {1, 1, 1}, ""});
  for (std::size_t c = 0; c < 40; ++c)
    for (std::size_t l = 0; l < 331; ++l)
      capture.frames.push_back(
          {.camera = c, .light = l, .file = "photos/" + capture.cameras[c].id + "/" + capture.lights[l].id + ".exr"});
  write_capture(capture);
  const auto seconds_to_read = [&] {
    const std::clock_t began = std::clock();  // of the processor: other programs do not count
    const Capture got = read_capture(folder.path());
    EXPECT_EQ(got.frames.size(), 13240u);
    EXPECT_NE(FrameTable(got).frame(39, 330), kAbsent);
    return static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  };
  const double rows = std::min(seconds_to_read(), seconds_to_read());
  files::write_whole(folder / "frames.json",
                     R"({"type": "olat frames", "version": 1, "patterns": [{"file": "photos/{camera}/{light}.exr"}]})");
  const double pattern = std::min(seconds_to_read(), seconds_to_read());
  std::printf("rows %.0f ms, pattern %.0f ms\n", 1e3 * rows, 1e3 * pattern);
#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__)
  EXPECT_LT(pattern, 0.2);
  EXPECT_LT(rows, 0.2);
#endif
}

}  // namespace
}  // namespace likeness::capture
