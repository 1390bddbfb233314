#pragma once

#include <numbers>
#include <tuple>

#include "brdf/ggx.h"
#include "brdf/hair/longitudinal.h"
#include "brdf/parameter.h"

// The closed forms that file 002 describes (Unreal's hair, after Karis 2016), and the exact values of what they
// approximate. All are fitted at eta = 1.55.
namespace likeness::brdf {

// 1 / eta', the ratio of the sines of gamma_t and gamma_i: cos(theta_d) / sqrt(eta^2 - sin^2(theta_d)). As a reciprocal
// it stays finite at 90 degrees, where eta' does not. Exact. Source  Marschner 2003.
template <Scalar S>
S inverse_eta_prime(const S& eta, const S& cos_d) {
  const S q = (eta - S(1)) * (eta + S(1));
  return cos_d / sqrt(larger(S(q + cos_d * cos_d), constant<S>(kTiny<S>)));
}
// The same for eta = 1.55, as a reciprocal of eta' = 1.19 / cos(theta_d) + 0.36 cos(theta_d): within 0.7 % of it, and
// multiplied through by the cosine. Source  file 002.
template <Scalar S>
S inverse_eta_prime_fit(const S& cos_d) {
  return cos_d / S(constant<S>(1.19) + constant<S>(0.36) * cos_d * cos_d);
}

// The offset at which the light that leaves at azimuth phi by TT entered, in [-1, 1]: the solution of
// 2 gamma_t - 2 gamma_i + pi = phi,
//
//     h = sign(phi) cos(phi / 2) / sqrt(1 + a^2 - 2 a sin(|phi| / 2)),   a = 1 / eta'
//
// Where |phi| is below 2 asin(a) no such light leaves, and the formula merely goes on. It is odd in phi: it changes its
// sign at 0 and vanishes at pi. Source  file 002, with the root as errata.md has it.
// Reads a, 1 - a >= 0 and t = (pi - |phi|) / 4, with which the root is (1 - a)^2 + 4 a sin^2(t), without cancellation;
// and sign = +-1.
template <Scalar S>
S h_tt(const S& a, const S& one_less_a, const S& t, const S& sign) {
  const S sine = sin(t), root2 = one_less_a * one_less_a + S(4) * a * sine * sine;
  const auto usable = greater(root2, constant<S>(kTiny<S>));
  return pick(usable, S(sign * S(2) * sine * cos(t) / sqrt(pick(usable, root2, S(1)))), S(0));
}
// Its size as file 002 fits it: cos(phi / 2) (1 + a (0.6 - 0.8 cos phi)).
template <Scalar S>
S h_tt_fit(const S& a, const S& cos_half, const S& cos_phi) {
  return cos_half * (S(1) + a * (constant<S>(0.6) - constant<S>(0.8) * cos_phi));
}

// What file 002's shader computes of one light, [1/sr]: it holds the cosine of theta_i already (its Gaussians are of
// sines, so that their integral over the sphere is 1).
template <Scalar S>
struct KarisLobes {
  S r;
  Rgb<S> tt, trt;
  Rgb<S> sum() const { return Rgb<S>(r) + tt + trt; }
};

// File 002's hair, single scattering of one fibre:
//
//     S cos(theta_i) = sum over p of g(B_p; sin(theta_i) + sin(theta_o) - alpha_p) N_p(phi)                [1/sr]
//
//     N_R    = 1/4 cos(phi/2) F(sqrt(1/2 + 1/2 wi.wo))
//     N_TT   = exp(-3.65 cos phi - 3.98) (1 - f)^2 C^(sqrt(1 - h^2 a^2) / (2 cos theta_d))     f = F(cos theta_d sqrt(1 - h^2))
//     N_TRT  = exp(17 cos phi - 16.78) (1 - f)^2 f C^(0.8 / cos theta_d)                       f = F(cos theta_d / 2)
//
//     g      hair_gauss; B = r^2, r^2 / 2, 2 r^2 and alpha = -2, +1, +4 times `shift` for R, TT, TRT
//     F      Schlick, F0 = ((1 - 1.55) / (1 + 1.55))^2;   a = inverse_eta_prime_fit, h = h_tt_fit
//
// R is scaled by 2 specular and by lerp(1, backlit, -wi.wo), TT by backlit: neutral at 0.5 and 1.
//
// Frame       that of HairFibre: x along the fibre, theta = asin(x); the shift's sign is that of its tilt.
// C           base color, what is left after the absorption that the exponents scale. C = exp(-4 sigma_a) is the sigma_a
//             per radius of the reference: exactly at h = 0 and theta = 0 for TT, to 4 % of the exponent for TRT.
// Source      file 002 (its printed shader code); Karis 2016 ("Physically Based Hair Shading in Unreal").
// Departures  the file's exponents C^(...) are kept, because h and 0.8 were fitted with them. `Shift` and `BScale` of
//             R, which the file uses without saying what they are, are alpha_R and 1. B is held above 1e-4; N_R, T and F
//             are guarded at theta_d = 90 degrees.
// Does not    conserve energy (docs/models/hair_karis.md), nor read an azimuthal roughness.
template <Scalar S>
struct HairKaris {
  static constexpr std::string_view kName = "hair_karis";
  static constexpr std::string_view kText = "closed forms of file 002 (Unreal's hair, Karis 2016): R, TT and TRT";
  static constexpr double kLeastBeta = 1e-4, kF0 = 0.04652056901191851;  // ((1 - 1.55) / (1 + 1.55))^2
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "base_color", .initial = 0.5, .range = {0, 1}, .typical = {0.02, 0.95}, .role = Role::kScale,
                .channels = 3, .text = "color of the fibre, linear RGB: exp(-4 sigma_a)"},
      Parameter{.name = "specular", .initial = 0.5, .range = {0, 1}, .typical = {0.2, 0.8}, .role = Role::kScale,
                .text = "half the scale of R; 0.5 is neutral"},
      Parameter{.name = "roughness", .initial = 0.3, .range = {0, 1}, .typical = {0.1, 0.8},
                .text = "square root of the width of R, in sines; the width is held above 1e-4"},
      Parameter{.name = "backlit", .initial = 1, .range = {0, 1}, .typical = {0.2, 1}, .role = Role::kScale,
                .text = "scale of light from behind; 1 is neutral"},
      Parameter{.name = "shift", .initial = 0.035, .range = {-0.35, 0.35}, .typical = {0, 0.09}, .unit = "rad",
                .role = Role::kAngle, .text = "tilt of the scales; positive moves R towards the root"},
  };
  // clang-format on
  static constexpr auto members() {
    return std::tuple{&HairKaris::base_color, &HairKaris::specular, &HairKaris::roughness, &HairKaris::backlit,
                      &HairKaris::shift};
  }
  Rgb<S> base_color{constant<S>(kParameters[0].initial)};
  S specular = constant<S>(kParameters[1].initial), roughness = constant<S>(kParameters[2].initial),
    backlit = constant<S>(kParameters[3].initial), shift = constant<S>(kParameters[4].initial);

  // What the formula reads of two directions; computed before anything is rounded to float.
  struct Terms {
    std::array<S, 3> beta, offset;  // of the Gaussians: width, and (sine sum - alpha) / width
    S cos_half, cos_phi;            // |cos(phi / 2)|, cos(phi)
    S cos_d;                        // cos(theta_d)
    S half_cosine;                  // sqrt(1/2 + 1/2 wi.wo)
  };
  // cos2_half = cos^2(phi / 2), sin2_half the rest to 1.
  Terms terms(const Inclination<S>& i, const Inclination<S>& o, const S& sin2_half, const S& cos2_half) const {
    constexpr double kWidths[]{1, 0.5, 2}, kShifts[]{-2, 1, 4};
    Terms t;
    const S width = larger(S(roughness * roughness), constant<S>(kLeastBeta));
    for (std::size_t p = 0; p < 3; ++p) {
      t.beta[p] = width * constant<S>(kWidths[p]);
      t.offset[p] = (i.sine + o.sine - shift * constant<S>(kShifts[p])) / t.beta[p];
    }
    // theta_d is half of theta_i - theta_o, theta_h here half of theta_i + theta_o.
    const S cos2_d = S(0.25) * (squared(S(i.cosine + o.cosine)) + squared(S(i.sine + o.sine)));
    const S sin2_h = S(0.5) * versine_of_sum(i, o);
    t.cos_half = safe_sqrt(cos2_half);
    t.cos_phi = cos2_half - sin2_half;
    t.cos_d = smaller(safe_sqrt(cos2_d), S(1));
    t.half_cosine = smaller(safe_sqrt(S(cos2_half * cos2_d + sin2_half * sin2_h)), S(1));
    return t;
  }

  KarisLobes<S> eval_cos(const Terms& t) const {
    const S over_cos_d = S(1) / larger(t.cos_d, constant<S>(kTiny<S>));
    const auto m = [&](std::size_t p) { return hair_gauss(t.beta[p], t.offset[p]); };

    const S behind = positive(S(S(1) - S(2) * t.half_cosine * t.half_cosine));
    KarisLobes<S> lobes;
    lobes.r = m(0) * S(0.25) * t.cos_half * fresnel(t.half_cosine) * S(2) * specular * mix(S(1), backlit, behind);

    const S a = inverse_eta_prime_fit(t.cos_d), h = h_tt_fit(a, t.cos_half, t.cos_phi);
    const S f = fresnel(S(t.cos_d * safe_sqrt(positive(S(S(1) - h * h)))));
    const S tt = m(1) * exp(S(constant<S>(-3.65) * t.cos_phi - constant<S>(3.98))) * squared(S(S(1) - f)) * backlit;
    const S way_tt = S(0.5) * safe_sqrt(positive(S(S(1) - h * h * a * a))) * over_cos_d;
    lobes.tt = transmitted(way_tt) * tt;

    const S f_trt = fresnel(S(t.cos_d * S(0.5)));
    const S trt = m(2) * exp(S(S(17) * t.cos_phi - constant<S>(16.78))) * squared(S(S(1) - f_trt)) * f_trt;
    lobes.trt = transmitted(S(constant<S>(0.8) * over_cos_d)) * trt;
    return lobes;
  }

  static S fresnel(const S& cosine) { return mix(constant<S>(kF0), S(1), schlick_weight(S(S(1) - cosine))); }

 private:
  Rgb<S> transmitted(const S& way) const {
    return {power(base_color.r, way), power(base_color.g, way), power(base_color.b, way)};
  }
};

}  // namespace likeness::brdf
