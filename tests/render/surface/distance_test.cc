#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "brdf/callisto_proxima.h"
#include "brdf/normal_length.h"
#include "render/sampling/sobol.h"
#include "render/surface/surfaces.h"

// What pixels see of surfaces: footprints, and kernels for bumps that are too small to be seen.
namespace likeness::surface {
namespace {

using C = brdf::Callisto<double>;

struct Random {
  std::uint32_t state = 7;
  float next() { return sampling::unit(state = sampling::mixed(state + 0x9e3779b9u)); }
  glm::vec3 direction() {
    const float z = 0.02f + 0.98f * next(), phi = 6.2831853f * next(), s = std::sqrt(1 - z * z);
    return {s * std::cos(phi), s * std::sin(phi), z};
  }
};

scene::Scene scene_of(const C& model, bool has_dual_normals) {
  scene::Scene s;
  s.images = {{"", {1, 1, 3, {}, {0.5f, 0.5f, 1}}}};
  s.materials.resize(1);
  s.materials[0].brdf = model;
  if (has_dual_normals) s.materials[0].diffuse_normal_map = s.materials[0].normal_map = scene::Texture{0};
  return s;
}
C model_with(unsigned parts) {
  C c;
  c.base_color = {0.5, 0.3, 0.2}, c.roughness = 0.4;
  if ((parts & C::kDiffuse) == 0) c.metallic = 1;
  if ((parts & C::kRise) != 0) c.diffuse_fresnel = 3;
  if ((parts & C::kRetro) != 0) c.retroreflection = 2;
  if ((parts & C::kTerminator) != 0) c.smooth_terminator = 0.5;
  if ((parts & C::kFalloff) != 0) c.specular_fresnel_falloff = 0.3;
  if ((parts & C::kSecondLobe) != 0) c.dual_specular_opacity = 0.4;
  return c;
}

// Its value against the formula in double, its samples against its value and its density.
TEST(DistantKernel, IsCallistoOverProximaOfTheBumps) {
  for (const bool is_dual : {false, true})
    for (unsigned parts = 0; parts <= C::kAllParts; ++parts) {
      SCOPED_TRACE(std::to_string(parts) + (is_dual ? " dual" : ""));
      const C exact = model_with(parts);
      const scene::Scene s = scene_of(exact, is_dual);
      const auto prepared = prepare_materials(s);
      const Kernel& k = prepared[0].distant_kernel;
      Random random;
      for (const float bumps : {0.0f, 0.1f, 0.9f}) {
        Bound bound{&prepared[0].model};
        bound.bumps = bumps;
        for (int i = 0; i < 60; ++i) {
          const glm::vec3 l = random.direction(), v = random.direction();
          const glm::dvec3 dl = glm::normalize(glm::dvec3(l)), dv = glm::normalize(glm::dvec3(v));
          const brdf::Geometry<double> g({dl.x, dl.y, dl.z}, {dv.x, dv.y, dv.z});
          const auto f = brdf::callisto_over_proxima<C::kAllParts>(exact, g, static_cast<double>(bumps));
          const Value value = k.eval(bound, l, v);
          for (const auto& [got, want] :
               {std::pair{value.f_cos.r, f.r}, std::pair{value.f_cos.g, f.g}, std::pair{value.f_cos.b, f.b}})
            ASSERT_NEAR(static_cast<double>(got), want * dl.z, 1e-4 * want * dl.z + 1e-7) << bumps;
          if (bumps == 0) {
            const Value plain = prepared[0].kernel.eval(bound, l, v);
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(value.f_cos[c], plain.f_cos[c], 1e-6f * plain.f_cos[c]);
          }
          const Lobes lobes = k.lobes(bound, l, v);
          for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(lobes.diffuse[c] + lobes.specular[c], value.f_cos[c], 1e-4f * value.f_cos[c] + 1e-6f);
          const Direction d = k.sample(bound, v, random.next(), {random.next(), random.next()});
          if (!(d.pdf > 0)) continue;
          const Value again = k.eval(bound, d.to_light, v);
          ASSERT_NEAR(again.pdf / d.pdf, 1, 1e-4);
          for (int c = 0; c < 3; ++c) ASSERT_NEAR(again.f_cos[c] / d.pdf, d.weight[c], 1e-4f * d.weight[c] + 1e-4f);
        }
      }
    }
}

// What samples of both lobes of Proxima bring is what the formula integrates to.
TEST(DistantKernel, SamplesTheDiffuseOfBumpsWithoutBias) {
  for (const bool is_dual : {false, true}) {
    C matte;
    matte.specular = 0, matte.specular_fresnel_falloff = 0, matte.base_color = {1, 1, 1};
    const scene::Scene s = scene_of(matte, is_dual);
    const auto prepared = prepare_materials(s);
    Bound bound{&prepared[0].model};
    bound.bumps = 0.8f;
    const glm::vec3 v = glm::normalize(glm::vec3(0.5f, 0, 1));
    double sampled = 0, integral = 0;
    constexpr int kCount = 200000;
    Random random;
    for (int i = 0; i < kCount; ++i) {
      const Direction d = prepared[0].distant_kernel.sample(bound, v, random.next(), {random.next(), random.next()});
      if (d.pdf > 0) sampled += static_cast<double>(d.weight.r) / kCount;
      const float z = random.next(), phi = 6.2831853f * random.next(), r = std::sqrt(1 - z * z);
      const Value f = prepared[0].distant_kernel.eval(bound, {r * std::cos(phi), r * std::sin(phi), z}, v);
      integral += 2 * std::numbers::pi * static_cast<double>(f.f_cos.r) / kCount;
    }
    EXPECT_NEAR(sampled, integral, 0.005);  // about four sigma of either
    EXPECT_LT(sampled, 0.95);               // Lambert's is 1
  }
}

// ---- footprints

struct Stage {
  scene::Scene scene;
  Stage() {
    scene.meshes.resize(1), scene.materials.resize(1);
    scene.instances = {{"", 0, 0, glm::mat4(1)}};
    scene::Mesh& mesh = scene.meshes[0];
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  }
  // The footprint at a point against where the rays beside it go.
  void expect_footprint(const glm::vec3& from, const glm::vec3& at, float tolerance) const {
    const auto prepared = prepare_materials(scene);
    const ray::Tracer tracer(scene, {});
    const Surfaces surfaces(scene, tracer, prepared);
    const SceneLevels levels(prepared);
    const glm::vec3 way = glm::normalize(at - from), x = glm::normalize(glm::cross(way, glm::vec3(0.1f, 1, 0.2f))),
                    y = glm::cross(way, x);
    constexpr float kStep = 1e-3f;
    const auto point = [&](const glm::vec3& direction, Point& p) {
      const ray::Ray ray{from, 0, glm::normalize(direction), ray::kFar};
      const ray::Hit hit = tracer.closest(ray);
      ASSERT_TRUE(hit.is_some());
      surfaces.at<Detail::kNone>(ray, hit, p);
    };
    const ray::Ray ray{from, 0, way, ray::kFar};
    const ray::Hit hit = tracer.closest(ray);
    Point p, right, down, left, up;
    point(way, p), point(way + kStep * x, right), point(way + kStep * y, down);
    point(way - kStep * x, left), point(way - kStep * y, up);
    const texture::Footprint f =
        surfaces.footprint(ray, hit, p, {levels, texture::Filter::kAnisotropic, kStep * x, kStep * y});
    const glm::vec2 by_right = 0.5f * (right.uv - left.uv), by_down = 0.5f * (down.uv - up.uv);
    EXPECT_LT(glm::distance(f.right, by_right), tolerance * glm::length(by_right));
    EXPECT_LT(glm::distance(f.down, by_down), tolerance * glm::length(by_down));
  }
};

TEST(Footprint, IsWhereTheRaysOfNeighborsGo) {
  Stage s;
  // Differences of a step of 1e-3 in floats: good to a few thousandths.
  s.expect_footprint({0.2f, 0.1f, 3}, {0.3f, 0.2f, 0}, 0.01f);
  s.expect_footprint({2, 1, 0.7f}, {0.3f, -0.2f, 0}, 0.02f);   // from aside
  s.expect_footprint({2, 1, -0.7f}, {-0.3f, 0.2f, 0}, 0.02f);  // and from behind
  s.scene.instances[0].world_from_object =
      glm::rotate(glm::scale(glm::mat4(1), {-2.0f, 1.0f, 3.0f}), 0.3f, glm::vec3(1, 0, 0));
  s.expect_footprint({0.2f, 0.3f, 4}, {0.3f, 0.2f, 0}, 0.02f);  // mirrored and stretched
  for (glm::vec2& uv : s.scene.meshes[0].uvs) uv = {3 * uv.y - uv.x, 0.5f * uv.x};
  s.expect_footprint({0.2f, 0.3f, 4}, {0.3f, 0.2f, 0}, 0.02f);  // uvs askew
}

TEST(Footprint, OfASphereIsThatOfItsTangentPlane) {
  Stage s;
  s.scene.meshes[0] = {};
  s.scene.meshes[0].is_sphere = true;
  s.scene.instances[0].world_from_object =
      glm::rotate(glm::scale(glm::mat4(1), glm::vec3(0.5f)), 0.4f, glm::vec3(1, 0, 0));
  s.expect_footprint({0.2f, 0.1f, 3}, {0.1f, 0.1f, 0}, 0.02f);
  s.expect_footprint({2, 1, 0.7f}, {0, 0, 0.1f}, 0.02f);
}

TEST(Footprint, IsAPointWithoutUvs) {
  Stage s;
  s.scene.meshes[0].uvs.clear();
  const auto prepared = prepare_materials(s.scene);
  const ray::Tracer tracer(s.scene, {});
  const Surfaces surfaces(s.scene, tracer, prepared);
  const SceneLevels levels(prepared);
  const ray::Ray ray{{0, 0, 2}, 0, {0, 0, -1}, ray::kFar};
  const ray::Hit hit = tracer.closest(ray);
  Point p;
  surfaces.at<Detail::kNone>(ray, hit, p);
  const texture::Footprint f =
      surfaces.footprint(ray, hit, p, {levels, texture::Filter::kAnisotropic, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(f.right, glm::vec2(0));
  EXPECT_EQ(f.down, glm::vec2(0));
}

// ---- levels of a scene

TEST(SceneLevels, AreSharedByTexturesThatDifferOnlyInPlace) {
  scene::Scene s = scene_of(C(), false);
  s.images[0].texels = {64, 64, 3, {}, std::vector<float>(64 * 64 * 3, 0.5f)};
  s.materials[0].bindings = {{0, {.image = 0}}};
  const auto one = prepare_materials(s);
  const std::size_t alone = SceneLevels(one).bytes();
  s.materials.push_back(s.materials[0]);
  s.materials[1].bindings[0].texture.uv_scale = {4, 4};
  s.materials[1].bindings[0].texture.scale = glm::vec3(0.5f);
  const auto two = prepare_materials(s);
  EXPECT_EQ(SceneLevels(two).bytes(), alone);
  EXPECT_LE(alone, 64u * 64 * 3 * sizeof(float) / 3);
  s.materials[1].normal_map = scene::Texture{0};
  const auto three = prepare_materials(s);
  EXPECT_GT(SceneLevels(three).bytes(), alone) << "normals are other means";
}

// The second lobe takes the same bumps as the first, not a multiple of what the first becomes.
TEST(Roughen, GivesBothLobesTheSameBumps) {
  C c;
  c.roughness = 0.2, c.dual_specular_opacity = 0.5, c.dual_specular_roughness_scale = 3;
  scene::Scene s = scene_of(c, false);
  s.materials[0].normal_map = scene::Texture{0};
  const auto prepared = prepare_materials(s);
  ModelBytes bytes = prepared[0].model;
  roughen(prepared[0], 0.05f, bytes);
  const auto& model = *reinterpret_cast<const brdf::Callisto<float>*>(&bytes);
  const auto with_bumps = [](double roughness) {
    const double deficit = 1 - (1 - brdf::normal_deficit(std::pow(roughness, 2))) * (1 - 0.05);
    return std::sqrt(brdf::alpha_of_normal_deficit(deficit));
  };
  EXPECT_NEAR(model.roughness, with_bumps(0.2), 3e-4);
  EXPECT_NEAR(model.roughness * model.dual_specular_roughness_scale, with_bumps(0.6), 6e-4);
  ModelBytes untouched = prepared[0].model;
  roughen(prepared[0], 0, untouched);
  EXPECT_EQ(untouched.bytes, prepared[0].model.bytes);
}

}  // namespace
}  // namespace likeness::surface
