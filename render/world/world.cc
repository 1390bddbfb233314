#include "render/world/world.h"

#include "render/texture/texture.h"

namespace likeness::world {

World::World(const scene::Scene& scene_, const plan::Plan& plan_, bool is_watertight)
    : scene(scene_),
      plan(plan_),
      materials(surface::prepare_materials(scene_, plan_.is_forced)),
      tracer(scene_, {.is_watertight = is_watertight,
                      .has_cut_outs = plan_.has(plan::Effect::kCutOuts),
                      .cut_outs = {this, &World::is_solid}}),
      surfaces(scene_, tracer, materials),
      lights(scene_) {}

bool World::is_solid(const void* world, scene::Index instance, scene::Index triangle, float u, float v) {
  const World& self = *static_cast<const World*>(world);
  const scene::Material& material = self.scene.materials[self.scene.instances[instance].material];
  const scene::Texture& opacity = *material.opacity;
  const glm::vec2 uv = self.surfaces.uv_at(instance, triangle, u, v);
  return texture::number_at(self.scene.images[opacity.image], opacity, uv) >= material.opacity_cutoff;
}

}  // namespace likeness::world
