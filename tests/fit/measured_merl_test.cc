#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "fit/measured/merl.h"
#include "render/files/files.h"
#include "tests/fit/measured_files.h"

namespace likeness::measured {
namespace {

using files::InputError;
using test::kSmallMerl;

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

// Each channel of each bin holds a number of its own, so that no two lookups can be confused.
std::string numbered(MerlSize size) {
  std::vector<Rgb> table(size.bins());
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = {1 + double(i), 2 + 2 * double(i), 3 + 3 * double(i)};
  return merl_bytes(table, size);
}

TEST(Merl, LooksEveryBinCentreUpInItsOwnBin) {
  const MerlSize size;
  const auto merl = parse_merl(numbered(size), "m");
  std::size_t wrong = 0, seen = 0;
  for (int h = 0; h < 90; ++h)
    for (int d = 0; d < 90; ++d)
      for (int p = 0; p < 180; ++p) {
        const HalfAngles a = merl_bin_centre(size, h, d, p);
        const auto g = brdf::geometry_at(a.theta_h, a.theta_d, a.phi_d);
        Rgb f;
        if (!g.above || !merl->evaluate(g.to_light, g.to_view, f)) continue;
        ++seen;
        const double want = 1 + double((h * 90 + d) * 180 + p);
        wrong += std::abs(f.r - want) > 1e-9 * want;  // stored as f / scale: two roundings
      }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(seen, 1'000'000u);
}

TEST(Merl, SpacesThetaHBySquareRoot) {
  const auto merl = parse_merl(numbered({}), "m");
  EXPECT_EQ(merl->bin({88.1 * std::numbers::pi / 180, 0, 0}) / 16200, 89u);  // bin 89 spans 88.01 to 90 degrees
  EXPECT_EQ(merl->bin({87.9 * std::numbers::pi / 180, 0, 0}) / 16200, 88u);
  EXPECT_EQ(merl->bin({22.4 * std::numbers::pi / 180, 0, 0}) / 16200, 44u);  // half of the bins lie below 22.5 degrees
  EXPECT_EQ(merl->bin({22.6 * std::numbers::pi / 180, 0, 0}) / 16200, 45u);
}

TEST(Merl, ScalesChannelsAsThePaperDoes) {
  std::string bytes = test::small_merl();
  const std::size_t plane = kSmallMerl.bins() * 8;
  for (const std::size_t channel : {0, 1, 2}) {
    const double stored = 1500;
    std::memcpy(bytes.data() + 12 + plane * channel, &stored, 8);
  }
  Rgb f;
  ASSERT_TRUE(parse_merl(bytes, "m", kSmallMerl)->value(0, f));
  EXPECT_DOUBLE_EQ(f.r, 1.0);
  EXPECT_DOUBLE_EQ(f.g, 1.15);
  EXPECT_DOUBLE_EQ(f.b, 1.66);
}

TEST(Merl, IsReciprocalBecausePhiDIsTakenModuloPi) {
  const auto merl = parse_merl(test::small_merl({90, 90, 180}), "m");
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 10000; ++i) {
    Direction l, v;
    directions_at({1.5 * unit(random), 1.5 * unit(random), 3.1 * unit(random)}, l, v);
    Rgb f, g;
    const bool there = merl->evaluate(l, v, f), back = merl->evaluate(v, l, g);
    ASSERT_EQ(there, back);
    if (there) {
      ASSERT_EQ(f.r, g.r) << "sample " << i;
    }
  }
}

TEST(Merl, WeightsOfAllPairsAboveTheHorizonAddUpToTwoPiSquared) {
  const auto merl = parse_merl(test::small_merl({90, 90, 180}), "m");
  double total = 0, lambert = 0;
  merl->for_each_sample([&](const Sample& s) {
    total += s.weight;
    lambert += s.weight * s.to_light.z * s.to_view.z / std::numbers::pi;
    ASSERT_GT(s.weight, 0);
  });
  EXPECT_NEAR(total / (4 * std::numbers::pi * std::numbers::pi), 1,
              5e-4);  // bins that the horizon cuts count whole or not: 1e-4 measured
  EXPECT_NEAR(lambert / std::numbers::pi, 1,
              5e-4);  // integral of cos cos / pi = pi: the density is right, not only its sum
}

TEST(Merl, DropsABinThatIsNegativeInOneChannelAndCountsNaN) {
  std::string bytes = test::small_merl();
  const auto before = parse_merl(bytes, "m", kSmallMerl)->coverage();
  const double negative = -0.5, nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  std::memcpy(bytes.data() + 12 + kSmallMerl.bins() * 8, &negative, 8);   // bin 0, green
  std::memcpy(bytes.data() + 12 + 8, &nan, 8);                            // bin 1, red
  std::memcpy(bytes.data() + 12 + kSmallMerl.bins() * 16 + 16, &inf, 8);  // bin 2, blue
  const auto merl = parse_merl(bytes, "m", kSmallMerl);
  EXPECT_EQ(merl->coverage().negative, before.negative + 1);
  EXPECT_EQ(merl->coverage().not_finite, 2u);
  EXPECT_EQ(merl->coverage().valid, before.valid - 3);
  for (const std::size_t bin : {0, 1, 2}) {
    Rgb f{7, 7, 7};
    EXPECT_FALSE(merl->value(bin, f));
    EXPECT_EQ(f.r, 7) << "f is untouched";
  }
}

TEST(Merl, RefusesAFileOneByteShortOrLong) {
  const std::string bytes = test::small_merl();
  EXPECT_THAT(message_of([&] { parse_merl(bytes.substr(0, bytes.size() - 1), "a.binary", kSmallMerl); }),
              testing::AllOf(testing::StartsWith("a.binary: 1739 bytes"), testing::HasSubstr("1740"),
                             testing::HasSubstr("cut short")));
  EXPECT_THAT(message_of([&] { parse_merl(bytes + "x", "a.binary", kSmallMerl); }), testing::HasSubstr("too long"));
}

TEST(Merl, RefusesOtherDimensionsAndNamesThem) {
  EXPECT_THAT(message_of([&] { parse_merl(test::small_merl(), "a.binary"); }),
              testing::AllOf(testing::HasSubstr("4 x 3 x 6"), testing::HasSubstr("90 x 90 x 180")));
}

TEST(Merl, RefusesATableWithoutAValidBin) {
  EXPECT_THAT(message_of([&] {
                parse_merl(merl_bytes(std::vector<Rgb>(kSmallMerl.bins(), Rgb(-1)), kSmallMerl), "a.binary",
                           kSmallMerl);
              }),
              testing::HasSubstr("no valid bin among 72 (72 negative"));
}

TEST(HalfAngles, InvertGeometryAt) {
  for (const double h : {1e-7, 0.01, 0.5, 1.2})
    for (const double d : {1e-7, 0.3, 1.1})
      for (const double p : {0.1, 1.5, 3.1}) {
        const auto g = brdf::geometry_at(h, d, p);
        const HalfAngles a = half_angles(g.to_light, g.to_view);
        EXPECT_NEAR(a.theta_h, h, 1e-15);  // a rounding of the unit vectors
        EXPECT_NEAR(a.theta_d, d, 1e-15);
        EXPECT_NEAR(a.phi_d, p, 1e-14 + 1e-15 / std::min(h, d));  // its lever is 1 / sin
      }
}

}  // namespace
}  // namespace likeness::measured
