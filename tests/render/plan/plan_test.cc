#include <functional>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "render/plan/plan.h"

namespace likeness::plan {
namespace {

using C = brdf::Callisto<double>;

// A scene that calls for nothing: black metal (no diffuse), no light, a pinhole. Material 1 is not used.
scene::Scene base() {
  scene::Scene scene;
  scene.meshes.resize(1);
  C metal;
  metal.metallic = 1;
  scene.materials.resize(2);
  scene.materials[0].name = "steel";
  scene.materials[0].brdf = scene.materials[1].brdf = metal;
  scene.instances = {{"thing", 0, 0, glm::mat4(1)}};
  scene.images = {{"picture.png", {1, 1, 3, {}, {1, 1, 1}}}, {"bumps.png", {2, 1, 3, {}, {1, 1, 1, 0, 1, 1}}}};
  scene.profiles = {{"lamp.ies", {}, {0, 90}, {0}, {1, 1}}};
  scene.cameras = {{.name = "front"}, {.name = "other"}};
  return scene;
}
C& callisto(scene::Scene& s) { return std::get<C>(s.materials[0].brdf); }

// The edit that an effect is called for by, what comes with it of need, and words of the fact.
struct Case {
  std::function<void(scene::Scene&)> edit;
  std::set<Effect> with;
  std::string fact;
};
const std::map<Effect, Case>& cases() {
  static const std::map<Effect, Case> all{
      {Effect::kDiffuse, {[](auto& s) { callisto(s).metallic = 0.5; }, {}, "material \"steel\": metallic = 0.5"}},
      {Effect::kDiffuseFresnel,
       {[](auto& s) { callisto(s).metallic = 0, callisto(s).diffuse_fresnel = 4; },
        {Effect::kDiffuse},
        "diffuse_fresnel = 4"}},
      {Effect::kRetroreflection,
       {[](auto& s) { callisto(s).metallic = 0, callisto(s).retroreflection = 3; },
        {Effect::kDiffuse},
        "retroreflection = 3"}},
      {Effect::kSmoothTerminator,
       {[](auto& s) { callisto(s).smooth_terminator = -0.25; }, {}, "smooth_terminator = -0.25"}},
      {Effect::kSpecularFalloff,
       {[](auto& s) { callisto(s).specular_fresnel_falloff = 0.7; }, {}, "specular_fresnel_falloff = 0.7"}},
      {Effect::kSecondLobe,
       {[](auto& s) { callisto(s).dual_specular_opacity = 0.1; }, {}, "dual_specular_opacity = 0.1"}},
      {Effect::kOtherModels, {[](auto& s) { s.materials[0].brdf = brdf::Ggx<double>(); }, {}, "model ggx"}},
      {Effect::kTextures,
       {[](auto& s) { s.materials[0].bindings = {{3, {.image = 0}}}; },
        {},
        "material \"steel\": roughness has a texture"}},
      {Effect::kTextureLevels,
       {[](auto& s) { s.materials[0].bindings = {{3, {.image = 1}}}; },
        {Effect::kTextures},
        "material \"steel\": roughness has 2 x 1 texels"}},
      {Effect::kProxima,
       {[](auto& s) { callisto(s).metallic = 0, s.materials[0].normal_map = scene::Texture{1}; },
        {Effect::kDiffuse, Effect::kNormalMaps, Effect::kTextureLevels},
        "material \"steel\": normal_map has 2 x 1 texels"}},
      {Effect::kNormalMaps,
       {[](auto& s) { s.materials[0].normal_map = scene::Texture{0}; }, {}, "material \"steel\": normal_map"}},
      {Effect::kDualNormals,
       {[](auto& s) { s.materials[0].diffuse_normal_map = scene::Texture{0}; }, {}, "diffuse_normal_map"}},
      {Effect::kRealis,
       {[](auto& s) {
          s.bakes.emplace_back().name = "photos/bake";
          s.materials[0].residual.emplace().bake = 0;
        },
        {},
        "material \"steel\": bake \"photos/bake\""}},
      {Effect::kCutOuts, {[](auto& s) { s.materials[0].opacity = scene::Texture{0}; }, {}, "opacity"}},
      {Effect::kEmission, {[](auto& s) { s.materials[0].emission = {0, 0, 1}; }, {}, "emission"}},
      {Effect::kPointLights, {[](auto& s) { s.lights = {{"lamp", scene::SpotLight{}}}; }, {}, "light \"lamp\": spot"}},
      {Effect::kAreaLights, {[](auto& s) { s.lights = {{"", scene::DiskLight{}}}; }, {}, "light 0: disk"}},
      {Effect::kProfiles,
       {[](auto& s) {
          s.lights = {{"lamp", scene::PointLight{}}};
          s.lights[0].profile = 0;
        },
        {Effect::kPointLights},
        "light \"lamp\": profile \"lamp.ies\""}},
      {Effect::kRanges,
       {[](auto& s) {
          s.lights = {{"lamp", scene::SphereLight{}}};
          s.lights[0].range = 5;
        },
        {Effect::kAreaLights},
        "light \"lamp\": range = 5 m"}},
      {Effect::kEnvironment, {[](auto& s) { s.environment.emplace(); }, {}, "environment"}},
      {Effect::kEnvironmentPicture,
       {[](auto& s) { s.environment = scene::Environment{0, {1, 1, 1}, 0}; },
        {Effect::kEnvironment},
        "picture \"picture.png\""}},
      {Effect::kDepthOfField,
       {[](auto& s) { s.cameras[0].lens_radius = 0.25f; }, {}, "camera \"front\": lens radius 0.25 m"}},
  };
  return all;
}

TEST(Plan, OfASceneThatUsesNothingHasNothing) {
  const Plan plan = plan_of(base());
  for (const EffectRow& row : kEffects) {
    EXPECT_FALSE(plan.has(row.effect)) << row.name;
    EXPECT_FALSE(plan.decisions[static_cast<std::size_t>(row.effect)].because.empty()) << row.name;
  }
}

// What a pixel sees of a texture needs levels whatever the texture gives; what only rays read does not.
TEST(Plan, HasLevelsForEveryTextureThatPixelsRead) {
  const scene::Texture bumps{1};
  const auto has = [](const scene::Scene& s, Effect effect) { return plan_of(s).has(effect); };
  scene::Scene s = base();
  s.materials[0].opacity = bumps;
  EXPECT_FALSE(has(s, Effect::kTextureLevels));
  s = base(), s.materials[0].emission_map = bumps;
  EXPECT_TRUE(has(s, Effect::kTextureLevels));
  s = base(), s.materials[0].diffuse_normal_map = bumps;
  EXPECT_TRUE(has(s, Effect::kTextureLevels));
  EXPECT_FALSE(has(s, Effect::kProxima)) << "a metal has no diffuse";
  callisto(s).metallic = 0;
  EXPECT_TRUE(has(s, Effect::kProxima));
  s = base(), callisto(s).metallic = 0, s.materials[0].normal_map = bumps;
  s.materials[0].diffuse_normal_map = scene::Texture{0};
  EXPECT_FALSE(has(s, Effect::kProxima)) << "the bumps are the specular's";
  s = base(), s.materials[0].brdf = brdf::Disney2012<double>(), s.materials[0].normal_map = bumps;
  EXPECT_TRUE(has(s, Effect::kTextureLevels));
  EXPECT_FALSE(has(s, Effect::kProxima)) << "another model";
}

TEST(Plan, IsChangedByEachEditByJustWhatItNeedsAndSaysWhy) {
  std::set<std::string_view> names;
  for (const EffectRow& row : kEffects) {
    SCOPED_TRACE(std::string(row.name));
    EXPECT_TRUE(names.insert(row.name).second);
    EXPECT_FALSE(row.text.empty());
    EXPECT_FALSE(row.saves.empty());
    ASSERT_TRUE(cases().contains(row.effect)) << "an effect without a test: add its edit to cases()";
    const Case& c = cases().at(row.effect);
    auto scene = base();
    c.edit(scene);
    const Plan plan = plan_of(scene), before = plan_of(base());
    for (const EffectRow& other : kEffects) {
      EXPECT_EQ(plan.has(other.effect), other.effect == row.effect || c.with.contains(other.effect)) << other.name;
      if (!plan.has(other.effect)) {
        EXPECT_EQ(plan.decisions[static_cast<std::size_t>(other.effect)].because,
                  before.decisions[static_cast<std::size_t>(other.effect)].because);
      }
    }
    const std::string& because = plan.decisions[static_cast<std::size_t>(row.effect)].because;
    EXPECT_NE(because.find(c.fact), std::string::npos) << because;

    // Forced, every effect is on; those that the scene calls for say so as before.
    const Plan forced = plan_of(scene, 0, true);
    EXPECT_TRUE(forced.is_forced);
    for (const EffectRow& other : kEffects) {
      EXPECT_TRUE(forced.has(other.effect)) << other.name;
      const std::string& why = forced.decisions[static_cast<std::size_t>(other.effect)].because;
      if (plan.has(other.effect)) {
        EXPECT_EQ(why, plan.decisions[static_cast<std::size_t>(other.effect)].because);
      } else {
        EXPECT_EQ(why.rfind("forced (", 0), 0u) << why;
      }
    }
  }
  EXPECT_EQ(cases().size(), kEffectCount);
}

TEST(Plan, CountsOnlyWhatIsUsed) {
  for (const auto& [effect, c] : cases()) {
    auto scene = base();
    c.edit(scene);
    if (!scene.lights.empty() || scene.environment || scene.cameras[0].lens_radius > 0) continue;
    scene.instances.clear();
    EXPECT_FALSE(plan_of(scene).has(effect)) << row_of(effect).name;
    // Its own line is there all the same.
    EXPECT_EQ(plan_of(scene).materials.size(), 2u);
  }
  auto scene = base();
  scene.cameras[1].lens_radius = 1;
  EXPECT_FALSE(plan_of(scene, 0).has(Effect::kDepthOfField));
  EXPECT_TRUE(plan_of(scene, 1).has(Effect::kDepthOfField));
}

// A texture may make of a neutral parameter anything: its part is needed whatever its number is.
TEST(Plan, ATextureOfAParameterCallsForItsPart) {
  const std::map<std::string_view, Effect> parts{
      {"metallic", Effect::kDiffuse},
      {"diffuse_fresnel", Effect::kDiffuseFresnel},
      {"diffuse_fresnel_tint", Effect::kDiffuseFresnel},
      {"retroreflection", Effect::kRetroreflection},
      {"retroreflection_tint", Effect::kRetroreflection},
      {"smooth_terminator", Effect::kSmoothTerminator},
      {"smooth_terminator_tint", Effect::kSmoothTerminator},  // of 0: more than it needs, and the same picture
      {"specular_fresnel_falloff", Effect::kSpecularFalloff},
      {"dual_specular_opacity", Effect::kSecondLobe},
  };
  for (std::size_t i = 0; i < C::kParameters.size(); ++i) {
    auto scene = base();
    const auto found = parts.find(C::kParameters[i].name);
    const bool needs_diffuse =
        found != parts.end() && (found->second == Effect::kDiffuseFresnel || found->second == Effect::kRetroreflection);
    if (needs_diffuse) callisto(scene).metallic = 0;
    const Plan before = plan_of(scene);
    scene.materials[0].bindings = {{i, {.image = 0}}};
    const Plan plan = plan_of(scene);
    for (const EffectRow& row : kEffects) {
      const bool expected = before.has(row.effect) || row.effect == Effect::kTextures ||
                            (found != parts.end() && row.effect == found->second);
      EXPECT_EQ(plan.has(row.effect), expected) << C::kParameters[i].name << " " << row.name;
    }
  }
  // Black paint with a picture of its color is not black.
  auto scene = base();
  callisto(scene).metallic = 0, callisto(scene).base_color = brdf::Rgb<double>(0.0);
  EXPECT_FALSE(plan_of(scene).has(Effect::kDiffuse));
  scene.materials[0].bindings = {{0, {.image = 0}}};
  EXPECT_TRUE(plan_of(scene).has(Effect::kDiffuse));
}

TEST(Plan, SaysOfEachMaterialWhatItHas) {
  auto scene = base();
  scene.materials[1].name = "skin";
  scene.materials[1].brdf = C();
  scene.materials[1].normal_map = scene.materials[1].diffuse_normal_map = scene.materials[1].opacity =
      scene::Texture{0};
  scene.materials[1].emission = {1, 0, 0};
  scene.materials[1].bindings = {{3, {.image = 0}}};
  const Plan plan = plan_of(scene);
  ASSERT_EQ(plan.materials.size(), 2u);
  const MaterialPlan &steel = plan.materials[0], &skin = plan.materials[1];
  EXPECT_EQ(steel.name, "steel");
  EXPECT_EQ(steel.model, "callisto");
  EXPECT_EQ(steel.callisto_parts, 0u);
  EXPECT_FALSE(steel.has_textures || steel.has_normal_map || steel.has_dual_normals || steel.is_cut_out || steel.emits);
  EXPECT_EQ(skin.callisto_parts, static_cast<unsigned>(C::kDiffuse));
  EXPECT_TRUE(skin.has_textures && skin.has_normal_map && skin.has_dual_normals && skin.is_cut_out && skin.emits);
}

}  // namespace
}  // namespace likeness::plan
