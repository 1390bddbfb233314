#include "olat/check/check.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/image/attributes.h"
#include "render/image/read.h"
#include "render/image/write.h"
#include "tests/olat/ball_capture.h"
#include "tests/render/scene/pages.h"
#include "tests/render/temporary_folder.h"

namespace likeness::olat_check {
namespace {

namespace fs = std::filesystem;
using capture::Capture;
using olat_test::Ball;
using olat_test::Faults;
using olat_test::kBallLights;
using olat_test::Planted;
using olat_test::write_ball_capture;
using test::TemporaryFolder;

std::vector<Finding> findings_of(const Report& report, Rule rule) {
  std::vector<Finding> out;
  for (const Finding& f : report.findings)
    if (f.rule == rule) out.push_back(f);
  return out;
}

// All that was found is of this rule.
std::vector<Finding> only(const Report& report, Rule rule) {
  for (const Finding& f : report.findings)
    EXPECT_EQ(row_of(f.rule).id, row_of(rule).id) << f.camera << " " << f.light << ": " << f.text;
  return findings_of(report, rule);
}

Report report_of(const Faults& faults) {
  const TemporaryFolder folder;
  return run_check(write_ball_capture(folder.path(), faults));
}

std::string texts(const Report& report) {
  std::string out;
  for (const Finding& f : report.findings) out += std::string(row_of(f.rule).id) + " " + f.light + " " + f.text + "\n";
  return out;
}

std::string measured_of(const Report& report, Rule rule) {
  std::string out;
  for (const Measured& m : report.measured)
    if (m.rule == rule) out += m.text + "\n";
  return out;
}

TEST(Check, FindsNothingInACleanCapture) {
  const Report report = report_of({});
  EXPECT_EQ(texts(report), "");
  EXPECT_TRUE(report.not_checked.empty());
  EXPECT_EQ(report.photos, kBallLights);
  EXPECT_EQ(report.renders, kBallLights);
  EXPECT_EQ(report.variant, "plain");
}

TEST(Check, FindsNothingInHonestPhotosWithHighlightsAndShadowsThatTheRendersLack) {
  const Report report = report_of({.plant = [](std::size_t, Ball& ball, Planted&) {
    ball.highlight = 0.5;
    ball.shadow = 0.05;
  }});
  EXPECT_EQ(texts(report), "");
}

TEST(Check, WithoutRendersOrNormalsSaysWhatItDidNotCheck) {
  const Report report = report_of({.plant = {}, .has_renders = false, .has_normals = false, .has_mask = false});
  EXPECT_EQ(texts(report), "");
  EXPECT_EQ(report.not_checked.size(), 9u) << "six rules of renders; curve, order and hand";
  const Report by_normals = report_of({.plant = {}, .has_renders = false});
  EXPECT_EQ(texts(by_normals), "");
  EXPECT_EQ(by_normals.not_checked.size(), 6u);
}

TEST(Check, FindsAShiftAndItsSize) {
  const Report report = report_of({.plant = [](std::size_t, Ball& ball, Planted&) { ball.x = 1.5; }});
  const auto found = only(report, Rule::kShift);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].value, 1.5, 0.1) << found[0].text;
  EXPECT_EQ(found[0].camera, "front");
}

TEST(Check, FindsALightThatIsHalfAStopTooBright) {
  const Report report = report_of({.plant = [](std::size_t light, Ball&, Planted& planted) {
    if (light == 3) planted.gain_ev = 0.5;
  }});
  const auto found = only(report, Rule::kLightGain);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].light, "003");
  EXPECT_NEAR(found[0].value, 0.5, 0.02) << found[0].text;
}

TEST(Check, FindsALightOfAnotherColor) {
  const auto plant = [](std::size_t light, Ball&, Planted& planted) {
    if (light == 5) planted.channel_ev = {0.15, 0, -0.3};
  };
  const auto found = findings_of(report_of({.plant = plant}), Rule::kWhiteBalance);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].light, "005");
  EXPECT_NEAR(found[0].value, 0.3, 0.02);
  EXPECT_EQ(only(report_of({.plant = plant, .has_renders = false}), Rule::kWhiteBalance).size(), 1u)
      << "without renders, by the mean color";
}

TEST(Check, NamesSwappedLightsWithRendersAndWithNormals) {
  for (const bool has_renders : {true, false}) {
    const TemporaryFolder folder;
    Capture capture = write_ball_capture(folder.path(), {.plant = {}, .has_renders = has_renders});
    std::swap(capture.frames[2].file, capture.frames[5].file);
    const auto found = only(run_check(capture), Rule::kLightOrder);
    ASSERT_EQ(found.size(), 2u) << has_renders;
    EXPECT_EQ(found[0].light, "002");
    EXPECT_NE(found[0].text.find("light 005"), std::string::npos) << found[0].text;
    EXPECT_EQ(found[1].light, "005");
    EXPECT_NE(found[1].text.find("light 002"), std::string::npos) << found[1].text;
  }
}

TEST(Check, FindsAForgottenTransferCurve) {
  for (const bool has_renders : {true, false}) {
    const Report report = report_of({.plant = [](std::size_t, Ball&, Planted& planted) { planted.exponent = 1 / 2.2; },
                                     .has_renders = has_renders});
    const auto found = findings_of(report, Rule::kTransferCurve);
    ASSERT_EQ(found.size(), 1u) << has_renders;
    EXPECT_NEAR(found[0].value, 1 - 1 / 2.2, 0.05) << found[0].text;
    EXPECT_TRUE(findings_of(report, Rule::kLightOrder).empty()) << texts(report);
  }
}

TEST(Check, FindsLightsOfTheOtherHand) {
  const TemporaryFolder folder;
  // Off the axis, since a ring of lights about the view is its own mirror image but for the names.
  Capture capture = write_ball_capture(folder.path(), {.plant = {}, .has_renders = false});
  for (auto& light : capture.lights) std::get<capture::DistantLight>(light.place).to_light.x *= -1;
  const auto found = findings_of(run_check(capture), Rule::kMirrored);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_GT(found[0].value, 0.3);
  EXPECT_NE(found[0].text.find("the sign of x turned over"), std::string::npos) << found[0].text;
}

TEST(Check, FindsABlackLevelThatIsNotBlack) {
  const Report report =
      report_of({.plant = [](std::size_t, Ball&, Planted& planted) { planted.black = 0.02; }, .has_renders = false});
  const auto found = findings_of(report, Rule::kBlackLevel);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].value, 0.02 / (0.3 * 1.3 + 0.02), 0.006)
      << "of blue, which has an albedo of 0.3 and less than 0.42";
  const Report below =
      report_of({.plant = [](std::size_t, Ball&, Planted& planted) { planted.black = -0.02; }, .has_renders = false});
  EXPECT_EQ(findings_of(below, Rule::kBlackLevel).size(), 1u) << "too much was subtracted";
}

TEST(Check, FindsClippedPixelsAndTheirShare) {
  const TemporaryFolder folder;
  Capture capture = write_ball_capture(folder.path());
  capture.frames[8].clip = 0.45;  // the light on the axis
  const auto found = only(run_check(capture), Rule::kClipped);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].light, "008");
  const image::Picture photo = image::read_picture(folder / capture.frames[8].file.string());
  const std::vector<float> mask = olat_test::ball_mask(olat_test::rendered_ball());
  double clipped = 0, inside = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (!(mask[i] > 0)) continue;
    ++inside;
    for (std::size_t c = 0; c < 3; ++c)
      if (photo.rgb[3 * i + c] >= 0.45f) {
        ++clipped;
        break;
      }
  }
  EXPECT_DOUBLE_EQ(found[0].value, clipped / inside);
}

TEST(Check, FindsNoiseThatIsNotTheStatedOne) {
  const TemporaryFolder folder;
  Capture capture = write_ball_capture(folder.path());
  capture.noise_floor = {{1e-3, 1e-3, 1e-3}};
  EXPECT_EQ(texts(run_check(capture)), "");
  capture.noise_floor = {{1e-3, 4e-3, 1e-3}};
  const auto found = only(run_check(capture), Rule::kNoiseFloor);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].value, 2, 0.3) << "a fourth: two stops";
}

TEST(Check, FindsNaNOfPhotosAndRenders) {
  const TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path());
  image::Picture photo = image::read_picture(folder / capture.frames[1].file.string());
  photo.at(48, 48)[0] = std::numeric_limits<float>::quiet_NaN();
  photo.at(2, 2)[0] = std::numeric_limits<float>::quiet_NaN();  // outside the mask
  image::write_exr(folder / capture.frames[1].file.string(), photo);
  const auto found = only(run_check(capture), Rule::kNotFinite);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].light, "001");
  EXPECT_EQ(found[0].value, 1);

  const fs::path render = folder / "renders/plain/front/004.exr";
  image::write_exr(folder / capture.frames[1].file.string(), image::read_picture(render));
  photo = image::read_picture(render);
  photo.at(1, 1)[2] = std::numeric_limits<float>::infinity();
  image::write_exr(render, photo);
  const auto in_render = findings_of(run_check(capture), Rule::kRenderNotFinite);
  ASSERT_EQ(in_render.size(), 1u);
  EXPECT_EQ(in_render[0].light, "004");
}

TEST(Check, FindsFaultsOfTheLists) {
  const TemporaryFolder folder;
  const Capture sound = write_ball_capture(folder.path());
  Capture capture = sound;
  capture.frames.erase(capture.frames.begin() + 4);
  auto found = only(run_check(capture), Rule::kMissingFrame);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].value, 1);
  EXPECT_NE(found[0].text.find("004"), std::string::npos);

  capture = sound;
  capture.frames.push_back(capture.frames[2]);
  const Report twice = run_check(capture);
  EXPECT_EQ(findings_of(twice, Rule::kDuplicateFrame).size(), 1u);
  EXPECT_EQ(findings_of(twice, Rule::kSameFile).size(), 1u);
  EXPECT_EQ(twice.findings.size(), 2u);

  capture = sound;
  capture.lights[6].place = {};
  found = only(run_check(capture), Rule::kLightWithoutPlace);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].light, "006");

  capture = sound;
  for (auto& frame : capture.frames) frame.exposure_s = 0.1;
  EXPECT_EQ(texts(run_check(capture)), "");
  capture.frames[3].exposure_s = 0.2;
  found = only(run_check(capture), Rule::kExposureGain);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].value, 1, 1e-9);
  capture.frames[3].gain = 0.5;
  EXPECT_TRUE(findings_of(run_check(capture), Rule::kExposureGain).empty());
}

TEST(Check, FindsAnUnusedLightOfManyCameras) {
  const TemporaryFolder folder;
  Capture capture = write_ball_capture(folder.path());
  capture::Camera side = capture.cameras[0];
  side.id = "side";
  capture.cameras.push_back(side);
  for (std::size_t i = 0; i < kBallLights; ++i) {
    capture::Frame frame = capture.frames[i];
    frame.camera = 1;
    frame.file = "photos/side/" + capture.lights[i].id + ".exr";
    fs::create_directories(folder / "photos/side");
    fs::copy_file(folder / capture.frames[i].file.string(), folder / frame.file.string());
    capture.frames.push_back(frame);
  }
  capture.variants.clear();
  EXPECT_EQ(texts(run_check(capture)), "");
  capture.lights.push_back({"099", "", capture::DistantLight{}, {1, 1, 1}, ""});
  const auto found = only(run_check(capture), Rule::kUnusedLight);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].light, "099");
  capture.lights.pop_back();
  capture.frames.pop_back();
  EXPECT_EQ(only(run_check(capture), Rule::kMissingFrame).size(), 1u);
}

TEST(Check, FindsFilesThatAreAbsentDamagedOrOfAnotherSize) {
  const TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path());
  fs::remove(folder / capture.frames[0].file.string());
  std::ofstream(folder / capture.frames[1].file.string()) << "no picture";
  image::write_exr(folder / capture.frames[2].file.string(), image::Picture(95, 96));
  const Report report = run_check(capture);
  const auto unreadable = findings_of(report, Rule::kUnreadable);
  ASSERT_EQ(unreadable.size(), 2u);
  EXPECT_EQ(unreadable[0].light, "000");
  EXPECT_EQ(unreadable[1].light, "001");
  const auto size = findings_of(report, Rule::kSize);
  ASSERT_EQ(size.size(), 1u);
  EXPECT_EQ(size[0].light, "002");
  EXPECT_EQ(size[0].value, 1);
  EXPECT_EQ(report.findings.size(), 3u) << texts(report);
}

TEST(Check, FindsAPhotoThatIsNotTheImportedOne) {
  const TemporaryFolder folder;
  Capture capture = write_ball_capture(folder.path());
  for (auto& frame : capture.frames)
    frame.sha256 = files::sha256(files::read_whole(folder / frame.file.string(), 1 << 24));
  EXPECT_EQ(texts(run_check(capture)), "");
  capture.frames[7].sha256[5] = capture.frames[7].sha256[5] == '0' ? '1' : '0';
  const auto found = only(run_check(capture), Rule::kSha256);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].light, "007");
  const Report without = run_check(capture, {.variant = "", .reads_hashes = false, .keep_going = {}});
  EXPECT_TRUE(without.findings.empty());
  EXPECT_EQ(without.not_checked.size(), 2u);
}

void write_exr_with_exposure(const fs::path& file, const image::Picture& picture, float seconds) {
  Imf::Header header(picture.width, picture.height);
  for (const char* channel : {"R", "G", "B"}) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
  Imf::addExpTime(header, seconds);
  Imf::OutputFile out(file.c_str(), header);
  Imf::FrameBuffer buffer;
  const char* const names[3] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c)
    buffer.insert(names[c],
                  Imf::Slice(Imf::FLOAT, const_cast<char*>(reinterpret_cast<const char*>(picture.rgb.data() + c)),
                             3 * sizeof(float), 3 * sizeof(float) * static_cast<std::size_t>(picture.width)));
  out.setFrameBuffer(buffer);
  out.writePixels(picture.height);
}

TEST(Check, FindsAnExposureThatTheHeaderDoesNotState) {
  const TemporaryFolder folder;
  Capture capture = write_ball_capture(folder.path());
  for (auto& frame : capture.frames) {
    frame.exposure_s = 0.1;
    const fs::path file = folder / frame.file.string();
    write_exr_with_exposure(file, image::read_picture(file), frame.light == 2 ? 0.05f : 0.1f);
  }
  const auto found = only(run_check(capture), Rule::kExposureAttributes);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].light, "002");
  EXPECT_NEAR(found[0].value, 1, 1e-6);
}

TEST(Check, FindsAnEmptyMaskAndMissingAndStaleRenders) {
  TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path());
  fs::remove(folder / "renders/plain/front/002.exr");
  auto found = only(run_check(capture), Rule::kMissingRender);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].text.find("002"), std::string::npos);

  const TemporaryFolder second;
  const Capture stale = write_ball_capture(second.path());
  const auto written = fs::last_write_time(second / "capture.json");
  fs::last_write_time(second / "renders/plain/front/003.exr", written - std::chrono::hours(1));
  EXPECT_EQ(texts(run_check(stale)), "") << "made before the capture was written, as renders may be";
  fs::last_write_time(second / "lights.json", written + std::chrono::seconds(30));
  found = only(run_check(stale), Rule::kStaleRender);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].text.find("003"), std::string::npos);

  image::write_exr(second / "aux/mask.exr", image::Picture(96, 96));
  EXPECT_EQ(findings_of(run_check(stale), Rule::kEmptyMask).size(), 1u);
  EXPECT_THROW(run_check(stale, {.variant = "plane", .reads_hashes = true, .keep_going = {}}), files::UsageError);
}

TEST(Check, FindsARenderWhoseHeaderNamesAnotherPair) {
  const TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path());
  const auto sign = [&](const char* light) {
    const fs::path file = folder / "renders/plain/front/003.exr";
    image::write_exr(file, image::read_picture(file),
                     {{"olat:camera", "front"}, {"olat:light", light}, {"olat:variant", "plain"}});
  };
  sign("003");
  EXPECT_EQ(texts(run_check(capture)), "");
  sign("004");
  const auto found = only(run_check(capture), Rule::kRenderOfOther);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].light, "003");
  EXPECT_NE(found[0].text.find("\"004\" instead of \"003\""), std::string::npos) << found[0].text;
}

TEST(Check, IsTheSameOnOneThreadAndStopsWhenAsked) {
  const TemporaryFolder folder;
  const Capture capture =
      write_ball_capture(folder.path(), {.plant = [](std::size_t light, Ball& ball, Planted& planted) {
                           ball.x = 1;
                           planted.gain_ev = light == 1 ? 1 : 0;
                         }});
  const Report many = run_check(capture);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(json_of(run_check(capture), capture), json_of(many, capture));
  Options options;
  options.keep_going = [](std::string_view, double) { return false; };
  EXPECT_FALSE(run_check(capture, options).is_complete);
}

// Real photographs, whose lights, masks and normals are known.
Capture shared_capture(const std::string& name, const std::string& mask, const std::string& normals) {
  Capture capture;
  capture.root = fs::path(LIKENESS_SHARED_DIR) / "data/captures" / name;
  std::ifstream rows(capture.root / "lights.csv");
  for (std::string row; std::getline(rows, row);) {
    if (row.empty() || row[0] == '#' || row.starts_with("file")) continue;
    const std::string file = row.substr(0, row.find(','));
    double v[6];
    if (std::sscanf(row.c_str() + file.size(), ",%lf,%lf,%lf,%lf,%lf,%lf", v, v + 1, v + 2, v + 3, v + 4, v + 5) != 6)
      continue;
    capture.lights.push_back({file, "", capture::DistantLight{{v[0], v[1], v[2]}}, {v[3], v[4], v[5]}, "lights.csv"});
    capture.frames.push_back({.light = capture.lights.size() - 1, .file = file});
  }
  if (capture.frames.empty()) return capture;
  const image::Texels first = image::read_texels(capture.root / capture.frames[0].file);
  capture.cameras.resize(1);
  capture.cameras[0].id = "front";
  capture.cameras[0].width = first.width;
  capture.cameras[0].height = first.height;
  if (!mask.empty()) capture.layers.push_back({0, capture::Layer::kMask, mask});
  if (!normals.empty()) capture.layers.push_back({0, capture::Layer::kNormal, normals});
  return capture;
}

TEST(CheckOfRealPhotos, TheCatIsCleanAndItsFaultsAreFound) {
  Capture cat = shared_capture("diligent-cat", "mask.png", "normal_gt.pfm");
  if (cat.frames.empty()) GTEST_SKIP() << "no " << cat.root;
  const Report report = run_check(cat);
  EXPECT_EQ(texts(report), "");
  std::swap(cat.frames[10].file, cat.frames[60].file);
  const auto swapped = findings_of(run_check(cat), Rule::kLightOrder);
  ASSERT_EQ(swapped.size(), 2u);
  EXPECT_NE(swapped[0].text.find("light 061.png"), std::string::npos) << swapped[0].text;
  std::swap(cat.frames[10].file, cat.frames[60].file);
  cat.frames.resize(24);
  cat.lights.resize(24);
  for (auto& light : cat.lights) std::get<capture::DistantLight>(light.place).to_light.y *= -1;
  EXPECT_EQ(findings_of(run_check(cat), Rule::kMirrored).size(), 1u);
  for (auto& light : cat.lights) std::get<capture::DistantLight>(light.place).to_light.y *= -1;
  for (auto& frame : cat.frames) frame.transfer = capture::Transfer::kGamma22;  // decoded once too often
  const Report curved = run_check(cat);
  EXPECT_EQ(findings_of(curved, Rule::kTransferCurve).size(), 1u) << measured_of(curved, Rule::kTransferCurve);
}

TEST(CheckOfRealPhotos, TheBuddhaHasNoFaultButWhatItsPhotosShow) {
  const Capture buddha = shared_capture("uw-buddha", "buddha.mask.tga", "");
  if (buddha.frames.empty()) GTEST_SKIP() << "no " << buddha.root;
  EXPECT_EQ(texts(run_check(buddha)), "");
}

TEST(Check, OfACaptureOfNothingFindsNothing) {
  const Report report = run_check(Capture{});
  EXPECT_TRUE(report.findings.empty());
  EXPECT_FALSE(text_of(report, Capture{}).empty());
}

TEST(CheckPage, HasTheTableOfTheRules) {
  std::string page = files::read_whole(LIKENESS_SOURCE_DIR "/docs/olat_check.md", 1 << 20);
  const std::string before = page;
  ASSERT_TRUE(scene::test::put_table(page, "rules", rules_table()));
  EXPECT_TRUE(page == before) << "rewrite docs/olat_check.md with: cmake --build BUILD --target olat_pages";
  for (const RuleRow& row : kRules) {
    EXPECT_FALSE(row.text.empty() || row.reason.empty() || row.way_out.empty() || row.unit.empty()) << row.id;
    EXPECT_EQ(std::ranges::count(kRules, row.id, &RuleRow::id), 1) << row.id;
  }
}

TEST(CheckReport, NamesRulePlaceValueAndWayOut) {
  const TemporaryFolder folder;
  Capture capture = write_ball_capture(folder.path());
  capture.lights[6].place = {};
  const Report report = run_check(capture);
  const std::string text = text_of(report, capture), json = json_of(report, capture);
  for (const char* part : {"light_without_place", "light 006", "way out: ", "1 error, 0 warnings"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  for (const char* part : {"\"rule\": \"light_without_place\"", "\"light\": \"006\"", "\"way_out\"", "\"allowed\""})
    EXPECT_NE(json.find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace likeness::olat_check
