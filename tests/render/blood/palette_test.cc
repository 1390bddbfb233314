#include <cmath>
#include <fstream>
#include <numeric>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "brdf/blood/palette.h"
#include "render/blood/palette_fit.h"
#include "render/blood/table.h"
#include "render/files/files.h"

namespace likeness::blood {
namespace {

using Palette = brdf::BloodPalette<double>;
using testing::HasSubstr;

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(Haemoglobin, TheTableIsThatOfThePublishedSpectra) {
  std::ifstream in(LIKENESS_SHARED_DIR "/data/media/data_hb.csv");
  if (!in) GTEST_SKIP() << "no spectra in " LIKENESS_SHARED_DIR;
  std::string line;
  std::size_t found = 0;
  while (std::getline(in, line)) {
    double nm = 0, with = 0, without = 0;
    if (std::sscanf(line.c_str(), "%lf %lf %lf", &nm, &with, &without) != 3) continue;
    const double row = (nm - brdf::kHaemoglobinFirstNm) / brdf::kHaemoglobinStepNm;
    if (row < 0 || row > 32 || row != std::floor(row)) continue;
    EXPECT_EQ(brdf::kHaemoglobin[static_cast<std::size_t>(row)][0], with) << nm;
    EXPECT_EQ(brdf::kHaemoglobin[static_cast<std::size_t>(row)][1], without) << nm;
    ++found;
  }
  EXPECT_EQ(found, brdf::kHaemoglobinRows);
}

TEST(Haemoglobin, WeightsOfAChannelSumToOne) {
  const brdf::HaemoglobinWeights weights;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    for (const auto& row : weights.weight) sum += row[c];
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(BloodPalette, NothingIsTheBackgroundAndThickBloodIsRed) {
  const Palette palette;
  for (const double time : {0.0, 600.0, 10800.0}) {
    const auto bare = color_of(palette, 0, time), thick = color_of(palette, 1, time);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(bare[c], palette.value[8], 1e-6);
    EXPECT_GT(thick[0], 3 * thick[1]);
    EXPECT_GT(thick[0], 3 * thick[2]);
    double before = 2;
    for (double opacity = 0; opacity <= 1; opacity += 0.02) {
      const double green = color_of(palette, opacity, time)[1];
      EXPECT_LE(green, before + 1e-12) << "more blood is darker";
      before = green;
    }
  }
  EXPECT_LT(color_of(palette, 0.9, 10800)[0], 0.9 * color_of(palette, 0.9, 0)[0]) << "oxygen is lost with age";
}

TEST(BloodPalette, EveryInputIsSafe) {
  Palette palette;
  for (auto& row : palette.spline) row = {0.2, -0.1, 0.05};
  for (const double opacity : {-1.0, 0.0, 1e-300, 0.5, 1.0, 7.0, HUGE_VAL})
    for (const double time : {-5.0, 0.0, 1e-300, 1e12, HUGE_VAL})
      for (const double value : color_of(palette, opacity, time)) {
        EXPECT_TRUE(std::isfinite(value)) << opacity << " " << time;
        EXPECT_GE(value, 0);
      }
  const brdf::HaemoglobinWeights weights;
  const brdf::BloodPalette<float> coarse;
  for (float opacity = 0; opacity <= 1; opacity += 0.1f)
    EXPECT_NEAR(coarse.color(weights, opacity, 600.0f).r, color_of(Palette(), static_cast<double>(opacity), 600)[0],
                2e-5);
}

TEST(BloodPalette, TheSplineIsAUnitySplineAndSmooth) {
  Palette palette;
  for (auto& row : palette.spline) row = {0.3, 0.3, 0.3};
  const auto a = color_of(palette, 0.37, 777), b = color_of(Palette(), 0.37, 777);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], std::exp(0.37 * 0.3), 1e-12) << "its basis sums to one";
  for (std::size_t i = 0; i < palette.spline.size(); ++i) palette.spline[i][0] = 0.1 * static_cast<double>(i % 7);
  for (const double knot : {0.5}) {
    const double step = 1e-5;
    const double left = color_of(palette, knot, 60)[0] - color_of(palette, knot - step, 60)[0];
    const double right = color_of(palette, knot + step, 60)[0] - color_of(palette, knot, 60)[0];
    EXPECT_NEAR(left / right, 1, 1e-3) << "no kink where pieces meet";
  }
}

TEST(PaletteFit, AKnownPaletteComesBackThroughNoise) {
  const PaletteFit fit = fit_palette(example_table(0.02, 1));
  EXPECT_LT(mean(fit.fitted), 1.0) << "2 % of noise is about 1 itself";
  EXPECT_LT(mean(fit.held_out), 2.0);
  // Against the truth, also between the cells.
  double sum = 0;
  int count = 0;
  for (double opacity = 0.35; opacity <= 0.98; opacity += 0.09)
    for (const double minutes : {1.0, 7.0, 20.0, 50.0, 100.0, 170.0}) {
      sum += difference(color_of(fit.palette, opacity, 60 * minutes), example_color(opacity, 60 * minutes));
      ++count;
    }
  EXPECT_LT(sum / count, 1.0);
}

TEST(PaletteFit, WithoutNoiseAndBrowningTheParametersComeBack) {
  Table table{"made", {}};
  const Palette truth = example_truth();
  const brdf::HaemoglobinWeights weights;
  for (const double opacity : {0.3, 0.6, 0.85, 0.98})
    for (const double minutes : {0.0, 5.0, 15.0, 45.0, 180.0}) {
      const auto rgb = truth.spectral(weights, opacity, 60 * minutes);
      table.cells.push_back(
          {"", opacity, 60 * minutes, {std::max(0.0, rgb.r), std::max(0.0, rgb.g), std::max(0.0, rgb.b)}});
    }
  const PaletteFit fit = fit_palette(table);
  EXPECT_LT(mean(fit.spectral), 0.05);
  EXPECT_NEAR(fit.palette.value[0], truth.value[0], 0.05 * truth.value[0]);
  EXPECT_NEAR(fit.palette.value[2], truth.value[2], 0.05);
  EXPECT_NEAR(fit.palette.value[8], truth.value[8], 0.02);
}

TEST(PaletteFit, TheSplineHelpsCellsThatItDidNotSee) {
  const PaletteFit fit = fit_palette(example_table(0.005, 3));
  EXPECT_TRUE(std::isfinite(fit.smoothness));
  EXPECT_LT(mean(fit.held_out), 0.8 * mean(fit.spectral)) << "the browning is no part of the spectra";
}

TEST(PaletteFit, HardTablesAreRefusedOrFinite) {
  EXPECT_THROW(fit_palette({"few", std::vector<Cell>(11, {"", 0.5, 0, {1, 0, 0}})}), std::invalid_argument);
  EXPECT_THROW(fit_palette({"one opacity", std::vector<Cell>(20, {"", 0.5, 0, {1, 0, 0}})}), std::invalid_argument);
  Table black = example_table(0, 1), white = black;
  for (Cell& cell : black.cells) cell.rgb = {0, 0, 0};
  for (Cell& cell : white.cells) cell.rgb = {4, 4, 4};
  for (const Table& table : {black, white})
    for (const double value : color_of(fit_palette(table).palette, 0.5, 600)) EXPECT_TRUE(std::isfinite(value));
}

TEST(BloodTable, TextReadsBackAndFaultsNameTheirLine) {
  const Table table = example_table(0.02, 1), again = table_of(text_of(table), "t.csv", Encoding::kSrgb);
  ASSERT_EQ(again.cells.size(), 36u);
  for (std::size_t k = 0; k < 36; ++k)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(again.cells[k].rgb[c], std::min(1.0, table.cells[k].rgb[c]), 1e-4);
  const auto message = [](const std::string& text) -> std::string {
    try {
      table_of(text, "t.csv", Encoding::kSrgb);
    } catch (const files::InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message("opacity,time_s,r,g,b\n0.5,0,256,0,0\n"), HasSubstr("t.csv:2: r = 256 is outside [0, 255]"));
  EXPECT_THAT(message("opacity,time_s,r,g,b\n1.5,0,25,0,0\n"), HasSubstr("opacity = 1.5"));
  EXPECT_THAT(message("opacity,time,r,g,b\n0.5,0,25,0,0\n"), HasSubstr("no column \"time_s\""));
}

}  // namespace
}  // namespace likeness::blood
