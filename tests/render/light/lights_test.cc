#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/light/lights.h"
#include "render/ray/tracer.h"
#include "render/sampling/sobol.h"
#include "tests/brdf/chi_square.h"

namespace likeness::light {
namespace {

constexpr std::uint32_t kLightDraws = 65536;

scene::Scene scene_of(const std::vector<scene::LightShape>& shapes) {
  scene::Scene scene;
  for (const auto& shape : shapes) scene.lights.push_back({"", shape});
  return scene;
}

double irradiance(const Lights& lights, std::size_t index, const glm::vec3& point, const glm::vec3& normal) {
  double sum = 0;
  for (std::uint32_t i = 0; i < kLightDraws; ++i) {
    const Sample s = lights.sample_light(index, point, sampling::Samples(0, i, 1).next());
    if (s.is_some()) sum += static_cast<double>(s.value.r * std::max(glm::dot(s.to_light, normal), 0.0f)) / kLightDraws;
  }
  return sum;
}
double irradiance_of(const scene::LightShape& shape, const glm::vec3& point, const glm::vec3& normal) {
  const auto scene = scene_of({shape});
  return irradiance(Lights(scene), 0, point, normal);
}

// Lambert's formula for a polygon of radiance 1 that is above the horizon of `normal`.
double of_polygon(const std::vector<glm::dvec3>& corners, const glm::dvec3& point, const glm::dvec3& normal) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - point),
                     b = glm::normalize(corners[(i + 1) % corners.size()] - point);
    const glm::dvec3 cross = glm::cross(a, b);
    sum += std::atan2(glm::length(cross), glm::dot(a, b)) * glm::dot(glm::normalize(cross), normal);
  }
  return std::abs(sum) / 2;
}
double of_rectangle(const scene::RectangleLight& l, const glm::vec3& point, const glm::vec3& normal) {
  const glm::dvec3 c(l.center), u(l.half_u), v(l.half_v);
  return of_polygon({c - u - v, c + u - v, c + u + v, c - u + v}, glm::dvec3(point), glm::dvec3(normal));
}

// Parallel, perpendicular and oblique; near, far and grazing. Tolerance: 65536 stratified samples; measured 4e-4 at most.
TEST(Lights, ARectangleGivesTheIrradianceOfItsPolygon) {
  const scene::RectangleLight light{{0, 2, 0}, {0.8f, 0, 0}, {0, 0, 0.5f}, {1, 1, 1}, false};
  struct Case {
    glm::vec3 point, normal;
  };
  for (const auto& [point, normal] : {
           Case{{0, 0, 0}, {0, 1, 0}},                                   // parallel
           Case{{3, 1, 0}, {-1, 0, 0}},                                  // perpendicular
           Case{{1, 0.5f, 2}, glm::normalize(glm::vec3(-1, 1, -1))},     // oblique
           Case{{0.3f, 1.98f, 0.1f}, {0, 1, 0}},                         // near
           Case{{4, 1.98f, 0}, glm::normalize(glm::vec3(-1, 0.1f, 0))},  // grazing
           Case{{0, -60, 0}, {0, 1, 0}},                                 // by doubles
           Case{{0, -9998, 0}, {0, 1, 0}},                               // by area
       }) {
    const double exact = of_rectangle(light, point, normal);
    EXPECT_NEAR(irradiance_of(light, point, normal), exact, 1e-3 * exact) << point.x << " " << point.y;
  }
  auto two_sided = light;
  two_sided.two_sided = true;
  EXPECT_NEAR(irradiance_of(two_sided, {0, 4, 0}, {0, -1, 0}), of_rectangle(light, {0, 0, 0}, {0, 1, 0}), 1e-3);
  EXPECT_EQ(irradiance_of(light, {0, 4, 0}, {0, -1, 0}), 0);
}

TEST(Lights, ADiskGivesTheIrradianceOfItsClosedForm) {
  const scene::DiskLight light{{0, 2, 0}, {0, -1, 0}, 0.7f, {1, 1, 1}, false};
  // A small surface parallel to a disk, aside of its axis (Howell, catalog of configuration factors, B-14).
  const auto exact_at = [](double a, double h, double r) {
    const double z = a * a + h * h + r * r;
    return std::numbers::pi * 0.5 * (1 - (a * a + h * h - r * r) / std::sqrt(z * z - 4 * a * a * r * r));
  };
  struct Case {
    float a, h;
  };
  for (const auto& [a, h] : {Case{0, 2}, Case{0, 0.3f}, Case{0.5f, 0.4f}, Case{2, 1}, Case{5, 0.5f}, Case{0, 1e4f}}) {
    const double exact = exact_at(static_cast<double>(a), static_cast<double>(h), 0.7);
    EXPECT_NEAR(irradiance_of(light, {a, 2 - h, 0}, {0, 1, 0}), exact, 3e-3 * exact) << a << " " << h;
  }
  EXPECT_EQ(irradiance_of(light, {0, 3, 0}, {0, -1, 0}), 0);
}

TEST(Lights, ASphereGivesTheIrradianceOfItsClosedForm) {
  const scene::SphereLight light{{0, 2, 0}, 0.7f, {1, 1, 1}};
  const glm::vec3 tilted = glm::normalize(glm::vec3(0.5f, 0.8f, 0.1f));
  for (const float d : {0.701f, 0.8f, 2.0f, 50.0f, 10000.0f})
    for (const glm::vec3& n : {glm::vec3(0, 1, 0), tilted}) {
      const double sine = 0.7 / static_cast<double>(d), cosine = static_cast<double>(n.y);
      if (std::acos(cosine) + std::asin(sine) > std::numbers::pi / 2) continue;  // partly below the horizon
      const double exact = std::numbers::pi * sine * sine * cosine;
      EXPECT_NEAR(irradiance_of(light, {0, 2 - d, 0}, n), exact, 1e-3 * exact) << d;
    }
  // Half below the horizon: a normal square to the way. The form factor of a half-hidden sphere (Howell B-43 with the
  // plane through its center): (asin s - s sqrt(1 - s^2)) / pi, s = r / d.
  const double s = 0.7 / 2, exact = std::asin(s) - s * std::sqrt(1 - s * s);
  EXPECT_NEAR(irradiance_of(light, {0, 0, 0}, {1, 0, 0}), exact, 2e-3 * exact);
  EXPECT_EQ(irradiance_of(light, {0, 2.1f, 0}, {0, 1, 0}), 0);  // inside
}

TEST(Lights, PointsSpotsAndDirectionsHaveTheIrradianceThatIsWritten) {
  EXPECT_NEAR(irradiance_of(scene::PointLight{{0, 3, 0}, {18, 1, 1}}, {0, 0, 0}, {0, 1, 0}), 2, 1e-6);
  EXPECT_NEAR(irradiance_of(scene::PointLight{{0, 3, 4}, {25, 1, 1}}, {0, 0, 0}, {0, 1, 0}), 0.6, 1e-6);
  EXPECT_NEAR(irradiance_of(scene::DirectionalLight{{0, -1, 0}, {5, 1, 1}}, {0, 0, 0}, {0, 0.6f, 0.8f}), 3, 1e-6);
  EXPECT_EQ(irradiance_of(scene::PointLight{{0, 0, 0}, {1, 1, 1}}, {0, 0, 0}, {0, 1, 0}), 0);  // at the light itself
  const scene::SpotLight spot{{0, 1, 0}, {0, -1, 0}, {1, 1, 1}, 0.3f, 0.5f};
  const auto at = [&](double angle) {  // the intensity there
    const glm::vec3 p{std::tan(angle), 0, 0};
    const glm::vec3 n = glm::normalize(spot.position - p);
    return irradiance_of(spot, p, n) / std::pow(std::cos(angle), 2);
  };
  EXPECT_NEAR(at(0), 1, 1e-5);
  EXPECT_NEAR(at(0.29), 1, 1e-5);
  EXPECT_NEAR(at(0.51), 0, 1e-6);
  const double t = (std::cos(0.42) - std::cos(0.5)) / (std::cos(0.3) - std::cos(0.5));
  EXPECT_NEAR(at(0.42), t * t * (3 - 2 * t), 1e-4);
  // Cones of one angle are a step, and not a division by 0.
  const scene::SpotLight sharp{{0, 1, 0}, {0, -1, 0}, {1, 1, 1}, 0.5f, 0.5f};
  EXPECT_NEAR(irradiance_of(sharp, {0.4f, 0, 0}, {0, 1, 0}), std::pow(1 / 1.16, 1.5), 1e-5);
  EXPECT_EQ(irradiance_of(sharp, {0.6f, 0, 0}, {0, 1, 0}), 0);
}

TEST(Lights, RangesEndWhereTheySay) {
  auto scene = scene_of({scene::PointLight{{0, 0, 0}, {1, 1, 1}}, scene::SphereLight{{0, 0, 0}, 0.5f, {1, 1, 1}}});
  scene.lights[0].range = scene.lights[1].range = 10;
  const Lights lights(scene);
  const auto window = [](double d) { return std::pow(std::max(1 - std::pow(d / 10, 4), 0.0), 2); };
  for (const double d : {1.0, 5.0, 9.0, 9.9, 10.1, 100.0}) {
    const glm::vec3 p{0, -d, 0};
    EXPECT_NEAR(irradiance(lights, 0, p, {0, 1, 0}), window(d) / (d * d), 1e-6) << d;
    const double near = d - 0.5;
    const Sample middle = lights.sample_light(1, p, {0, 0});
    EXPECT_NEAR(middle.is_some() ? static_cast<double>(middle.value.r * middle.pdf) : 0.0, window(near), 1e-5) << d;
    EXPECT_NEAR(lights.radiance(1, {0, 1, 0}, static_cast<float>(near), {0, -1, 0}).r, window(near), 1e-5) << d;
  }
}

TEST(Lights, ProfilesTurnWithTheLight) {
  auto scene = scene_of({scene::PointLight{{0, 3, 0}, {9, 9, 9}}});
  scene.profiles.push_back({"", scene::Profile::Type::kC, {0, 90}, {0}, {200, 50}});
  scene.lights[0].profile = 0;
  EXPECT_NEAR(irradiance(Lights(scene), 0, {0, 0, 0}, {0, 1, 0}), 1, 1e-5);  // below: all of it
  EXPECT_NEAR(irradiance(Lights(scene), 0, {3, 0, 0}, {0, 1, 0}), 0.5 * (125.0 / 200) / std::sqrt(2), 1e-5);
  EXPECT_EQ(irradiance(Lights(scene), 0, {0, 6, 0}, {0, -1, 0}), 0);  // above: none
  scene.lights[0].profile_axis = {0, 1, 0};
  EXPECT_NEAR(irradiance(Lights(scene), 0, {0, 6, 0}, {0, -1, 0}), 1, 1e-5);
}

// ---- the choice among lights

scene::Scene all_kinds() {
  scene::Scene scene = scene_of({
      scene::PointLight{{1, 2, 0}, {2, 1, 1}},
      scene::SpotLight{{-1, 3, 0}, {0, -1, 0}, {5, 5, 5}, 0.5f, 0.9f},
      scene::DirectionalLight{{0.6f, -0.8f, 0}, {1, 1, 2}},
      scene::RectangleLight{{0, 4, 0}, {1, 0, 0}, {0, 0, 1}, {3, 3, 3}, false},
      scene::DiskLight{{3, 1, 0}, {-1, 0, 0}, 0.5f, {6, 6, 6}, true},
      scene::SphereLight{{0, -3, 0}, 0.5f, {2, 2, 2}},
      scene::SphereLight{{-3, 1, 1}, 0.2f, {30, 20, 10}},
  });
  scene.lights[6].is_visible = false;
  scene.lights[6].range = 7;
  scene::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5f}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  scene.meshes = {mesh};
  scene.materials.resize(2);
  scene.materials[1].emission = {4, 4, 1};
  glm::mat4 place(1);
  place[3] = {0, 1, -3, 1};
  scene.instances = {{"dark", 0, 0, glm::mat4(1)}, {"bright", 0, 1, place}};
  scene.instances[0].world_from_object[3] = {100, 100, 100, 1};
  scene.images.push_back({"sky", {4, 2, 1, {}, {1, 2, 3, 4, 1, 1, 1, 1}}});
  scene.environment = scene::Environment{0, {0.1f, 0.1f, 0.1f}, 0};
  return scene;
}

const std::vector<std::pair<glm::vec3, glm::vec3>> kPlaces{
    {{0, 0, 0}, {0, 1, 0}},      {{0.2f, 0.1f, 0.3f}, {0, -1, 0}}, {{2, 5, 0}, {0, -1, 0}},
    {{0, 3.99f, 0}, {0, 1, 0}},  {{0, -3, 0}, {0, 1, 0}},          {{50, 0, 3}, {-1, 0, 0}},
    {{-3, 1, 1.1f}, {0, 0, -1}}, {{0.2f, 1.2f, -2.9f}, {0, 0, -1}}};

TEST(Lights, AreChosenAsOftenAsValueAndDensitySay) {
  const auto scene = all_kinds();
  const Lights lights(scene);
  ASSERT_EQ(lights.count(), 9u);
  for (const auto& [point, normal] : kPlaces) {
    std::vector<double> counts(lights.count(), 0), stated(lights.count(), 0);
    for (std::uint32_t i = 0; i < kLightDraws; ++i) {
      const glm::vec2 u = sampling::Samples(3, i, 1).next();
      const float choice = (static_cast<float>(i) + 0.5f) / kLightDraws;
      const Sample s = lights.sample(point, normal, choice, u);
      if (!s.is_some()) continue;
      ++counts[s.light];
      const Sample alone = lights.sample_light(s.light, point, u);
      ASSERT_EQ(alone.to_light, s.to_light);
      ASSERT_EQ(alone.distance, s.distance);
      const float p = alone.value.r / s.value.r;
      stated[s.light] = static_cast<double>(p);
      if (alone.pdf > 0) {
        ASSERT_NEAR(s.pdf / alone.pdf, p, 1e-5f * p);
      } else {
        ASSERT_EQ(s.pdf, 0);
      }
    }
    double sum = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      sum += stated[i];
      // A light that sends nothing from some of its places has fewer samples than choices.
      EXPECT_LE(counts[i] / kLightDraws, stated[i] + 1e-3) << i;
      if (i != 5 && i != 7 && i != 8) {
        EXPECT_NEAR(counts[i] / kLightDraws, stated[i], 1e-3) << i << " at " << point.x;
      }
    }
    EXPECT_LE(sum, 1 + 1e-5);
  }
}

// Light that arrives is never left out: where a light alone sends something to the upper side, it has a chance.
TEST(Lights, ThatSendSomethingHaveAChance) {
  for (std::size_t kind = 0; kind < 7; ++kind) {
    auto scene = scene_of({all_kinds().lights[kind].shape, scene::DirectionalLight{{0, 0, 1}, {1e-3f, 0, 0}}});
    scene.lights[0].range = kind == 6 ? 7 : scene::kForever;
    const Lights lights(scene);
    int sent = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      sampling::Samples r(i, 0, 3);
      const glm::vec2 a = r.next(), b = r.next(), c = r.next();
      const glm::vec3 point{10 * a.x - 5, 10 * a.y - 5, 10 * b.x - 5};
      const glm::vec3 normal = glm::normalize(glm::vec3(c.x - 0.5f, c.y - 0.5f, b.y - 0.5f));
      const glm::vec2 u = r.next();
      const Sample alone = lights.sample_light(0, point, u);
      // 1e-5: of light that is at the horizon by rounding.
      if (!alone.is_some() || !(glm::dot(alone.to_light, normal) > 1e-5f)) continue;
      ++sent;
      const Sample s = lights.sample(point, normal, 0, u);  // the first that has a weight
      ASSERT_TRUE(s.is_some() || glm::dot(normal, glm::vec3(0, 0, -1)) > 0) << kind;
      // The chance that both lights have is that of one: not the other's alone.
      double least = 1;
      for (const float choice : {0.0f, 0.25f, 0.5f, 0.75f, 0.999f}) {
        const Sample one = lights.sample(point, normal, choice, u);
        if (one.light == 0 && one.is_some()) least = 0;
      }
      ASSERT_EQ(least, 0) << kind << " " << point.x << " " << point.y << " " << point.z;
    }
    EXPECT_GT(sent, 100) << kind;
  }
}

// What a ray that meets a light says of the density is what the sample said.
TEST(Lights, StateTheDensityOfASampleToARayThatMeetsThem) {
  const auto scene = all_kinds();
  const Lights lights(scene);
  const ray::Tracer tracer(scene, {});
  std::vector<int> met(lights.count(), 0);
  for (const auto& [point, normal] : kPlaces)
    for (std::uint32_t i = 0; i < 4000; ++i) {
      sampling::Samples r(3, i, 1);
      const float choice = r.next().x;
      const Sample s = lights.sample(point, normal, choice, r.next());
      if (!s.is_some() || s.pdf == 0) continue;
      if (s.light == lights.environment_index()) {
        const float pdf = lights.environment_pdf(point, normal, s.to_light);
        if (std::abs(pdf / s.pdf - 1) < 1e-3f) ++met[s.light];
        continue;
      }
      const ray::Hit hit = tracer.closest({point, s.distance * 0.999f, s.to_light, s.distance * 1.001f});
      if (!hit.is_some()) continue;  // past the edge, by rounding
      const bool is_emitter = s.light >= scene.lights.size();
      ASSERT_EQ(hit.surface, is_emitter ? 1 : scene.instances.size() + s.light);
      const glm::vec3 n = glm::normalize(hit.normal);
      const float pdf = is_emitter
                            ? lights.emitter_pdf(hit.surface, hit.triangle, point, normal, s.to_light, hit.distance, n)
                            : lights.light_pdf(s.light, point, normal, s.to_light, hit.distance);
      // Triangles that share an edge have each its own.
      if (is_emitter && (hit.u < 1e-3f || hit.v < 1e-3f || hit.u + hit.v > 0.999f)) continue;
      ASSERT_NEAR(pdf / s.pdf, 1, 2e-3) << s.light;
      if (!is_emitter) {
        const float back = lights.radiance(s.light, s.to_light, hit.distance, hit.normal).r / pdf;
        ASSERT_NEAR(s.value.r / back, 1, 4e-3) << s.light;
      }
      ++met[s.light];
    }
  for (const std::size_t i : {3u, 4u, 5u, 7u, 8u}) EXPECT_GT(met[i], 500) << i;
}

TEST(Lights, DoNotMindAThousandOfThem) {
  std::vector<scene::LightShape> shapes;
  for (int i = 0; i < 1000; ++i)
    shapes.push_back(scene::PointLight{{0, 0, 10}, glm::vec3(i % 10 == 0 ? 0.0f : static_cast<float>(1 + i % 7))});
  const auto scene = scene_of(shapes);
  const Lights lights(scene);
  std::vector<double> counts(1000, 0), expected(1000, 0);
  constexpr std::uint32_t kMany = 1u << 18;
  for (std::uint32_t i = 0; i < kMany; ++i) {
    const Sample s = lights.sample({0, 0, 0}, {0, 0, 1}, sampling::unit(sampling::mixed(i)), {0, 0});
    ASSERT_TRUE(s.is_some());
    ++counts[s.light];
  }
  double total = 0;
  for (int i = 0; i < 1000; ++i) total += i % 10 == 0 ? 0 : 1 + i % 7;
  for (int i = 0; i < 1000; ++i) expected[static_cast<std::size_t>(i)] = (i % 10 == 0 ? 0 : 1 + i % 7) / total * kMany;
  EXPECT_GE(brdf::chi_square(counts, expected).p, 0.01);  // significance 1 %; fixed numbers
  // Whichever is chosen, value is what all of them together send: each was chosen in proportion to its own.
  const Sample one = lights.sample({0, 0, 0}, {0, 0, 1}, 0.3f, {0, 0});
  EXPECT_NEAR(static_cast<double>(one.value.r), total / 100, 1e-4 * total);
}

TEST(Lights, ThatPathsCannotMeetSayThatOnlyTheirChoiceFindsThem) {
  for (const scene::LightShape& shape : std::initializer_list<scene::LightShape>{
           scene::RectangleLight{{0, 2, 0}, {1, 0, 0}, {0, 0, 1}, {1, 1, 1}},
           scene::DiskLight{{0, 2, 0}, {0, -1, 0}, 1, {1, 1, 1}}, scene::SphereLight{{0, 2, 0}, 1, {1, 1, 1}}}) {
    auto scene = scene_of({shape});
    EXPECT_GT(Lights(scene).sample_light(0, {0, 0, 0}, {0.3f, 0.6f}).pdf, 0);
    scene.lights[0].is_visible = false;
    const Sample s = Lights(scene).sample_light(0, {0, 0, 0}, {0.3f, 0.6f});
    EXPECT_TRUE(s.is_some());
    EXPECT_EQ(s.pdf, 0);
  }
}

TEST(Lights, OfASceneWithoutAnyAreNone) {
  const scene::Scene scene;
  const Lights lights(scene);
  EXPECT_TRUE(lights.is_empty());
  EXPECT_FALSE(lights.sample({0, 0, 0}, {0, 1, 0}, 0.5f, {0.5f, 0.5f}).is_some());
}

}  // namespace
}  // namespace likeness::light
