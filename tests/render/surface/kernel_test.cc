#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/sampling/sobol.h"
#include "render/surface/materials.h"

// What a renderer calls against the models themselves in double.
namespace likeness::surface {
namespace {

using C = brdf::Callisto<double>;

struct KernelDraws {
  std::uint32_t state = 1;
  float next() { return sampling::unit(state = sampling::mixed(state + 0x9e3779b9u)); }
  // Above the horizon; some of them grazing.
  glm::vec3 direction() {
    const float z = next() < 0.8f ? 0.02f + 0.98f * next() : 0.001f + 0.02f * next(), phi = 6.2831853f * next();
    const float s = std::sqrt(1 - z * z);
    return {s * std::cos(phi), s * std::sin(phi), z};
  }
};

// A material made ready, alive with its scene.
struct Ready {
  scene::Scene scene;
  std::vector<Prepared> prepared;
  explicit Ready(const scene::Material& material, bool force = false) {
    scene.materials = {material};
    scene.images = {{"", {1, 1, 3, {}, {0.5f, 0.5f, 1}}}};
    prepared = prepare_materials(scene, force);
  }
  Ready(const Ready&) = delete;
  const Prepared& operator*() const { return prepared[0]; }
  Bound bound() const { return {&prepared[0].model}; }
};
scene::Material material_of(const brdf::AnyBrdf& brdf) {
  scene::Material m;
  m.brdf = brdf;
  return m;
}

brdf::Vec3<double> in_double(const glm::vec3& v) {
  const glm::dvec3 d = glm::normalize(glm::dvec3(v));
  return {d.x, d.y, d.z};
}

// A kernel's eval against f cos_i in double; its samples against its own eval, density and weight.
void expect_kernel(const std::string& what, const brdf::AnyBrdf& any, double tolerance = 4e-5) {
  SCOPED_TRACE(what);
  const Ready ready(material_of(any));
  const Kernel& k = (*ready).kernel;
  const Bound bound = ready.bound();
  KernelDraws random;
  double worst = 0, worst_weight = 0, worst_lobes = 0;
  std::visit(
      [&](const auto& model) {
        for (int i = 0; i < 3000; ++i) {
          const glm::vec3 l = random.direction(), v = random.direction();
          const auto f = model.eval(in_double(l), in_double(v));
          const double cosine = static_cast<double>(l.z) / static_cast<double>(glm::length(l));
          const Value value = k.eval(bound, l, v);
          const glm::dvec3 exact(f.r * cosine, f.g * cosine, f.b * cosine);
          const Lobes lobes = k.lobes(bound, l, v);
          for (int c = 0; c < 3; ++c) {
            const double scale = std::max(exact[c], 1e-6);
            worst = std::max(worst, std::abs(static_cast<double>(value.f_cos[c]) - exact[c]) / scale);
            worst_lobes = std::max(
                worst_lobes, std::abs(static_cast<double>(lobes.diffuse[c] + lobes.specular[c]) - exact[c]) / scale);
            ASSERT_GE(lobes.diffuse[c], 0);
            ASSERT_GE(lobes.specular[c], 0);
          }
          const double pdf = model.pdf(in_double(l), in_double(v));
          ASSERT_NEAR(static_cast<double>(value.pdf), pdf, 1e-4 * pdf + 1e-9);

          const glm::vec2 u{random.next(), random.next()};
          const Direction d = k.sample(bound, v, random.next(), u);
          if (!(d.pdf > 0)) continue;
          ASSERT_NEAR(glm::length(d.to_light), 1, 2e-6);
          ASSERT_GT(d.to_light.z, 0);
          const Value again = k.eval(bound, d.to_light, v);
          ASSERT_NEAR(again.pdf / d.pdf, 1, 1e-4);
          for (int c = 0; c < 3; ++c)
            worst_weight = std::max(worst_weight, std::abs(static_cast<double>(again.f_cos[c] / d.pdf - d.weight[c])) /
                                                      std::max(1e-4, static_cast<double>(d.weight[c])));
        }
      },
      any);
  EXPECT_LT(worst, tolerance);
  EXPECT_LT(worst_lobes, 2 * tolerance + 1e-4);
  EXPECT_LT(worst_weight, 1e-4);  // f cos / pdf of the same direction, by other roundings
  for (const glm::vec3& below : {glm::vec3(0.6f, 0, -0.8f), glm::vec3(1, 0, 0)}) {
    EXPECT_EQ(k.eval(bound, below, {0, 0, 1}).f_cos, glm::vec3(0));
    EXPECT_EQ(k.eval(bound, {0, 0, 1}, below).f_cos, glm::vec3(0));
    EXPECT_EQ(k.eval(bound, {0, 0, 1}, below).pdf, 0);
    EXPECT_EQ(k.sample(bound, below, 0.5f, {0.5f, 0.5f}).pdf, 0);
  }
}

TEST(Kernel, OfEveryModelIsTheModel) {
  for (const auto name : brdf::kModelNames) {
    brdf::AnyBrdf model;
    ASSERT_TRUE(brdf::model_of_name(name, model));
    expect_kernel(std::string(name), model);
  }
}

// Every set of parts: a material that needs just these.
C with_parts(unsigned parts) {
  C c;
  c.roughness = 0.4;
  c.base_color = {0.7, 0.4, 0.2};
  if ((parts & C::kDiffuse) == 0) c.metallic = 1;
  if (parts & C::kRise) c.diffuse_fresnel = 4, c.diffuse_fresnel_tint = {1, 0.5, 0.2};
  if (parts & C::kRetro) c.retroreflection = 3, c.retroreflection_tint = {0.3, 1, 0.6};
  if (parts & C::kTerminator) c.smooth_terminator = 0.7, c.smooth_terminator_tint = {1, 0.2, 0.9};
  if (parts & C::kFalloff) c.specular_fresnel_falloff = 0.8;
  if (parts & C::kSecondLobe) c.dual_specular_opacity = 0.3;
  return c;
}

TEST(Kernel, OfEverySetOfPartsIsCallisto) {
  for (unsigned parts = 0; parts <= C::kAllParts; ++parts) {
    const C model = with_parts(parts);
    const bool has_diffuse = (parts & C::kDiffuse) != 0;
    const Ready ready(material_of(model)), forced(material_of(model), true);
    // Rises of a diffuse that is not there are not needed.
    EXPECT_EQ((*ready).callisto_parts, has_diffuse ? parts : parts & ~static_cast<unsigned>(C::kRise | C::kRetro));
    EXPECT_EQ((*forced).callisto_parts, static_cast<unsigned>(C::kAllParts));
    expect_kernel("parts " + std::to_string(parts), model);
    // The kernel that has every part says the same of it.
    KernelDraws random;
    for (int i = 0; i < 300; ++i) {
      const glm::vec3 l = random.direction(), v = random.direction();
      const Value a = (*ready).kernel.eval(ready.bound(), l, v), b = (*forced).kernel.eval(forced.bound(), l, v);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(a.f_cos[c], b.f_cos[c], 1e-6f * (1e-3f + a.f_cos[c])) << parts;
      ASSERT_NEAR(a.pdf, b.pdf, 2e-6f * a.pdf) << parts;
      const glm::vec2 u{random.next(), random.next()};
      const float choice = random.next();
      const Direction x = (*ready).kernel.sample(ready.bound(), v, choice, u),
                      y = (*forced).kernel.sample(forced.bound(), v, choice, u);
      ASSERT_LT(glm::distance(x.to_light, y.to_light), 1e-6f) << parts;
    }
  }
}

TEST(Kernel, LobesOfCallistoAreItsDiffuseAndItsSpecular) {
  C model = with_parts(C::kAllParts), black = model;
  black.base_color = brdf::Rgb<double>(0.0);
  black.metallic = model.metallic = 0;
  const Ready ready(material_of(model));
  KernelDraws random;
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 l = random.direction(), v = random.direction();
    const Lobes lobes = (*ready).kernel.lobes(ready.bound(), l, v);
    const auto f = black.eval(in_double(l), in_double(v));  // without base color it has no diffuse
    ASSERT_NEAR(static_cast<double>(lobes.specular.g), f.g * static_cast<double>(l.z), 1e-4 * f.g + 1e-7);
  }
}

// ---- dual normals

TEST(DualNormals, ThatAreEqualAreOne) {
  for (const unsigned parts : {63u, 1u, 33u, 28u}) {
    const C model = with_parts(parts);
    auto material = material_of(model);
    const Ready one(material);
    material.normal_map = material.diffuse_normal_map = scene::Texture{0};
    const Ready two(material);
    ASSERT_TRUE((*two).has_dual_normals());
    KernelDraws random;
    for (int i = 0; i < 2000; ++i) {
      const glm::vec3 l = random.direction(), v = random.direction();
      const Value a = (*one).kernel.eval(one.bound(), l, v), b = (*two).kernel.eval(two.bound(), l, v);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(a.f_cos[c], b.f_cos[c], 2e-5f * (1e-3f + a.f_cos[c])) << parts;
      ASSERT_NEAR(a.pdf, b.pdf, 1e-4f * a.pdf + 1e-6f) << parts << " " << v.z;
      const Lobes x = (*one).kernel.lobes(one.bound(), l, v), y = (*two).kernel.lobes(two.bound(), l, v);
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(x.diffuse[c], y.diffuse[c], 3e-5f * (1e-2f + a.f_cos[c])) << parts;
        ASSERT_NEAR(x.specular[c], y.specular[c], 3e-5f * (1e-2f + a.f_cos[c])) << parts;
      }
    }
  }
}

// Apart, by any angle: samples have the density that eval states, and its integral is what is not lost below.
TEST(DualNormals, AreSampledByTheDensityTheyState) {
  C model = with_parts(C::kAllParts);
  model.metallic = 0;
  auto material = material_of(model);
  material.normal_map = material.diffuse_normal_map = scene::Texture{0};
  const Ready ready(material);
  const Kernel& k = (*ready).kernel;
  KernelDraws random;
  for (const glm::vec3& view :
       {glm::vec3(0, 0, 1), glm::normalize(glm::vec3(1, 0.3f, 0.2f)), glm::normalize(glm::vec3(-1, 0, 0.02f))})
    for (const float tilt : {0.0f, 0.3f, 0.8f}) {
      Bound bound = ready.bound();
      bound.diffuse_normal = glm::normalize(glm::vec3(tilt, 0, 1));
      bound.specular_normal = glm::normalize(glm::vec3(0, -tilt, 1));
      int kept = 0;
      constexpr int kDraws = 200000;
      double mean = 0, squares = 0;
      for (int i = 0; i < kDraws; ++i) {
        const Direction d = k.sample(bound, view, random.next(), {random.next(), random.next()});
        if (!(d.pdf > 0)) continue;
        ++kept;
        const double x = static_cast<double>(d.weight.g);
        mean += x / kDraws, squares += x * x / kDraws;
        if (i % 50 == 0) {
          const Value v = k.eval(bound, d.to_light, view);
          ASSERT_NEAR(v.pdf / d.pdf, 1, 1e-3);
          ASSERT_NEAR(v.f_cos.g / d.pdf, d.weight.g, 1e-3f * (1 + d.weight.g));
        }
      }
      double whole = 0, albedo = 0;  // over the hemisphere, by a midpoint rule in z and azimuth
      constexpr int kSteps = 400;
      for (int a = 0; a < kSteps; ++a)
        for (int b = 0; b < 2 * kSteps; ++b) {
          const double z = (a + 0.5) / kSteps, phi = (b + 0.5) / (2 * kSteps) * 6.283185307, s = std::sqrt(1 - z * z);
          const Value v = k.eval(bound, {s * std::cos(phi), s * std::sin(phi), z}, view);
          whole += static_cast<double>(v.pdf) * 6.283185307 / (2.0 * kSteps * kSteps);
          albedo += static_cast<double>(v.f_cos.g) * 6.283185307 / (2.0 * kSteps * kSteps);
        }
      const double share = static_cast<double>(kept) / kDraws;
      // 4.5 standard errors of 200000 draws, and 1 % of the quadrature at a lobe of alpha 0.16.
      EXPECT_NEAR(share, whole, 4.5 * std::sqrt(share * (1 - share) / kDraws) + 0.01) << tilt << " " << view.z;
      EXPECT_NEAR(mean, albedo, 4.5 * std::sqrt(std::max(squares - mean * mean, 0.0) / kDraws) + 0.01 * albedo)
          << tilt << " " << view.z;
    }
}

}  // namespace
}  // namespace likeness::surface
