#pragma once

#include "brdf/fresnel/spectral_weights.h"
#include "brdf/fresnel/thin_film.h"
#include "brdf/vector.h"

namespace likeness::brdf {

// A camera with sensitivities exp(-(lambda - peak)^2 / (2 width^2)) between 360 and 780 nm, white-balanced to light of
// equal energy. Peaks are kept in [380, 740] nm and the width, one standard deviation, at 5 nm or more.
template <Scalar S>
struct GaussianCamera {
  S red, green, blue, width;  // [nm]
};

// What a camera or an observer sees of a film: its reflectance averaged over the wavelengths of SpectralWeights. The wave
// at the first wave number and the step to the next are all that is trigonometric; the others follow by rotation.
//
// Holds     a film of no thickness is the bare boundary to the last bit, and joined to it smoothly.
// Does not  blur what a real film of uneven thickness does; nor know dispersion.
// Error     of the 512 wavelengths: 1e-5 for coatings of low index up to 20 um, for soap films, and for films of any
//           index up to 1.5 um; more for thick films of high index in air near grazing (docs/models/thin_film.md).
template <Scalar S>
struct FilmSpectrum {
  ThinFilm<S> film;
  S first_k, first_phase, step_k, step_phase;

  FilmSpectrum() = default;

  // thickness in nm.
  FilmSpectrum(const ThinFilm<S>& film_, const S& thickness) : film(film_) {
    first_k = thickness * constant<S>(2 * std::numbers::pi * SpectralWeights::kFirst);
    step_k = thickness * constant<S>(2 * std::numbers::pi * SpectralWeights::kStep);
    first_phase = film_phase(first_k, film.g2);
    step_phase = film_phase(step_k, film.g2);
  }

  // As plain numbers, and back without loss.
  static constexpr std::size_t kColumns = ThinFilm<S>::kColumns + 4;
  void to_columns(S* out) const {
    film.to_columns(out);
    const S all[]{first_k, first_phase, step_k, step_phase};
    for (std::size_t i = 0; i < 4; ++i) out[ThinFilm<S>::kColumns + i] = all[i];
  }
  static FilmSpectrum from_columns(const S* in) {
    FilmSpectrum spectrum;
    spectrum.film = ThinFilm<S>::from_columns(in);
    const S* rest = in + ThinFilm<S>::kColumns;
    spectrum.first_k = rest[0];
    spectrum.first_phase = rest[1];
    spectrum.step_k = rest[2];
    spectrum.step_phase = rest[3];
    return spectrum;
  }

  // Reflectance of each channel [1]; with weights below 0, as a gamut has them, it may leave [0, 1].
  Rgb<S> seen_with(const SpectralWeights& weights) const {
    Rgb<S> change;
    const S bare = for_each_wave_number([&](std::size_t i, const S& by) {
      const double* w = weights.weight[i];
      change = change + Rgb<S>(constant<S>(w[0]), constant<S>(w[1]), constant<S>(w[2])) * by;
    });
    return Rgb<S>(bare) + change;
  }

  // Reflectance of each channel, in [0, 1].
  Rgb<S> seen_with(const GaussianCamera<S>& camera) const {
    const auto peak = [](const S& nm) { return larger(smaller(nm, S(740)), S(380)); };
    const S per_width = S(1) / larger(camera.width, S(5));
    const Rgb<S> peaks(peak(camera.red), peak(camera.green), peak(camera.blue));
    Rgb<S> change, total;
    const S bare = for_each_wave_number([&](std::size_t i, const S& by) {
      const double nm = 1 / (SpectralWeights::kFirst + SpectralWeights::kStep * double(i));
      const auto weight = [&](const S& center) {
        const S t = (constant<S>(nm) - center) * per_width;
        return S(constant<S>(nm * nm / (560.0 * 560.0)) * exp(S(S(-0.5) * t * t)));
      };
      const Rgb<S> w(weight(peaks.r), weight(peaks.g), weight(peaks.b));
      change = change + w * by;
      total = total + w;
    });
    return {bare + change.r / total.r, bare + change.g / total.g, bare + change.b / total.b};
  }

 private:
  // Calls visit(i, what the film changes at wave number i); returns the bare boundary's reflectance.
  template <class F>
  S for_each_wave_number(F&& visit) const {
    const S bare = film.reflectance(FilmWave<S>{S(1), S(0)});
    FilmWave<S> step = film_wave(step_k, film.g2, step_phase);
    // Where it is evanescent, short steps grow too: by c + |g| s, which 512 of them must not.
    const S growth = pick(greater(S(0), film.g2), S(step.c + root_or_zero(S(-film.g2)) * step.s), S(1));
    step = {step.c / growth, step.s / growth};
    FilmWave<S> wave = film_wave(first_k, film.g2, first_phase);
    for (std::size_t i = 0; i < SpectralWeights::kCount; ++i) {
      visit(i, S(film.reflectance(wave) - bare));
      wave = wave.after(step, film.g2);
    }
    return bare;
  }
};

}  // namespace likeness::brdf
