#include "fit/film/estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/Dense>

#include "brdf/fresnel/thin_film.h"
#include "brdf/fresnel/thin_film_color.h"
#include "render/image/cie_lab.h"

namespace likeness::film {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// A spread below this share of the mean is taken for rounding of the table, not for knowledge.
constexpr double kLeastDeviation = 1e-3;

// The reflectances of the model on the grid of thicknesses: one column each.
Eigen::MatrixXd model_on_grid(const Readings& readings, const Options& options) {
  const auto count = static_cast<Eigen::Index>(std::lround(options.most_nm / kStepNm)) + 1;
  Eigen::MatrixXd grid(static_cast<Eigen::Index>(readings.wavelengths_nm.size()), count);
  for (Eigen::Index k = 0; k < count; ++k)
    for (Eigen::Index i = 0; i < grid.rows(); ++i)
      grid(i, k) = options.eye.reflectance(kStepNm * static_cast<double>(k),
                                           readings.wavelengths_nm[static_cast<std::size_t>(i)]);
  return grid;
}

// The inverse of the covariance of the means. The correlation between wavelengths is used where the subjects are enough
// to know it.
Eigen::MatrixXd precision_of_means(const Readings& readings, double error) {
  const auto wavelengths = static_cast<Eigen::Index>(readings.wavelengths_nm.size());
  const auto count = static_cast<double>(readings.subjects.size());
  const std::vector<double> mean = readings.mean();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(wavelengths, wavelengths);
  for (Eigen::Index i = 0; i < wavelengths; ++i)
    for (Eigen::Index j = 0; j < wavelengths; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      if (readings.subjects.size() < 2) {
        if (i == j) covariance(i, j) = std::pow(error * mean[a], 2);
        continue;
      }
      if (i != j && static_cast<Eigen::Index>(readings.subjects.size()) <= wavelengths + 1) continue;
      double sum = 0;
      for (const Subject& subject : readings.subjects)
        sum += (subject.reflectance[a] - mean[a]) * (subject.reflectance[b] - mean[b]);
      covariance(i, j) = sum / (count - 1) / count;
      if (i == j) covariance(i, j) += std::pow(kLeastDeviation * mean[a], 2);
    }
  return covariance.inverse();
}

Eigen::MatrixXd precision_of_one(const std::vector<double>& values, double error) {
  Eigen::VectorXd diagonal(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    diagonal[static_cast<Eigen::Index>(i)] = 1 / std::pow(error * values[i], 2);
  return diagonal.asDiagonal();
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Misfit and scale at every thickness of the grid. A scale that is given is held.
struct Profile {
  Eigen::VectorXd chi2, scale;
};
Profile profile_of(const Eigen::VectorXd& data, const Eigen::MatrixXd& precision, const Eigen::MatrixXd& grid,
                   const double* held) {
  const Eigen::VectorXd weighted = precision * data;
  const double of_data = data.dot(weighted);
  Profile profile{Eigen::VectorXd(grid.cols()), Eigen::VectorXd(grid.cols())};
  for (Eigen::Index k = 0; k < grid.cols(); ++k) {
    const double cross = grid.col(k).dot(weighted), own = grid.col(k).dot(precision * grid.col(k));
    const double scale = held != nullptr ? *held : std::max(0.0, cross / own);
    profile.scale[k] = scale;
    profile.chi2[k] = std::max(0.0, of_data - 2 * scale * cross + scale * scale * own);
  }
  return profile;
}

// Where chi2 is at most `limit`, between grid points by straight lines.
std::vector<Interval> region_of(const Eigen::VectorXd& chi2, double limit) {
  std::vector<Interval> out;
  bool is_inside = false;
  const auto crossing = [&](Eigen::Index k) {  // between k - 1 and k
    return kStepNm * (static_cast<double>(k - 1) + (limit - chi2[k - 1]) / (chi2[k] - chi2[k - 1]));
  };
  for (Eigen::Index k = 0; k < chi2.size(); ++k) {
    const bool now = chi2[k] <= limit;
    if (now && !is_inside) out.push_back({k == 0 ? 0 : crossing(k), 0});
    if (!now && is_inside) out.back().high = crossing(k);
    is_inside = now;
  }
  if (is_inside) out.back().high = kStepNm * static_cast<double>(chi2.size() - 1);
  return out;
}

// The vertex of the parabola through a minimum of the grid and its neighbours.
Candidate minimum_at(const Profile& profile, Eigen::Index k) {
  Candidate at{kStepNm * static_cast<double>(k), profile.scale[k], profile.chi2[k]};
  if (k == 0 || k + 1 == profile.chi2.size()) return at;
  const double before = profile.chi2[k - 1], after = profile.chi2[k + 1], bend = before - 2 * at.chi2 + after;
  if (!(bend > 0)) return at;
  const double shift = std::clamp(0.5 * (before - after) / bend, -0.5, 0.5);
  at.thickness_nm += kStepNm * shift;
  at.scale += 0.5 * shift * (profile.scale[k + 1] - profile.scale[k - 1]);
  at.chi2 = std::max(0.0, at.chi2 - 0.25 * (before - after) * shift);
  return at;
}

// How far chi2 may rise above its least within a region of the given share. The covariance is known from `subjects` only,
// which C. R. Rao, "Some problems involving linear hypotheses in multivariate analysis", Biometrika 46, 1959, accounts for:
// of its degrees of freedom, one is lost for each wavelength that no parameter takes. 0 subjects: it is known.
double rise_of(double share, int subjects, int wavelengths, int parameters, double least) {
  if (subjects < 2) return share > 0.9 ? 3.841 : 1;
  const int whole = subjects - 1, freedom = std::max(1, whole - std::max(0, wavelengths - parameters));
  return std::pow(student_t(share, freedom), 2) * whole / freedom * (1 + least / whole);
}

Estimate estimate_of(const Profile& profile, int subjects, int wavelengths, int parameters) {
  const Eigen::VectorXd& chi2 = profile.chi2;
  const double least = chi2.minCoeff();
  const double limit68 = rise_of(0.6827, subjects, wavelengths, parameters, least);
  const double limit95 = rise_of(0.95, subjects, wavelengths, parameters, least);
  Estimate out;
  out.chi2.assign(chi2.begin(), chi2.end());
  for (Eigen::Index k = 0; k < chi2.size(); ++k) {
    const bool below_left = k == 0 || chi2[k] < chi2[k - 1],
               below_right = k + 1 == chi2.size() || chi2[k] <= chi2[k + 1];
    if (below_left && below_right && chi2[k] <= least + limit95) out.candidates.push_back(minimum_at(profile, k));
  }
  std::stable_sort(out.candidates.begin(), out.candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.chi2 < b.chi2; });
  out.region68 = region_of(chi2, least + limit68);
  out.region95 = region_of(chi2, least + limit95);
  return out;
}

std::array<double, 5> bootstrap(const Readings& readings, const Options& options, const Eigen::MatrixXd& precision,
                                const Eigen::MatrixXd& grid, const double* held) {
  std::array<double, 5> out;
  out.fill(kNan);
  if (readings.subjects.size() < 3 || options.resamples < 1) return out;
  std::mt19937_64 engine(options.seed);
  const std::size_t count = readings.subjects.size();
  std::vector<double> found;
  for (int r = 0; r < options.resamples; ++r) {
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(grid.rows());
    for (std::size_t i = 0; i < count; ++i)
      mean += vector_of(readings.subjects[engine() % count].reflectance) / static_cast<double>(count);
    const Profile profile = profile_of(mean, precision, grid, held);
    Eigen::Index at = 0;
    profile.chi2.minCoeff(&at);
    found.push_back(minimum_at(profile, at).thickness_nm);
  }
  std::sort(found.begin(), found.end());
  constexpr std::array<double, 5> kShares{0.025, 0.16, 0.5, 0.84, 0.975};
  for (std::size_t i = 0; i < kShares.size(); ++i)
    out[i] = found[static_cast<std::size_t>(kShares[i] * static_cast<double>(found.size() - 1) + 0.5)];
  return out;
}

}  // namespace

double Eye::reflectance(double thickness_nm, double wavelength_nm) const {
  const double cosine = std::cos(incidence_deg * std::numbers::pi / 180);
  return brdf::thin_film(cosine, 1.0, film_index, tear_index, thickness_nm, wavelength_nm);
}

std::array<double, 3> Eye::color(double thickness_nm) const {
  static const brdf::SpectralWeights kWeights = brdf::rec709_under_d65();
  const brdf::ThinFilm<double> film(1.0, 1.0, film_index, tear_index);
  const brdf::Rgb<double> rgb = brdf::FilmSpectrum<double>(film, thickness_nm).seen_with(kWeights);
  return {rgb.r, rgb.g, rgb.b};
}

double student_t(double share, int freedom) {
  // With t = sqrt(freedom) tan(angle) the density is cos^(freedom - 1) of the angle: midpoints, 1e-6 of the whole.
  constexpr int kSteps = 20000;
  const auto density = [&](int i) {
    return std::pow(std::cos((i + 0.5) * 0.5 * std::numbers::pi / kSteps), freedom - 1);
  };
  double whole = 0, sum = 0;
  for (int i = 0; i < kSteps; ++i) whole += density(i);
  for (int i = 0; i < kSteps; ++i) {
    const double next = sum + density(i) / whole;
    if (next >= share)
      return std::sqrt(freedom) * std::tan((i + (share - sum) / (next - sum)) * 0.5 * std::numbers::pi / kSteps);
    sum = next;
  }
  return std::numeric_limits<double>::infinity();
}

Study study_of(const Readings& readings, const Options& options) {
  const Eigen::MatrixXd grid = model_on_grid(readings, options);
  const Eigen::MatrixXd precision = precision_of_means(readings, options.error);
  const Eigen::VectorXd mean = vector_of(readings.mean());
  const int subjects = static_cast<int>(readings.subjects.size()), wavelengths = static_cast<int>(grid.rows());
  const double one = 1;
  Study study;
  study.scaled = estimate_of(profile_of(mean, precision, grid, nullptr), subjects, wavelengths, 2);
  study.absolute = estimate_of(profile_of(mean, precision, grid, &one), subjects, wavelengths, 1);
  study.scaled_bootstrap = bootstrap(readings, options, precision, grid, nullptr);
  study.absolute_bootstrap = bootstrap(readings, options, precision, grid, &one);
  const double scale = study.scaled.best().scale;
  for (const Subject& subject : readings.subjects) {
    const Eigen::VectorXd own = vector_of(subject.reflectance);
    const Eigen::MatrixXd certain = precision_of_one(subject.reflectance, options.error);
    study.scaled_subjects.push_back(estimate_of(profile_of(own, certain, grid, &scale), 0, wavelengths, 1));
    study.absolute_subjects.push_back(estimate_of(profile_of(own, certain, grid, &one), 0, wavelengths, 1));
  }
  return study;
}

double luminance(const std::array<double, 3>& rgb) { return image::xyz_of_rec709(rgb)[1]; }

Range luminance_range(const Eye& eye, double most_nm) {
  Range range{1, 0, 0};
  for (int k = 0; k * kStepNm <= most_nm; ++k) {
    const double y = luminance(eye.color(k * kStepNm));
    range.least = std::min(range.least, y);
    if (y > range.most) range.most = y, range.most_at_nm = k * kStepNm;
  }
  return range;
}

double thickness_of_luminance(const Eye& eye, double value, double most_nm) {
  double before = luminance(eye.color(0));
  for (int k = 1; k * kStepNm <= most_nm; ++k) {
    const double y = luminance(eye.color(k * kStepNm));
    if ((before - value) * (y - value) <= 0 && before != y) return kStepNm * (k - 1 + (value - before) / (y - before));
    before = y;
  }
  return kNan;
}

}  // namespace likeness::film
