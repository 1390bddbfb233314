#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "fit/measured/csv.h"
#include "render/files/files.h"
#include "tests/fit/measured_files.h"

namespace likeness::measured {
namespace {

using files::InputError;
constexpr double kPi = std::numbers::pi;

Rgb at(const Material& material, double theta_i_deg, double theta_o_deg, double phi_deg) {
  Direction l, v;
  directions_at({theta_i_deg * kPi / 180, theta_o_deg * kPi / 180, phi_deg * kPi / 180}, l, v);
  Rgb f(-1);
  material.evaluate(l, v, f);
  return f;
}

std::string message_of(const std::string& text) {
  try {
    parse_csv(text, "own.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Csv, ReadsDegreesCommentsRepeatsAndGaps) {
  const auto material = parse_csv(test::small_csv(), "m");
  const Coverage c = material->coverage();
  EXPECT_EQ(c.stored, 5u);
  EXPECT_EQ(c.valid, 3u);
  EXPECT_EQ(c.repeats, 1u);
  EXPECT_EQ(c.clipped, 1u);
  EXPECT_EQ(c.not_finite, 1u);
  EXPECT_EQ(at(*material, 30, 30, 180).r, 2) << "the mean of two rows";
  EXPECT_EQ(at(*material, 45, 60, 90).g, 0) << "phi is folded, the negative channel clipped";
  EXPECT_EQ(at(*material, 60, 45, 90).g, 0) << "by reciprocity";
  EXPECT_EQ(at(*material, 45, 75, 90).g, -1) << "out of reach: no value";
}

TEST(Csv, TakesRadiansUnlessTheHeaderSaysDegrees) {
  const auto material = parse_csv("phi,r,g,b,theta_o,theta_i\n3.14159265,1,2,3,0.5,0.25\n", "m");
  EXPECT_EQ(at(*material, 0.25 * 180 / kPi, 0.5 * 180 / kPi, 180).b, 3);
  EXPECT_THAT(message_of("theta_i,theta_o,phi,r,g,b\n30,30,0,1,1,1\n"),
              testing::StartsWith("own.csv:2: theta_i = 30.000000 rad; expected 0 to 1.5708; for degrees name the column theta_i_deg"));
}

TEST(Csv, DoesNotCareForTheOrderOfRows) {
  std::vector<std::string> rows;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 300; ++i) {
    std::string row;
    for (const double x : {1.4 * unit(random), 1.4 * unit(random), 3 * unit(random)}) row += std::to_string(x) + ",";
    rows.push_back(row + std::to_string(unit(random)) + ",1,1\n");
  }
  rows.push_back(rows[0].substr(0, rows[0].rfind(",1,1") - 8) + "0.123457,1,1\n");  // a repeat
  const auto text = [&] {
    std::string all = "theta_i,theta_o,phi,r,g,b\n";
    for (const std::string& row : rows) all += row;
    return all;
  };
  const auto one = parse_csv(text(), "m");
  std::shuffle(rows.begin(), rows.end(), random);
  const auto other = parse_csv(text(), "m");
  EXPECT_EQ(one->coverage().repeats, 1u);
  for (int i = 0; i < 500; ++i) {
    const double a = 80 * unit(random), b = 80 * unit(random), c = 180 * unit(random);
    EXPECT_EQ(at(*one, a, b, c).r, at(*other, a, b, c).r);
  }
}

// The tree finds what a search through all samples by rotated directions finds.
TEST(Csv, FindsTheNearestSampleInTheMetricItStates) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<std::array<Direction, 2>> pairs;
  std::string text = "theta_i,theta_o,phi,r,g,b\n";
  for (int i = 0; i < 2000; ++i) {
    const Elevations e{1.5 * unit(random), 1.5 * unit(random), 3.1 * unit(random)};
    Direction l, v;
    directions_at(e, l, v);
    pairs.push_back({l, v});
    text += std::to_string(e.theta_i) + "," + std::to_string(e.theta_o) + "," + std::to_string(e.phi) + "," + std::to_string(i) + ",0,0\n";
  }
  const auto material = parse_csv(text, "m");
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    // A small step away from a sample, whose nearest is still that sample.
    const std::size_t k = std::size_t(unit(random) * 2000);
    Elevations e = elevations(pairs[k][0], pairs[k][1]);
    e.phi = std::clamp(e.phi + 1e-4, 0.0, kPi);
    Direction l, v;
    directions_at(e, l, v);
    Rgb f;
    ASSERT_TRUE(material->evaluate(l, v, f));
    found += std::abs(f.r - double(k)) < 0.02 * double(k) + 2;
  }
  EXPECT_GE(found, 195);  // a few of the 200 have a second sample within 1e-3
}

TEST(Csv, PhiHasNoMeaningAtNormalIncidence) {
  const auto material = parse_csv("theta_i_deg,theta_o_deg,phi_deg,r,g,b\n0,40,0,1,2,3\n", "m");
  EXPECT_EQ(at(*material, 0, 40, 120).g, 2);
}

TEST(Csv, WeightsAddUpToTwoPiSquaredWithoutAColumnAndAreKeptWithOne) {
  const auto sum = [](const std::string& text) {
    double total = 0;
    parse_csv(text, "m")->for_each_sample([&](const Sample& s) { total += s.weight; });
    return total;
  };
  const std::string rows = "0.1,0.2,0.3,1,1,1";
  EXPECT_NEAR(sum("theta_i,theta_o,phi,r,g,b\n" + rows + "\n0.5,0.5,0.5,1,1,1\n"), 4 * kPi * kPi, 1e-5);  // float weights
  EXPECT_EQ(sum("theta_i,theta_o,phi,r,g,b,weight\n" + rows + ",0.25\n"), 0.25);
}

TEST(Csv, NamesTheLineOfWhatItRefuses) {
  const std::string header = "theta_i,theta_o,phi,r,g,b\n";
  EXPECT_THAT(message_of(header + "\n0,0,0,1,1\n"), testing::StartsWith("own.csv:3: 5 values; expected 6"));
  EXPECT_THAT(message_of(header + "0,0,0,1,1,1,1\n"), testing::StartsWith("own.csv:2: more than 6 values"));
  EXPECT_THAT(message_of(header + "0,0,0,1,x,1\n"), testing::StartsWith("own.csv:2: value \"x\" in column 5; expected a number"));
  EXPECT_THAT(message_of("theta_i,theta,phi,r,g,b\n"), testing::StartsWith("own.csv:1: column \"theta\""));
  EXPECT_THAT(message_of("theta_i,phi,r,g,b\n"), testing::HasSubstr("no column \"theta_o\""));
  EXPECT_THAT(message_of(header), testing::HasSubstr("no valid row among 0"));
  EXPECT_THAT(message_of(header + "0,0,0,nan,1,1\n0,0,0,-1,-1,-1\n"), testing::HasSubstr("among 2 (1 negative, 1 NaN or Inf)"));
  EXPECT_THAT(message_of(""), testing::HasSubstr("no header"));
}

}  // namespace
}  // namespace likeness::measured
