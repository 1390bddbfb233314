#pragma once

#include "brdf/hair/longitudinal.h"
#include "brdf/hair/mean_scattering.h"

// Multiple scattering in a volume of hair: light that comes through n strands (global), and light that comes back from
// the strands behind the one that is shaded (local). Zinke, Yuksel, Weber and Keyser 2008, "Dual Scattering
// Approximation for Fast Multiple Scattering in Hair".
//
// The paper counts paths along a row of equal, parallel strands: a strand hit sends a share a_f on and a_b back. Public
// codes disagree on what follows from this, so it is derived here, and proven against walks along such rows
// (tests/brdf/hair/dual_scattering_test.cc). A path that turns back once after i strands passes 2 i in all; one that
// turns three times passes 2 (i + k), in i ways. With F = a_f^2 and w = a_b^2 / (1 - F)^2:
//
//     A_1 = a_b F / (1 - F),   A_3 = a_b^3 F / (1 - F)^3 = w A_1
//     passes, mean            2 / (1 - F)                     2 (1 + 2 F) / (1 - F)
//     passes squared, mean    4 (1 + F) / (1 - F)^2           4 (1 + 7 F + 4 F^2) / (1 - F)^2
//
// Departures from the paper
//   Delta_b    its factor (1 - 2 w) of alpha_b is (1 + 3 w) / (1 + w): a path with three turns is shifted three times
//   sigma_b    exact variance of the counted paths (passes, turns, and the spread of their shifts) instead of its fit
//   energy     the three turns leave 5/8 of white hair's light; all of them leave all: energy_of_all
//   a_f -> 1   1 - F is kept above a_b (2 - a_b), which energy conservation (a_f + a_b <= 1) makes a bound, not a fudge
namespace likeness::brdf {

// Variances that the longitudinal term is given: below, a highlight narrower than any fibre's; above, it is uniform.
inline constexpr double kLeastVariance = 1e-6, kWidestVariance = 100;
// The half that faces the light ends within +-kEdge of cos(phi) = 0, and not in a step.
inline constexpr double kEdge = 0.25;

// What a row of strands sends back, without the first strand's own.
template <Scalar S>
struct RowBackscatter {
  S energy;         // A_b = A_1 + A_3, [1]: paths that turn once or three times
  S energy_of_all;  // paths that turn any odd number of times, [1]
  S shift;          // Delta_b: mean turn of the inclination over the paths of A_b [rad]
  S variance;       // sigma_b^2 [rad^2]
};

template <Scalar S>
RowBackscatter<S> row_backscatter(const MeanScatter<S>& forward, const MeanScatter<S>& backward) {
  const S b = clamp01(backward.energy), f = smaller(clamp01(forward.energy), S(S(1) - b));
  const S square = f * f;
  // 1 - F, by its factors and not below what a_f <= 1 - a_b allows; b = 0 and f = 1 together scatter nothing back.
  const S rest = larger(S((S(1) - f) * (S(1) + f)), larger(S(b * (S(2) - b)), constant<S>(kTiny<S>)));
  const S inverse = S(1) / rest, root_w = b * inverse, w = root_w * root_w, scale = S(1) / (S(1) + w);
  RowBackscatter<S> row;
  row.energy = b * square * inverse * (S(1) + w);

  // R = b + F R / (1 - b R): the row with its first strand, the root that is b for F = 0. The discriminant
  // (1 - F + b^2)^2 - 4 b^2 by its factors, of which the first is what a strand absorbs.
  const S inner = (S(1) - b - f) * (S(1) - b + f), outer = (S(1) + b - f) * (S(1) + b + f);
  const S root = safe_sqrt(positive(S(inner * outer)));
  const S all = S(2) * b / larger(S(rest + b * b + root), constant<S>(kTiny<S>));
  row.energy_of_all = larger(S(all - b), row.energy);

  const S passes = S(2) * inverse * (S(1) + w * (S(1) + S(2) * square)) * scale;
  const S turns = (S(1) + S(3) * w) * scale;
  // Variances of the two counts and their covariance.
  const S passes2 = S(4) * inverse * inverse * ((S(1) + square) + w * (S(1) + square * (S(7) + S(4) * square))) * scale;
  const S passes_turns = S(2) * inverse * (S(1) + S(3) * w * (S(1) + S(2) * square)) * scale;
  const S turns2 = (S(1) + S(9) * w) * scale;
  const S of_shifts = squared(forward.shift) * positive(S(passes2 - passes * passes)) +
                      S(2) * forward.shift * backward.shift * (passes_turns - passes * turns) +
                      squared(backward.shift) * positive(S(turns2 - turns * turns));
  row.shift = passes * forward.shift + turns * backward.shift;
  row.variance = passes * forward.variance + turns * backward.variance + positive(of_shifts);
  return row;
}

// What n strands let through: T_f = a_f^n with the variance n beta_f^2 and the shift n alpha_f. n >= 0 may be a fraction,
// as a strand count read from a volume is: below 1 the share 1 - n sees the light directly.
template <Scalar S>
struct Transmitted {
  S direct;     // share of the light that meets no strand, [0, 1]
  S scattered;  // share that comes through strands, [0, 1]
  S shift;      // of the scattered part [rad]
  S variance;   // [rad^2]
};

template <Scalar S>
Transmitted<S> transmitted_through(const S& strands, const MeanScatter<S>& forward) {
  const S n = positive(strands), passed = larger(n, S(1)), direct = positive(S(S(1) - n));
  // a_f^n is 0 where a_f is: power() is for exponents above 0, and passed is at least 1.
  return {direct, S((S(1) - direct) * power(clamp01(forward.energy), passed)), S(passed * forward.shift),
          S(passed * forward.variance)};
}

// A fibre as dual scattering sees it.
template <Scalar S>
struct DualFibre {
  std::array<LobeScattering<S>, kHairLobes> lobes;
  std::array<S, kHairLobes> shifts;     // of the inclination [rad]: -2, 1 and 4 times the cuticle's tilt, 0
  std::array<S, kHairLobes> variances;  // of the longitudinal terms [rad^2]

  MeanScatter<S> forward() const {
    return mean_of_lobes<S>({lobes[0].forward, lobes[1].forward, lobes[2].forward, lobes[3].forward}, shifts,
                            variances);
  }
  MeanScatter<S> backward() const {
    return mean_of_lobes<S>({lobes[0].backward, lobes[1].backward, lobes[2].backward, lobes[3].backward}, shifts,
                            variances);
  }
};

// Longitudinal term of variance v about the direction that is turned by `shift` from the mirror's, [1/rad/cos]. The
// inclination of the light is turned instead of the viewer's, as pbrt's and Cycles' fibres do.
template <Scalar S>
S turned_hair_mp(const S& v, const S& shift, const Inclination<S>& i, const Inclination<S>& o) {
  const S c = cos(shift), s = sin(shift);
  // theta_i - shift; its cosine may come out below 0 beyond a pole.
  const Inclination<S> turned{S(i.sine * c - i.cosine * s), S(abs(S(i.cosine * c + i.sine * s)))};
  return hair_mp(v, turned, o);
}

// N_p averaged over light from the whole front half: what a strand makes of light that was scattered before. From the
// Fourier coefficients 0, 1 and 3; the second vanishes in that average, and the rest counts for at most 1/8 of a fifth
// coefficient. [1/rad], of all lobes weighted by `longitudinal`.
template <Scalar S>
S scattered_azimuthal(const LobeScattering<S>& lobe, const S& cos_phi) {
  const S cos_3phi = cos_phi * (S(4) * cos_phi * cos_phi - S(3));
  const S total = lobe.forward + lobe.backward;
  const S series = total + constant<S>(4 / std::numbers::pi) *
                               (lobe.first_cosine * cos_phi - lobe.third_cosine * cos_3phi * constant<S>(1.0 / 3));
  return positive(S(series * constant<S>(0.5 / std::numbers::pi)));
}

// Everything but the single scattering of direct light, which the caller has from its own fibre: [1/sr], without cosine.
template <Scalar S>
struct DualScattering {
  S direct;        // factor of the fibre's own scattering function
  S local;         // of direct light, back from the strands behind
  S global;        // of light that came through strands, scattered once by this one
  S global_local;  // and back from the strands behind
  S sum() const { return local + global + global_local; }
};

// `strands` towards the light; `density` in [0, 1] is the share of a strand's surroundings that are hair (d_f = d_b of
// the paper, 0.7 for human hair).
template <Scalar S>
DualScattering<S> dual_scattering(const DualFibre<S>& fibre, const S& strands, const S& density,
                                  const Inclination<S>& i, const Inclination<S>& o, const S& cos_phi) {
  const MeanScatter<S> forward = fibre.forward(), backward = fibre.backward();
  const RowBackscatter<S> row = row_backscatter(forward, backward);
  const Transmitted<S> through = transmitted_through(strands, forward);
  const S widest = constant<S>(kWidestVariance), least = constant<S>(kLeastVariance);
  const auto variance = [&](const S& v) { return smaller(larger(v, least), widest); };

  // Evenly over the half that faces the light: smoothstep is odd about its middle, so the integral over phi is 1.
  const S t = clamp01(S((cos_phi + constant<S>(kEdge)) * constant<S>(0.5 / kEdge)));
  const S back = density * row.energy * t * t * (S(3) - S(2) * t) * constant<S>(std::numbers::inv_pi);
  DualScattering<S> f;
  f.direct = through.direct;
  f.local = through.direct * back * turned_hair_mp(variance(row.variance), row.shift, i, o);
  const S reaching = density * through.scattered;
  S global(0.0);
  for (std::size_t p = 0; p < kHairLobes; ++p) {
    global = global + scattered_azimuthal(fibre.lobes[p], cos_phi) *
                          turned_hair_mp(variance(S(fibre.variances[p] + through.variance)),
                                         S(fibre.shifts[p] + through.shift), i, o);
  }
  f.global = reaching * global;
  // Light from the whole front half comes back over the whole of it.
  const S wide = constant<S>(0.5 * std::numbers::inv_pi) *
                 (S(1) + cos_phi * constant<S>(8 / (std::numbers::pi * std::numbers::pi)));
  f.global_local = reaching * density * row.energy * wide *
                   turned_hair_mp(variance(S(row.variance + through.variance)), S(row.shift + through.shift), i, o);
  return f;
}

}  // namespace likeness::brdf
