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

Rgb at(const Material& material, double theta_i_deg, double theta_o_deg, double phi_deg) {
  Direction l, v;
  directions_at(
      {theta_i_deg * std::numbers::pi / 180, theta_o_deg * std::numbers::pi / 180, phi_deg * std::numbers::pi / 180}, l,
      v);
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
  EXPECT_EQ(at(*material, 0.25 * 180 / std::numbers::pi, 0.5 * 180 / std::numbers::pi, 180).b, 3);
  EXPECT_THAT(message_of("theta_i,theta_o,phi,r,g,b\n30,30,0,1,1,1\n"),
              testing::StartsWith(
                  "own.csv:2: theta_i = 30.000000 rad; expected 0 to 1.5708; for degrees name the column theta_i_deg"));
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

// Least root of summed squared chords over the azimuth, by trying azimuths.
double distance_by_search(const Elevations& a, const Elevations& b) {
  Direction l, v, l2, v2;
  directions_at(a, l, v);
  directions_at(b, l2, v2);
  double best = 100;
  for (double psi = -std::numbers::pi; psi < std::numbers::pi; psi += 1e-3) {
    const double c = std::cos(psi), s = std::sin(psi);
    const Direction d = l - Direction(c * l2.x - s * l2.y, s * l2.x + c * l2.y, l2.z);
    const Direction e = v - Direction(c * v2.x - s * v2.y, s * v2.x + c * v2.y, v2.z);
    best = std::min(best, dot(d, d) + dot(e, e));
  }
  return std::sqrt(best);
}

TEST(Csv, ReachesAsFarAsTheMetricItStates) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  int near = 0;
  for (int i = 0; i < 400; ++i) {
    // theta_i and theta_o differ by more than the reach, so that the swapped pair is never near.
    const Elevations e{0.7 * unit(random), 0.9 + 0.6 * unit(random), std::numbers::pi * unit(random)};
    const auto off = [&](double x, double most) { return std::clamp(x + 0.16 * (unit(random) - 0.5), 0.0, most); };
    const Elevations q{off(e.theta_i, 1.5), off(e.theta_o, 1.5),
                       std::clamp(e.phi + 0.6 * (unit(random) - 0.5), 0.0, std::numbers::pi)};
    const double distance = distance_by_search(e, q);
    if (std::abs(distance - kCsvReach) < 1e-3) continue;  // the search's own step
    const auto material = parse_csv("theta_i,theta_o,phi,r,g,b\n" + std::to_string(e.theta_i) + "," +
                                        std::to_string(e.theta_o) + "," + std::to_string(e.phi) + ",1,1,1\n",
                                    "m");
    Direction l, v;
    directions_at(q, l, v);
    Rgb f;
    EXPECT_EQ(material->evaluate(l, v, f), distance < kCsvReach) << "distance " << distance;
    near += distance < kCsvReach;
  }
  EXPECT_GT(near, 50);
  EXPECT_LT(near, 350);
}

// The tree prunes nothing that a search through all samples would find.
TEST(Csv, TreeFindsWhatOneSampleAtATimeFinds) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  std::string rows[400];
  std::string all = "theta_i,theta_o,phi,r,g,b\n";
  const std::string header = all;
  for (std::string& row : rows) {
    row = std::to_string(1.5 * unit(random)) + "," + std::to_string(1.5 * unit(random)) + "," +
          std::to_string(std::numbers::pi * unit(random)) + ",1,1,1\n";
    all += row;
  }
  const auto together = parse_csv(all, "m");
  std::vector<std::unique_ptr<Material>> apart;
  for (const std::string& row : rows) apart.push_back(parse_csv(header + row, "m"));
  int found = 0;
  for (int i = 0; i < 500; ++i) {
    Direction l, v;
    directions_at({1.5 * unit(random), 1.5 * unit(random), std::numbers::pi * unit(random)}, l, v);
    Rgb f;
    const bool any = std::any_of(apart.begin(), apart.end(), [&](const auto& one) { return one->evaluate(l, v, f); });
    EXPECT_EQ(together->evaluate(l, v, f), any);
    found += any;
  }
  EXPECT_GT(found, 50);
  EXPECT_LT(found, 450);
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
  EXPECT_NEAR(sum("theta_i,theta_o,phi,r,g,b\n" + rows + "\n0.5,0.5,0.5,1,1,1\n"),
              4 * std::numbers::pi * std::numbers::pi,
              1e-5);  // float weights
  EXPECT_EQ(sum("theta_i,theta_o,phi,r,g,b,weight\n" + rows + ",0.25\n"), 0.25);
}

TEST(Csv, NamesTheLineOfWhatItRefuses) {
  const std::string header = "theta_i,theta_o,phi,r,g,b\n";
  EXPECT_THAT(message_of(header + "\n0,0,0,1,1\n"), testing::StartsWith("own.csv:3: 5 values; expected 6"));
  EXPECT_THAT(message_of(header + "0,0,0,1,1,1,1\n"), testing::StartsWith("own.csv:2: more than 6 values"));
  EXPECT_THAT(message_of(header + "0,0,0,1,x,1\n"),
              testing::StartsWith("own.csv:2: value \"x\" in column 5; expected a number"));
  EXPECT_THAT(message_of("theta_i,theta,phi,r,g,b\n"), testing::StartsWith("own.csv:1: column \"theta\""));
  EXPECT_THAT(message_of("theta_i,phi,r,g,b\n"), testing::HasSubstr("no column \"theta_o\""));
  EXPECT_THAT(message_of(header), testing::HasSubstr("no valid row among 0"));
  EXPECT_THAT(message_of(header + "0,0,0,nan,1,1\n0,0,0,-1,-1,-1\n"),
              testing::HasSubstr("among 2 (1 negative, 1 NaN or Inf)"));
  EXPECT_THAT(message_of(""), testing::HasSubstr("no header"));
}

}  // namespace
}  // namespace likeness::measured
