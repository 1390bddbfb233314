#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/light/profile.h"

namespace likeness::light {
namespace {

// The direction at type C's angles for a lamp that hangs (nadir -y) with its 0 degree plane towards +x; 90 degrees is
// towards -z, which is counter-clockwise seen from above.
glm::vec3 type_c(double vertical_deg, double horizontal_deg) {
  const double v = vertical_deg * std::numbers::pi / 180, h = horizontal_deg * std::numbers::pi / 180;
  return {std::sin(v) * std::cos(h), -std::cos(v), -std::sin(v) * std::sin(h)};
}
float intensity(const scene::Profile& p, const glm::vec3& d) {
  return relative_intensity(p, largest_candela(p), {0, -1, 0}, {1, 0, 0}, d);
}

TEST(Profile, OfOnePlaneIsABodyOfRevolution) {
  const scene::Profile p{"", scene::Profile::Type::kC, {0, 30, 90}, {0}, {100, 50, 10}};
  EXPECT_EQ(largest_candela(p), 100);
  for (const double h : {0.0, 45.0, 133.0, 359.0}) {
    EXPECT_NEAR(intensity(p, type_c(0, h)), 1, 1e-5);
    EXPECT_NEAR(intensity(p, type_c(15, h)), 0.75, 1e-5);
    EXPECT_NEAR(intensity(p, type_c(30, h)), 0.5, 1e-5);
    EXPECT_NEAR(intensity(p, type_c(60, h)), 0.3, 1e-5);
    EXPECT_NEAR(intensity(p, type_c(89.9, h)), (10 + 40 * 0.1 / 60) / 100, 1e-4);
    EXPECT_EQ(intensity(p, type_c(91, h)), 0);  // beyond what was measured
    EXPECT_EQ(intensity(p, type_c(180, h)), 0);
  }
}

// Type C with all planes: each value by hand.
TEST(Profile, OfTypeCIsBilinearInItsAngles) {
  const scene::Profile p{"",
                         scene::Profile::Type::kC,
                         {0, 90, 180},
                         {0, 90, 180, 270, 360},
                         {8, 2, 1, 8, 4, 1, 8, 6, 1, 8, 7, 1, 8, 2, 1}};
  const auto at = [&](double v, double h) { return intensity(p, type_c(v, h)) * 8; };
  EXPECT_NEAR(at(90, 0), 2, 1e-4);
  EXPECT_NEAR(at(90, 90), 4, 1e-4);
  EXPECT_NEAR(at(90, 180), 6, 1e-4);
  EXPECT_NEAR(at(90, 270), 7, 1e-4);
  EXPECT_NEAR(at(90, 45), 3, 1e-4);
  EXPECT_NEAR(at(90, 225), 6.5, 1e-4);
  EXPECT_NEAR(at(90, 315), 4.5, 1e-4);  // towards 360 again
  EXPECT_NEAR(at(45, 45), 5.5, 1e-4);
  EXPECT_NEAR(at(135, 180), 3.5, 1e-4);
  EXPECT_NEAR(at(0, 77), 8, 1e-4);
  EXPECT_NEAR(at(180, 77), 1, 1e-4);
}

TEST(Profile, HalvesAndQuartersAreMirrored) {
  const scene::Profile half{"", scene::Profile::Type::kC, {0, 90}, {0, 90, 180}, {8, 2, 8, 4, 8, 6}};
  const scene::Profile quarter{"", scene::Profile::Type::kC, {0, 90}, {0, 90}, {8, 2, 8, 4}};
  const auto of_half = [&](double h) { return intensity(half, type_c(90, h)) * 8; };
  const auto of_quarter = [&](double h) { return intensity(quarter, type_c(90, h)) * 8; };
  EXPECT_NEAR(of_half(135), 5, 1e-4);
  EXPECT_NEAR(of_half(225), 5, 1e-4);
  EXPECT_NEAR(of_half(270), 4, 1e-4);
  EXPECT_NEAR(of_half(300), 2 + 2 * 60.0 / 90, 1e-4);
  EXPECT_NEAR(of_quarter(30), 2 + 2 * 30.0 / 90, 1e-4);
  EXPECT_NEAR(of_quarter(150), 2 + 2 * 30.0 / 90, 1e-4);
  EXPECT_NEAR(of_quarter(210), 2 + 2 * 30.0 / 90, 1e-4);
  EXPECT_NEAR(of_quarter(330), 2 + 2 * 30.0 / 90, 1e-4);
  EXPECT_NEAR(of_quarter(180), 2, 1e-4);
}

// Type B: a flood light that is aimed along the axis. Its vertical angle turns about the horizontal axis, towards the 0
// degree direction; the horizontal one is what is left, a latitude about that axis.
TEST(Profile, OfTypeBHasItsPolesAtTheSides) {
  const scene::Profile p{"", scene::Profile::Type::kB, {-90, 0, 90}, {-90, 0, 90}, {1, 2, 3, 4, 10, 6, 7, 8, 9}};
  const glm::vec3 axis{0, 0, -1}, zero{0, 1, 0}, aside = glm::cross(zero, axis);
  const auto at = [&](double v, double h) {
    const double a = v * std::numbers::pi / 180, b = h * std::numbers::pi / 180;
    const glm::vec3 d = static_cast<float>(std::cos(b) * std::cos(a)) * axis +
                        static_cast<float>(std::cos(b) * std::sin(a)) * zero + static_cast<float>(std::sin(b)) * aside;
    return relative_intensity(p, largest_candela(p), axis, zero, d) * 10;
  };
  EXPECT_NEAR(at(0, 0), 10, 1e-4);
  EXPECT_NEAR(at(90, 0), 6, 1e-4);
  EXPECT_NEAR(at(-90, 0), 4, 1e-4);
  EXPECT_NEAR(at(0, 89.99), 8, 1e-2);
  EXPECT_NEAR(at(0, -89.99), 2, 1e-2);
  EXPECT_NEAR(at(45, 0), 8, 1e-4);
  EXPECT_NEAR(at(0, 45), 9, 1e-4);
  EXPECT_NEAR(at(45, 45), 0.25 * (10 + 6 + 8 + 9), 1e-4);
  EXPECT_NEAR(at(-45, -45), 0.25 * (10 + 4 + 2 + 1), 1e-4);
  EXPECT_EQ(at(135, 0), 0);  // behind
  EXPECT_EQ(at(180, 0), 0);
}

TEST(Profile, IsFiniteForEveryDirectionAndDarkIfItIsDark) {
  const scene::Profile c{"", scene::Profile::Type::kC, {0, 90}, {0, 90}, {8, 2, 8, 4}};
  const scene::Profile b{"", scene::Profile::Type::kB, {-90, 0, 90}, {-90, 0, 90}, {1, 2, 3, 4, 10, 6, 7, 8, 9}};
  const scene::Profile dark{"", scene::Profile::Type::kC, {0, 90}, {0}, {0, 0}};
  for (int i = 0; i < 8; ++i)
    for (const float z : {-1.0000001f, -1.0f, 0.0f, 1.0f}) {
      const glm::vec3 d{i % 2 ? 1e-20f : 0, z, i / 4 ? -1e-20f : 0.0f};
      for (const auto& p : {c, b, dark}) {
        const float x = intensity(p, d);
        EXPECT_TRUE(x >= 0 && x <= 1) << x;
      }
      EXPECT_EQ(intensity(dark, d), 0);
    }
}

}  // namespace
}  // namespace likeness::light
