#include "render/scene/trim.h"

#include <algorithm>

namespace likeness::scene {
namespace {

// Calls visit(Index&) for every picture that a material names.
template <class F>
void for_each_image(Material& material, F&& visit) {
  for (Material::Binding& binding : material.bindings) visit(binding.texture.image);
  for (std::optional<Texture>* map :
       {&material.normal_map, &material.diffuse_normal_map, &material.opacity, &material.emission_map})
    if (*map) visit((*map)->image);
}

// Removes the entries of `list` that are not marked, and returns where the others went.
template <class T>
std::vector<Index> keep(std::vector<T>& list, const std::vector<bool>& used) {
  std::vector<Index> moved(list.size(), kNone);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!used[i]) continue;
    moved[i] = static_cast<Index>(kept);
    if (kept != i) list[kept] = std::move(list[i]);
    ++kept;
  }
  list.resize(kept);
  return moved;
}

}  // namespace

void trim(Scene& scene) {
  std::vector<bool> meshes(scene.meshes.size()), materials(scene.materials.size()), images(scene.images.size()),
      profiles(scene.profiles.size());
  for (const Instance& instance : scene.instances) meshes[instance.mesh] = materials[instance.material] = true;
  const std::vector<Index> mesh_at = keep(scene.meshes, meshes), material_at = keep(scene.materials, materials);
  for (Instance& instance : scene.instances) {
    instance.mesh = mesh_at[instance.mesh];
    instance.material = material_at[instance.material];
  }

  for (Material& material : scene.materials) for_each_image(material, [&](Index image) { images[image] = true; });
  if (scene.environment && scene.environment->image != kNone) images[scene.environment->image] = true;
  const std::vector<Index> image_at = keep(scene.images, images);
  for (Material& material : scene.materials) for_each_image(material, [&](Index& image) { image = image_at[image]; });
  if (scene.environment && scene.environment->image != kNone)
    scene.environment->image = image_at[scene.environment->image];

  for (const Light& light : scene.lights)
    if (light.profile != kNone) profiles[light.profile] = true;
  const std::vector<Index> profile_at = keep(scene.profiles, profiles);
  for (Light& light : scene.lights)
    if (light.profile != kNone) light.profile = profile_at[light.profile];
}

}  // namespace likeness::scene
