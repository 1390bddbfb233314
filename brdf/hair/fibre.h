#pragma once

#include <tuple>

#include "brdf/hair/azimuthal.h"
#include "brdf/hair/longitudinal.h"
#include "brdf/parameter.h"
#include "brdf/vector.h"

namespace likeness::brdf {

// Below this a roughness is held: v = 5e-5 and s = 0.0017, half a degree. A smooth fibre is another model.
inline constexpr double kHairRoughnessFloor = 0.01;

// What a cosine that is divided by is held above, in every precision: at a pole all return the same.
inline constexpr double kHairLeastCosine = 1e-18;

// Variance of the longitudinal lobe R from the longitudinal roughness beta_m in [0, 1], [rad^2]. TT has a quarter of
// it, TRT and all longer paths four times as much (the ratios of Marschner 2003, squared).
// Source  Chiang 2016, section 4.1, a fit made so that beta_m is perceptually even; the digits are those of pbrt-v3.
template <Scalar S>
S hair_variance(const S& beta_m) {
  const S b = larger(beta_m, constant<S>(kHairRoughnessFloor)), b2 = b * b, b4 = b2 * b2, b8 = b4 * b4;
  const S root = constant<S>(0.726) * b + constant<S>(0.812) * b2 + constant<S>(3.7) * b8 * b8 * b4;
  return root * root;
}
// Width of the azimuthal logistic from the azimuthal roughness beta_n in [0, 1], [rad]. Source  as above.
template <Scalar S>
S hair_width(const S& beta_n) {
  const S b = larger(beta_n, constant<S>(kHairRoughnessFloor)), b2 = b * b, b4 = b2 * b2, b8 = b4 * b4;
  constexpr double kRoot = 0.62665706865775013;  // sqrt(pi / 8)
  return constant<S>(kRoot) *
         (constant<S>(0.265) * b + constant<S>(1.194) * b2 + constant<S>(5.372) * b8 * b8 * b4 * b2);
}

// The chance of each lobe to be sampled: its attenuation, as the mean of the channels; evenly where all is absorbed.
template <Scalar S>
std::array<S, kHairLobes> hair_chances(const std::array<Rgb<S>, kHairLobes>& attenuations) {
  std::array<S, kHairLobes> chances;
  S total = S(0.0);
  for (std::size_t p = 0; p < kHairLobes; ++p) {
    chances[p] = attenuations[p].r + attenuations[p].g + attenuations[p].b;
    total = total + chances[p];
  }
  const auto usable = greater(total, constant<S>(kTiny<S>));
  const S scale = S(1) / pick(usable, total, S(1));
  for (S& c : chances) c = pick(usable, S(c * scale), S(0.25));
  return chances;
}

// What two directions and an offset come to, for a fibre: all that is left is exponentials. Lobe p = 3 has the variance
// of p = 2, no tilt, and is even in azimuth.
template <Scalar S>
struct HairTerms {
  std::array<S, 3> v;                          // variance of R, TT and TRT
  std::array<S, kHairLobes> versine, cosines;  // (1 - cos(theta_i + theta_o)) / v and cos cos / v, with the lobe's tilt
  std::array<S, 3> distance;                   // of the azimuth from the centre of the lobe, [0, pi]
  S s;                                         // width of the logistic
  std::array<Rgb<S>, kHairLobes> attenuations;  // A_p
  S cos_i;                                      // cosine of the light's inclination

  // M_p D_p, the density of the lobes over directions, [1/sr].
  std::array<S, kHairLobes> densities() const {
    const S scale = trimmed_logistic_scale(s), even = constant<S>(0.5 / std::numbers::pi);
    const std::array<S, 3> of_v{hair_mp_scale(v[0]), hair_mp_scale(v[1]), hair_mp_scale(v[2])};
    std::array<S, kHairLobes> d;
    for (std::size_t p = 0; p < kHairLobes; ++p) {
      const S m = scaled_exp(S(bessel_i0_scaled(cosines[p]) * of_v[p < 3 ? p : 2]), versine[p]);
      d[p] = m * (p < 3 ? trimmed_logistic(distance[p < 3 ? p : 0], s, scale) : even);
    }
    return d;
  }
  // S cos(theta_i), [1/sr]: no cosine is divided by.
  Rgb<S> eval_cos() const { return eval_cos(densities()); }
  Rgb<S> eval_cos(const std::array<S, kHairLobes>& d) const {
    const auto& a = attenuations;
    return a[0] * d[0] + a[1] * d[1] + a[2] * d[2] + a[3] * d[3];
  }
  // S, [1/sr], without the cosine: grows without bound towards the poles, where the cosine is held above 1e-18.
  Rgb<S> eval() const { return eval_cos() * S(S(1) / larger(cos_i, constant<S>(kHairLeastCosine))); }
  // Density over directions with which `sample` proposes, [1/sr].
  S pdf() const { return pdf(densities()); }
  S pdf(const std::array<S, kHairLobes>& d) const {
    const auto c = hair_chances(attenuations);
    return c[0] * d[0] + c[1] * d[1] + c[2] * d[2] + c[3] * d[3];
  }
};

// A direction that a fibre proposes.
template <Scalar S>
struct HairSample {
  Vec3<S> to_light;  // unit
  S pdf;             // [1/sr], of all lobes: what pdf() gives for that direction
  Rgb<S> weight;     // S cos(theta_i) / pdf
};

// A fibre of hair or fur: a rough dielectric cylinder with an absorbing core, near field.
//
//     S(i, o, h) cos(theta_i) = sum over p of M_p(theta_i, theta_o) A_p(theta_o, h) D_p(phi_i - phi_o)     [1/sr]
//
// Frame       x along the fibre, from root to tip; y and z across it. theta = asin(x), phi = atan2(z, y).
// Directions  unit, leaving the fibre: to_light (i) and to_view (o). Scattered radiance is the integral of S L_i
//             cos(theta_i) over the sphere, where cos(theta) = sqrt(y^2 + z^2).
// h           offset of the viewing ray from the axis in radii, [-1, 1]: sin(phi_o - azimuth of the normal it hits).
// Lobes       R, TT, TRT, and all longer paths together, evenly in azimuth.
// Tilt        of the scales by alpha: they shift theta_i + theta_o of R, TT, TRT by -2, +1 and +4 alpha.
// Source      Chiang 2016 ("A Practical and Controllable Hair and Fur Model for Production Path Tracing"), M_p of
//             d'Eon 2011.
// Departures  eval without the cosine divides by it, eval_cos does not; the tilt turns theta_o, so that each M_p
//             still integrates to 1 over the light (turning theta_i does not: see docs/models/hair.md).
// Holds       without absorption the integral of S cos(theta_i) over the light is 1, for every theta_o, h and roughness.
// Does not    stay the same when light and viewer change places: A_p reads theta_o and h.
template <Scalar S>
struct HairFibre {
  static constexpr std::string_view kName = "hair_fibre";
  static constexpr std::string_view kText = "a fibre of hair, near field: R, TT, TRT and longer paths (Chiang 2016)";
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "sigma_a", .initial = 0.2, .range = {0, 1e6}, .typical = {0, 3}, .unit = "1/radius",
                .role = Role::kShape, .channels = 3, .text = "absorption inside the fibre, per radius"},
      Parameter{.name = "eta", .initial = 1.55, .range = {1, 3}, .typical = {1.3, 1.8}, .text = "refractive index"},
      Parameter{.name = "beta_m", .initial = 0.3, .range = {0, 1}, .typical = {0.05, 0.8},
                .text = "longitudinal roughness; held above 0.01"},
      Parameter{.name = "beta_n", .initial = 0.3, .range = {0, 1}, .typical = {0.05, 0.8},
                .text = "azimuthal roughness; held above 0.01"},
      Parameter{.name = "tilt_deg", .initial = 2, .range = {-20, 20}, .typical = {0, 5}, .unit = "deg",
                .role = Role::kAngle, .text = "tilt alpha of the scales; positive moves R towards the root"},
  };
  // clang-format on
  static constexpr auto members() {
    return std::tuple{&HairFibre::sigma_a, &HairFibre::eta, &HairFibre::beta_m, &HairFibre::beta_n,
                      &HairFibre::tilt_deg};
  }
  Rgb<S> sigma_a{constant<S>(kParameters[0].initial)};
  S eta = constant<S>(kParameters[1].initial), beta_m = constant<S>(kParameters[2].initial),
    beta_n = constant<S>(kParameters[3].initial), tilt_deg = S(kParameters[4].initial);

  // What depends on the viewer alone: make it once for many lights.
  struct View {
    std::array<S, 3> v;
    std::array<Inclination<S>, kHairLobes> o;  // theta_o with the tilt of each lobe taken off
    S s, phi_o, gamma_i, gamma_t;
    std::array<Rgb<S>, kHairLobes> attenuations;

    HairTerms<S> terms(const Inclination<S>& i, const S& phi_i) const {
      HairTerms<S> t;
      t.v = v;
      for (std::size_t p = 0; p < kHairLobes; ++p) {
        const S scale = S(1) / v[p < 3 ? p : 2];
        t.versine[p] = versine_of_sum(i, o[p]) * scale;
        t.cosines[p] = i.cosine * o[p].cosine * scale;
      }
      for (std::size_t p = 0; p < 3; ++p)
        t.distance[p] = azimuth_distance(constant<S>(double(p)), S(phi_i - phi_o), gamma_i, gamma_t);
      t.s = s;
      t.attenuations = attenuations;
      t.cos_i = i.cosine;
      return t;
    }
    HairTerms<S> terms(const Vec3<S>& to_light) const { return terms(inclination(to_light), azimuth(to_light)); }
  };

  View view(const Inclination<S>& o, const S& phi_o, const S& h) const {
    View view;
    const S v = hair_variance(beta_m);
    view.v = {v, S(v * S(0.25)), S(v * S(4))};
    view.s = hair_width(beta_n);
    const S alpha = tilt_deg * constant<S>(std::numbers::pi / 180);
    view.o = {turned(o, S(S(2) * alpha)), turned(o, S(-alpha)), turned(o, S(S(-4) * alpha)), o};
    const FibrePath<S> path = fibre_path(h, o.cosine, eta);
    view.gamma_i = path.gamma_i;
    view.gamma_t = path.gamma_t;
    view.phi_o = phi_o;
    const Rgb<S> depth = sigma_a * S(S(2) * path.chord);
    const auto r = hair_attenuations(path.reflected, path.transmitted, depth.r),
               g = hair_attenuations(path.reflected, path.transmitted, depth.g),
               b = hair_attenuations(path.reflected, path.transmitted, depth.b);
    for (std::size_t p = 0; p < kHairLobes; ++p) view.attenuations[p] = {r[p], g[p], b[p]};
    return view;
  }
  View view(const Vec3<S>& to_view, const S& h) const { return view(inclination(to_view), azimuth(to_view), h); }

  Rgb<S> eval(const Vec3<S>& to_light, const Vec3<S>& to_view, const S& h) const {
    return view(to_view, h).terms(to_light).eval();
  }
  Rgb<S> eval_cos(const Vec3<S>& to_light, const Vec3<S>& to_view, const S& h) const {
    return view(to_view, h).terms(to_light).eval_cos();
  }
  S pdf(const Vec3<S>& to_light, const Vec3<S>& to_view, const S& h) const {
    return view(to_view, h).terms(to_light).pdf();
  }
  // choice, u, w and a are independent and uniform in [0, 1): choice takes a lobe by its attenuation, u and w an
  // inclination from its M, a an azimuth from its D.
  HairSample<S> sample(const Vec3<S>& to_view, const S& h, const S& choice, const S& u, const S& w, const S& a) const {
    const View from = view(to_view, h);
    const Vec3<S> to_light = proposed(from, choice, u, w, a);
    const HairTerms<S> terms = from.terms(to_light);
    const auto densities = terms.densities();
    const S pdf = terms.pdf(densities);
    const auto usable = greater(pdf, constant<S>(kTiny<S>));
    return {to_light, pdf, terms.eval_cos(densities) * pick(usable, S(S(1) / pick(usable, pdf, S(1))), S(0))};
  }

  static Inclination<S> inclination(const Vec3<S>& w) { return {w.x, safe_sqrt(S(w.y * w.y + w.z * w.z))}; }
  // 0 for a direction along the fibre, which has none.
  static S azimuth(const Vec3<S>& w) {
    const auto usable = greater(S(w.y * w.y + w.z * w.z), constant<S>(kTiny<S>));
    return atan2(w.z, pick(usable, w.y, S(1)));
  }

  // theta + angle. Beyond a pole the direction comes down on the other side: its cosine is folded.
  static Inclination<S> turned(const Inclination<S>& i, const S& angle) {
    const S sine = sin(angle), cosine = cos(angle);
    return {i.sine * cosine + i.cosine * sine, S(abs(S(i.cosine * cosine - i.sine * sine)))};
  }

 private:
  static Vec3<S> proposed(const View& from, const S& choice, const S& u, const S& w, const S& a) {
    // The first three lobes in order, what is left for the fourth.
    const auto chance = hair_chances(from.attenuations);
    const S first = chance[0], second = first + chance[1], third = second + chance[2];
    const auto not_r = greater(S(choice), first), not_tt = greater(S(choice), second),
               not_trt = greater(S(choice), third);
    const auto of = [&](const S& r, const S& tt, const S& trt, const S& rest) {
      return pick(not_trt, rest, pick(not_tt, trt, pick(not_r, tt, r)));
    };
    const S v = of(from.v[0], from.v[1], from.v[2], from.v[2]);
    const Inclination<S> o{of(from.o[0].sine, from.o[1].sine, from.o[2].sine, from.o[3].sine),
                           of(from.o[0].cosine, from.o[1].cosine, from.o[2].cosine, from.o[3].cosine)};
    const Inclination<S> i = sample_hair_mp(v, o, u, w);
    const S p = of(S(0), S(1), S(2), S(0));
    const S centre = S(2) * (p * from.gamma_t - from.gamma_i) + p * constant<S>(std::numbers::pi);
    const S even = (S(2) * a - S(1)) * constant<S>(std::numbers::pi);
    const S turn = pick(not_trt, even, S(centre + sample_trimmed_logistic(from.s, a)));
    const S phi = from.phi_o + turn;
    return {i.sine, S(i.cosine * cos(phi)), S(i.cosine * sin(phi))};
  }
};

}  // namespace likeness::brdf
