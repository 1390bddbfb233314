#include "brdf/eval/draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "brdf/evaluator.h"

namespace likeness::eval {
namespace {

using brdf::Parameter;
using brdf::Role;

// clang-format off
constexpr std::array kInputs{
    Parameter{.name = "light_x", .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "x"},
    Parameter{.name = "light_y", .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "y"},
    Parameter{.name = "light_z", .initial = 1, .range = {-1, 1}, .typical = {0, 1}, .role = Role::kDirection, .text = "z"},
    Parameter{.name = "view_x", .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "x"},
    Parameter{.name = "view_y", .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "y"},
    Parameter{.name = "view_z", .initial = 1, .range = {-1, 1}, .typical = {0, 1}, .role = Role::kDirection, .text = "z"},
    Parameter{.name = "theta", .range = {0, brdf::kHalfPi}, .typical = {0, 1}, .role = Role::kAngle, .text = "an angle"},
    Parameter{.name = "s", .initial = 1, .range = {1e-6, 1e6}, .typical = {0.1, 10}, .logarithmic = true, .text = "a scale"},
    Parameter{.name = "tenth", .initial = 0.2, .range = {0.1, 0.3}, .typical = {0.1, 0.2}, .text = "ends that no float has"},
    Parameter{.name = "color", .initial = 0.5, .range = {0, 1}, .typical = {0.1, 0.9}, .channels = 3, .text = "a color"}};
// clang-format on
constexpr std::size_t kCount = 12, kRows = 20000;

struct Drawn {
  std::vector<float> values = std::vector<float>(kCount * kRows);
  float at(std::size_t input, std::size_t row) const { return values[input * kRows + row]; }
};
Drawn draw(std::uint64_t seed) {
  Drawn drawn;
  std::vector<float*> columns;
  for (std::size_t i = 0; i < kCount; ++i) columns.push_back(drawn.values.data() + i * kRows);
  const Draw rows(kInputs);
  EXPECT_EQ(rows.count(), kCount);
  const std::uint64_t stream = stream_of(seed, "model");
  for (std::size_t row = 0; row < kRows; ++row) {
    Random random(stream, row);
    rows.row(random, columns.data(), row);
  }
  return drawn;
}

TEST(Draw, EveryInputLiesWithinItsRangeAfterRounding) {
  const Drawn drawn = draw(1);
  std::size_t at = 0;
  for (const Parameter& p : kInputs)
    for (int c = 0; c < p.channels; ++c, ++at)
      for (std::size_t row = 0; row < kRows; ++row) {
        ASSERT_GE(double{drawn.at(at, row)}, p.range.low) << p.name << " " << row;
        ASSERT_LE(double{drawn.at(at, row)}, p.range.high) << p.name << " " << row;
      }
}

// A row of 1e7 walks would take longer than all others, and find nothing that 1000 do not.
TEST(Draw, AskForNoMoreWorkThanIsUsual) {
  constexpr std::array kWalks{Parameter{.name = "walks",
                                        .initial = 10000,
                                        .range = {2, 1e7},
                                        .typical = {1e3, 1e5},
                                        .logarithmic = true,
                                        .text = "many"}};
  const Draw rows(kWalks);
  float least = 1e9f, most = 0, walks = 0;
  float* column = &walks;
  for (std::size_t row = 0; row < 2000; ++row) {
    Random random(1, row);
    rows.row(random, &column, 0);
    least = std::min(least, walks), most = std::max(most, walks);
  }
  EXPECT_EQ(least, 2);
  EXPECT_EQ(most, 1000);
}

TEST(Draw, DirectionsAreUnitToRounding) {
  const Drawn drawn = draw(2);
  for (const std::size_t first : {0u, 3u})
    for (std::size_t row = 0; row < kRows; ++row) {
      const double x = drawn.at(first, row), y = drawn.at(first + 1, row), z = drawn.at(first + 2, row);
      ASSERT_NEAR(std::sqrt(x * x + y * y + z * z), 1, 1e-7);  // three floats, each rounded to 6e-8
    }
}

// How often something happens among the rows.
template <class F>
double share(const Drawn& drawn, F&& happens) {
  std::size_t count = 0;
  for (std::size_t row = 0; row < kRows; ++row) count += happens([&](std::size_t i) { return drawn.at(i, row); });
  (void)drawn;
  return double(count) / kRows;
}

TEST(Draw, EveryEdgeIsMetOften) {
  const Drawn drawn = draw(3);
  const auto often = [&](const char* what, auto&& happens) { EXPECT_GT(share(drawn, happens), 0.002) << what; };
  often("low end", [](auto&& in) { return in(9) == 0; });
  often("high end", [](auto&& in) { return in(9) == 1; });
  often("default", [](auto&& in) { return in(9) == 0.5f; });
  often("1e-7 beside an end", [](auto&& in) { return in(9) > 0 && in(9) < 2e-7f; });
  often("beside the other end", [](auto&& in) { return in(9) < 1 && in(9) > 0.999999f; });
  often("decades of a logarithmic input", [](auto&& in) { return in(7) > 1e-5f && in(7) < 1e-4f; });
  often("light along the normal", [](auto&& in) { return in(2) == 1; });
  often("light in the surface", [](auto&& in) { return in(2) == 0; });
  often("light grazing", [](auto&& in) { return in(2) > 0 && in(2) < 2e-7f; });
  often("light below", [](auto&& in) { return in(2) < -0.01f; });
  often("identical", [](auto&& in) { return in(0) == in(3) && in(1) == in(4) && in(2) == in(5) && in(2) != 1; });
  often("mirrored", [](auto&& in) { return in(0) == -in(3) && in(1) == -in(4) && in(2) == in(5) && in(2) != 1; });
  often("opposite", [](auto&& in) { return in(0) == -in(3) && in(1) == -in(4) && in(2) == -in(5) && in(2) != 0; });
  often("nearly mirrored", [](auto&& in) {
    const float x = in(0) + in(3), y = in(1) + in(4), z = in(2) - in(5), d = x * x + y * y + z * z;
    return d > 0 && d < 1e-6f;
  });
  often("nothing on an edge", [](auto&& in) {
    for (const std::size_t i : {9, 10, 11})
      if (in(i) < 0.05f || in(i) > 0.95f || in(i) == 0.5f) return false;
    return in(2) > 0.05f && in(2) < 0.95f && in(5) > 0.05f && in(5) < 0.95f;
  });
}

TEST(Draw, TheSameSeedGivesTheSameRowsAndAnotherOneOthers) {
  EXPECT_EQ(draw(4).values, draw(4).values);
  EXPECT_NE(draw(4).values, draw(5).values);
  EXPECT_NE(stream_of(1, "a"), stream_of(1, "b"));
  EXPECT_NE(stream_of(1, "a"), stream_of(2, "a"));
}

TEST(Draw, TheFloatBesideLiesTowardsTheMiddle) {
  const Draw rows(kInputs);
  EXPECT_GT(rows.beside(9, 0), 0);
  EXPECT_LT(rows.beside(9, 1), 1);
  EXPECT_NE(rows.beside(9, 0.5f), 0.5f);
}

}  // namespace
}  // namespace likeness::eval
