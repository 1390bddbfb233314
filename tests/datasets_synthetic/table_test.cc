#include "datasets_synthetic/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <map>
#include <sstream>
#include <tuple>

#include "fit/measured/csv.h"
#include "fit/measured/mbsdf.h"
#include "fit/measured/merl.h"

namespace likeness::datasets_synthetic {
namespace {

using measured::Format;

// Every term of Callisto at work, and not symmetric in light and view.
brdf::AnyBrdf lively() {
  brdf::Callisto<double> c;
  c.base_color = {0.5, 0.2, 0.1};
  c.roughness = 0.3;
  c.diffuse_fresnel = 3;
  c.retroreflection = 2;
  c.smooth_terminator = 0.7;
  c.dual_specular_opacity = 0.4;
  return c;
}

brdf::Rgb<double> value(const brdf::AnyBrdf& brdf, const brdf::Geometry<double>& g) {
  return std::visit([&](const auto& model) { return model.eval(g); }, brdf);
}

TEST(Table, MerlHoldsTheEvaluatorAtEveryBinCenter) {
  const brdf::AnyBrdf brdf = lively();
  const auto merl = measured::parse_merl(bytes_of(tabulate(brdf, grid_of(Format::kMerl, 0, 0))), "made");
  std::size_t valid = 0;
  for (int i = 0; i < 90; ++i)
    for (int j = 0; j < 90; ++j)
      for (int k = 0; k < 180; ++k) {
        const auto at = measured::merl_bin_centre({}, i, j, k);
        const auto g = brdf::geometry_at(at.theta_h, at.theta_d, at.phi_d);
        measured::Rgb f;
        const bool has_value = merl->value((std::size_t(i) * 90 + std::size_t(j)) * 180 + std::size_t(k), f);
        ASSERT_EQ(has_value, g.above) << i << ' ' << j << ' ' << k;
        if (!has_value) continue;
        ++valid;
        const auto truth = value(brdf, g);
        // 1e-11: two roundings of storing, and those of the center's angle, which the sharp peak enlarges.
        ASSERT_NEAR(f.r, truth.r, 1e-11 * truth.r) << i << ' ' << j << ' ' << k;
        ASSERT_NEAR(f.g, truth.g, 1e-11 * truth.g) << i << ' ' << j << ' ' << k;
        ASSERT_NEAR(f.b, truth.b, 1e-11 * truth.b) << i << ' ' << j << ' ' << k;
      }
  EXPECT_EQ(merl->coverage().valid, valid);
  EXPECT_NEAR(double(valid) / 1458000, 0.75, 0.005);  // fit.md: 'about 25 % of bins' are below the horizon
}

TEST(Table, MbsdfHoldsTheEvaluatorRoundedToFloat) {
  const brdf::AnyBrdf brdf = lively();
  const auto mbsdf = measured::parse_mbsdf(bytes_of(tabulate(brdf, grid_of(Format::kMbsdf, 12, 20))), "made");
  EXPECT_EQ(mbsdf->coverage().valid, 12u * 12 * 20);
  std::size_t seen = 0;
  mbsdf->for_each_sample([&](const measured::Sample& sample) {
    ++seen;
    const auto truth = value(brdf, {sample.to_light, sample.to_view});
    // Half a float ulp is 6e-8 relative; the directions are the same to 1e-15.
    EXPECT_NEAR(sample.f.r, truth.r, 6e-8 * truth.r);
    EXPECT_NEAR(sample.f.g, truth.g, 6e-8 * truth.g);
    EXPECT_NEAR(sample.f.b, truth.b, 6e-8 * truth.b);
  });
  EXPECT_EQ(seen, 12u * 12 * 20);
}

TEST(Table, CsvHoldsTheEvaluatorToTheLastBit) {
  const brdf::AnyBrdf brdf = lively();
  std::istringstream text(bytes_of(tabulate(brdf, grid_of(Format::kCsv, 6, 8))));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "theta_i_deg,theta_o_deg,phi_deg,r,g,b");
  std::size_t rows = 0;
  while (std::getline(text, line)) {
    double theta_i, theta_o, phi, r, g, b;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", &theta_i, &theta_o, &phi, &r, &g, &b), 6);
    const Grid grid = grid_of(Format::kCsv, 6, 8);
    const auto truth = value(brdf, geometry_of(grid, int(theta_i / 15), int(theta_o / 15), int(phi / 22.5)));
    EXPECT_EQ(theta_i, 15 * (int(theta_i / 15) + 0.5));
    EXPECT_EQ(std::tuple(r, g, b), std::tuple(truth.r, truth.g, truth.b)) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 6u * 6 * 8);
}

TEST(Table, CsvIsReadBackWhole) {
  const brdf::AnyBrdf brdf = lively();
  const auto csv = measured::parse_csv(bytes_of(tabulate(brdf, grid_of(Format::kCsv, 8, 12))), "made");
  EXPECT_EQ(csv->coverage().valid, 8u * 8 * 12);
  csv->for_each_sample([&](const measured::Sample& sample) {
    const auto truth = value(brdf, {sample.to_light, sample.to_view});
    // The reader keeps angles in float, 1e-7 of a radian, and the lobe (alpha 0.09) changes by 2 / alpha a radian.
    EXPECT_NEAR(sample.f.g, truth.g, 1e-5 * truth.g);
  });
}

TEST(Table, DoesNotDependOnTheNumberOfThreads) {
  for (const Format format : {Format::kMerl, Format::kMbsdf, Format::kCsv}) {
    const Grid grid = grid_of(format, 10, 14);
    const std::string one = bytes_of(tabulate(lively(), grid, 1));
    EXPECT_EQ(one, bytes_of(tabulate(lively(), grid, 3))) << std::string(measured::kFormatNames[std::size_t(format)]);
  }
}

TEST(Table, MarksWhatWasNotMeasured) {
  const Grid grid = grid_of(Format::kMbsdf, 4, 4);
  Table table = tabulate(lively(), grid);
  table.state[5] = State::kInvalid;
  table.f[1][7] = std::numeric_limits<double>::quiet_NaN();
  table.state[7] = State::kNotFinite;
  const auto coverage = measured::parse_mbsdf(bytes_of(table), "made")->coverage();
  EXPECT_EQ(coverage.negative, 1u);
  EXPECT_EQ(coverage.not_finite, 1u);
  table.grid.format = Format::kCsv;
  const std::string text = bytes_of(table);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 64 - 1);  // heading, 64 samples, one left out
  EXPECT_THAT(text, testing::HasSubstr(",nan,"));
}

TEST(Table, MirrorDirectionsLieAtPhi180) {
  const Grid grid = grid_of(Format::kMbsdf, 9, 30);
  const auto mirror = geometry_of(grid, 4, 4, 29), back = geometry_of(grid, 4, 4, 0);
  EXPECT_GT(mirror.cos_h, 0.999);  // half a bin of phi, 3 degrees, from the mirror direction
  EXPECT_GT(back.cos_d, 0.999);    // as far from looking back into the light
}

}  // namespace
}  // namespace likeness::datasets_synthetic
