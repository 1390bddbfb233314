#pragma once

#include <numbers>

#include "brdf/subsurface/burley_profile.h"
#include "brdf/vector.h"

// Light through a slab: what the viewer sees of an object that is lit from behind.
namespace likeness::brdf {

// The part of the light on the back of a slab that leaves at one point of its front, [1]:
//
//     T = integral over the back of R(sqrt(r^2 + t^2)) / A = (exp(-s t) + 3 exp(-s t / 3)) / 4
//
// t  thickness along the normal, >= 0, [length]; s as in brdf/subsurface/burley_profile.h
//
// Assumes     parallel faces without end, the whole back lit alike, and that light crosses the slab as it spreads along a
//             surface, by the distance between its ends alone. T(0) = 1.
// Source      'Efficient Screen-Space Subsurface Scattering' (SIGGRAPH 2018 Advances), 'Thin Object Translucency', after
//             Jimenez et al. 2010; T is 1 - CDF of Burley's profile at t.
template <Scalar S>
S slab_transmission(const S& thickness, const S& s) {
  return burley_beyond(S(s * thickness));
}

// Light from behind: radiance that leaves the front over the irradiance that the light puts on a surface that faces it,
// [1/sr], all factors included. x = s thickness by channel, `lit` one of the two factors below.
//
//     f = A T lit / pi
//
// Assumes  diffuse transmission at both faces (1 / pi); the albedo of the front is applied once, on the way out.
// Source   as above.
template <Scalar S>
Rgb<S> translucency(const Rgb<S>& albedo, const Rgb<S>& x, const S& lit) {
  return albedo * Rgb<S>(burley_beyond(x.r), burley_beyond(x.g), burley_beyond(x.b)) *
         S(lit * constant<S>(std::numbers::inv_pi));
}

// Of a thin object, a leaf or an ear: shadow max(0, -cos_i). `facing` is -cos_i, the cosine between the light and the
// reverse of the front's normal.
//
// shadow   of the front, in [0, 1], 1 where the light is seen: front and back share one look-up, made at the front and with
//          a bias larger than the thickness
// Assumes  the normal of the back is the reverse of the front's.
// Source   as above; Jimenez et al. 2010, 'Real-Time Realistic Skin Translucency', for the reversed normal.
template <Scalar S>
S lit_thin(const S& facing, const S& shadow) {
  return positive(facing) * shadow;
}

// Of a thick object: max(0, w - cos_i) / (1 + w)^2. `facing` is w - cos_i.
//
// wrap     w in [0, 1]: how far light reaches round the edge of the back; 0 is the cosine alone. It keeps the energy: over
//          all directions this integrates to pi.
// Assumes  as lit_thin, but for the shadow: a shadow map gives the thickness (slab_thickness) and does not darken, or the
//          back would shadow the front. Attenuation over a long way is all the shadow there is.
// Source   talk as above, 'Thick Object Translucency', after Barre-Brisebois and Bouchard 2011; McAuley's 'Energy-Conserving
//          Wrapped Diffuse'. The talk does not wrap.
template <Scalar S>
S lit_thick(const S& facing, const S& wrap) {
  const S reach = S(1) + wrap;
  return positive(facing) / (reach * reach);
}
// The larger of the thickness from a texture and the way through the object from a shadow map, which is 0 where the map,
// with its few bits, says 'lit'.
template <Scalar S>
S slab_thickness(const S& baked, const S& from_shadow_map) {
  return larger(baked, from_shadow_map);
}

}  // namespace likeness::brdf
