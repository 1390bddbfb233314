#pragma once

#include <algorithm>
#include <cmath>

#include "realis/weight/samples.h"

namespace likeness::realis::weight {

// 1 - clamp01(b g^a (1 - |v_camera . v_lobe|)) (spec: Realis, Bake, 3): what a camera sees of a texture at a slant is drawn out
// over many texels. g is the norm of d(texture space) / d(clip space), over its median in the picture, so that a and b mean
// the same for any texture and any distance; v_lobe is the light's direction, about which the sample's lobe lies. 1 everywhere
// where there is no uv: of an image-space subject, texture space is the picture.
struct StretchSettings {
  double a = 1;     // gradient strength, >= 0
  double b = 0.05;  // fade speed, >= 0
};
Weights stretch(const Samples& s, const StretchSettings& settings);

// The two halves of that formula, for who has g from elsewhere: b g^a, and the weight of a light with v_camera . v_lobe.
inline double stretch_strength(double gradient, const StretchSettings& settings) {
  return settings.b * std::pow(gradient, settings.a);
}
inline double stretch_weight(double strength, double cosine) {
  return 1 - std::clamp(strength * (1 - std::abs(cosine)), 0.0, 1.0);
}

}  // namespace likeness::realis::weight
