#include "render/plan/plan.h"

#include <algorithm>
#include <string_view>

#include "render/files/files.h"

namespace likeness::plan {
namespace {

using C = brdf::Callisto<double>;

// Collects the first fact that turns each effect on.
class Facts {
 public:
  explicit Facts(Plan& plan) : plan_(plan) {}
  void on(Effect effect, const std::string& because) {
    Decision& d = plan_.decisions[static_cast<std::size_t>(effect)];
    if (!d.is_on) d = {true, because};
  }
  void off(Effect effect, const std::string& because) {
    Decision& d = plan_.decisions[static_cast<std::size_t>(effect)];
    if (!d.is_on) d.because = because;
  }

 private:
  Plan& plan_;
};

std::string named(std::string_view what, const std::string& name, std::size_t index) {
  return std::string(what) + " " + (name.empty() ? std::to_string(index) : "\"" + name + "\"");
}

// The parameter that a part of Callisto stands for, with its value or its texture.
std::string fact_of(const C& model, const scene::Material& material, unsigned part) {
  const auto bound = [&](std::string_view name) {
    return std::any_of(material.bindings.begin(), material.bindings.end(),
                       [&](const auto& b) { return C::kParameters[b.parameter].name == name; });
  };
  const auto number = [&](std::string_view name, double value) {
    return std::string(name) + (bound(name) ? " has a texture" : " = " + files::number_text(value));
  };
  switch (part) {
    case C::kDiffuse:
      return bound("metallic") || model.metallic < 1 ? number("metallic", model.metallic) : "base_color is not black";
    case C::kRise:
      return number("diffuse_fresnel", model.diffuse_fresnel) + (bound("diffuse_fresnel_tint") ? ", tinted" : "");
    case C::kRetro:
      return number("retroreflection", model.retroreflection) + (bound("retroreflection_tint") ? ", tinted" : "");
    case C::kTerminator:
      return number("smooth_terminator", model.smooth_terminator);
    case C::kFalloff:
      return number("specular_fresnel_falloff", model.specular_fresnel_falloff);
    default:
      return number("dual_specular_opacity", model.dual_specular_opacity);
  }
}

std::string texels_of(const scene::Scene& scene, const std::optional<scene::Texture>& texture, std::string_view name) {
  if (!texture) return {};
  const image::Texels& texels = scene.images[texture->image].texels;
  if (texels.width <= 1 && texels.height <= 1) return {};
  return std::string(name) + " has " + std::to_string(texels.width) + " x " + std::to_string(texels.height) + " texels";
}

// The first of a material's textures that looks otherwise from afar: one texel is the same everywhere. An opacity is not
// read by pixels but by rays.
std::string texels_of(const scene::Scene& scene, const scene::Material& material) {
  for (const scene::Material::Binding& binding : material.bindings) {
    const std::string name = std::visit(
        [&]<class M>(const M&) { return std::string(M::kParameters[binding.parameter].name); }, material.brdf);
    if (std::string fact = texels_of(scene, binding.texture, name); !fact.empty()) return fact;
  }
  for (const auto& [texture, name] : {std::pair{&material.normal_map, "normal_map"},
                                      {&material.diffuse_normal_map, "diffuse_normal_map"},
                                      {&material.emission_map, "emission_map"}})
    if (std::string fact = texels_of(scene, *texture, name); !fact.empty()) return fact;
  return {};
}

// The map of bumps below a diffuse of Callisto's.
std::string bumps_of(const scene::Scene& scene, const scene::Material& material, const MaterialPlan& plan) {
  if ((plan.callisto_parts & C::kDiffuse) == 0) return {};
  return plan.has_dual_normals ? texels_of(scene, material.diffuse_normal_map, "diffuse_normal_map")
                               : texels_of(scene, material.normal_map, "normal_map");
}

void materials(const scene::Scene& scene, Plan& plan, Facts& facts) {
  std::vector<bool> is_used(scene.materials.size(), false);
  for (const scene::Instance& instance : scene.instances) is_used[instance.material] = true;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const scene::Material& material = scene.materials[i];
    const std::string who = named("material", material.name, i) + ": ";
    MaterialPlan& own = plan.materials.emplace_back();
    own.name = material.name;
    own.model = std::visit([]<class M>(const M&) { return std::string(M::kName); }, material.brdf);
    own.has_textures = !material.bindings.empty();
    own.has_normal_map = material.normal_map.has_value();
    own.has_dual_normals = material.diffuse_normal_map.has_value();
    own.is_cut_out = material.opacity.has_value();
    own.emits = material.emission.r > 0 || material.emission.g > 0 || material.emission.b > 0;
    const auto* callisto = std::get_if<C>(&material.brdf);
    if (callisto != nullptr)
      own.callisto_parts = callisto->parts([&](std::string_view name) {
        return std::none_of(material.bindings.begin(), material.bindings.end(),
                            [&](const auto& b) { return C::kParameters[b.parameter].name == name; });
      });
    if (!is_used[i]) continue;
    if (callisto != nullptr) {
      constexpr std::pair<unsigned, Effect> kParts[]{
          {C::kDiffuse, Effect::kDiffuse},         {C::kRise, Effect::kDiffuseFresnel},
          {C::kRetro, Effect::kRetroreflection},   {C::kTerminator, Effect::kSmoothTerminator},
          {C::kFalloff, Effect::kSpecularFalloff}, {C::kSecondLobe, Effect::kSecondLobe},
      };
      for (const auto& [part, effect] : kParts)
        if ((own.callisto_parts & part) != 0) facts.on(effect, who + fact_of(*callisto, material, part));
    } else {
      facts.on(Effect::kOtherModels, who + "model " + own.model);
    }
    if (own.has_textures)
      facts.on(Effect::kTextures, who +
                                      std::visit(
                                          [&]<class M>(const M&) {
                                            return std::string(M::kParameters[material.bindings[0].parameter].name);
                                          },
                                          material.brdf) +
                                      " has a texture");
    if (const std::string texels = texels_of(scene, material); !texels.empty())
      facts.on(Effect::kTextureLevels, who + texels);
    if (own.has_normal_map) facts.on(Effect::kNormalMaps, who + "normal_map");
    if (const std::string bumps = bumps_of(scene, material, own); !bumps.empty())
      facts.on(Effect::kProxima, who + bumps);
    if (own.has_dual_normals) facts.on(Effect::kDualNormals, who + "diffuse_normal_map");
    if (material.residual)
      facts.on(Effect::kRealis, who + "bake \"" + scene.bakes[material.residual->bake].name + "\"");
    if (own.is_cut_out) facts.on(Effect::kCutOuts, who + "opacity");
    if (own.emits) facts.on(Effect::kEmission, who + "emission");
  }
}

void lights(const scene::Scene& scene, Facts& facts) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const scene::Light& light = scene.lights[i];
    const std::string who = named("light", light.name, i);
    std::visit(
        [&]<class L>(const L&) {
          constexpr bool kIsPoint = std::same_as<L, scene::PointLight> || std::same_as<L, scene::SpotLight> ||
                                    std::same_as<L, scene::DirectionalLight>;
          constexpr std::string_view kKind = std::same_as<L, scene::PointLight>         ? "point"
                                             : std::same_as<L, scene::SpotLight>        ? "spot"
                                             : std::same_as<L, scene::DirectionalLight> ? "directional"
                                             : std::same_as<L, scene::RectangleLight>   ? "rectangle"
                                             : std::same_as<L, scene::DiskLight>        ? "disk"
                                                                                        : "sphere";
          facts.on(kIsPoint ? Effect::kPointLights : Effect::kAreaLights, who + ": " + std::string(kKind));
        },
        light.shape);
    if (light.profile != scene::kNone)
      facts.on(Effect::kProfiles, who + ": profile \"" + scene.profiles[light.profile].name + "\"");
    if (light.range != scene::kForever)
      facts.on(Effect::kRanges, who + ": range = " + files::number_text(static_cast<double>(light.range)) + " m");
  }
  if (!scene.environment) return;
  facts.on(Effect::kEnvironment, "environment");
  if (scene.environment->image != scene::kNone)
    facts.on(Effect::kEnvironmentPicture,
             "environment: picture \"" + scene.images[scene.environment->image].name + "\"");
}

std::string nothing(Effect effect) {
  switch (effect) {
    case Effect::kDiffuse:
      return "no Callisto material that is not metal";
    case Effect::kDiffuseFresnel:
      return "diffuse_fresnel is 1 in every material";
    case Effect::kRetroreflection:
      return "retroreflection is 1 in every material";
    case Effect::kSmoothTerminator:
      return "smooth_terminator is 0 in every material";
    case Effect::kSpecularFalloff:
      return "specular_fresnel_falloff is 0.5 in every material";
    case Effect::kSecondLobe:
      return "dual_specular_opacity is 0 in every material";
    case Effect::kOtherModels:
      return "every material is Callisto";
    case Effect::kTextures:
      return "no parameter has a texture";
    case Effect::kTextureLevels:
      return "no texture of more than one texel";
    case Effect::kNormalMaps:
      return "no material has a normal_map";
    case Effect::kProxima:
      return "no map of normals below a diffuse";
    case Effect::kDualNormals:
      return "no material has a diffuse_normal_map";
    case Effect::kRealis:
      return "no material has a bake";
    case Effect::kCutOuts:
      return "no material has an opacity";
    case Effect::kEmission:
      return "no material has an emission";
    case Effect::kPointLights:
      return "no point, spot or directional light";
    case Effect::kAreaLights:
      return "no rectangle, disk or sphere light";
    case Effect::kProfiles:
      return "no light has a profile";
    case Effect::kRanges:
      return "no light has a range";
    case Effect::kEnvironment:
      return "no environment";
    case Effect::kEnvironmentPicture:
      return "the environment has no picture";
    case Effect::kDepthOfField:
      return "the camera is a pinhole";
    case Effect::kCount:
      break;
  }
  return {};
}

}  // namespace

Plan plan_of(const scene::Scene& scene, std::size_t camera, bool force_all) {
  Plan plan;
  plan.is_forced = force_all;
  Facts facts(plan);
  materials(scene, plan, facts);
  lights(scene, facts);
  if (camera < scene.cameras.size() && scene.cameras[camera].lens_radius > 0)
    facts.on(Effect::kDepthOfField, named("camera", scene.cameras[camera].name, camera) + ": lens radius " +
                                        files::number_text(static_cast<double>(scene.cameras[camera].lens_radius)) +
                                        " m");
  for (const EffectRow& row : kEffects) {
    facts.off(row.effect, nothing(row.effect));
    if (force_all) facts.on(row.effect, "forced (" + nothing(row.effect) + ")");
  }
  return plan;
}

}  // namespace likeness::plan
