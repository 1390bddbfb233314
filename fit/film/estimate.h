#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fit/film/readings.h"

// The thickness of the film of oil on tears from its reflectances.
namespace likeness::film {

// Air, a film of oil, tears. Indices as in Olsen 1985.
struct Eye {
  double film_index = 1.48, tear_index = 1.337;
  double incidence_deg = 20;  // between the light and the normal: half of what is between light and microscope

  // Unpolarised, at one wavelength and angle; brdf::thin_film.
  double reflectance(double thickness_nm, double wavelength_nm) const;
  // Head on, in linear Rec. 709 under D65; brdf::FilmSpectrum.
  std::array<double, 3> color(double thickness_nm) const;
};

struct Options {
  Eye eye;
  double most_nm = 200;  // thicknesses from 0 to this are tried
  double error = 0.05;   // relative standard error of one reading
  int resamples = 2000;  // of the bootstrap; 0: none
  std::uint64_t seed = 1;
};

struct Interval {
  double low = 0, high = 0;
};

// A thickness where the misfit has a minimum.
struct Candidate {
  double thickness_nm = 0, scale = 1, chi2 = 0;
};

// reading = scale x reflectance(thickness). chi2 is the misfit against the covariance of the readings, at the best scale
// for each thickness (the profile likelihood, -2 log up to a constant).
struct Estimate {
  std::vector<Candidate> candidates;         // within the 95 % region, the best first; never empty
  std::vector<Interval> region68, region95;  // of the thickness; several where interference is ambiguous
  std::vector<double> chi2;                  // on the grid: thickness i x kStepNm

  const Candidate& best() const { return candidates.front(); }
};
inline constexpr double kStepNm = 0.25;

struct Study {
  // Of the means, whose covariance is that of the subjects over their number; regions by Student's t.
  Estimate scaled;    // the scale is fitted: ratios of readings decide
  Estimate absolute;  // the scale is 1: readings are taken at their word
  // Subjects drawn with replacement, the means fitted again: percentiles 2.5, 16, 50, 84, 97.5 of the thickness.
  // NaN for fewer than three subjects.
  std::array<double, 5> scaled_bootstrap{}, absolute_bootstrap{};
  // Each subject by itself, with the error of one reading and the scale of the means.
  std::vector<Estimate> scaled_subjects, absolute_subjects;
};

Study study_of(const Readings& readings, const Options& options);

// t of a two-sided interval that holds `share` of Student's distribution; `freedom` of 1 or more.
double student_t(double share, int freedom);

// Luminance of the color above: its least and most over 0 to most_nm, and where it first reaches a value (NaN if never).
struct Range {
  double least = 0, most = 0, most_at_nm = 0;
};
double luminance(const std::array<double, 3>& rgb);
Range luminance_range(const Eye& eye, double most_nm);
double thickness_of_luminance(const Eye& eye, double value, double most_nm);

}  // namespace likeness::film
