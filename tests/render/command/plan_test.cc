#include "render/plan/plan.h"

#include <functional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/plan/draw.h"
#include "render/plan/without.h"

namespace likeness::plan {
namespace {

using scene::Scene;
using C = brdf::Callisto<double>;
using Effects = std::set<Effect>;

// A metal ball in a room of one color, seen through a pinhole: the environment is all that is on.
Scene plain_scene() {
  Scene s;
  s.cameras.emplace_back();
  s.meshes.emplace_back().is_sphere = true;
  scene::Material& metal = s.materials.emplace_back();
  metal.name = "metal";
  C model;
  model.metallic = 1;
  metal.brdf = model;
  s.instances.push_back({"ball", 0, 0, glm::mat4(1)});
  s.environment.emplace();
  return s;
}

C& callisto(Scene& s, std::size_t i = 0) { return std::get<C>(s.materials[i].brdf); }

std::size_t row(std::string_view name) {
  for (std::size_t i = 0; i < C::kParameters.size(); ++i)
    if (C::kParameters[i].name == name) return i;
  ADD_FAILURE() << name;
  return 0;
}
void bind(Scene& s, std::string_view parameter, std::size_t material = 0) {
  if (s.images.empty()) s.images.push_back({"grey.png", {1, 1, 1, {128}, {}}});
  s.materials[material].bindings.push_back({row(parameter), {.image = 0}});
}
scene::Texture texture(Scene& s) {
  if (s.images.empty()) s.images.push_back({"grey.png", {1, 1, 1, {128}, {}}});
  return {.image = 0};
}
scene::Light& add_light(Scene& s, scene::LightShape shape) {
  return s.lights.emplace_back(scene::Light{"lamp", shape});
}

Effects on(const Plan& plan) {
  Effects out;
  for (const EffectRow& r : kEffects)
    if (plan.has(r.effect)) out.insert(r.effect);
  return out;
}
std::string names(const Effects& effects) {
  std::string out;
  for (const Effect e : effects) out += std::string(row_of(e).name) + " ";
  return out;
}
std::string because(const Plan& plan, Effect e) { return plan.decisions[static_cast<std::size_t>(e)].because; }

// An edit of the plain scene, what it turns on, and words of the fact that the plan gives for the first of them.
struct Edit {
  std::string what;
  std::function<void(Scene&)> edit;
  std::vector<Effect> turned_on;
  std::string fact;
};

const std::vector<Edit>& edits() {
  static const std::vector<Edit> kEdits{
      {"half a metal", [](Scene& s) { callisto(s).metallic = 0.5; }, {Effect::kDiffuse}, "\"metal\": metallic = 0.5"},
      {"metal by a texture",
       [](Scene& s) { bind(s, "metallic"); },
       {Effect::kDiffuse, Effect::kTextures},
       "metallic has a texture"},
      {"rise",
       [](Scene& s) { callisto(s).metallic = 0, callisto(s).diffuse_fresnel = 3; },
       {Effect::kDiffuseFresnel, Effect::kDiffuse},
       "diffuse_fresnel = 3"},
      {"rise of a metal", [](Scene& s) { callisto(s).diffuse_fresnel = 3; }, {}, ""},
      {"rise that only its tint makes",
       [](Scene& s) { callisto(s).metallic = 0, callisto(s).diffuse_fresnel_tint = {1, 1, 0.5}; },
       {Effect::kDiffuseFresnel, Effect::kDiffuse},
       "diffuse_fresnel = 1"},
      {"rise by a texture",
       [](Scene& s) {
         callisto(s).metallic = 0;
         bind(s, "diffuse_fresnel");
       },
       {Effect::kDiffuseFresnel, Effect::kDiffuse, Effect::kTextures},
       "diffuse_fresnel has a texture"},
      {"a falloff of a rise that is none",
       [](Scene& s) { callisto(s).metallic = 0, callisto(s).diffuse_fresnel_falloff = 0.2; },
       {Effect::kDiffuse},
       "metallic = 0"},
      {"retroreflection",
       [](Scene& s) { callisto(s).metallic = 0, callisto(s).retroreflection = 0; },
       {Effect::kRetroreflection, Effect::kDiffuse},
       "retroreflection = 0"},
      {"retroreflection by a tint's texture",
       [](Scene& s) {
         callisto(s).metallic = 0;
         bind(s, "retroreflection_tint");
       },
       {Effect::kRetroreflection, Effect::kDiffuse, Effect::kTextures},
       "retroreflection = 1, tinted"},
      {"terminator",
       [](Scene& s) { callisto(s).smooth_terminator = -0.5; },
       {Effect::kSmoothTerminator},
       "smooth_terminator = -0.5"},
      {"specular falloff",
       [](Scene& s) { callisto(s).specular_fresnel_falloff = 0.4; },
       {Effect::kSpecularFalloff},
       "specular_fresnel_falloff = 0.4"},
      {"second lobe",
       [](Scene& s) { callisto(s).dual_specular_opacity = 0.1; },
       {Effect::kSecondLobe},
       "dual_specular_opacity = 0.1"},
      {"second lobe's roughness alone", [](Scene& s) { callisto(s).dual_specular_roughness_scale = 4; }, {}, ""},
      {"another model",
       [](Scene& s) { s.materials[0].brdf = brdf::Ggx<double>{}; },
       {Effect::kOtherModels},
       "model ggx"},
      {"a texture", [](Scene& s) { bind(s, "roughness"); }, {Effect::kTextures}, "roughness has a texture"},
      {"a normal map", [](Scene& s) { s.materials[0].normal_map = texture(s); }, {Effect::kNormalMaps}, "normal_map"},
      {"a texture of many texels",
       [](Scene& s) {
         bind(s, "roughness");
         s.images[0].texels = {2, 1, 1, {1, 2}, {}};
       },
       {Effect::kTextureLevels, Effect::kTextures},
       "roughness has 2 x 1 texels"},
      {"bumps on a diffuse",
       [](Scene& s) {
         callisto(s).metallic = 0;
         s.materials[0].normal_map = texture(s);
         s.images[0].texels = {2, 1, 1, {1, 2}, {}};
       },
       {Effect::kProxima, Effect::kTextureLevels, Effect::kNormalMaps, Effect::kDiffuse},
       "normal_map has 2 x 1 texels"},
      {"dual normals",
       [](Scene& s) { s.materials[0].diffuse_normal_map = texture(s); },
       {Effect::kDualNormals},
       "diffuse_normal_map"},
      {"a bake",
       [](Scene& s) {
         s.bakes.emplace_back().name = "photos/bake";
         s.materials[0].residual.emplace().bake = 0;
       },
       {Effect::kRealis},
       "bake \"photos/bake\""},
      {"a cut-out", [](Scene& s) { s.materials[0].opacity = texture(s); }, {Effect::kCutOuts}, "opacity"},
      {"emission", [](Scene& s) { s.materials[0].emission = {0, 0, 1}; }, {Effect::kEmission}, "emission"},
      {"a point light",
       [](Scene& s) { add_light(s, scene::PointLight{}); },
       {Effect::kPointLights},
       "light \"lamp\": point"},
      {"a spot light", [](Scene& s) { add_light(s, scene::SpotLight{}); }, {Effect::kPointLights}, "spot"},
      {"the sun", [](Scene& s) { add_light(s, scene::DirectionalLight{}); }, {Effect::kPointLights}, "directional"},
      {"a rectangle", [](Scene& s) { add_light(s, scene::RectangleLight{}); }, {Effect::kAreaLights}, "rectangle"},
      {"a disk", [](Scene& s) { add_light(s, scene::DiskLight{}); }, {Effect::kAreaLights}, "disk"},
      {"a sphere", [](Scene& s) { add_light(s, scene::SphereLight{}); }, {Effect::kAreaLights}, "sphere"},
      {"a profile",
       [](Scene& s) {
         s.profiles.emplace_back().name = "street.ies";
         add_light(s, scene::PointLight{}).profile = 0;
       },
       {Effect::kProfiles, Effect::kPointLights},
       "profile \"street.ies\""},
      {"a range",
       [](Scene& s) { add_light(s, scene::SphereLight{}).range = 5; },
       {Effect::kRanges, Effect::kAreaLights},
       "range = 5 m"},
      {"a picture around it",
       [](Scene& s) { s.environment->image = texture(s).image; },
       {Effect::kEnvironmentPicture},
       "picture \"grey.png\""},
      {"a lens", [](Scene& s) { s.cameras[0].lens_radius = 0.25f; }, {Effect::kDepthOfField}, "lens radius 0.25 m"},
      {"a material that nothing has", [](Scene& s) { s.materials.emplace_back().brdf = brdf::Ggx<double>{}; }, {}, ""},
      {"a lens of another camera", [](Scene& s) { s.cameras.emplace_back().lens_radius = 1; }, {}, ""},
  };
  return kEdits;
}

TEST(Plan, OfAPlainSceneHasNothingButItsEnvironment) {
  const Plan plan = plan_of(plain_scene());
  EXPECT_EQ(names(on(plan)), "environment ");
  Scene dark = plain_scene();
  dark.environment.reset();
  EXPECT_EQ(names(on(plan_of(dark))), "");
  for (const EffectRow& r : kEffects) EXPECT_NE(because(plan, r.effect), "") << r.name;
}

TEST(Plan, ChangesByJustWhatAnEditNeedsAndSaysWhy) {
  Effects seen{Effect::kEnvironment};
  for (const Edit& e : edits()) {
    Scene s = plain_scene();
    e.edit(s);
    const Plan plan = plan_of(s);
    Effects expected{Effect::kEnvironment};
    expected.insert(e.turned_on.begin(), e.turned_on.end());
    EXPECT_EQ(names(on(plan)), names(expected)) << e.what;
    if (!e.turned_on.empty()) {
      EXPECT_NE(because(plan, e.turned_on[0]).find(e.fact), std::string::npos)
          << e.what << ": " << because(plan, e.turned_on[0]);
    }
    seen.insert(expected.begin(), expected.end());
  }
  EXPECT_EQ(seen.size(), kEffectCount) << "an effect that no edit above turns on";
}

TEST(Plan, FromASecondMaterialIsTheSame) {
  for (const Edit& e : edits()) {
    Scene s = plain_scene();
    e.edit(s);
    if (s.materials.size() != 1) continue;
    Scene two = plain_scene();
    Scene edited = s;
    two.materials.push_back(edited.materials[0]);
    two.instances.push_back({"other", 0, 1, glm::mat4(1)});
    two.images = edited.images, two.lights = edited.lights, two.profiles = edited.profiles;
    two.environment = edited.environment, two.cameras = edited.cameras, two.bakes = edited.bakes;
    EXPECT_EQ(names(on(plan_of(two))), names(on(plan_of(s)))) << e.what;
  }
}

// Everything at once.
Scene full_scene() {
  Scene s = plain_scene();
  s.materials[0].name = "paint";
  C& paint = callisto(s);
  paint.metallic = 0, paint.diffuse_fresnel = 2, paint.retroreflection = 4, paint.smooth_terminator = 0.5;
  paint.specular_fresnel_falloff = 0.3, paint.dual_specular_opacity = 0.5;
  bind(s, "base_color");
  s.materials[0].normal_map = s.materials[0].diffuse_normal_map = s.materials[0].opacity = texture(s);
  s.images[0].texels = {2, 1, 1, {100, 150}, {}};
  s.materials[0].emission = {1, 1, 1};
  s.bakes.emplace_back();
  s.materials[0].residual.emplace().bake = 0;
  s.materials.emplace_back().brdf = brdf::Disney2012<double>{};
  s.instances.push_back({"other", 0, 1, glm::mat4(1)});
  s.profiles.emplace_back();
  scene::Light& lamp = add_light(s, scene::PointLight{});
  lamp.profile = 0, lamp.range = 3;
  add_light(s, scene::SphereLight{}).range = 3;
  s.environment->image = 0;
  s.cameras[0].lens_radius = 0.1f;
  return s;
}

TEST(Without, TakesOneEffectAwayAndWhatHangsOnIt) {
  const Scene full = full_scene();
  ASSERT_EQ(on(plan_of(full)).size(), kEffectCount);
  for (const EffectRow& r : kEffects) {
    Effects expected = on(plan_of(full));
    expected.erase(r.effect);
    if (r.effect == Effect::kDiffuse)
      for (const Effect hangs : {Effect::kDiffuseFresnel, Effect::kRetroreflection, Effect::kProxima})
        expected.erase(hangs);
    if (r.effect == Effect::kTextureLevels) expected.erase(Effect::kProxima);
    if (r.effect == Effect::kPointLights) expected.erase(Effect::kProfiles);
    if (r.effect == Effect::kEnvironment) expected.erase(Effect::kEnvironmentPicture);
    EXPECT_EQ(names(on(plan_of(without(full, r.effect)))), names(expected)) << r.name;
  }
}

TEST(Without, UndoesEveryEdit) {
  for (const Edit& e : edits()) {
    if (e.turned_on.empty()) continue;
    Scene s = plain_scene();
    e.edit(s);
    EXPECT_FALSE(plan_of(without(s, e.turned_on[0])).has(e.turned_on[0])) << e.what;
  }
}

TEST(Without, LeavesASceneThatHasTheEffectNotAsItIs) {
  const Plan plan = plan_of(plain_scene());
  for (const EffectRow& r : kEffects) {
    if (r.effect == Effect::kEnvironment) continue;
    EXPECT_EQ(digest_of(plan_of(without(plain_scene(), r.effect))), digest_of(plan)) << r.name;
  }
}

TEST(Without, LeavesWhatHasNothingToDoWithTheEffect) {
  const Scene full = full_scene();
  const Scene s = without(full, Effect::kDiffuseFresnel);
  EXPECT_EQ(std::get<C>(s.materials[0].brdf).diffuse_fresnel, 1);
  EXPECT_EQ(std::get<C>(s.materials[0].brdf).retroreflection, 4);
  EXPECT_EQ(s.materials[0].bindings.size(), 1u) << "the base color keeps its texture";
  EXPECT_EQ(s.lights.size(), 2u);
  EXPECT_EQ(without(full, Effect::kPointLights).lights.size(), 1u);
  EXPECT_EQ(without(full, Effect::kAreaLights).lights.size(), 1u);
}

TEST(Without, GivesAnotherModelsParametersToCallistoByTheirNames) {
  Scene s = plain_scene();
  brdf::Disney2012<double> disney;
  disney.base_color = {0.1, 0.2, 0.3}, disney.roughness = 0.7, disney.metallic = 1;
  s.materials[0].brdf = disney;
  const C callisto = std::get<C>(without(s, Effect::kOtherModels).materials[0].brdf);
  EXPECT_EQ(callisto.base_color.g, 0.2);
  EXPECT_EQ(callisto.roughness, 0.7);
  EXPECT_EQ(callisto.metallic, 1);
}

TEST(Plan, ForcedHasEverythingAndSaysThatItWasForced) {
  const Plan plan = plan_of(plain_scene(), 0, true);
  EXPECT_TRUE(plan.is_forced);
  EXPECT_EQ(on(plan).size(), kEffectCount);
  EXPECT_NE(because(plan, Effect::kSecondLobe).find("forced"), std::string::npos);
  EXPECT_EQ(because(plan, Effect::kEnvironment), "environment") << "what the scene calls for keeps its fact";
}

TEST(PlanDigest, IsOfTheWorkAndNotOfNames) {
  const std::string plain = digest_of(plan_of(plain_scene()));
  Scene s = plain_scene();
  s.materials[0].name = "other", callisto(s).roughness = 0.1;
  EXPECT_EQ(digest_of(plan_of(s)), plain);
  std::set<std::string> seen{plain, digest_of(plan_of(plain_scene(), 0, true))};
  EXPECT_EQ(seen.size(), 2u);
  callisto(s).smooth_terminator = 1;
  EXPECT_TRUE(seen.insert(digest_of(plan_of(s))).second);
  callisto(s).dual_specular_opacity = 1;
  EXPECT_TRUE(seen.insert(digest_of(plan_of(s))).second);
}

TEST(PlanDigest, IsOfTheKernelsAndNotOfTheEffectsAlone) {
  Scene s = plain_scene();
  s.materials.push_back(s.materials[0]);
  s.instances.push_back({"other", 0, 1, glm::mat4(1)});
  Scene first = s, both = s;
  callisto(first).smooth_terminator = 1;
  callisto(both).smooth_terminator = callisto(both, 1).smooth_terminator = 1;
  EXPECT_EQ(names(on(plan_of(first))), names(on(plan_of(both))));
  EXPECT_NE(digest_of(plan_of(first)), digest_of(plan_of(both)));
}

}  // namespace
}  // namespace likeness::plan
