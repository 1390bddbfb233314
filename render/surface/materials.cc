#include "render/surface/materials.h"

#include <algorithm>
#include <cstring>
#include <tuple>

#include "render/surface/residual.h"
#include "render/texture/texture.h"

namespace likeness::surface {
namespace {

using brdf::Parameter;

template <class From, class To>
void copy_number(const From& from, To& to) {
  if constexpr (requires { from.r; })
    to = {static_cast<float>(from.r), static_cast<float>(from.g), static_cast<float>(from.b)};
  else to = static_cast<float>(from);
}

// The model in floats, and where each row of its table lies in it.
template <template <class> class M>
void prepare(const M<double>& model, const scene::Scene& scene, Prepared& out) {
  M<float> in_floats;
  const auto from = M<double>::members(), to = M<float>::members();
  constexpr std::size_t kRows = std::tuple_size_v<std::remove_const_t<decltype(to)>>;
  std::array<std::size_t, kRows> places{};
  const auto* first = reinterpret_cast<const std::byte*>(&in_floats);
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (copy_number(model.*std::get<I>(from), in_floats.*std::get<I>(to)), ...);
    ((places[I] = static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&(in_floats.*std::get<I>(to))) - first) /
                  sizeof(float)),
     ...);
  }(std::make_index_sequence<kRows>{});
  static_assert(sizeof in_floats <= kModelBytes && std::is_trivially_copyable_v<M<float>>);
  out.model_bytes = sizeof in_floats;
  std::memcpy(&out.model, &in_floats, sizeof in_floats);
  for (std::size_t i = 0; i < kRows; ++i) {
    if (M<double>::kParameters[i].name == "base_color") out.base_color_at = places[i];
    if (M<double>::kParameters[i].name == "roughness") out.roughness_at = places[i];
    if (M<double>::kParameters[i].name == "dual_specular_roughness_scale") out.second_scale_at = places[i];
  }
  for (const scene::Material::Binding& binding : out.material->bindings) {
    const Parameter& row = M<double>::kParameters[binding.parameter];
    out.slots.push_back({&scene.images[binding.texture.image], binding.texture, places[binding.parameter], row.channels,
                         static_cast<float>(row.range.low), static_cast<float>(row.range.high)});
  }
}

const scene::Image* image_of(const scene::Scene& scene, const std::optional<scene::Texture>& texture) {
  return texture ? &scene.images[texture->image] : nullptr;
}

std::vector<std::uint16_t> varying_of(const Prepared& material) {
  std::vector<std::uint16_t> out;
  const auto add = [&](std::size_t place) {
    if (place != kNoPlace) out.push_back(static_cast<std::uint16_t>(place));
  };
  for (const Prepared::Slot& slot : material.slots)
    for (int k = 0; k < slot.channels; ++k) add(slot.at + static_cast<std::size_t>(k));
  if (material.normal_map != nullptr) add(material.roughness_at), add(material.second_scale_at);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

const void* Prepared::model_at(const glm::vec2& uv, ModelBytes& scratch) const {
  return model_with(scratch, [&](std::size_t i, auto is_number) {
    if constexpr (is_number) return texture::number_at(*slots[i].image, slots[i].texture, uv);
    else return texture::color_at(*slots[i].image, slots[i].texture, uv);
  });
}

std::vector<Prepared> prepare_materials(const scene::Scene& scene, bool force_all) {
  std::vector<Prepared> all;
  for (const scene::Material& material : scene.materials) {
    Prepared& out = all.emplace_back();
    out.material = &material;
    out.normal_map = image_of(scene, material.normal_map);
    out.diffuse_normal_map = image_of(scene, material.diffuse_normal_map);
    out.emission_map = image_of(scene, material.emission_map);
    out.emits = material.emission.r > 0 || material.emission.g > 0 || material.emission.b > 0;
    std::visit([&](const auto& model) { prepare(model, scene, out); }, material.brdf);
    out.kernel = out.distant_kernel = kernel_of(material.brdf);
    if (const auto* callisto = std::get_if<brdf::Callisto<double>>(&material.brdf)) {
      const auto is_fixed = [&](std::string_view name) {
        return std::none_of(material.bindings.begin(), material.bindings.end(), [&](const auto& binding) {
          return brdf::Callisto<double>::kParameters[binding.parameter].name == name;
        });
      };
      using C = brdf::Callisto<double>;
      out.is_callisto = true;
      out.callisto_parts = force_all ? static_cast<unsigned>(C::kAllParts) : callisto->parts(is_fixed);
      out.kernel = callisto_kernel(out.callisto_parts, out.has_dual_normals());
      out.distant_kernel = distant_callisto_kernel(out.callisto_parts, out.has_dual_normals());
      if ((out.callisto_parts & C::kSecondLobe) == 0) out.second_scale_at = kNoPlace;
    }
    out.varying = varying_of(out);
    if (material.residual) {
      out.bake = &scene.bakes[material.residual->bake];
      out.plain_kernel = out.kernel, out.plain_distant_kernel = out.distant_kernel;
      out.kernel = out.distant_kernel = residual_kernel();
    }
  }
  return all;
}

}  // namespace likeness::surface
