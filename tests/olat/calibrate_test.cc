#include "olat/calibrate/calibrate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "olat/calibrate/chrome.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/image/write.h"
#include "tests/olat/ball_capture.h"
#include "tests/render/temporary_folder.h"

namespace likeness::olat_calibrate {
namespace {

namespace fs = std::filesystem;
using capture::Capture;
using olat_test::Ball;
using olat_test::Faults;
using olat_test::kBallLights;
using olat_test::Planted;
using olat_test::write_ball_capture;
using test::TemporaryFolder;

Options of_gain(GainOf gain) {
  Options options;
  options.gain = gain;
  return options;
}

double ev(double ratio) { return std::log2(ratio); }

TEST(Gains, OfALightAreFoundFromRendersAndWritten) {
  const TemporaryFolder folder;
  const Capture capture =
      write_ball_capture(folder.path(), {.plant = [](std::size_t light, Ball& ball, Planted& planted) {
                           planted.gain_ev = 0.3 + (light == 3 ? 0.5 : 0);
                           ball.highlight = 1;
                         }});
  const Result relative = run_calibrate(capture, of_gain(GainOf::kLight));
  for (std::size_t i = 0; i < kBallLights; ++i)
    EXPECT_NEAR(ev(relative.capture.lights[i].intensity.x), i == 3 ? 0.5 : 0, 0.02) << i;
  Options options = of_gain(GainOf::kLight);
  options.is_absolute = true;
  const Result absolute = run_calibrate(capture, options);
  EXPECT_NEAR(ev(absolute.capture.lights[0].intensity.y), 0.3, 0.02);
  EXPECT_NEAR(ev(absolute.capture.lights[3].intensity.y), 0.8, 0.02);

  // What is written is read again, and calibrated again nothing is left.
  const auto lines = write_result(absolute, "");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(fs::exists(folder / "lights.1.json")) << "the old one is kept";
  const Capture again = capture::read_capture(folder.path());
  EXPECT_NE(again.lights[3].calibrated_by.find("--gain"), std::string::npos);
  for (const auto& light : run_calibrate(again, options).capture.lights)
    EXPECT_NEAR(ev(light.intensity.x / again.lights[capture::light_of(again, light.id)].intensity.x), 0, 1e-3);
  write_result(absolute, "");
  EXPECT_TRUE(fs::exists(folder / "lights.2.json")) << "and the next";
}

TEST(Gains, OfAChannelAreTheWhiteBalanceOfTheLight) {
  const TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path(), {.plant = [](std::size_t light, Ball&, Planted& planted) {
                                               if (light == 5) planted.channel_ev = {0.4, 0.1, -0.3};
                                             }});
  const Result result = run_calibrate(capture, of_gain(GainOf::kChannel));
  const glm::dvec3 intensity = result.capture.lights[5].intensity;
  EXPECT_NEAR(ev(intensity.x), 0.4, 0.02);
  EXPECT_NEAR(ev(intensity.y), 0.1, 0.02);
  EXPECT_NEAR(ev(intensity.z), -0.3, 0.02);
  EXPECT_NEAR(ev(result.capture.lights[4].intensity.z), 0, 0.02);
}

// A flat grey card under each light, as a capture of its own.
Capture grey_card(const fs::path& folder, const std::vector<std::array<double, 3>>& colors) {
  Capture card =
      write_ball_capture(folder, {.plant = {}, .has_renders = false, .has_normals = false, .has_mask = false});
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 2e-3);
  for (std::size_t i = 0; i < kBallLights; ++i) {
    image::Picture photo(96, 96);
    for (std::size_t k = 0; k < photo.rgb.size(); ++k)
      photo.rgb[k] = static_cast<float>(0.18 * colors[i][k % 3] + noise(random));
    image::write_exr(folder / card.frames[i].file, photo);
  }
  return card;
}

TEST(Gains, OfAGreyCardNeedNoRenders) {
  const TemporaryFolder folder, of_card;
  const Capture capture = write_ball_capture(folder.path(), {.plant = {}, .has_renders = false});
  std::vector<std::array<double, 3>> colors(kBallLights, {1.1, 1, 0.9});
  colors[2] = {2.2, 2, 1.2};
  Capture card = grey_card(of_card.path(), colors);
  Options options = of_gain(GainOf::kChannel);
  EXPECT_THROW(run_calibrate(capture, options), files::UsageError) << "neither renders nor a card";
  options.grey = &card;
  const Result result = run_calibrate(capture, options);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(result.capture.lights[2].intensity[c], colors[2][static_cast<std::size_t>(c)], 0.01);
    EXPECT_NEAR(result.capture.lights[7].intensity[c], colors[7][static_cast<std::size_t>(c)], 0.01);
  }
  EXPECT_TRUE(result.notes.empty());
  for (auto& light : card.lights) light.id = "other " + light.id;
  EXPECT_EQ(run_calibrate(capture, options).notes.size(), 1u) << "by their order, and it is said";
  card.lights.pop_back();
  card.frames.pop_back();
  EXPECT_THROW(run_calibrate(capture, options), files::UsageError);
}

TEST(Noise, IsMeasuredAndWritten) {
  const TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path());
  Options options;
  options.noise = true;
  const Result result = run_calibrate(capture, options);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(result.capture.noise_floor[0][c], 1e-3, 1e-4);
  write_result(result, "");
  EXPECT_NEAR(capture::read_capture(folder.path()).noise_floor[0].x, result.capture.noise_floor[0].x, 1e-12);
}

TEST(Calibrate, IntoANewFolderLeavesTheOldOneAlone) {
  const TemporaryFolder folder, other;
  const Capture capture = write_ball_capture(folder.path());
  const std::string before = files::read_whole(folder / "cameras.json", 1 << 20);
  Options options;
  options.noise = true;
  const Result result = run_calibrate(capture, options);
  write_result(result, (other / "new").string());
  EXPECT_EQ(files::read_whole(folder / "cameras.json", 1 << 20), before);
  const Capture there = capture::read_capture(other / "new");
  EXPECT_TRUE(fs::exists(capture::photo_file(there, there.frames[0])));
  EXPECT_NO_THROW(capture::read_photo(there, 0));
  EXPECT_EQ(there.noise_floor.size(), 1u);
}

TEST(Calibrate, InterruptedChangesNothing) {
  const TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path());
  Options options = of_gain(GainOf::kLight);
  options.keep_going = [](std::string_view, double) { return false; };
  EXPECT_THROW(run_calibrate(capture, options), files::Interrupted);
}

TEST(FlatField, TakesOutWhatTheLensDarkens) {
  const TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path());
  image::Picture white(96, 96);
  const auto vignette = [](int x, int y) {
    const double r2 = ((x - 48) * (x - 48) + (y - 48) * (y - 48)) / (68.0 * 68.0);
    return 1 - 0.4 * r2;
  };
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x)
      for (std::size_t c = 0; c < 3; ++c) white.at(x, y)[c] = static_cast<float>(0.5 * vignette(x, y));
  image::write_exr(folder / "white.exr", white);
  image::write_exr(folder / capture.frames[0].file, white);  // the first photo is the same even surface
  Options options;
  options.flat = (folder / "white.exr").string();
  const Result result = run_calibrate(capture, options);
  write_result(result, "");
  const capture::Photo photo = capture::read_photo(capture::read_capture(folder.path()), 0);
  const float middle = photo.light.at(48, 48)[1];
  EXPECT_NEAR(photo.light.at(10, 48)[1] / middle, 1, 5e-3);
  EXPECT_NEAR(photo.light.at(80, 80)[1] / middle, 1, 5e-3);
  image::write_exr(folder / "white.exr", image::Picture(96, 96));
  EXPECT_THROW(run_calibrate(capture, options), files::InputError) << "black is no flat field";
}

std::string reference_text() {
  return files::read_whole(fs::path(LIKENESS_SHARED_DIR) / "data/colour/data_colorchecker24_after_nov2014_cie_lab.csv",
                           1 << 20);
}
bool has_reference() {
  return fs::exists(fs::path(LIKENESS_SHARED_DIR) / "data/colour/data_colorchecker24_after_nov2014_cie_lab.csv");
}

TEST(Chart, EachStageIsBetterAndAPlantedMatrixIsTakenOut) {
  if (!has_reference()) GTEST_SKIP() << "no reference values in " << LIKENESS_SHARED_DIR;
  const Reference reference = reference_of(reference_text(), "reference");
  EXPECT_EQ(reference.space, "Lab");
  // The colors that a perfect camera sees, through an exposure, a color cast and crosstalk of channels.
  const TemporaryFolder folder;
  const std::array<std::array<double, 3>, kPatches> neutral = [&] {
    std::array<std::array<double, 3>, kPatches> grey{};
    for (auto& color : grey) color = {0.2, 0.2, 0.2};
    return grey;
  }();
  const ChartFit grey_fit = fit_chart(neutral, reference);
  EXPECT_GT(grey_fit.stages[2].mean, 10) << "a chart that is all grey has no colors to find";

  const glm::dmat3 crosstalk(0.6, 0.15, 0.05, 0.25, 0.9, 0.2, 0.05, 0.1, 0.5);
  std::array<std::array<double, 3>, kPatches> patches{};
  const glm::dmat3 to_rgb =
      glm::inverse(glm::dmat3(0.4360747, 0.2225045, 0.0139322, 0.3850649, 0.7168786, 0.0971045, 0.1430804, 0.0606169,
                              0.7141733));  // sRGB to XYZ under D50, Bradford
  const glm::dvec3 d50(0.9642957, 1, 0.8251046);
  for (std::size_t i = 0; i < kPatches; ++i) {
    const image::Lab& lab = reference.lab[i];
    const auto cube = [](double f) { return f > 6.0 / 29 ? f * f * f : 3 * 36.0 / 841 * (f - 4.0 / 29); };
    const double y = (lab.l + 16) / 116;
    const glm::dvec3 xyz = d50 * glm::dvec3(cube(y + lab.a / 500), cube(y), cube(y - lab.b / 200));
    const glm::dvec3 seen = 0.4 * (crosstalk * (to_rgb * xyz));
    patches[i] = {seen.x, seen.y, seen.z};
  }
  const ChartFit fit = fit_chart(patches, reference);
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_LT(fit.stages[k].mean, fit.stages[k - 1].mean);
    EXPECT_LT(fit.stages[k].largest, fit.stages[k - 1].largest);
  }
  EXPECT_LT(fit.stages[2].largest, 0.05) << "a matrix was planted, so a matrix is enough";
  const glm::dmat3 product = fit.matrix * std::exp2(fit.exposure_ev) * 0.4 * crosstalk;
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(product[i / 3][i % 3], i % 4 == 0 ? 1 : 0, 2e-3) << i;
}

TEST(Chart, PatchesAreReadThroughThePerspectiveOfTheCorners) {
  // A chart whose patches are numbers, drawn by the inverse of the same perspective, which a grid search checks.
  const Corners corners{{{40, 30}, {260, 50}, {250, 190}, {55, 200}}};
  image::Picture photo(300, 240);
  // Projective by hand: bilinear is not enough for the middle of a skewed chart, but diagonals meet where they meet.
  std::array<std::array<double, 3>, kPatches> patches = patches_of(photo, corners);
  for (const auto& color : patches) EXPECT_EQ(color[0], 0);
  Corners straight{{{30, 20}, {270, 20}, {270, 180}, {30, 180}}};
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 300; ++x) {
      const int column = (x - 30) / 40, row = (y - 20) / 40;
      const bool inside = x >= 30 && y >= 20 && column < 6 && row < 4;
      const bool frame = (x - 30) % 40 < 6 || (y - 20) % 40 < 6;
      photo.at(x, y)[0] = inside && !frame ? static_cast<float>(1 + column + 6 * row) : -5.0f;
    }
  photo.at(50, 40)[0] = 1000;  // dust
  patches = patches_of(photo, straight);
  for (std::size_t i = 0; i < kPatches; ++i) EXPECT_EQ(patches[i][0], static_cast<double>(i + 1));
  // Turned by 180 degrees: the corners say so.
  std::rotate(straight.begin(), straight.begin() + 2, straight.end());
  patches = patches_of(photo, straight);
  for (std::size_t i = 0; i < kPatches; ++i) EXPECT_EQ(patches[i][0], static_cast<double>(kPatches - i));
  std::swap(straight[1], straight[3]);
  EXPECT_THROW(patches_of(photo, straight), files::UsageError) << "the wrong way round";
  straight[0] = {-3, 4};
  EXPECT_THROW(patches_of(photo, straight), files::UsageError);
}

TEST(Chart, RefusesTablesThatAreNone) {
  for (const char* text :
       {"", "patch,c0,c1,c2\n1,2,3\n", "1,50,0,0\n1,50,0,0\n", "25,50,0,0\n", "1,nan,0,0\n", "1,50,0,0x\n"})
    EXPECT_THROW(reference_of(text, "a.csv"), files::InputError) << text;
}

TEST(Chart, OfARealRawPhotoGetsBetterAtEachStage) {
  const fs::path folder = fs::path(LIKENESS_SHARED_DIR) / "data/colour";
  if (!fs::exists(folder / "colorchart.dng")) GTEST_SKIP() << "no " << folder / "colorchart.dng";
  const image::Picture photo = capture::read_encoded(folder / "colorchart.dng");
  const Corners corners{{{664, 573}, {1303, 563}, {1315, 974}, {646, 981}}};  // read off the picture
  for (const char* name : {"data_colorchecker2005.csv", "data_colorchecker24_after_nov2014_cie_lab.csv"}) {
    const Reference reference = read_reference(folder / name);
    const ChartFit fit = fit_chart(patches_of(photo, corners), reference);
    for (std::size_t k = 0; k < 3; ++k)
      std::printf("%s %s: mean %.2f, largest %.2f (patch %zu)\n", name, std::string(fit.stages[k].name).c_str(),
                  fit.stages[k].mean, fit.stages[k].largest, fit.stages[k].worst + 1);
    for (std::size_t k = 1; k < 3; ++k) {
      EXPECT_LT(fit.stages[k].mean, fit.stages[k - 1].mean) << name;
      EXPECT_LT(fit.stages[k].largest, fit.stages[k - 1].largest) << name;
    }
  }
}

// A mirror ball under a small lamp, seen by an orthographic camera that looks along -z with y up.
image::Picture mirror_ball(const std::array<double, 3>& to_light, double lobe) {
  image::Picture photo(200, 200);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) {
      const double nx = (x + 0.5 - 104) / 80, ny = -(y + 0.5 - 97) / 80, z2 = 1 - nx * nx - ny * ny;
      if (z2 <= 0) continue;
      const double nz = std::sqrt(z2);
      const double cosine = 2 * nz * (nx * to_light[0] + ny * to_light[1] + nz * to_light[2]) - to_light[2];
      for (std::size_t c = 0; c < 3; ++c)
        photo.at(x, y)[c] = static_cast<float>(0.02 + (cosine > 0 ? std::min(1.0, 3 * std::pow(cosine, lobe)) : 0));
    }
  return photo;
}

TEST(Chrome, DirectionsOfALampAreFoundToATenthOfADegree) {
  capture::Camera camera;
  camera.is_orthographic = true;
  camera.world_from_camera = glm::dmat4(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 3, 1);
  std::vector<std::uint8_t> mask;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) mask.push_back(std::hypot(x + 0.5 - 104, y + 0.5 - 97) < 80 ? 1 : 0);
  const auto ball = ball_of(mask, 200, 200);
  ASSERT_TRUE(ball);
  EXPECT_NEAR(ball->x, 104, 0.02);
  EXPECT_NEAR(ball->radius, 80, 0.1);
  for (const auto& light : olat_test::ring_of_lights(9)) {
    const auto found = direction_of(mirror_ball(light, 400), *ball, camera);
    ASSERT_TRUE(found);
    const double cosine = (*found)[0] * light[0] + (*found)[1] * light[1] + (*found)[2] * light[2];
    EXPECT_LT(std::acos(std::min(1.0, cosine)) * 57.29578, 0.1);
  }
  EXPECT_FALSE(direction_of(image::Picture(200, 200), *ball, camera)) << "no light";
  EXPECT_FALSE(ball_of(std::vector<std::uint8_t>(100, 0), 10, 10));
}

TEST(Chrome, DirectionsOfTheUwBallAreNearThoseThatAreGiven) {
  const fs::path folder = fs::path(LIKENESS_SHARED_DIR) / "data/captures";
  if (!fs::exists(folder / "uw-chrome/lights.csv")) GTEST_SKIP() << "no " << folder / "uw-chrome";
  const auto read = [&](const std::string& name, const std::string& mask) {
    Capture capture;
    capture.root = folder / name;
    capture.name = name;
    std::ifstream rows(capture.root / "lights.csv");
    for (std::string row; std::getline(rows, row);) {
      if (row.empty() || row[0] == '#' || row.starts_with("file")) continue;
      const std::string file = row.substr(0, row.find(','));
      glm::dvec3 l(0);
      std::sscanf(row.c_str() + file.size(), ",%lf,%lf,%lf", &l.x, &l.y, &l.z);
      capture.lights.push_back({file, "", capture::DistantLight{glm::normalize(l)}, {1, 1, 1}, "lights.csv"});
      capture.frames.push_back({.light = capture.lights.size() - 1, .file = file});
    }
    const image::Picture first = capture::read_encoded(capture.root / capture.frames[0].file);
    capture.cameras.resize(1);
    capture.cameras[0].id = "front";
    capture.cameras[0].width = first.width;
    capture.cameras[0].height = first.height;
    capture.cameras[0].is_orthographic = true;
    capture.cameras[0].world_from_camera = glm::dmat4(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 3, 1);
    capture.layers.push_back({0, capture::Layer::kMask, mask});
    return capture;
  };
  const Capture buddha = read("uw-buddha", "buddha.mask.tga"), chrome = read("uw-chrome", "chrome.mask.tga");
  Options options;
  options.chrome = &chrome;
  const Result result = run_calibrate(buddha, options);
  ASSERT_EQ(result.changes.size(), 12u);
  // The given ones scatter about the spots of the photos by up to 9 pixels (light 1), and explain the photos of the buddha
  // no better (residual of photometric stereo: 0.0469 of the mean with them, 0.0460 with the found ones).
  std::vector<double> degrees;
  for (std::size_t i = 0; i < 12; ++i) {
    const glm::dvec3 given = std::get<capture::DistantLight>(buddha.lights[i].place).to_light,
                     found = std::get<capture::DistantLight>(result.capture.lights[i].place).to_light;
    degrees.push_back(glm::degrees(std::acos(std::min(1.0, glm::dot(given, found)))));
  }
  std::ranges::sort(degrees);
  EXPECT_LT(degrees[6], 2.5);
  EXPECT_LT(degrees[11], 9);
  for (const std::string& note : result.notes) std::printf("%s\n", note.c_str());
}

TEST(CalibrateReport, SaysWhatChanged) {
  const TemporaryFolder folder;
  const Capture capture = write_ball_capture(folder.path(), {.plant = [](std::size_t light, Ball&, Planted& planted) {
                                               planted.gain_ev = light == 3 ? 1 : 0;
                                             }});
  const Result result = run_calibrate(capture, of_gain(GainOf::kLight));
  EXPECT_NE(text_of(result).find("lights.json 003: intensity from 1 1 1 to "), std::string::npos) << text_of(result);
  EXPECT_NE(json_of(result).find("\"id\": \"003\""), std::string::npos);
  EXPECT_EQ(text_of(Result{}), "nothing to change\n");
}

}  // namespace
}  // namespace likeness::olat_calibrate
