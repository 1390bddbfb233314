#pragma once

#include <numbers>

#include "brdf/subsurface/burley_profile.h"
#include "brdf/vector.h"

// Light through a slab: what reaches the viewer of an object that is lit from behind.
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

// Light from behind, thin object: reflected radiance over the irradiance that the light puts on a surface that faces it,
// [1/sr], all factors included.
//
//     f = shadow A T max(0, -cos_i) / pi
//
// cos_i   between the normal of the front and the light: below 0 for light from behind
// shadow  of the front, in [0, 1], 1 where the light is seen: front and back of a thin object share one look-up, made at
//         the front with a bias larger than the thickness
//
// Assumes     the normal of the back is the reverse of the front's, and diffuse transmission at both faces (1 / pi). The
//             albedo of the front is applied once.
// Source      as above; Jimenez et al. 2010, 'Real-Time Realistic Skin Translucency', for the reversed normal.
template <Scalar S>
Rgb<S> thin_translucency(const Rgb<S>& albedo, const Rgb<S>& s, const S& thickness, const S& cos_i, const S& shadow) {
  const S lit = positive(S(-cos_i)) * shadow * constant<S>(std::numbers::inv_pi);
  return albedo *
         Rgb<S>(slab_transmission(thickness, s.r), slab_transmission(thickness, s.g),
                slab_transmission(thickness, s.b)) *
         lit;
}

// Light from behind, thick object, [1/sr], all factors included:
//
//     f = A T(max(baked, shadow map)) wrapped(-cos_i) / pi,   wrapped(c) = max(0, c + w) / (1 + w)^2
//
// baked, from_shadow_map  thickness from a texture, and the way of the light through the object from the shadow map: 0
//                         where the map says 'lit', which is why the larger of the two counts, [length]
// wrap                    w in [0, 1]: how far light reaches round the back's edge; 0 is the cosine. It keeps the energy:
//                         wrapped / pi integrates to 1 over all directions.
//
// Assumes     what thin_translucency does, but for the shadow: the map gives the thickness and does not darken, or the back
//             would shadow the front. Attenuation over a long way is all the shadow there is.
// Source      talk as above, 'Thick Object Translucency', after Barre-Brisebois and Bouchard 2011; wrapped: McAuley's
//             'Energy-Conserving Wrapped Diffuse'. The talk does not wrap.
template <Scalar S>
Rgb<S> thick_translucency(const Rgb<S>& albedo, const Rgb<S>& s, const S& baked, const S& from_shadow_map,
                          const S& cos_i, const S& wrap) {
  const S thickness = larger(baked, from_shadow_map), reach = S(1) + wrap;
  const S lit = positive(S(wrap - cos_i)) / (reach * reach) * constant<S>(std::numbers::inv_pi);
  return albedo *
         Rgb<S>(slab_transmission(thickness, s.r), slab_transmission(thickness, s.g),
                slab_transmission(thickness, s.b)) *
         lit;
}

}  // namespace likeness::brdf
