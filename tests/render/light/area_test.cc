#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/light/area.h"
#include "render/sampling/sobol.h"
#include "tests/brdf/chi_square.h"

// Directions to lights with a size against the density that they state, in coordinates of the light itself, where every
// light fills all bins: in 2-D, and over each coordinate alone.
namespace likeness::light {
namespace {

using brdf::chi_square;
using brdf::sidak;
constexpr int kAreaDraws = 60000;
constexpr std::size_t kCoarseCells = 16, kFineCells = 64;

// The whole suite below: 3 tests for each of the places of each light; together they fail by chance once in 100.
constexpr std::size_t kTests = 3 * 40;
const double kLeastP = sidak(0.01, kTests);

// A number of a random stream without pattern.
struct Plain {
  std::uint32_t state = 1;
  float next() { return sampling::unit(state = sampling::mixed(state + 0x9e3779b9u)); }
};

// A light in coordinates of its own.
struct Shape {
  std::function<Towards(const glm::vec2&)> sample;
  std::function<double(const glm::dvec3&, double)> pdf;  // of a direction and a distance
  // The place of a point on the light [0, 1]^2, and back, with how much solid angle a unit of the square fills there.
  std::function<glm::dvec2(const glm::dvec3&)> place;
  struct At {
    glm::dvec3 direction;
    double distance, solid_angle;
  };
  std::function<At(const glm::dvec2&)> at;
};

void expect_sound(const std::string& what, const Shape& shape, const glm::vec3& point, double pdf_tolerance = 2e-3) {
  SCOPED_TRACE(what);
  std::vector<double> fine(kFineCells * kFineCells, 0);
  double whole = 0;
  constexpr int kSteps = 4;  // of the midpoint rule in each fine bin
  for (std::size_t y = 0; y < kFineCells; ++y)
    for (std::size_t x = 0; x < kFineCells; ++x)
      for (int j = 0; j < kSteps; ++j)
        for (int i = 0; i < kSteps; ++i) {
          const Shape::At at = shape.at({(static_cast<double>(x) + (i + 0.5) / kSteps) / kFineCells,
                                         (static_cast<double>(y) + (j + 0.5) / kSteps) / kFineCells});
          const double p =
              shape.pdf(at.direction, at.distance) * at.solid_angle / (kFineCells * kFineCells * kSteps * kSteps);
          fine[y * kFineCells + x] += p, whole += p;
        }
  EXPECT_NEAR(whole, 1, pdf_tolerance);
  std::vector<double> counts(kFineCells * kFineCells, 0);
  Plain random{static_cast<std::uint32_t>(what.size())};
  double worst = 0, outside = 0;
  for (int i = 0; i < kAreaDraws; ++i) {
    const Towards t = shape.sample({random.next(), random.next()});
    ASSERT_GT(t.pdf, 0.0f);
    ASSERT_TRUE(std::isfinite(t.pdf));
    ASSERT_NEAR(glm::length(t.direction), 1, 1e-6);
    worst = std::max(
        worst,
        std::abs(shape.pdf(glm::dvec3(t.direction), static_cast<double>(t.distance)) / static_cast<double>(t.pdf) - 1));
    const glm::dvec3 on = glm::dvec3(point) + glm::dvec3(t.direction) * static_cast<double>(t.distance);
    const glm::dvec2 q = shape.place(on);
    outside = std::max({outside, -q.x, -q.y, q.x - 1, q.y - 1});
    const auto bin = [](double v) { return static_cast<std::size_t>(std::clamp(v, 0.0, 0.999999) * kFineCells); };
    ++counts[bin(q.y) * kFineCells + bin(q.x)];
  }
  EXPECT_LT(worst, 2e-3);    // sample's own pdf against pdf(): cosines in float near the plane of the light
  EXPECT_LT(outside, 2e-2);  // of the light's width: a float direction misses by 1e-7 times the distance
  std::vector<double> in_x(kFineCells, 0), in_y(kFineCells, 0), of_x(kFineCells, 0), of_y(kFineCells, 0);
  std::vector<double> coarse(kCoarseCells * kCoarseCells, 0), of_coarse(kCoarseCells * kCoarseCells, 0);
  for (std::size_t y = 0; y < kFineCells; ++y)
    for (std::size_t x = 0; x < kFineCells; ++x) {
      const double count = counts[y * kFineCells + x], expected = fine[y * kFineCells + x] / whole * kAreaDraws;
      in_x[x] += count, of_x[x] += expected, in_y[y] += count, of_y[y] += expected;
      const std::size_t cell = y * kCoarseCells / kFineCells * kCoarseCells + x * kCoarseCells / kFineCells;
      coarse[cell] += count, of_coarse[cell] += expected;
    }
  EXPECT_GE(chi_square(coarse, of_coarse).p, kLeastP);
  EXPECT_GE(chi_square(in_x, of_x).p, kLeastP);
  EXPECT_GE(chi_square(in_y, of_y).p, kLeastP);
}

Shape shape_of(const scene::RectangleLight& light, const glm::vec3& point) {
  const glm::dvec3 u(light.half_u), v(light.half_v), c(light.center), p(point);
  return {[=](const glm::vec2& x) { return sample_rectangle(light, point, x); },
          [=](const glm::dvec3& d, double t) {
            return static_cast<double>(rectangle_pdf(light, point, glm::vec3(d), static_cast<float>(t)));
          },
          [=](const glm::dvec3& on) {
            return glm::dvec2(glm::dot(on - c, u) / glm::dot(u, u), glm::dot(on - c, v) / glm::dot(v, v)) * 0.5 + 0.5;
          },
          [=](const glm::dvec2& q) -> Shape::At {
            const glm::dvec3 way = c + (2 * q.x - 1) * u + (2 * q.y - 1) * v - p;
            const double t = glm::length(way);
            const glm::dvec3 normal = glm::normalize(glm::cross(u, v));
            return {way / t, t, 4 * glm::length(glm::cross(u, v)) * std::abs(glm::dot(way / t, normal)) / (t * t)};
          }};
}

Shape shape_of(const scene::DiskLight& light, const glm::vec3& point) {
  const glm::dvec3 n(light.normal), c(light.center), p(point);
  const glm::dvec3 x = glm::normalize(std::abs(n.x) < 0.5 ? glm::cross(n, {1, 0, 0}) : glm::cross(n, {0, 1, 0}));
  const glm::dvec3 y = glm::cross(n, x);
  const double radius = static_cast<double>(light.radius);
  return {[=](const glm::vec2& u) { return sample_disk(light, point, u); },
          [=](const glm::dvec3& d, double t) {
            return static_cast<double>(disk_pdf(light, point, glm::vec3(d), static_cast<float>(t)));
          },
          [=](const glm::dvec3& on) {
            const double a = glm::dot(on - c, x), b = glm::dot(on - c, y);
            return glm::dvec2((a * a + b * b) / (radius * radius), std::atan2(b, a) / (2 * std::numbers::pi) + 0.5);
          },
          [=](const glm::dvec2& q) -> Shape::At {
            const double r = radius * std::sqrt(q.x), phi = (q.y - 0.5) * 2 * std::numbers::pi;
            const glm::dvec3 way = c + r * (std::cos(phi) * x + std::sin(phi) * y) - p;
            const double t = glm::length(way);
            return {way / t, t, std::numbers::pi * radius * radius * std::abs(glm::dot(way / t, n)) / (t * t)};
          }};
}

Shape shape_of(const scene::SphereLight& light, const glm::vec3& point) {
  const glm::dvec3 c(light.center), p(point), z = glm::normalize(c - p);
  const glm::dvec3 x = glm::normalize(std::abs(z.x) < 0.5 ? glm::cross(z, {1, 0, 0}) : glm::cross(z, {0, 1, 0}));
  const glm::dvec3 y = glm::cross(z, x);
  const double d = glm::distance(c, p), r = static_cast<double>(light.radius), sin2 = r * r / (d * d);
  const double versine = sin2 / (1 + std::sqrt(1 - sin2));
  return {[=](const glm::vec2& u) { return sample_sphere(light, point, u); },
          [=](const glm::dvec3&, double) { return static_cast<double>(sphere_pdf(light, point)); },
          [=](const glm::dvec3& on) {
            const glm::dvec3 w = glm::normalize(on - p);
            const double a = glm::dot(w, x), b = glm::dot(w, y), s2 = a * a + b * b;
            return glm::dvec2(s2 / (1 + std::sqrt(std::max(1 - s2, 0.0))) / versine,
                              std::atan2(b, a) / (2 * std::numbers::pi) + 0.5);
          },
          [=](const glm::dvec2& q) -> Shape::At {
            const double v = q.x * versine, s = std::sqrt(v * (2 - v)), phi = (q.y - 0.5) * 2 * std::numbers::pi;
            const glm::dvec3 w = s * std::cos(phi) * x + s * std::sin(phi) * y + (1 - v) * z;
            return {w, d * (1 - v) - std::sqrt(std::max(r * r - d * d * s * s, 0.0)), 2 * std::numbers::pi * versine};
          }};
}

// Turned out of the axes: u, v and the normal u x v, which points down.
const scene::RectangleLight kRectangle{{0.3f, 2, -0.2f}, {0.8f, 0, 0}, {0, 0, 0.5f}, {1, 1, 1}, false};
const scene::RectangleLight kTilted{
    {1, 2, 3}, 0.7f * glm::normalize(glm::vec3(1, 1, 0)), 0.4f * glm::normalize(glm::vec3(1, -1, 1)), {1, 1, 1}, true};

TEST(RectangleLight, IsSampledByItsDensity) {
  for (const auto& [what, point] : std::initializer_list<std::pair<const char*, glm::vec3>>{
           {"below", {0.3f, 0, -0.2f}},
           {"aside", {3, 0, 1}},
           {"very near", {0.2f, 1.99f, -0.1f}},
           {"near an edge", {1.2f, 1.9f, -0.2f}},
           {"grazing", {4, 1.9f, 0}},
           {"very grazing", {4, 1.999f, 0}},
           {"below a corner", {-0.5f, 1, 0.3f}},
           {"10 m", {0, -8, 0}},
           {"where floats end", {0.3f, -12, -0.2f}},
           {"just nearer than far", {0.3f, 2 - 126, -0.2f}},
           {"just far", {0.3f, 2 - 127, -0.2f}},
           {"10 km", {6000, -8000, 0}},
       })
    expect_sound(what, shape_of(kRectangle, point), point);
  for (const auto& [what, point] : std::initializer_list<std::pair<const char*, glm::vec3>>{
           {"tilted, one side", {0, 0, 0}}, {"tilted, other side", {2, 4, 6}}, {"tilted, far", {-3000, 100, 8000}}})
    expect_sound(what, shape_of(kTilted, point), point);
}

TEST(RectangleLight, AStripIsSampledByItsDensityFromNearAndFar) {
  // 100 m long, 1 mm wide: its area is small, its angle is not.
  const scene::RectangleLight strip{{0, 2, 0}, {50, 0, 0}, {0, 0, 0.0005f}, {1, 1, 1}, false};
  for (const auto& [what, point] : std::initializer_list<std::pair<const char*, glm::vec3>>{
           {"strip, below the middle", {0, 0, 0}}, {"strip, below its end", {49, 1, 0}}, {"strip, aside", {20, 0, 40}}})
    expect_sound(what, shape_of(strip, point), point);
}

// Uneven solid angle within a light is what its sampling is to even out: the value of all samples must be near equal.
TEST(RectangleLight, HasOneDensityWhereItsAngleIsNotSmall) {
  const scene::RectangleLight strip{{0, 2, 0}, {50, 0, 0}, {0, 0, 0.0005f}, {1, 1, 1}, false};
  const glm::vec3 point{49, 1, 0};  // under its end: 35 times as near as the center
  Plain random;
  float least = INFINITY, most = 0;
  for (int i = 0; i < 1000; ++i) {
    const Towards t = sample_rectangle(strip, point, {random.next(), random.next()});
    least = std::min(least, t.pdf), most = std::max(most, t.pdf);
  }
  EXPECT_LT(most, 1.01f * least);
}

// The closed form of the solid angle: four corners, each of an arc tangent.
double solid_angle(const scene::RectangleLight& light, const glm::vec3& point) {
  const glm::dvec3 u(light.half_u), v(light.half_v), way = glm::dvec3(light.center) - glm::dvec3(point);
  const double a = glm::length(u), b = glm::length(v), x = glm::dot(way, u / a), y = glm::dot(way, v / b);
  const double z = std::abs(glm::dot(way, glm::normalize(glm::cross(u, v))));
  const auto corner = [&](double s, double t) { return std::atan2(s * t, z * std::sqrt(s * s + t * t + z * z)); };
  return corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b) + corner(x - a, y - b);
}

// From 1 mm to 10 km in steps of 2 %, straight below, aside and grazing: by floats, doubles and areas.
TEST(RectangleLight, DensityIsOneOverTheSolidAngleAtEveryDistance) {
  double worst = 0;
  for (const glm::vec3& way :
       {glm::vec3(0, -1, 0), glm::vec3(0.6f, -0.8f, 0), glm::vec3(0.7f, -0.1f, -0.7f), glm::vec3(0.8f, -0.01f, 0.6f)})
    for (float distance = 1e-3f; distance < 1e4f; distance *= 1.02f) {
      const glm::vec3 point = kRectangle.center + distance * way;
      const double exact = 1 / solid_angle(kRectangle, point);
      const Towards middle = sample_rectangle(kRectangle, point, {0.5f, 0.5f});
      ASSERT_GT(middle.pdf, 0.0f) << distance;
      worst = std::max(worst, std::abs(static_cast<double>(middle.pdf) / exact - 1));
    }
  EXPECT_LT(worst, 4e-3);
  RecordProperty("worst", std::to_string(worst));
}

TEST(DiskLight, IsSampledByItsDensity) {
  const scene::DiskLight disk{{0.3f, 2, -0.2f}, glm::normalize(glm::vec3(0.1f, -1, 0.2f)), 0.7f, {1, 1, 1}, false};
  for (const auto& [what, point] : std::initializer_list<std::pair<const char*, glm::vec3>>{
           {"disk below", {0.3f, 0, -0.2f}},
           {"disk aside", {3, 0, 1}},
           {"disk near", {0.3f, 1.7f, -0.2f}},
           {"disk grazing", {6, 2.3f, -0.2f}},
           {"disk 10 km", {6000, -8000, 0}},
       })
    expect_sound(what, shape_of(disk, point), point, 5e-3);  // the midpoint rule where the density rises steeply
}

TEST(SphereLight, IsSampledByItsDensity) {
  const scene::SphereLight sphere{{0.3f, 2, -0.2f}, 0.7f, {1, 1, 1}};
  for (const auto& [what, point] : std::initializer_list<std::pair<const char*, glm::vec3>>{
           {"sphere below", {0.3f, 0, -0.2f}},
           {"sphere aside", {3, 0, 1}},
           {"sphere touching", {0.3f, 1.2999f, -0.2f}},
           {"sphere just beside", {0.3f, 1.2f, -0.2f}},
           {"sphere 1 km", {600, -800, 0}},
       })
    expect_sound(what, shape_of(sphere, point), point);
}

TEST(SphereLight, PointsOfItAreOnIt) {
  const scene::SphereLight sphere{{0.3f, 2, -0.2f}, 0.7f, {1, 1, 1}};
  Plain random;
  for (const glm::vec3& point : {glm::vec3(0.3f, 0, -0.2f), glm::vec3(3, 0, 1), glm::vec3(60, -80, 0)})
    for (int i = 0; i < 1000; ++i) {
      const Towards t = sample_sphere(sphere, point, {random.next(), random.next()});
      const glm::vec3 on = point + t.distance * t.direction;
      ASSERT_NEAR(glm::distance(on, sphere.center), 0.7f, 2e-4f * glm::length(point));  // half chord near the rim
      ASSERT_LT(glm::dot(on - sphere.center, t.direction), 1e-3f);                      // on the near side
    }
}

TEST(AreaLights, CannotBeSeenFromBehindFromInsideOrWithoutArea) {
  const glm::vec2 u{0.3f, 0.6f};
  EXPECT_EQ(sample_rectangle(kRectangle, {0, 3, 0}, u).pdf, 0);
  EXPECT_EQ(rectangle_pdf(kRectangle, {0, 3, 0}, {0, -1, 0}, 1), 0);
  EXPECT_EQ(sample_rectangle(kRectangle, {6000, 3, 0}, u).pdf, 0);
  EXPECT_EQ(sample_rectangle(kRectangle, {0, 2, 0}, u).pdf, 0);  // in its plane
  EXPECT_EQ(sample_rectangle(kRectangle, {9, 2, 0}, u).pdf, 0);
  auto two_sided = kRectangle;
  two_sided.two_sided = true;
  EXPECT_GT(sample_rectangle(two_sided, {0, 3, 0}, u).pdf, 0);
  EXPECT_EQ(sample_rectangle(two_sided, {9, 2, 0}, u).pdf, 0);

  const scene::DiskLight disk{{0, 2, 0}, {0, -1, 0}, 0.5f, {1, 1, 1}, false};
  EXPECT_EQ(sample_disk(disk, {0, 3, 0}, u).pdf, 0);
  EXPECT_EQ(disk_pdf(disk, {0, 3, 0}, {0, -1, 0}, 1), 0);
  EXPECT_EQ(sample_disk(disk, {7, 2, 0}, u).pdf, 0);
  auto both = disk;
  both.two_sided = true;
  EXPECT_GT(sample_disk(both, {0, 3, 0}, u).pdf, 0);

  const scene::SphereLight sphere{{0, 2, 0}, 0.5f, {1, 1, 1}};
  EXPECT_EQ(sample_sphere(sphere, {0, 2, 0}, u).pdf, 0);
  EXPECT_EQ(sample_sphere(sphere, {0, 1.6f, 0}, u).pdf, 0);
  EXPECT_EQ(sphere_pdf(sphere, {0, 1.6f, 0}), 0);

  for (const glm::vec3& half_v : {glm::vec3(0), glm::vec3(0.5f, 0, 0)}) {  // a line, twice
    const scene::RectangleLight line{{0, 2, 0}, {0.5f, 0, 0}, half_v, {1, 1, 1}, true};
    for (const glm::vec3& p : {glm::vec3(0), glm::vec3(0, 2, 0), glm::vec3(0, 1.9999f, 0)}) {
      const Towards t = sample_rectangle(line, p, u);
      EXPECT_FALSE(t.pdf > 0 && std::isfinite(t.pdf)) << t.pdf;
    }
  }
  EXPECT_FALSE(std::isfinite(sample_disk({{0, 2, 0}, {0, -1, 0}, 0, {1, 1, 1}, true}, {0, 0, 0}, u).pdf));
  EXPECT_EQ(sample_sphere({{0, 2, 0}, 0, {1, 1, 1}}, {0, 0, 0}, u).pdf, 0);
}

}  // namespace
}  // namespace likeness::light
