#pragma once

#include <array>
#include <numbers>

#include "brdf/burley_diffuse.h"
#include "brdf/geometry.h"
#include "brdf/ggx.h"
#include "brdf/parameter.h"
#include "brdf/promises.h"

namespace likeness::brdf {

// Berry's distribution (GTR with gamma = 1) D(h), [1/sr], isotropic, 0 < alpha < 1: the clearcoat's long tail.
// Source  Burley 2012, appendix B.2 (GTR, gamma = 1), written in sin^2 and cos^2. Holds: integral of D cos = 1.
template <Scalar S, Scalar T>
S gtr1_distribution(const S& alpha, const T& cos_h, const T& sin2_h) {
  const S alpha2 = alpha * alpha;
  const S e = alpha2 * T(cos_h * cos_h) + sin2_h;
  return (alpha2 - S(1)) / (S(log(alpha2)) * e * constant<T>(std::numbers::pi));
}

// The normals of Berry's distribution, as a lobe to sample: density D(h) cos_h / (4 cos_d). Every normal, seen or not:
// what is mirrored below the horizon is lost. sin^2 and cos^2 come from inverting the distribution's integral,
// cos^2 = (1 - alpha^(2 (1 - v))) / (1 - alpha^2), each without cancellation.
template <Scalar S>
struct BerryLobe {
  S alpha;

  Vec3<S> light(const Vec3<S>& to_view, const S& u, const S& v) const {
    const S log_alpha2 = log(S(alpha * alpha)), angle = constant<S>(2 * std::numbers::pi) * u;
    const S cos2 = S(expm1(S((S(1) - v) * log_alpha2))) / S(expm1(log_alpha2));
    const S sin2 = alpha * alpha * S(expm1(S(-v * log_alpha2))) / (S(1) - alpha * alpha);
    const S one = sin2 + cos2, sine = sqrt(S(sin2 / one));  // 1 but for roundings, which mirroring would multiply
    return mirrored(to_view, Vec3<S>(S(sine * cos(angle)), S(sine * sin(angle)), S(sqrt(S(cos2 / one)))));
  }
  S density(const Geometry<S>& g) const {
    return gtr1_distribution(alpha, g.cos_h, g.sin2_h) * g.cos_h / larger(S(S(4) * g.cos_d), constant<S>(kTiny<S>));
  }
};

// Disney's "principled" BRDF of 2012, all of it: Burley's diffuse or its flatter 'subsurface' variant, sheen,
// one anisotropic GGX lobe and a clearcoat; [1/sr], cosine not included.
//
//     f = (mix(f_d, f_ss, subsurface) rho / pi + f_sheen) (1 - metallic) + F D G' + clearcoat / 4 F_c D_c G'_c
//     f_d      Burley's diffuse factor, [1] (burley_diffuse.h)
//     f_ss     1.25 (F_ss (1 / (cos_i + cos_o) - 1/2) + 1/2), F_ss as f_d with F_SS90 = roughness cos^2 theta_d
//     f_sheen  sheen mix(1, tint, sheen_tint) (1 - cos theta_d)^5,     tint = rho / luminance(rho)
//     F        Schlick, f0 = mix(0.08 specular mix(1, tint, specular_tint), rho, metallic)
//     D        GGX, alpha_x = roughness^2 / aspect, alpha_y = roughness^2 aspect, aspect^2 = 1 - 0.9 anisotropic
//     G'       Smith's G1(l) G1(v) / (4 cos_i cos_o) with its own alpha_g = (0.5 + roughness / 2)^2
//     F_c D_c  Schlick, f0 = 0.04; GTR1 with alpha from 0.1 (gloss 0) to 0.001 (gloss 1); G'_c with alpha_g = 0.25
//
// Source      Burley, "Physically-Based Shading at Disney", SIGGRAPH 2012 course, sections 5.3 to 5.6 and appendix
//             B.2; what the notes leave out (tint, subsurface, clearcoat constants) as in Disney's BRDF Explorer.
// Departures  base_color is linear, where BRDF Explorer takes a display color to the power 2.2. G stays the
//             original's remapped one, isotropic also under an anisotropic D; later versions follow alpha_x, alpha_y.
//             Values past 1 of clearcoat are allowed: published fits use 3.
// Frame       local: z along the shading normal, x along the tangent of alpha_x (the longer highlight), y of alpha_y.
// Directions  unit, both leaving the surface. If either is at or below the horizon, f = 0.
// Holds       f(l, v) = f(v, l); at anisotropic = 0, f does not depend on the tangent.
// Does not    conserve energy (sheen and clearcoat are added, f_d exceeds 1 when rough). tint has no limit at black:
//             there it is white, while the darkest non-black color keeps its hue.
template <Scalar S>
struct Disney2012 {
  static constexpr std::string_view kName = "disney2012";
  static constexpr std::string_view kText = "the principled model of Burley 2012";
  static constexpr Promises kPromises{.reciprocal = true, .energy = Energy::kUnbounded};
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "base_color", .initial = 0.5, .range = {0, 1}, .typical = {0.02, 0.9},
                .role = Role::kScale, .channels = 3,
                .text = "rho: diffuse color of the dielectric part, f0 of the metallic part, linear RGB"},
      Parameter{.name = "subsurface", .initial = 0, .range = {0, 1}, .typical = {0, 1}, .role = Role::kMix,
                .text = "0 Burley's diffuse, 1 its flatter variant that stands for scattering below the surface"},
      Parameter{.name = "metallic", .initial = 0, .range = {0, 1}, .typical = {0, 1}, .role = Role::kMix,
                .text = "0 dielectric, 1 metal: moves f0 to base_color, removes diffuse and sheen"},
      Parameter{.name = "specular", .initial = 0.5, .range = {0, 1}, .typical = {0.1, 1}, .role = Role::kScale,
                .text = "f0 of the dielectric part, divided by 0.08"},
      Parameter{.name = "specular_tint", .initial = 0, .range = {0, 1}, .typical = {0, 1}, .role = Role::kMix,
                .text = "moves the dielectric f0 from white to the hue of base_color"},
      Parameter{.name = "roughness", .initial = 0.5, .range = {0, 1}, .typical = {0.05, 0.9},
                .text = "of the diffuse and of the specular lobe; its square is the GGX alpha, kept above 0.001"},
      Parameter{.name = "anisotropic", .initial = 0, .range = {0, 1}, .typical = {0, 0.8},
                .text = "stretches the highlight along x: at 1 alpha_x is ten times alpha_y"},
      Parameter{.name = "sheen", .initial = 0, .range = {0, 1}, .typical = {0, 1}, .role = Role::kScale,
                .text = "added towards theta_d = 90 deg, for cloth"},
      Parameter{.name = "sheen_tint", .initial = 0.5, .range = {0, 1}, .typical = {0, 1}, .role = Role::kMix,
                .text = "moves the sheen from white to the hue of base_color"},
      Parameter{.name = "clearcoat", .initial = 0, .range = {0, 4}, .typical = {0, 1}, .role = Role::kScale,
                .text = "strength of a second, white lobe; the paper's range ends at 1, published fits reach 3"},
      Parameter{.name = "clearcoat_gloss", .initial = 1, .range = {0, 1}, .typical = {0, 1},
                .text = "0 satin (alpha 0.1), 1 gloss (alpha 0.001)"},
  };
  // clang-format on
  static constexpr auto members() {
    using D = Disney2012;
    return std::tuple{&D::base_color,  &D::subsurface, &D::metallic,   &D::specular,  &D::specular_tint,  &D::roughness,
                      &D::anisotropic, &D::sheen,      &D::sheen_tint, &D::clearcoat, &D::clearcoat_gloss};
  }
  static consteval double at(std::string_view name) { return initial(kParameters, name); }

  Rgb<S> base_color{S(at("base_color"))};
  S subsurface = S(at("subsurface"));
  S metallic = S(at("metallic"));
  S specular = S(at("specular"));
  S specular_tint = S(at("specular_tint"));
  S roughness = S(at("roughness"));
  S anisotropic = S(at("anisotropic"));
  S sheen = S(at("sheen"));
  S sheen_tint = S(at("sheen_tint"));
  S clearcoat = S(at("clearcoat"));
  S clearcoat_gloss = S(at("clearcoat_gloss"));

  template <Scalar T>
  Rgb<S> eval(const Geometry<T>& g) const {
    const T cos_i = pick(g.above, g.cos_i, T(1)), cos_o = pick(g.above, g.cos_o, T(1));
    const T fresnel = schlick_weight(g.versine_d);

    // Diffuse: Burley's, or the flatter Hanrahan-Krueger shape scaled by 1.25 to about the same albedo.
    const S at_grazing = burley_at_grazing(roughness, g.cos_d);
    const S flat = burley_grazing(S(at_grazing - S(0.5)) * S(0.5), cos_i, cos_o);
    const T lift = T(1) / larger(T(cos_i + cos_o), constant<T>(kTiny<T>)) - T(0.5);
    const S diffuse = mix(burley_grazing(at_grazing, cos_i, cos_o), S(S(1.25) * (flat * lift + S(0.5))), subsurface) *
                      constant<T>(std::numbers::inv_pi);

    // Specular: one lobe for all channels, the Fresnel term in each.
    const GgxLobe<S> slopes = specular_slopes();
    const S alpha_g = squared(S(S(0.5) + S(0.5) * roughness));
    const S lobe = ggx_distribution_anisotropic(slopes.alpha_x, slopes.alpha_y, g.half, g.cos_h) *
                   ggx_masking(alpha_g, cos_i) * ggx_masking(alpha_g, cos_o);

    // Clearcoat: white, of fixed index (f0 = 0.04) and fixed masking.
    const T coat_fresnel = mix(constant<T>(0.04), T(1), fresnel);
    const T coat_masking = ggx_masking(T(0.25), cos_i) * ggx_masking(T(0.25), cos_o);
    const S coat =
        S(0.25) * clearcoat * gtr1_distribution(coat_alpha(), g.cos_h, g.sin2_h) * T(coat_fresnel * coat_masking);

    const Rgb<S> hue = tint();
    const auto channel = [&](const S& rho, const S& of_channel) {
      const S f0 = mix(S(constant<S>(0.08) * specular * mix(S(1), of_channel, specular_tint)), rho, metallic);
      const S sheen_color = sheen * mix(S(1), of_channel, sheen_tint) * fresnel;
      const S below = (diffuse * rho + sheen_color) * (S(1) - metallic);
      return S(pick(g.above, S(below + mix(f0, S(1), fresnel) * lobe + coat), S(0)));
    };
    return {channel(base_color.r, hue.r), channel(base_color.g, hue.g), channel(base_color.b, hue.b)};
  }
  Rgb<S> eval(const Vec3<S>& to_light, const Vec3<S>& to_view) const { return eval(Geometry<S>(to_light, to_view)); }

  // What is sampled: diffuse and sheen by the cosine, the specular lobe by the normals of its D that Smith's term for that
  // D leaves visible (f itself has the remapped one), the clearcoat by its D, in proportion to estimates of what they
  // return to this view.
  Mixture<S, CosineLobe<S>, BerryLobe<S>, GgxLobe<S>> lobes(const Vec3<S>& to_view) const {
    const S rise = schlick_weight(usual_versine(to_view));
    const S hue = mean(tint()), rho = mean(base_color);
    const S f0 = mix(S(constant<S>(0.08) * specular * mix(S(1), hue, specular_tint)), rho, metallic);
    const S diffuse = (rho + sheen * mix(S(1), hue, sheen_tint) * rise) * (S(1) - metallic);
    const S coat = S(0.25) * clearcoat * mix(constant<S>(0.04), S(1), rise);
    return Mixture<S, CosineLobe<S>, BerryLobe<S>, GgxLobe<S>>({diffuse, coat, mix(f0, S(1), rise)}, {}, {coat_alpha()},
                                                               specular_slopes());
  }
  Sample<S> sample(const Vec3<S>& to_view, const S& choice, const S& u, const S& v) const {
    return sample_lobes(*this, to_view, choice, u, v);
  }
  S pdf(const Vec3<S>& to_light, const Vec3<S>& to_view) const {
    return lobes_pdf(lobes(to_view), Geometry<S>(to_light, to_view));
  }

 private:
  GgxLobe<S> specular_slopes() const {
    const S alpha = roughness * roughness, aspect = sqrt(S(S(1) - constant<S>(0.9) * anisotropic));
    return {larger(S(alpha / aspect), constant<S>(0.001)), larger(S(alpha * aspect), constant<S>(0.001))};
  }
  S coat_alpha() const { return mix(constant<S>(0.1), constant<S>(0.001), clearcoat_gloss); }
  // base_color over its luminance; white where it is black.
  Rgb<S> tint() const {
    const S luminance =
        constant<S>(0.3) * base_color.r + constant<S>(0.6) * base_color.g + constant<S>(0.1) * base_color.b;
    const auto has_hue = greater(luminance, constant<S>(kTiny<S>));
    const S scale = S(1) / pick(has_hue, luminance, S(1));
    return {pick(has_hue, S(base_color.r * scale), S(1)), pick(has_hue, S(base_color.g * scale), S(1)),
            pick(has_hue, S(base_color.b * scale), S(1))};
  }
};

}  // namespace likeness::brdf
