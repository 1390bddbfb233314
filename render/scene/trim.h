#pragma once

#include "render/scene/scene.h"

namespace likeness::scene {

// Leaves out the meshes, materials, pictures and profiles that nothing in the scene uses (a glTF's own materials where
// the scene gives others), so that what a renderer derives from the lists is of what it will show.
void trim(Scene& scene);

}  // namespace likeness::scene
