#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "render/blood/drops.h"
#include "render/blood/raster.h"

namespace likeness::blood {
namespace {

double sum_of(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum;
}

// The axis ratio, and the turn of the longer one against the right, of a coverage by its second moments.
struct Moments {
  double ratio, turn, area;
};
Moments moments_of(const std::vector<float>& coverage, int size) {
  double m = 0, mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto w = static_cast<double>(coverage[static_cast<std::size_t>(y * size + x)]);
      m += w, mx += w * x, my -= w * y;
    }
  mx /= m, my /= m;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto w = static_cast<double>(coverage[static_cast<std::size_t>(y * size + x)]);
      xx += w * (x - mx) * (x - mx) / m, yy += w * (-y - my) * (-y - my) / m, xy += w * (x - mx) * (-y - my) / m;
    }
  const double middle = 0.5 * (xx + yy), half = std::hypot(0.5 * (xx - yy), xy);
  return {std::sqrt((middle - half) / (middle + half)), 0.5 * std::atan2(2 * xy, xx - yy), m};
}

TEST(Drops, DragOfASphereIsThatOfStokesWhenSlow) {
  // 10 um at 1 mm/s: of the stopping distance v d^2 rho / (18 mu), 0.33 um, a third.
  EXPECT_NEAR(speed_after(1e-3, 0.01, 1e-7) / 1e-3, 1 - 1e-7 / (1e-3 * 1e-10 * kBloodDensity / (18 * kAirViscosity)),
              0.02);
  // And falls at d^2 rho g / (18 mu) = 3.2 mm/s.
  EXPECT_NEAR(falling_speed(0.01), 1e-10 * kBloodDensity * 9.81 / (18 * kAirViscosity), 1e-4);
  // A drop of 4.5 mm falls at about 8 to 10 m/s (Bevel and Gardner: 7.6).
  EXPECT_GT(falling_speed(4.5), 7);
  EXPECT_LT(falling_speed(4.5), 13);
}

TEST(Drops, SmallOnesAreStoppedFirst) {
  double before = 0;
  for (double diameter = 0.01; diameter < 5; diameter *= 1.3) {
    const double left = speed_after(50, diameter, 0.5);
    EXPECT_GE(left, before) << diameter;
    before = left;
  }
  EXPECT_EQ(speed_after(50, 1, 0), 50);
  EXPECT_LT(speed_after(50, 1, 1), speed_after(50, 1, 0.5));
}

TEST(Drops, WidthsOfPerpendicularStainsAreThoseOfTheirClass) {
  constexpr std::array<std::array<double, 2>, 3> kWidths{{{4, 1e9}, {1, 4}, {0, 1}}};
  for (const SpeedRow& row : kSpeeds) {
    const Spatter spatter = spatter_of({.speed = row.speed, .distance = 0, .drops = 500});
    int counted = 0;
    for (const Drop& drop : spatter.drops) {
      if (drop.part == Part::kMist) continue;
      ++counted;
      const auto& range = kWidths[static_cast<std::size_t>(row.speed)];
      EXPECT_LE(drop.width, range[1] * 1.0001) << row.name;
      // A drop that comes in aslant spreads by the part of its speed that is across the surface.
      if (drop.angle_deg > 80) {
        EXPECT_GE(drop.width, range[0] * 0.98) << row.name;
      }
      EXPECT_GE(drop.velocity, row.velocity[0] * 0.999);
      EXPECT_LE(drop.velocity, row.velocity[1] * 1.001);
    }
    EXPECT_GT(counted, 100);
  }
}

TEST(Drops, TheAngleIsThatOfTheAxisRatio) {
  for (const double angle : {90.0, 60.0, 30.0, 15.0, 5.0}) {
    const Spatter spatter = spatter_of({.speed = Speed::kLow, .distance = 1, .angle_deg = angle, .drops = 300});
    double sum = 0;
    for (const Drop& drop : spatter.drops) {
      EXPECT_NEAR(drop.width / drop.length, std::sin(drop.angle_deg * std::numbers::pi / 180), 1e-12);
      sum += drop.angle_deg / static_cast<double>(spatter.drops.size());
    }
    EXPECT_NEAR(sum, angle, angle == 90 ? 6 : 3) << "about the axis";
  }
}

TEST(Raster, MomentsOfAStainGiveItsAngleBack) {
  for (const double angle : {90.0, 45.0, 20.0, 8.0})
    for (const double turn : {0.0, 0.7, std::numbers::pi / 2, -1.2}) {
      Drop drop;
      drop.width = 10, drop.angle_deg = angle, drop.turn = turn, drop.diameter = 4, drop.spines = 24;
      drop.length = drop.width / std::sin(angle * std::numbers::pi / 180);
      const Decal decal = decal_of({1, 0, {drop}}, 400, 100);
      const Moments moments = moments_of(decal.coverage[0], 400);
      EXPECT_NEAR(std::asin(std::min(1.0, moments.ratio)) * 180 / std::numbers::pi, angle, angle == 90 ? 5 : 0.6)
          << turn;
      EXPECT_NEAR(moments.area / 16, std::numbers::pi / 4 * drop.width * drop.length, 0.02 * moments.area / 16)
          << "4 pixels a mm";
      if (angle < 90) {
        EXPECT_NEAR(std::abs(std::remainder(moments.turn - turn, std::numbers::pi)), 0, 0.02);
      }
      // Its volume is that of the drop.
      EXPECT_NEAR(sum_of(decal.thickness[0]) / 16, std::numbers::pi / 6 * 64, 0.03 * std::numbers::pi / 6 * 64);
    }
}

TEST(Raster, SmallStainsKeepTheirArea) {
  Drop drop;
  drop.width = 0.1, drop.length = 0.2, drop.diameter = 0.05;
  const Decal decal = decal_of({1, 0, {drop}}, 50, 50);
  EXPECT_NEAR(sum_of(decal.coverage[0]), std::numbers::pi / 4 * 0.02, 1e-6);
}

TEST(Spatter, TheSameSeedGivesTheSameBytes) {
  SpatterOptions options{.speed = Speed::kHigh, .distance = 0.5, .drops = 400, .seed = 9};
  const Decal a = decal_of(spatter_of(options), 64, 300), b = decal_of(spatter_of(options), 64, 300);
  EXPECT_EQ(a.coverage, b.coverage);
  EXPECT_EQ(a.thickness, b.thickness);
  options.seed = 10;
  EXPECT_NE(decal_of(spatter_of(options), 64, 300).coverage, a.coverage);
}

TEST(Spatter, MistAndArrivalsFallWithDistance) {
  double share_before = 2;
  std::size_t before = 1u << 30;
  for (const double distance : {0.0, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 10.0}) {
    const Spatter spatter = spatter_of({.speed = Speed::kHigh, .distance = distance});
    std::size_t mist = 0;
    for (const Drop& drop : spatter.drops) mist += drop.part == Part::kMist ? 1 : 0;
    const double share =
        spatter.drops.empty() ? 0 : static_cast<double>(mist) / static_cast<double>(spatter.drops.size());
    EXPECT_LE(share, share_before) << distance;
    EXPECT_LE(spatter.drops.size(), before) << distance;
    if (distance == 0.0) {
      EXPECT_NEAR(share, 0.6, 0.05);
    }
    if (distance >= 1.6) {
      EXPECT_EQ(mist, 0u) << "it flies some decimetres";
    }
    share_before = share, before = spatter.drops.size();
  }
}

TEST(Spatter, MoreDropsCoverMore) {
  double before = -1;
  for (const int drops : {0, 10, 100, 1000}) {
    const double covered = sum_of(decal_of(spatter_of({.distance = 0.3, .drops = drops}), 128, 250).all_coverage());
    EXPECT_GT(covered, before) << drops;
    before = covered;
  }
}

TEST(Spatter, WallsDripAndFloorsDoNot) {
  SpatterOptions options{.speed = Speed::kLow, .distance = 0.3, .drops = 60};
  EXPECT_GT(sum_of(decal_of(spatter_of(options), 128, 200).coverage[static_cast<std::size_t>(Part::kDrips)]), 0);
  options.is_wall = false;
  EXPECT_EQ(sum_of(decal_of(spatter_of(options), 128, 200).coverage[static_cast<std::size_t>(Part::kDrips)]), 0);
}

TEST(Spatter, HardCasesAreFinite) {
  for (const SpeedRow& row : kSpeeds)
    for (const double angle : {90.0, 5.0})
      for (const double distance : {0.0, 1e-9, 20.0})
        for (const int size : {1, 33}) {
          const Decal decal =
              decal_of(spatter_of({.speed = row.speed, .distance = distance, .angle_deg = angle, .drops = 50}), size,
                       size == 1 ? 0.01 : 1e6);
          for (const auto* layers : {&decal.coverage, &decal.thickness})
            for (const auto& layer : *layers)
              for (const float value : layer) ASSERT_TRUE(std::isfinite(value) && value >= 0);
          for (const float value : decal.all_coverage()) ASSERT_LE(value, 1);
          for (const float value : preview_of(decal, 0).rgb) ASSERT_TRUE(value >= 0 && value <= 1);
        }
  EXPECT_TRUE(spatter_of({.drops = 0}).drops.empty());
}

}  // namespace
}  // namespace likeness::blood
