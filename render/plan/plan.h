#pragma once

#include <array>
#include <string>
#include <vector>

#include "render/plan/effects.h"
#include "render/scene/scene.h"

namespace likeness::plan {

// Whether an effect is worked on, and the fact of the scene that decided it, in words:
// "material \"skin\": retroreflection = 4", "no light has a range".
struct Decision {
  bool is_on = false;
  std::string because;
};

struct MaterialPlan {
  std::string name, model;
  unsigned callisto_parts = 0;  // brdf::Callisto::Part
  bool has_textures = false, has_normal_map = false, has_dual_normals = false, is_cut_out = false, emits = false;
};

// What has to be done for a scene: made from the scene alone.
struct Plan {
  std::array<Decision, kEffectCount> decisions;
  std::vector<MaterialPlan> materials;  // of the scene, in order
  bool is_forced = false;               // every effect is on, needed or not

  bool has(Effect effect) const { return decisions[static_cast<std::size_t>(effect)].is_on; }
};

// `force_all` turns every effect on: the picture is the same, and the time shows what was saved. Only what an instance
// uses counts; camera `camera` is looked through.
Plan plan_of(const scene::Scene& scene, std::size_t camera = 0, bool force_all = false);

}  // namespace likeness::plan
