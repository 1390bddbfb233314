#include "render/plan/without.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>

namespace likeness::plan {
namespace {

using C = brdf::Callisto<double>;

// Calls f(name, member) for each parameter of a model.
template <class M, class F>
void for_parameters(M& model, F&& f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    constexpr auto kMembers = M::members();
    (f(M::kParameters[I].name, model.*std::get<I>(kMembers)), ...);
  }(std::make_index_sequence<M::kParameters.size()>{});
}

void drop_bindings(scene::Material& material, std::initializer_list<std::string_view> names) {
  std::erase_if(material.bindings, [&](const scene::Material::Binding& b) {
    return std::find(names.begin(), names.end(), C::kParameters[b.parameter].name) != names.end();
  });
}

// `edit` on every Callisto material, which then has no texture for what `names` says.
template <class F>
void for_callisto(scene::Scene& scene, std::initializer_list<std::string_view> names, F&& edit) {
  for (scene::Material& material : scene.materials)
    if (auto* model = std::get_if<C>(&material.brdf)) {
      edit(*model);
      drop_bindings(material, names);
    }
}

template <class M>
void to_callisto(const M& model, scene::Material& material) {
  C callisto;
  for_parameters(callisto, [&](std::string_view name, auto& to) {
    for_parameters(model, [&](std::string_view its, const auto& from) {
      if constexpr (std::same_as<std::remove_cvref_t<decltype(to)>, std::remove_cvref_t<decltype(from)>>)
        if (name == its) to = from;
    });
  });
  std::erase_if(material.bindings, [&](scene::Material::Binding& b) {
    const auto& its = M::kParameters[b.parameter];
    const auto row = std::find_if(C::kParameters.begin(), C::kParameters.end(),
                                  [&](const auto& p) { return p.name == its.name && p.channels == its.channels; });
    if (row == C::kParameters.end()) return true;
    b.parameter = static_cast<std::size_t>(row - C::kParameters.begin());
    return false;
  });
  material.brdf = callisto;
}

// Gives a texture a picture of one texel, the mean of the numbers in its own.
void to_one_texel(scene::Scene& scene, scene::Texture& texture) {
  const image::Texels& from = scene.images[texture.image].texels;
  scene::Image one{scene.images[texture.image].name, {1, 1, from.channels, {}, {}}};
  const auto mean = [&](const auto& values, std::size_t channel) {
    double sum = 0;
    for (std::size_t i = channel; i < values.size(); i += static_cast<std::size_t>(from.channels))
      if (std::isfinite(static_cast<double>(values[i]))) sum += static_cast<double>(values[i]);
    return sum / static_cast<double>(from.count());
  };
  for (std::size_t k = 0; k < static_cast<std::size_t>(from.channels); ++k)
    if (from.floats.empty()) one.texels.bytes.push_back(static_cast<std::uint8_t>(mean(from.bytes, k)));
    else one.texels.floats.push_back(static_cast<float>(mean(from.floats, k)));
  texture.image = static_cast<scene::Index>(scene.images.size());
  scene.images.push_back(std::move(one));
}

template <class... Shapes>
void drop_lights(scene::Scene& scene) {
  std::erase_if(scene.lights,
                [](const scene::Light& light) { return (std::holds_alternative<Shapes>(light.shape) || ...); });
}

}  // namespace

scene::Scene without(const scene::Scene& original, Effect effect) {
  scene::Scene scene = original;
  switch (effect) {
    case Effect::kDiffuse:
      for_callisto(scene, {"metallic"}, [](C& m) { m.metallic = 1; });
      break;
    case Effect::kDiffuseFresnel:
      for_callisto(scene, {"diffuse_fresnel", "diffuse_fresnel_tint"},
                   [](C& m) { m.diffuse_fresnel = 1, m.diffuse_fresnel_tint = {1, 1, 1}; });
      break;
    case Effect::kRetroreflection:
      for_callisto(scene, {"retroreflection", "retroreflection_tint"},
                   [](C& m) { m.retroreflection = 1, m.retroreflection_tint = {1, 1, 1}; });
      break;
    case Effect::kSmoothTerminator:
      for_callisto(scene, {"smooth_terminator", "smooth_terminator_tint"}, [](C& m) { m.smooth_terminator = 0; });
      break;
    case Effect::kSpecularFalloff:
      for_callisto(scene, {"specular_fresnel_falloff"}, [](C& m) { m.specular_fresnel_falloff = 0.5; });
      break;
    case Effect::kSecondLobe:
      for_callisto(scene, {"dual_specular_opacity"}, [](C& m) { m.dual_specular_opacity = 0; });
      break;
    case Effect::kOtherModels:
      for (scene::Material& material : scene.materials)
        if (!std::holds_alternative<C>(material.brdf))
          std::visit([&](const auto model) { to_callisto(model, material); }, material.brdf);
      break;
    case Effect::kTextures:
      for (scene::Material& material : scene.materials) material.bindings.clear();
      break;
    case Effect::kTextureLevels:
      for (scene::Material& material : scene.materials) {
        for (scene::Material::Binding& binding : material.bindings) to_one_texel(scene, binding.texture);
        for (auto* map : {&material.normal_map, &material.diffuse_normal_map, &material.emission_map})
          if (*map) to_one_texel(scene, **map);
      }
      break;
    case Effect::kNormalMaps:
      for (scene::Material& material : scene.materials) material.normal_map.reset();
      break;
    case Effect::kProxima:
      for (scene::Material& material : scene.materials)
        if (auto& map = material.diffuse_normal_map ? material.diffuse_normal_map : material.normal_map)
          to_one_texel(scene, *map);
      break;
    case Effect::kDualNormals:
      for (scene::Material& material : scene.materials) material.diffuse_normal_map.reset();
      break;
    case Effect::kRealis:
      for (scene::Material& material : scene.materials) material.residual.reset();
      break;
    case Effect::kCutOuts:
      for (scene::Material& material : scene.materials) material.opacity.reset();
      break;
    case Effect::kEmission:
      for (scene::Material& material : scene.materials) material.emission = {0, 0, 0}, material.emission_map.reset();
      break;
    case Effect::kPointLights:
      drop_lights<scene::PointLight, scene::SpotLight, scene::DirectionalLight>(scene);
      break;
    case Effect::kAreaLights:
      drop_lights<scene::RectangleLight, scene::DiskLight, scene::SphereLight>(scene);
      break;
    case Effect::kProfiles:
      for (scene::Light& light : scene.lights) light.profile = scene::kNone;
      break;
    case Effect::kRanges:
      for (scene::Light& light : scene.lights) light.range = scene::kForever;
      break;
    case Effect::kEnvironment:
      scene.environment.reset();
      break;
    case Effect::kEnvironmentPicture:
      if (scene.environment) scene.environment->image = scene::kNone;
      break;
    case Effect::kDepthOfField:
      for (scene::Camera& camera : scene.cameras) camera.lens_radius = 0;
      break;
    case Effect::kCount:
      break;
  }
  return scene;
}

}  // namespace likeness::plan
