#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "render/light/lights.h"
#include "render/sampling/sobol.h"
#include "tests/brdf/chi_square.h"

// Meshes that shine.
namespace likeness::light {
namespace {

using brdf::chi_square;
using brdf::sidak;
constexpr std::uint32_t kEmitterDraws = 65536;

// A unit square in the plane z = 0, cut into triangles of very different sizes; it faces +z.
scene::Mesh square(bool has_uvs = true) {
  scene::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.9f, 0.9f, 0}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 0, 1}};  // the last has no area
  if (has_uvs)
    for (const auto& p : mesh.positions) mesh.uvs.push_back({p.x, p.y});
  return mesh;
}
scene::Scene scene_with(const glm::mat4& place = glm::mat4(1)) {
  scene::Scene scene;
  scene.meshes = {square()};
  scene.materials.resize(1);
  scene.materials[0].emission = {1, 2, 3};
  scene.instances = {{"", 0, 0, place}};
  return scene;
}

// The irradiance of red at a point by many samples of light 0.
double irradiance(const Lights& lights, const glm::vec3& point, const glm::vec3& normal, std::uint32_t seed = 1) {
  double sum = 0;
  for (std::uint32_t i = 0; i < kEmitterDraws; ++i) {
    const Sample s = lights.sample_light(0, point, sampling::Samples(0, i, seed).next());
    if (s.is_some())
      sum += static_cast<double>(s.value.r * std::max(glm::dot(s.to_light, normal), 0.0f)) / kEmitterDraws;
  }
  return sum;
}
// The same by a midpoint rule over the square, of radiance(x, y) that leaves to the side of +z.
template <class F>
double by_quadrature(const glm::dvec3& point, const glm::dvec3& normal, F&& radiance) {
  constexpr int kSteps = 1000;
  double sum = 0;
  for (int y = 0; y < kSteps; ++y)
    for (int x = 0; x < kSteps; ++x) {
      const double a = (x + 0.5) / kSteps, b = (y + 0.5) / kSteps;
      const glm::dvec3 way = glm::dvec3(a, b, 0) - point;
      const double d2 = glm::dot(way, way);
      sum += radiance(a, b) * std::max(glm::dot(way, normal), 0.0) * std::abs(way.z) / (d2 * d2);
    }
  return sum / (kSteps * kSteps);
}

TEST(Emitter, GivesTheIrradianceOfAQuadrature) {
  const auto scene = scene_with();
  const Lights lights(scene);
  ASSERT_EQ(lights.count(), 1u);
  for (const glm::vec3& p :
       {glm::vec3(0.5f, 0.5f, 1), glm::vec3(0.2f, 0.1f, 0.3f), glm::vec3(4, -2, 0.5f), glm::vec3(0, 0, -2)}) {
    const glm::vec3 normal{0, 0.3f, p.z > 0 ? -std::sqrt(0.91f) : std::sqrt(0.91f)};
    const double exact = by_quadrature(glm::dvec3(p), glm::dvec3(normal), [](double, double) { return 1; });
    EXPECT_NEAR(irradiance(lights, p, normal), exact, 2e-3 * exact) << p.x << " " << p.z;  // measured: 5e-4
  }
}

TEST(Emitter, ShinesByItsTextureToTheSideItHas) {
  auto scene = scene_with();
  scene.images.push_back({"", {2, 2, 3, {}, {0, 0, 0, 1, 1, 1, 4, 4, 4, -3, -3, -3}}});  // light below 0 counts as none
  scene.materials[0].emission_map = scene::Texture{0, {}, scene::Wrap::kClamp};
  scene.materials[0].two_sided = false;
  const Lights lights(scene);
  const auto texel = [](double u, double v) {
    const double x = std::clamp(2 * u - 0.5, 0.0, 1.0), y = std::clamp(2 * v - 0.5, 0.0, 1.0);
    return std::max((1 - y) * x + y * (4 * (1 - x) - 3 * x), 0.0);
  };
  const glm::vec3 p{0.4f, 0.2f, 0.8f}, normal{0, 0, -1};
  const double exact = by_quadrature(glm::dvec3(p), glm::dvec3(normal), texel);
  EXPECT_NEAR(irradiance(lights, p, normal), exact, 3e-3 * exact);
  EXPECT_EQ(irradiance(lights, {0.4f, 0.2f, -0.8f}, {0, 0, 1}), 0);  // behind
}

// A material with holes does not shine from them.
TEST(Emitter, DoesNotShineFromItsHoles) {
  auto scene = scene_with();
  scene.images.push_back({"", {2, 1, 1, {}, {0, 1}}});
  scene.materials[0].opacity = scene::Texture{0, {}, scene::Wrap::kClamp};
  scene.materials[0].opacity_cutoff = 0.5f;  // solid where u > 1/2
  const Lights lights(scene);
  const glm::vec3 p{0.4f, 0.2f, 0.8f}, normal{0, 0, -1};
  const double exact =
      by_quadrature(glm::dvec3(p), glm::dvec3(normal), [](double u, double) { return u > 0.5 ? 1 : 0; });
  EXPECT_NEAR(irradiance(lights, p, normal), exact, 3e-3 * exact);
}

// The side is that of the normals, whatever the order of the corners; without normals that of the order, and a mirror
// image shines to the mirrored side.
TEST(Emitter, OfOneSideFacesWhereItsSurfaceDoes) {
  const glm::vec3 above{0.4f, 0.2f, 0.8f}, below{0.4f, 0.2f, -0.8f};
  auto scene = scene_with();
  scene.materials[0].two_sided = false;
  scene.meshes[0].normals.assign(5, {0, 0, -1});  // against the corners' order
  {
    const Lights lights(scene);
    EXPECT_EQ(irradiance(lights, above, {0, 0, -1}), 0);
    EXPECT_GT(irradiance(lights, below, {0, 0, 1}), 0.1);
  }
  scene.meshes[0].normals.clear();
  scene.instances[0].world_from_object = glm::scale(glm::mat4(1), {-1, 1, 1});
  {
    const Lights lights(scene);
    EXPECT_GT(irradiance(lights, {-0.4f, 0.2f, 0.8f}, {0, 0, -1}), 0.1);
    EXPECT_EQ(irradiance(lights, {-0.4f, 0.2f, -0.8f}, {0, 0, 1}), 0);
  }
}

TEST(Emitter, SamplesByTheDensityThatItStates) {
  const glm::mat4 place =
      glm::rotate(glm::scale(glm::translate(glm::mat4(1), {1, 2, 3}), {2, 1, 0.5f}), 0.7f, glm::vec3(0.6f, 0, 0.8f));
  const auto scene = scene_with(place);
  const Lights lights(scene);
  const glm::vec3 corner(place * glm::vec4(0, 0, 0, 1)), u(place[0]), v(place[1]);
  const glm::vec3 n = glm::normalize(glm::cross(u, v));
  const double area = static_cast<double>(glm::length(glm::cross(u, v)));
  const glm::vec3 point{0.5f, 1, 5};
  // u and v are not square to each other: coordinates by the dual basis.
  const glm::vec3 to_u = glm::cross(v, n) / glm::dot(u, glm::cross(v, n)),
                  to_v = glm::cross(u, n) / glm::dot(v, glm::cross(u, n));
  constexpr std::size_t kBins = 32;
  std::vector<double> counts(kBins * kBins, 0), in_x(kBins, 0), in_y(kBins, 0);
  for (std::uint32_t i = 0; i < kEmitterDraws; ++i) {
    const Sample s = lights.sample_light(0, point, sampling::Samples(i, 0, 7).next());
    ASSERT_GT(s.pdf, 0.0f);
    const glm::vec3 on = point + s.distance * s.to_light - corner;
    const float x = glm::dot(on, to_u), y = glm::dot(on, to_v);
    ASSERT_TRUE(x > -1e-4f && x < 1.0001f && y > -1e-4f && y < 1.0001f) << x << " " << y;
    const auto bin = [](float t) { return static_cast<std::size_t>(std::clamp(t, 0.0f, 0.99999f) * kBins); };
    ++counts[bin(y) * kBins + bin(x)], ++in_x[bin(x)], ++in_y[bin(y)];
    // By area.
    const double d = static_cast<double>(s.distance);
    ASSERT_NEAR(static_cast<double>(s.pdf) * area * static_cast<double>(std::abs(glm::dot(n, s.to_light))) / (d * d), 1,
                1e-4);
    // What a ray that met it would say, of its triangle.
    const std::array<glm::vec2, 5> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.9f, 0.9f}}};
    scene::Index triangle = scene::kNone;
    for (scene::Index t = 0; t < 4; ++t) {
      const auto side = [&](const glm::vec2& a, const glm::vec2& b) {
        return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
      };
      const auto& c = scene.meshes[0].triangles[t];
      if (side(corners[c[0]], corners[c[1]]) > 1e-4f && side(corners[c[1]], corners[c[2]]) > 1e-4f &&
          side(corners[c[2]], corners[c[0]]) > 1e-4f)
        triangle = t;
    }
    if (triangle == scene::kNone) continue;  // on an edge
    ASSERT_NEAR(lights.emitter_pdf(0, triangle, point, {0, 0, -1}, s.to_light, s.distance, n) / s.pdf, 1, 1e-4);
  }
  const double least = sidak(0.01, 3);  // significance 1 %; fixed seed
  EXPECT_GE(chi_square(counts, std::vector<double>(kBins * kBins, double(kEmitterDraws) / (kBins * kBins))).p, least);
  EXPECT_GE(chi_square(in_x, std::vector<double>(kBins, double(kEmitterDraws) / kBins)).p, least);
  EXPECT_GE(chi_square(in_y, std::vector<double>(kBins, double(kEmitterDraws) / kBins)).p, least);
  EXPECT_EQ(lights.emitter_pdf(0, 4, point, {0, 0, -1}, {0, 0, 1}, 1, n), 0);  // the triangle without area
}

TEST(Emitter, IsNotOneIfItIsDarkEmptyWithoutAreaOrInItsPlane) {
  auto scene = scene_with();
  scene.materials[0].emission = {0, 0, 0};
  EXPECT_TRUE(Lights(scene).is_empty());
  scene = scene_with();
  scene.meshes[0].triangles.clear();
  EXPECT_TRUE(Lights(scene).is_empty());
  scene = scene_with();
  scene.meshes[0].triangles = {{0, 0, 1}, {2, 2, 2}};
  const Lights without_area(scene);
  EXPECT_EQ(irradiance(without_area, {0.5f, 0.5f, 1}, {0, 0, -1}), 0);
  scene = scene_with();
  const Lights lights(scene);
  EXPECT_EQ(irradiance(lights, {3, 0.5f, 0}, {-1, 0, 0}), 0);
}

}  // namespace
}  // namespace likeness::light
