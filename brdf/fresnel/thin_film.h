#pragma once

#include <cstddef>
#include <numbers>

#include "brdf/fresnel/exact_sum.h"

namespace likeness::brdf {

// The standing wave in a film: c = cos(delta) and s = sin(delta) / g, delta = k g. Both are functions of g^2, which is
// negative beyond the critical angle; they grow exponentially there, and are divided by exp(k |g|), because a
// reflectance depends on their ratio alone. For the same reason their common sign means nothing.
template <Scalar S>
struct FilmWave {
  S c, s;

  // The wave after a further step.
  FilmWave after(const FilmWave& step, const S& g2) const {
    return {c * step.c - g2 * s * step.s, s * step.c + c * step.s};
  }
};

// k      2 pi thickness / wavelength
// g2     (n cos theta)^2 in the film, below 0 if the wave is evanescent
// phase  film_phase(k, g2)
template <Scalar S>
FilmWave<S> film_wave(const S& k, const S& g2, const S& phase) {
  // A series where the phase is small: it knows no difference between the two sides of the critical angle.
  const S z = k * k * g2, size = pick(greater(z, S(0)), z, S(-z));
  const auto term = [&z](double divisor, const S& rest) { return S(S(1) - z * constant<S>(1 / divisor) * rest); };
  const S c_series = term(2, term(12, term(30, term(56, term(90, S(1))))));
  const S s_series = k * term(6, term(20, term(42, term(72, term(110, S(1))))));

  const auto large = greater(size, constant<S>(0.05));  // the series then ends below 4e-17
  const auto evanescent = both(large, greater(S(0), z));
  const S g = sqrt(pick(large, pick(evanescent, S(-g2), g2), S(1)));
  const S decay = exp(S(S(-2) * pick(evanescent, phase, S(0))));
  const S wave = pick(evanescent, S(0), phase);
  const S c = pick(evanescent, S(S(0.5) * (S(1) + decay)), S(cos(wave)));
  const S s = pick(evanescent, S(S(0.5) * (S(1) - decay)), S(sin(wave)));
  return {pick(large, c, c_series), pick(large, S(s / g), s_series)};
}

// k |g|, less half turns where g is real, which leaves it in [-pi/2, pi/2]: made in double it survives rounding to float.
template <Scalar S>
S film_phase(const S& k, const S& g2) {
  const auto real = greater(g2, S(0));
  const S phase = k * root_or_zero(S(pick(real, g2, S(-g2))));
  const S half_turns = phase * constant<S>(std::numbers::inv_pi);
  const S rest = half_turns - floor(S(half_turns + S(0.5)));
  return pick(real, S(rest * constant<S>(std::numbers::pi)), phase);
}

// One polarisation: the amplitude (a c - i b s) / (a_sum c - i b_sum s).
template <Scalar S>
struct FilmAmplitude {
  S a, a_sum, b, b_sum;

  S reflectance(const FilmWave<S>& wave) const {
    const S c2 = wave.c * wave.c, s2 = wave.s * wave.s;
    return (a * a * c2 + b * b * s2) / larger(S(a_sum * a_sum * c2 + b_sum * b_sum * s2), constant<S>(kTiny<S>));
  }
};

// Reflectance of unpolarised light by one plane film between two media, none of which absorbs [1].
//
//     r = (Y0 E - H) / (Y0 E + H),   E = cos delta - i (Y2 / Y1) sin delta,   H = Y2 cos delta - i Y1 sin delta
//     delta = 2 pi d n1 cos theta_1 / lambda;   Y = n cos theta for s waves, cos theta / n for p waves
//
// which is Airy's sum over all paths. The mean of |r_s|^2 and |r_p|^2 is returned.
//
// Source      Born and Wolf, Principles of Optics, section 1.6 (characteristic matrix of a film).
// Departures  Y0 Y2 - Y1^2 and Y0 - Y2, where interfaces of nearly equal media cancel, from products of index
//             differences; sin(delta) / Y1 as a function of Y1^2, so that no complex number is left: a film in which the
//             wave is evanescent (frustrated total reflection) needs no case of its own, and one on a medium in which it
//             is evanescent reflects everything.
// Holds       R in [0, 1]; at thickness 0 the bare boundary of n0 and n2, as fresnel_dielectric gives it; the same for
//             n1 = n0 and n1 = n2; 1 at grazing.
// Does not    know dispersion, absorption or a coherence length.
template <Scalar S>
struct ThinFilm {
  FilmAmplitude<S> s_wave, p_wave;
  S g2;  // (n1 cos theta_1)^2, below 0 if the wave in the film is evanescent

  ThinFilm() = default;

  // cosine      of the incident ray in medium 0; clamped to [0, 1]
  // n0, n1, n2  index in front of, in, and behind the film, above 0
  ThinFilm(const S& cosine, const S& n0, const S& n1, const S& n2) {
    const S c = clamp01(cosine), c2 = c * c, sin2 = (S(1) - c) * (S(1) + c);
    const S m0 = n0 * n0, m1 = n1 * n1, m2 = n2 * n2, q2 = m0 * sin2;
    const S m01 = (n0 - n1) * (n0 + n1), m21 = (n2 - n1) * (n2 + n1), m20 = (n2 - n0) * (n2 + n0);
    const S behind2 = m20 + m0 * c2;  // (n2 cos theta_2)^2
    const S g_0 = n0 * c, g_2 = root_or_zero(behind2);
    g2 = m0 * c2 - m01;

    s_wave = amplitude(S(g_0 + g_2), S(-m20), S(g_0 * g_2), g2, m01, m21, S(1));
    // e0 = (m1 Y0)^2 - g2 and e2 = (m1 Y2)^2 - g2 of the p wave.
    const S e0 = m01 / m0 * (sin2 * (m0 + m1) - m1), e2 = m21 / (m2 * m2) * (q2 * (m1 + m2) - m1 * m2);
    p_wave = amplitude(S(g_0 / m0 + g_2 / m2), S(m20 * (c2 * (m0 + m2) - m0) / (m0 * m2 * m2)),
                       S(m1 * g_0 * g_2 / (m0 * m2)), S(g2 / m1), e0, e2, S(m1 * m1));
    const auto total = greater(S(0), behind2);
    for (FilmAmplitude<S>* wave : {&s_wave, &p_wave})
      *wave = {pick(total, S(1), wave->a), pick(total, S(1), wave->a_sum), pick(total, S(1), wave->b),
               pick(total, S(1), wave->b_sum)};
  }

  // As plain numbers, for tables and streams, and back without loss.
  static constexpr std::size_t kColumns = 9;
  void to_columns(S* out) const {
    const S all[]{s_wave.a, s_wave.a_sum, s_wave.b, s_wave.b_sum, p_wave.a, p_wave.a_sum, p_wave.b, p_wave.b_sum, g2};
    for (std::size_t i = 0; i < kColumns; ++i) out[i] = all[i];
  }
  static ThinFilm from_columns(const S* in) {
    ThinFilm film;
    film.s_wave = {in[0], in[1], in[2], in[3]};
    film.p_wave = {in[4], in[5], in[6], in[7]};
    film.g2 = in[8];
    return film;
  }

  S reflectance(const FilmWave<S>& wave) const {
    return smaller(S(S(0.5) * (s_wave.reflectance(wave) + p_wave.reflectance(wave))), S(1));
  }

 private:
  // b = outer - inner, which is (outer^2 - inner^2) / (outer + inner) with both squares measured from g2^2.
  FilmAmplitude<S> amplitude(const S& a_sum, const S& a_squares, const S& outer, const S& inner, const S& e0,
                             const S& e2, const S& scale) const {
    const auto any = greater(a_sum, S(0)), both_real = greater(inner, S(0));
    const S b_sum = outer + inner;
    const S b_squares = (g2 * (e0 + e2) + e0 * e2) / scale;
    return {pick(any, S(a_squares / pick(any, a_sum, S(1))), S(0)), a_sum,
            pick(both_real, S(b_squares / pick(both_real, b_sum, S(1))), S(outer - inner)), b_sum};
  }
};

// The reflectance above at one wavelength. thickness and wavelength in the same unit; wavelength above 0.
template <Scalar S>
S thin_film(const S& cos_i, const S& n0, const S& n1, const S& n2, const S& thickness, const S& wavelength) {
  const ThinFilm<S> film(cos_i, n0, n1, n2);
  const S k = constant<S>(2 * std::numbers::pi) * thickness / wavelength;
  return film.reflectance(film_wave(k, film.g2, film_phase(k, film.g2)));
}

}  // namespace likeness::brdf
