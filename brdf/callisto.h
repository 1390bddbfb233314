#pragma once

#include <array>
#include <numbers>

#include "brdf/geometry.h"
#include "brdf/ggx.h"
#include "brdf/parameter.h"
#include "brdf/promises.h"

namespace likeness::brdf {

// The Callisto BRDF: Lambert and two GGX lobes with explicit controls for the diffuse Fresnel rise,
// retroreflection, the shading terminator and the specular Fresnel rise.
//
//     f(l, v) = (c1 rho / pi + f_ggx) c2                        [1/sr], cosine not included
//     c1  = lerp(1, rho_f, h(theta_d, n_f, theta_h, m_f)) lerp(1, rho_r, h(theta_h, n_r, theta_d, m_r))
//     c2  = lerp(1, smoothstep(0, alpha_s p, cos_i), alpha_s o)
//     F   = f0 + t(2 - r(n_s)) (1 - f0) (1 - cos theta_d)^(5 r(n_s))
//     h(t, n, u, m) = (1 - cos t)^(5 r(n)) (cos u)^(5 r(m)),   r(x) = 2 (1 - x),   0^0 = 1
//     alpha_s = (1 - (1 - cos theta_d)^3) (1 - (1 - cos theta_h)^3)
//
// Source      Jimenez and Petersen, "The Rendering of The Callisto Protocol", SIGGRAPH 2023 Advances.
// Departures  the slide's first mask prints n_r, m_r for n_f, m_f; its alpha_s has angles for cosines;
//             its Fresnel exponent has lost its raising: all three as in the project's definition.
// Frame       local: z along the shading normal.
// Directions  unit, both leaving the surface. If either is at or below the horizon, f = 0.
// Holds       at its defaults (and any values of the first four rows) f is Lambert + GGX, bit for bit.
// Does not    conserve energy (rho_f, rho_r reach 256), nor hold f(l, v) = f(v, l): c2 sees cos_i only.
template <Scalar S>
struct Callisto {
  static constexpr std::string_view kName = "callisto";
  static constexpr std::string_view kText =
      "diffuse shaped in half-angle space, two GGX lobes, and a smooth terminator";
  static constexpr Promises kPromises{.reciprocal = false, .energy = Energy::kUnbounded};
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "base_color", .initial = 0.5, .range = {0, 1}, .typical = {0.02, 0.9},
                .role = Role::kScale, .channels = 3,
                .text = "rho: diffuse albedo of the dielectric part, f0 of the metallic part, linear RGB"},
      Parameter{.name = "metallic", .initial = 0, .range = {0, 1}, .typical = {0, 1}, .role = Role::kMix,
                .text = "0 dielectric, 1 metal: moves f0 to base_color and removes the diffuse"},
      Parameter{.name = "specular", .initial = 0.5, .range = {0, 1}, .typical = {0.1, 1}, .role = Role::kScale,
                .text = "f0 of the dielectric part, divided by 0.08"},
      Parameter{.name = "roughness", .initial = 0.5, .range = {0, 1}, .typical = {0.03, 0.9},
                .text = "of the sharper lobe; its square is the GGX alpha, kept above 1e-4"},
      Parameter{.name = "diffuse_fresnel", .initial = 1, .range = {0, 256}, .typical = {0, 8},
                .role = Role::kScale, .tier = Tier::kBase,
                .text = "rho_f: factor on the diffuse towards theta_d = 90 deg"},
      Parameter{.name = "diffuse_fresnel_falloff", .initial = 0.75, .range = {0, 1}, .typical = {0.3, 0.95},
                .tier = Tier::kBase, .text = "n_f: 0 late, 1 everywhere"},
      Parameter{.name = "retroreflection", .initial = 1, .range = {0, 256}, .typical = {0, 8},
                .role = Role::kScale, .tier = Tier::kBase,
                .text = "rho_r: factor on the diffuse towards theta_h = 90 deg"},
      Parameter{.name = "retroreflection_falloff", .initial = 0.75, .range = {0, 1}, .typical = {0.3, 0.95},
                .tier = Tier::kBase, .text = "n_r: 0 late, 1 everywhere"},
      Parameter{.name = "smooth_terminator", .initial = 0, .range = {-1, 1}, .typical = {-0.5, 1},
                .role = Role::kScale, .tier = Tier::kBase,
                .text = "o: above 0 darkens towards the terminator, below 0 brightens"},
      Parameter{.name = "diffuse_fresnel_tint", .initial = 1, .range = {0, 1}, .typical = {0.3, 1},
                .role = Role::kTint, .tier = Tier::kAdvanced, .channels = 3, .tints = "diffuse_fresnel",
                .text = "multiplies diffuse_fresnel, linear RGB"},
      Parameter{.name = "retroreflection_tint", .initial = 1, .range = {0, 1}, .typical = {0.3, 1},
                .role = Role::kTint, .tier = Tier::kAdvanced, .channels = 3, .tints = "retroreflection",
                .text = "multiplies retroreflection, linear RGB"},
      Parameter{.name = "smooth_terminator_tint", .initial = 1, .range = {0, 1}, .typical = {0.3, 1},
                .role = Role::kTint, .tier = Tier::kAdvanced, .channels = 3, .tints = "smooth_terminator",
                .text = "multiplies smooth_terminator, linear RGB"},
      Parameter{.name = "specular_fresnel_falloff", .initial = 0.5, .range = {0, 1}, .typical = {0, 0.9},
                .tier = Tier::kAdvanced, .text = "n_s: 0 no rise, 0.5 Schlick's, 1 white everywhere"},
      Parameter{.name = "dual_specular_roughness_scale", .initial = 2, .range = {1, 16}, .typical = {1.5, 8},
                .tier = Tier::kAdvanced, .text = "roughness of the second lobe over that of the first, capped at roughness 1"},
      Parameter{.name = "dual_specular_opacity", .initial = 0, .range = {0, 1}, .typical = {0, 0.9},
                .role = Role::kMix, .tier = Tier::kAdvanced, .text = "weight of the second lobe; the first has the rest"},
      Parameter{.name = "diffuse_fresnel_tangent_falloff", .initial = 0.75, .range = {0, 1}, .typical = {0.3, 1},
                .tier = Tier::kFull, .text = "m_f: how soon the rise fades towards theta_h = 90 deg; 1 never"},
      Parameter{.name = "retroreflection_tangent_falloff", .initial = 0.75, .range = {0, 1}, .typical = {0.3, 1},
                .tier = Tier::kFull, .text = "m_r: how soon it fades towards theta_d = 90 deg; 1 never"},
      Parameter{.name = "smooth_terminator_length", .initial = 0.5, .range = {0, 1}, .typical = {0.1, 1},
                .tier = Tier::kFull, .text = "p: cosine of the light's angle at which the terminator's effect ends"},
  };
  // clang-format on
  static constexpr auto members() {
    using C = Callisto;
    return std::tuple{&C::base_color,
                      &C::metallic,
                      &C::specular,
                      &C::roughness,
                      &C::diffuse_fresnel,
                      &C::diffuse_fresnel_falloff,
                      &C::retroreflection,
                      &C::retroreflection_falloff,
                      &C::smooth_terminator,
                      &C::diffuse_fresnel_tint,
                      &C::retroreflection_tint,
                      &C::smooth_terminator_tint,
                      &C::specular_fresnel_falloff,
                      &C::dual_specular_roughness_scale,
                      &C::dual_specular_opacity,
                      &C::diffuse_fresnel_tangent_falloff,
                      &C::retroreflection_tangent_falloff,
                      &C::smooth_terminator_length};
  }
  static consteval double at(std::string_view name) { return initial(kParameters, name); }

  Rgb<S> base_color{S(at("base_color"))};
  S metallic = S(at("metallic"));
  S specular = S(at("specular"));
  S roughness = S(at("roughness"));
  S diffuse_fresnel = S(at("diffuse_fresnel"));
  S diffuse_fresnel_falloff = S(at("diffuse_fresnel_falloff"));
  S retroreflection = S(at("retroreflection"));
  S retroreflection_falloff = S(at("retroreflection_falloff"));
  S smooth_terminator = S(at("smooth_terminator"));
  Rgb<S> diffuse_fresnel_tint{S(at("diffuse_fresnel_tint"))};
  Rgb<S> retroreflection_tint{S(at("retroreflection_tint"))};
  Rgb<S> smooth_terminator_tint{S(at("smooth_terminator_tint"))};
  S specular_fresnel_falloff = S(at("specular_fresnel_falloff"));
  S dual_specular_roughness_scale = S(at("dual_specular_roughness_scale"));
  S dual_specular_opacity = S(at("dual_specular_opacity"));
  S diffuse_fresnel_tangent_falloff = S(at("diffuse_fresnel_tangent_falloff"));
  S retroreflection_tangent_falloff = S(at("retroreflection_tangent_falloff"));
  S smooth_terminator_length = S(at("smooth_terminator_length"));

  // What a pair of directions contributes, the same for all three channels. Each term depends on at most
  // three parameters, and none on the parameters of another: a fit differentiates them with short Jets.
  template <Scalar X>
  struct Terms {
    X rise;     // mask of the diffuse Fresnel rise [0, 1]; falloffs n_f, m_f
    X retro;    // mask of retroreflection [0, 1]; falloffs n_r, m_r
    X shade;    // c2 at o = 1, which is 1 - (1 - smoothstep) alpha_s, [0, 1]; length p
    X lobe;     // the two GGX lobes without Fresnel [1/sr]; roughness, scale, opacity
    X fresnel;  // weight of the specular's rise to white [0, 1]; falloff n_s
  };

  // What a material may do without: left out, its f is the same to the last bit as long as the parameters that a part
  // reads are at their neutral values (parts() says which are not). A renderer has a kernel for each set of parts.
  enum Part : unsigned {
    kDiffuse = 1,      // not all metal, not black
    kRise = 2,         // diffuse_fresnel is not 1
    kRetro = 4,        // retroreflection is not 1
    kTerminator = 8,   // smooth_terminator is not 0
    kFalloff = 16,     // specular_fresnel_falloff is not 0.5
    kSecondLobe = 32,  // dual_specular_opacity is not 0
    kAllParts = 63
  };
  // The parts that f needs. Scalars that compare as one: numbers. `is_fixed(name)` says whether a parameter has its value
  // everywhere; one that has not needs its part.
  template <class F>
  unsigned parts(F&& is_fixed) const {
    const auto rest = [&](bool is_neutral, auto... names) { return is_neutral && (is_fixed(names) && ...); };
    const auto all = [](const Rgb<S>& c, double x) { return c.r == S(x) && c.g == S(x) && c.b == S(x); };
    unsigned parts = 0;
    if (!rest(metallic == S(1), "metallic") && !rest(all(base_color, 0), "base_color")) {
      parts |= kDiffuse;
      if (!rest(all(diffuse_fresnel_tint * diffuse_fresnel, 1), "diffuse_fresnel", "diffuse_fresnel_tint"))
        parts |= kRise;
      if (!rest(all(retroreflection_tint * retroreflection, 1), "retroreflection", "retroreflection_tint"))
        parts |= kRetro;
    }
    if (!rest(all(smooth_terminator_tint * smooth_terminator, 0), "smooth_terminator", "smooth_terminator_tint"))
      parts |= kTerminator;
    if (!rest(specular_fresnel_falloff == S(0.5), "specular_fresnel_falloff")) parts |= kFalloff;
    if (!rest(dual_specular_opacity == S(0), "dual_specular_opacity")) parts |= kSecondLobe;
    return parts;
  }

  // The alpha of the second lobe.
  S second_alpha() const { return alpha_of_roughness(smaller(S(roughness * dual_specular_roughness_scale), S(1))); }

  // Needs both directions above the horizon; elsewhere finite and meaningless. Terms of parts that are left out are not
  // written.
  template <unsigned kParts = kAllParts, Scalar T>
  Terms<S> terms(const Geometry<T>& g) const {
    Terms<S> t;
    diffuse_terms<kParts>(g, t);
    specular_terms<kParts>(g, t);
    if constexpr ((kParts & kTerminator) != 0) shade_term(g, t);
    return t;
  }
  template <unsigned kParts = kAllParts, Scalar T>
  void diffuse_terms(const Geometry<T>& g, Terms<S>& t) const {
    if constexpr ((kParts & kRise) != 0)
      t.rise =
          power5(g.versine_d, remap(diffuse_fresnel_falloff)) * power5(g.cos_h, remap(diffuse_fresnel_tangent_falloff));
    if constexpr ((kParts & kRetro) != 0)
      t.retro =
          power5(g.versine_h, remap(retroreflection_falloff)) * power5(g.cos_d, remap(retroreflection_tangent_falloff));
  }
  template <unsigned kParts = kAllParts, Scalar T>
  void specular_terms(const Geometry<T>& g, Terms<S>& t) const {
    const T cos_i = pick(g.above, g.cos_i, T(1)), cos_o = pick(g.above, g.cos_o, T(1));
    const S alpha = alpha_of_roughness(roughness);
    t.lobe = ggx_distribution(alpha, g.cos_h, g.sin2_h) * ggx_visibility(alpha, cos_i, cos_o);
    if constexpr ((kParts & kSecondLobe) != 0) {
      const S alpha_2 = second_alpha();
      t.lobe = mix(t.lobe, S(ggx_distribution(alpha_2, g.cos_h, g.sin2_h) * ggx_visibility(alpha_2, cos_i, cos_o)),
                   dual_specular_opacity);
    }
    if constexpr ((kParts & kFalloff) != 0) {
      const S r = remap(specular_fresnel_falloff);
      t.fresnel = clamp01(S(S(2) - r)) * power5(g.versine_d, r);
    } else {
      t.fresnel = S(schlick_weight(g.versine_d));
    }
  }
  // 1 - alpha_s (1 - smoothstep(0, end, cos_i)), where alpha_s = (1 - a) (1 - b): written as a sum of positive terms,
  // which keeps its digits where it vanishes, and so that end = 0 is a step and not 0 / 0.
  template <Scalar T>
  void shade_term(const Geometry<T>& g, Terms<S>& t) const {
    const T cos_i = pick(g.above, g.cos_i, T(1));
    const T a = g.versine_d * g.versine_d * g.versine_d, b = g.versine_h * g.versine_h * g.versine_h;
    const T mask = (T(1) - a) * (T(1) - b);
    const S end = smooth_terminator_length * mask;
    const auto inside = greater(end, cos_i);
    const S u = pick(inside, S(cos_i / pick(inside, end, S(1))), S(1));
    t.shade = pick(inside, S(T(a + b * (T(1) - a)) + mask * (u * u * (S(3) - (u + u)))), S(1));
  }

  // c1 times the diffuse of one channel, whose shape is Lambert's 1 / pi or what stands in its place.
  template <unsigned kParts = kAllParts, Scalar X>
  static X diffuse_part(const Terms<X>& t, const X& metallic, const X& rho, const X& rho_f, const X& rho_r,
                        const X& shape) {
    const X diffuse = rho * (X(1) - metallic) * shape;
    if constexpr ((kParts & (kRise | kRetro)) == 0) return diffuse;
    X c1(1.0);
    if constexpr ((kParts & kRise) != 0) c1 = X(1) + (rho_f - X(1)) * t.rise;
    if constexpr ((kParts & kRetro) != 0) c1 = c1 * (X(1) + (rho_r - X(1)) * t.retro);
    return c1 * diffuse;
  }
  // f_ggx of one channel.
  template <Scalar X>
  static X specular_part(const Terms<X>& t, const X& metallic, const X& specular, const X& rho) {
    const X f0 = mix(X(constant<X>(0.08) * specular), rho, metallic);
    return mix(f0, X(1), t.fresnel) * t.lobe;
  }
  // One channel of f from its terms and that channel's reflectance and intensities.
  template <unsigned kParts = kAllParts, Scalar X>
  static X combine(const Terms<X>& t, const X& metallic, const X& specular, const X& rho, const X& rho_f,
                   const X& rho_r, const X& o, const X& shape = constant<X>(std::numbers::inv_pi)) {
    X f = specular_part(t, metallic, specular, rho);
    if constexpr ((kParts & kDiffuse) != 0) f = diffuse_part<kParts>(t, metallic, rho, rho_f, rho_r, shape) + f;
    if constexpr ((kParts & kTerminator) != 0) f = f * mix(X(1), t.shade, o);
    return f;
  }

  // Calls channel(rho, rho_f, rho_r, o) for red, green and blue.
  template <class F>
  Rgb<S> for_channels(F&& channel) const {
    const Rgb<S> rho_f = diffuse_fresnel_tint * diffuse_fresnel;
    const Rgb<S> rho_r = retroreflection_tint * retroreflection;
    const Rgb<S> o = smooth_terminator_tint * smooth_terminator;
    return {channel(base_color.r, rho_f.r, rho_r.r, o.r), channel(base_color.g, rho_f.g, rho_r.g, o.g),
            channel(base_color.b, rho_f.b, rho_r.b, o.b)};
  }
  // f from terms and the shape of the diffuse; 0 where the mask does not hold.
  template <unsigned kParts = kAllParts, class M>
  Rgb<S> combined(const M& above, const Terms<S>& t, const S& shape) const {
    return for_channels([&](const S& rho, const S& rho_f, const S& rho_r, const S& o) {
      return S(pick(above, combine<kParts>(t, metallic, specular, rho, rho_f, rho_r, o, shape), S(0)));
    });
  }

  template <unsigned kParts = kAllParts, Scalar T>
  Rgb<S> eval(const Geometry<T>& g) const {
    return combined<kParts>(g.above, terms<kParts>(g), constant<S>(std::numbers::inv_pi));
  }
  Rgb<S> eval(const Vec3<S>& to_light, const Vec3<S>& to_view) const { return eval(Geometry<S>(to_light, to_view)); }

  // What is sampled: the diffuse by its cosine, each GGX lobe by its normals, in proportion to estimates of what they
  // return to this view. The diffuse rises are taken where they peak, in the mirror direction and towards the viewer;
  // their mean and not their product, because one has faded where the other peaks.
  template <unsigned kParts = kAllParts>
  auto lobes(const Vec3<S>& to_view) const {
    const S f0 = mix(S(constant<S>(0.08) * specular), mean(base_color), metallic);
    S glossy;
    if constexpr ((kParts & kFalloff) != 0) {
      const S r = remap(specular_fresnel_falloff);
      glossy = mix(f0, S(1), S(clamp01(S(S(2) - r)) * power5(usual_versine(to_view), r)));
    } else {
      glossy = mix(f0, S(1), S(schlick_weight(usual_versine(to_view))));
    }
    const GgxLobe<S> first(alpha_of_roughness(roughness));
    if constexpr ((kParts & kSecondLobe) != 0) {
      const GgxLobe<S> second(second_alpha());
      const S most = glossy * (S(1) - dual_specular_opacity), rest = glossy * dual_specular_opacity;
      if constexpr ((kParts & kDiffuse) == 0) return Mixture<S, GgxLobe<S>, GgxLobe<S>>({most, rest}, first, second);
      else
        return Mixture<S, CosineLobe<S>, GgxLobe<S>, GgxLobe<S>>({diffuse_energy<kParts>(to_view), most, rest}, {},
                                                                 first, second);
    } else {
      if constexpr ((kParts & kDiffuse) == 0) return first;
      else return Mixture<S, CosineLobe<S>, GgxLobe<S>>({diffuse_energy<kParts>(to_view), glossy}, {}, first);
    }
  }
  template <unsigned kParts>
  S diffuse_energy(const Vec3<S>& to_view) const {
    const S versine = S(1) - clamp01(to_view.z);
    S facing(1.0), backwards(1.0);
    if constexpr ((kParts & kRise) != 0)
      facing =
          mix(S(1), S(diffuse_fresnel * mean(diffuse_fresnel_tint)), power5(versine, remap(diffuse_fresnel_falloff)));
    if constexpr ((kParts & kRetro) != 0)
      backwards =
          mix(S(1), S(retroreflection * mean(retroreflection_tint)), power5(versine, remap(retroreflection_falloff)));
    return mean(base_color) * (S(1) - metallic) * S(0.5) * (facing + backwards);
  }
  Sample<S> sample(const Vec3<S>& to_view, const S& choice, const S& u, const S& v) const {
    return sample_lobes(*this, to_view, choice, u, v);
  }
  S pdf(const Vec3<S>& to_light, const Vec3<S>& to_view) const {
    return lobes_pdf(lobes(to_view), Geometry<S>(to_light, to_view));
  }

 private:
  static S remap(const S& x) { return S(2) * (S(1) - x); }
};

}  // namespace likeness::brdf
