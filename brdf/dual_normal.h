#pragma once

#include "brdf/callisto.h"

namespace likeness::brdf {

// A pair of directions about a normal that is not the frame's own: a normal from a map, in the tangent frame of the
// surface, whose z says which side of the surface a direction is on.
//
// Light      its cosine to this normal may be anything; at or below 0 the pair is dark. So it is where light or viewer is
//            at or below the surface (z <= 0).
// View       below this normal but above the surface it is taken at the normal's horizon (cos_o = 1e-18), and a half
//            vector below it likewise: whoever sees the surface sees it shaded, with no step where the normal turns away.
template <Scalar T>
Geometry<T> geometry_about(const Vec3<T>& normal, const Vec3<T>& to_light, const Vec3<T>& to_view) {
  // Tangents to the normal, without a branch (Duff et al. 2017). The models that are lit this way do not read them.
  const T sign = pick(greater(T(0), normal.z), T(-1), T(1));
  const T a = T(-1) / (sign + normal.z), b = normal.x * normal.y * a;
  const Vec3<T> x(T(T(1) + sign * normal.x * normal.x * a), T(sign * b), T(-sign * normal.x));
  const Vec3<T> y(b, T(sign + normal.y * normal.y * a), T(-normal.y));
  const auto about = [&](const Vec3<T>& w) { return Vec3<T>(dot(w, x), dot(w, y), dot(w, normal)); };
  Geometry<T> g(about(to_light), about(to_view));

  const auto outside = both(greater(to_light.z, T(0)), greater(to_view.z, T(0)));
  g.cos_i = pick(outside, g.cos_i, T(0));
  g.cos_o = larger(g.cos_o, constant<T>(1e-18));
  g.above = greater(g.cos_i, T(0));
  const auto turned_away = greater(T(0), g.half.z);
  g.sin2_h = pick(turned_away, T(1), g.sin2_h);
  g.versine_h = pick(turned_away, T(1), g.versine_h);
  return g;
}

// Callisto with one normal for its diffuse and another for its specular: wet skin, lacquer over a grain. Returns
// f cos_i, [1/sr], because each part has a cosine of its own:
//
//     c1 rho / pi c2 cos_i (about the diffuse normal) + f_ggx c2 cos_i (about the specular normal)
//
// shape      of the diffuse: Lambert's 1 / pi, or what stands in its place (proxima_factor(..) / pi about `diffuse`).
// diffuse, specular   the same directions about either normal: geometry_about(normal, to_light, to_view), or
//                     Geometry(to_light, to_view) for the frame's own.
// Source      Jimenez and Petersen, "The Rendering of The Callisto Protocol", SIGGRAPH 2023 Advances ('Dual normal'),
//             which shows it and prints no formula.
// Holds       with two equal normals it is Callisto's f cos_i. Each part fades to 0 with its own cos_i, so a light that is
//             below one normal only still lights the other part, and there is no step at either normal's horizon. The
//             step that is left is the surface's own (z = 0), where the surface hides what is behind it. Never negative.
// Does not    know of a geometry under the two normals: what the diffuse reflects is not shaded by the specular's bumps.
template <Scalar S, Scalar T>
Rgb<S> dual_normal(const Callisto<S>& model, const Geometry<T>& diffuse, const Geometry<T>& specular,
                   const S& shape = constant<S>(std::numbers::inv_pi)) {
  typename Callisto<S>::template Terms<S> below, above;
  model.diffuse_terms(diffuse, below);
  model.shade_term(diffuse, below);
  model.specular_terms(specular, above);
  model.shade_term(specular, above);
  const T cos_below = pick(diffuse.above, diffuse.cos_i, T(0)), cos_above = pick(specular.above, specular.cos_i, T(0));
  return model.for_channels([&](const S& rho, const S& rho_f, const S& rho_r, const S& o) {
    const S scattered = Callisto<S>::diffuse_part(below, model.metallic, rho, rho_f, rho_r, shape);
    const S mirrored = Callisto<S>::specular_part(above, model.metallic, model.specular, rho);
    return S(scattered * mix(S(1), below.shade, o) * cos_below + mirrored * mix(S(1), above.shade, o) * cos_above);
  });
}

}  // namespace likeness::brdf
