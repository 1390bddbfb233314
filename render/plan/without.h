#pragma once

#include "render/plan/effects.h"
#include "render/scene/scene.h"

namespace likeness::plan {

// The scene edited so that it does not call for an effect, and as it was otherwise: the parameter at its neutral value and
// without its texture, the lights taken out, the environment of one color, pictures of one texel. Effects that hang on it
// go with it (without diffuse its rises, without point lights their profiles). Materials of other models become Callisto
// with the parameters of the same names, and may call for diffuse then.
scene::Scene without(const scene::Scene& scene, Effect effect);

}  // namespace likeness::plan
