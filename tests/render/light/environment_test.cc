#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/light/environment.h"
#include "render/sampling/sobol.h"
#include "tests/brdf/chi_square.h"

namespace likeness::light {
namespace {

using brdf::chi_square;
using brdf::sidak;

// A picture whose texels are what `value` says of a column and a row.
template <class F>
scene::Scene scene_of(int width, int height, F&& value) {
  scene::Scene scene;
  scene::Image image{"sky", {width, height, 3, {}, {}}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec3 c = value(x, y);
      image.texels.floats.insert(image.texels.floats.end(), {c.r, c.g, c.b});
    }
  scene.images.push_back(image);
  scene.environment = scene::Environment{0, {1, 1, 1}, 0};
  return scene;
}
scene::Scene sun(int width, int height, int at_x, int at_y, float low = 0.1f) {
  return scene_of(width, height, [&](int x, int y) { return glm::vec3(x == at_x && y == at_y ? 1000.0f : low); });
}
Environment environment_of(const scene::Scene& scene) { return Environment(scene, *scene.environment); }

TEST(Environment, MiddleColumnIsAheadItsRightNeighborToTheRightAndTheTopAbove) {
  const auto scene = scene_of(9, 5, [](int x, int y) { return glm::vec3(x, y, 1); });
  const Environment e = environment_of(scene);
  EXPECT_NEAR(e.radiance({0, 0, -1}).r, 4, 1e-5);
  EXPECT_NEAR(e.radiance({0, 0, -1}).g, 2, 1e-5);
  const float a = static_cast<float>(2 * std::numbers::pi / 9);
  EXPECT_NEAR(e.radiance({std::sin(a), 0, -std::cos(a)}).r, 5, 1e-5);
  EXPECT_NEAR(e.radiance({-std::sin(a), 0, -std::cos(a)}).r, 3, 1e-5);
  EXPECT_NEAR(e.radiance({0, 1, 0}).g, 0, 1e-5);
  EXPECT_NEAR(e.radiance({0, -1, 0}).g, 4, 1e-5);
  EXPECT_NEAR(e.radiance({1, 0, 0}).r, 4 + 9.0 / 4, 1e-5);
  // Behind, the picture's ends meet: halfway between columns 8 and 0.
  EXPECT_NEAR(e.radiance({0, 0, 1}).r, 4, 1e-4);
}

TEST(Environment, TurnsCounterClockwiseSeenFromAbove) {
  auto scene = scene_of(9, 5, [](int x, int y) { return glm::vec3(x, y, 1); });
  scene.environment->turn = static_cast<float>(std::numbers::pi / 2);
  const Environment e = environment_of(scene);
  // About +y, right-handed: what was ahead (-z) is at the left (-x), what was at the right (+x) is ahead.
  EXPECT_NEAR(e.radiance({-1, 0, 0}).r, 4, 1e-5);
  EXPECT_NEAR(e.radiance({0, 0, -1}).r, 4 + 9.0 / 4, 1e-5);
}

TEST(Environment, PlacesAndDirectionsAreEachOthersInverse) {
  auto scene = scene_of(4, 2, [](int, int) { return glm::vec3(1); });
  for (const float turn : {0.0f, 1.0f, -2.5f, 100.0f}) {
    scene.environment->turn = turn;
    const Environment e = environment_of(scene);
    double worst = 0, worst_angle = 0;
    for (int i = 0; i < 20000; ++i) {
      sampling::Samples samples(static_cast<std::uint32_t>(i), 0, 1);
      const glm::vec2 u = samples.next();
      // A part of them near the poles.
      const double theta =
          i % 3 == 0 ? 1e-5 * std::pow(1e5, static_cast<double>(u.x)) : std::acos(1 - 2 * static_cast<double>(u.x));
      const double phi = 2 * std::numbers::pi * static_cast<double>(u.y), up = i % 2 ? 1 : -1;
      const glm::vec3 d{std::sin(theta) * std::cos(phi), up * std::cos(theta), std::sin(theta) * std::sin(phi)};
      const glm::vec2 place = e.place_of(d);
      ASSERT_TRUE(place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1);
      const double distance = static_cast<double>(glm::distance(e.direction_at(place), d));
      worst = std::max(worst, distance);
      if (std::min(theta, std::numbers::pi - theta) < 0.1)
        worst_angle = std::max(worst_angle, distance / std::sin(theta));
    }
    EXPECT_LT(worst, 4e-6 * (1 + std::abs(static_cast<double>(turn)))) << turn;  // floats of angles up to the turn
    // Near the poles the error is small beside the angle to them: at 1e-5 rad that of pi - theta, 2.4e-7, is 2.4 %.
    EXPECT_LT(worst_angle, 0.05) << turn;
  }
}

// The integral of f over the sphere by a fine midpoint rule.
template <class F>
double over_sphere(int columns, F&& f) {
  double sum = 0;
  const int rows = columns / 2;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const double theta = (y + 0.5) / rows * std::numbers::pi, phi = (x + 0.5) / columns * 2 * std::numbers::pi;
      sum += f(glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi))) *
             std::sin(theta);
    }
  return sum * 2 * std::numbers::pi * std::numbers::pi / (static_cast<double>(rows) * columns);
}

// Samples against the density, densities against each other, and means of radiance over density against a quadrature.
void expect_sound(const scene::Scene& scene, const char* what, double least, double tolerance) {
  SCOPED_TRACE(what);
  const Environment e = environment_of(scene);
  EXPECT_NEAR(over_sphere(1024, [&](const glm::vec3& d) { return static_cast<double>(e.pdf(d)); }), 1, 4e-3);
  constexpr std::size_t kBins = 32, kFine = 1024;
  std::vector<double> counts(kBins * kBins, 0), expected(kBins * kBins, 0), in_y(kFine, 0), of_y(kFine, 0);
  // The density is constant in each cell of the picture: 2048 x 1024 points hit every one.
  for (std::size_t y = 0; y < kFine; ++y)
    for (std::size_t x = 0; x < 2 * kFine; ++x) {
      const glm::vec2 place{(static_cast<float>(x) + 0.5f) / (2 * kFine), (static_cast<float>(y) + 0.5f) / kFine};
      const double sine = std::sin(static_cast<double>(place.y) * std::numbers::pi);
      const double p =
          static_cast<double>(e.pdf(e.direction_at(place))) * 2 * std::numbers::pi * std::numbers::pi * sine;
      expected[y * kBins / kFine * kBins + x * kBins / (2 * kFine)] += p, of_y[y] += p;
    }
  constexpr int kDraws = 100000;
  double whole = 0;
  for (const double p : of_y) whole += p;
  EXPECT_NEAR(whole / (2.0 * kFine * kFine), 1, 2e-3);
  int elsewhere = 0;
  glm::dvec3 flux(0);
  double up = 0;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    sampling::Samples samples(i, 0, 4);
    const auto c = e.sample(samples.next());
    if (!(c.pdf > 0)) continue;
    ASSERT_TRUE(std::isfinite(c.pdf));
    ASSERT_NEAR(glm::length(c.direction), 1, 1e-6);
    if (std::abs(e.pdf(c.direction) / c.pdf - 1) > 2e-3f) ++elsewhere;
    const glm::vec2 place = e.place_of(c.direction);
    const auto x = std::min(static_cast<std::size_t>(place.x * kBins), kBins - 1);
    const auto y = std::min(static_cast<std::size_t>(place.y * kBins), kBins - 1);
    ++counts[y * kBins + x];
    ++in_y[std::min(static_cast<std::size_t>(place.y * kFine), kFine - 1)];
    flux += glm::dvec3(e.radiance(c.direction)) / static_cast<double>(c.pdf) / double(kDraws);
    up += static_cast<double>(e.radiance(c.direction).g * std::max(c.direction.y, 0.0f) / c.pdf) / kDraws;
  }
  EXPECT_LT(elsewhere, kDraws / 200);  // on the border of the next cell, after two roundings of the place
  for (double& x : expected) x *= kDraws / whole;
  for (double& x : of_y) x *= kDraws / whole;
  EXPECT_GE(chi_square(counts, expected).p, least);
  EXPECT_GE(chi_square(in_y, of_y).p, least);
  const double exact = over_sphere(2048, [&](const glm::vec3& d) { return static_cast<double>(e.radiance(d).g); });
  EXPECT_NEAR(flux.g, exact, tolerance * exact);
  const double exact_up =
      over_sphere(2048, [&](const glm::vec3& d) { return static_cast<double>(e.radiance(d).g * std::max(d.y, 0.0f)); });
  EXPECT_NEAR(up, exact_up, tolerance * exact + 1e-12);
  const double mean = static_cast<double>(e.mean_radiance().g);
  EXPECT_NEAR(mean, exact / (4 * std::numbers::pi),
              0.1 * mean);  // of texels, not of what lies between them: half of one at a pole
  // Nothing bright is missed.
  for (std::uint32_t i = 0; i < 20000; ++i) {
    sampling::Samples samples(i, 0, 5);
    const glm::vec2 u = samples.next();
    const glm::vec3 d = e.direction_at({u.x, 1e-4f + u.y * 0.9998f});
    if (e.radiance(d).g > 0) {
      ASSERT_GT(e.pdf(d), 0.0f) << d.x << " " << d.y << " " << d.z;
    }
  }
}

TEST(Environment, SamplesByTheDensityThatItStates) {
  const double least = sidak(0.01, 2 * 7);  // significance 1 % of all together; fixed seeds
  expect_sound(scene_of(64, 32, [](int, int) { return glm::vec3(2); }), "the same everywhere", least, 5e-3);
  expect_sound(
      scene_of(64, 32,
               [](int x, int y) {
                 return glm::vec3(1 + std::sin(0.3f * static_cast<float>(x)) * std::cos(0.2f * static_cast<float>(y)));
               }),
      "smooth", least, 1e-2);
  expect_sound(sun(64, 32, 20, 9), "a sun of one texel", least, 1e-2);
  expect_sound(sun(64, 32, 0, 16, 0), "a sun at the seam, and nothing else", least, 1e-2);
  expect_sound(sun(64, 32, 31, 0), "a sun at the upper pole", least, 3e-2);
  expect_sound(sun(64, 32, 5, 31, 0), "a sun at the lower pole, and nothing else", least, 3e-2);
  auto turned = sun(32, 16, 3, 4);
  turned.environment->turn = -2;
  turned.environment->scale = {3, 2, 1};
  expect_sound(turned, "turned and scaled", least, 1e-2);
}

TEST(Environment, OfMoreColumnsThanItsGridMissesNothing) {
  for (const int width : {1025, 1500, 3000}) {
    const auto scene =
        scene_of(width, 8, [&](int x, int y) { return glm::vec3(x == width - 2 && y == 4 ? 100.0f : 0.0f); });
    const Environment e = environment_of(scene);
    double sum = 0;
    constexpr int kDraws = 100000;
    for (std::uint32_t i = 0; i < kDraws; ++i) {
      const auto c = e.sample(sampling::Samples(1, i, 4).next());
      if (c.pdf > 0) sum += static_cast<double>(e.radiance(c.direction).g / c.pdf) / kDraws;
    }
    double exact = 0;  // of the bilinear picture: a tent of one texel about the texel
    for (int i = 0; i < 8000; ++i) {
      const double y = (i + 0.5) / 8000 * 8, weight = std::max(1 - std::abs(y - 4.5), 0.0);
      exact +=
          100 * weight * std::sin(y / 8 * std::numbers::pi) * 2 * std::numbers::pi * std::numbers::pi / 8000 / width;
    }
    EXPECT_NEAR(sum, exact, 0.02 * exact) << width;
  }
}

TEST(Environment, ReadsBytesAsSrgbAndGreyAsGrey) {
  scene::Scene scene;
  scene.images.push_back({"", {2, 1, 1, {188, 188}, {}}});
  scene.environment = scene::Environment{0, {1, 2, 3}, 0};
  const Environment e = environment_of(scene);
  const glm::vec3 c = e.radiance({0, 0, -1});
  EXPECT_NEAR(c.r, 0.5029, 1e-4);  // IEC 61966-2-1: ((188 / 255 + 0.055) / 1.055)^2.4
  EXPECT_NEAR(c.b, 3 * 0.5029, 3e-4);
}

TEST(Environment, OfOneColorIsThatEverywhereAndNotSampled) {
  scene::Scene scene;
  scene.environment = scene::Environment{scene::kNone, {1, 2, 3}, 0};
  const Environment e = environment_of(scene);
  EXPECT_FALSE(e.has_picture());
  EXPECT_EQ(e.radiance({0, 1, 0}), glm::vec3(1, 2, 3));
  EXPECT_EQ(e.mean_radiance(), glm::vec3(1, 2, 3));
}

TEST(Environment, ThatIsBlackOrHasATexelThatIsNoNumberKeepsItsDensityFinite) {
  const auto black = scene_of(8, 4, [](int, int) { return glm::vec3(0); });
  const auto c = environment_of(black).sample({0.3f, 0.6f});
  EXPECT_TRUE(c.pdf >= 0 && std::isfinite(c.pdf));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto holed = scene_of(8, 4, [&](int x, int y) { return glm::vec3(x == 3 && y == 1 ? nan : 1.0f); });
  const Environment e = environment_of(holed);
  EXPECT_TRUE(std::isfinite(e.mean_radiance().g));
  EXPECT_NEAR(e.mean_radiance().g, 1, 0.1);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const auto s = e.sample(sampling::Samples(1, i, 4).next());
    EXPECT_TRUE(s.pdf > 0 && std::isfinite(s.pdf));
  }
}

}  // namespace
}  // namespace likeness::light
