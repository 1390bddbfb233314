#include "render/blood/palette_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include <Eigen/Dense>

#include "render/image/color_difference.h"
#include "render/image/tone_curve.h"

namespace likeness::blood {
namespace {

using Palette = brdf::BloodPalette<double>;

constexpr std::size_t kCoefficients = Palette::kAcross * Palette::kAlong;
// Added to light before logarithms, so that black cells weigh little: below what an 8-bit photograph tells from black.
constexpr double kDarkest = 4e-3;

const brdf::HaemoglobinWeights& weights() {
  static const brdf::HaemoglobinWeights kWeights;
  return kWeights;
}

// A parameter without bounds: the logit of where it is within its range, by logarithms where that spans decades.
bool spans_decades(const brdf::Parameter& row) { return row.range.low > 0; }
double coordinate_of(std::size_t i, double value) {
  const brdf::Parameter& row = Palette::kParameters[i];
  const double share = spans_decades(row) ? std::log(value / row.range.low) / std::log(row.range.high / row.range.low)
                                          : (value - row.range.low) / (row.range.high - row.range.low);
  const double inside = std::clamp(share, 1e-6, 1 - 1e-6);
  return std::log(inside / (1 - inside));
}
double value_of(std::size_t i, double coordinate) {
  const brdf::Parameter& row = Palette::kParameters[i];
  const double share = 1 / (1 + std::exp(-coordinate));
  return spans_decades(row) ? row.range.low * std::pow(row.range.high / row.range.low, share)
                            : row.range.low + share * (row.range.high - row.range.low);
}

Eigen::VectorXd rest_of(const std::vector<Cell>& cells, const Eigen::VectorXd& at) {
  Palette palette;
  for (std::size_t i = 0; i < Palette::kCount; ++i) palette.value[i] = value_of(i, at[static_cast<Eigen::Index>(i)]);
  Eigen::VectorXd rest(static_cast<Eigen::Index>(3 * cells.size() + Palette::kCount));
  Eigen::Index k = 0;
  for (const Cell& cell : cells) {
    const brdf::Rgb<double> rgb = palette.spectral(weights(), cell.opacity, cell.time);
    const std::array<double, 3> model{rgb.r, rgb.g, rgb.b};
    for (std::size_t c = 0; c < 3; ++c)
      rest[k++] = image::srgb_encode(std::max(0.0, model[c])) - image::srgb_encode(cell.rgb[c]);
  }
  // What the table does not tell stays near its default.
  for (std::size_t i = 0; i < Palette::kCount; ++i)
    rest[k++] = 1e-3 * (at[static_cast<Eigen::Index>(i)] - coordinate_of(i, Palette::kParameters[i].initial));
  return rest;
}

// Levenberg and Marquardt with differences: nine unknowns.
Palette fit_spectra(const std::vector<Cell>& cells) {
  constexpr auto kUnknowns = static_cast<Eigen::Index>(Palette::kCount);
  Eigen::VectorXd at(kUnknowns);
  for (Eigen::Index i = 0; i < kUnknowns; ++i)
    at[i] = coordinate_of(static_cast<std::size_t>(i), Palette::kParameters[static_cast<std::size_t>(i)].initial);
  Eigen::VectorXd rest = rest_of(cells, at);
  double damping = 1e-2;
  for (int step = 0; step < 200 && damping < 1e12; ++step) {
    Eigen::MatrixXd jacobian(rest.size(), kUnknowns);
    for (Eigen::Index i = 0; i < kUnknowns; ++i) {
      Eigen::VectorXd low = at, high = at;
      low[i] -= 1e-5, high[i] += 1e-5;
      jacobian.col(i) = (rest_of(cells, high) - rest_of(cells, low)) / 2e-5;
    }
    const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    const Eigen::VectorXd slope = jacobian.transpose() * rest;
    bool is_better = false;
    while (!is_better && damping < 1e12) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() += damping * (normal.diagonal().array() + 1e-9).matrix();
      const Eigen::VectorXd next = (at - damped.ldlt().solve(slope)).cwiseMax(-13).cwiseMin(13);
      const Eigen::VectorXd then = rest_of(cells, next);
      is_better = then.squaredNorm() < rest.squaredNorm();
      damping *= is_better ? 0.3 : 4;
      if (!is_better) continue;
      const double gain = 1 - then.squaredNorm() / rest.squaredNorm();
      at = next, rest = then;
      if (gain < 1e-10) damping = 1e12;
    }
  }
  Palette palette;
  for (std::size_t i = 0; i < Palette::kCount; ++i) palette.value[i] = value_of(i, at[static_cast<Eigen::Index>(i)]);
  palette.longest = 60;
  for (const Cell& cell : cells) palette.longest = std::max(palette.longest, cell.time);
  return palette;
}

// The spline's basis at each cell: one row each.
Eigen::MatrixXd basis_of(const Palette& palette, const std::vector<Cell>& cells) {
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(cells.size()), static_cast<Eigen::Index>(kCoefficients));
  for (std::size_t k = 0; k < cells.size(); ++k) {
    std::size_t across = 0, along = 0;
    const auto x = Palette::basis(cells[k].opacity, Palette::kAcross, across);
    const auto y = Palette::basis(palette.time_coordinate(cells[k].time), Palette::kAlong, along);
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i)
        out(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>((along + j) * Palette::kAcross + across + i)) =
            x[i] * y[j];
  }
  return out;
}

// The squares of second differences along both coordinates, and a little of the values themselves.
Eigen::MatrixXd roughness() {
  const auto n = static_cast<Eigen::Index>(kCoefficients);
  Eigen::MatrixXd out = 0.01 * Eigen::MatrixXd::Identity(n, n);
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(n);
    row[static_cast<Eigen::Index>(a)] = row[static_cast<Eigen::Index>(c)] = 1, row[static_cast<Eigen::Index>(b)] = -2;
    out += row * row.transpose();
  };
  for (std::size_t j = 0; j < Palette::kAlong; ++j)
    for (std::size_t i = 0; i + 2 < Palette::kAcross; ++i)
      add(j * Palette::kAcross + i, j * Palette::kAcross + i + 1, j * Palette::kAcross + i + 2);
  for (std::size_t j = 0; j + 2 < Palette::kAlong; ++j)
    for (std::size_t i = 0; i < Palette::kAcross; ++i)
      add(j * Palette::kAcross + i, (j + 1) * Palette::kAcross + i, (j + 2) * Palette::kAcross + i);
  return out;
}

// Gives the palette the spline whose error of cells left out is least; returns its smoothness.
double fit_spline(Palette& palette, const std::vector<Cell>& cells) {
  const Eigen::MatrixXd basis = basis_of(palette, cells), rough = roughness();
  Eigen::MatrixXd data(static_cast<Eigen::Index>(cells.size()), 3);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const brdf::Rgb<double> rgb = palette.spectral(weights(), cells[k].opacity, cells[k].time);
    const std::array<double, 3> model{rgb.r, rgb.g, rgb.b};
    for (std::size_t c = 0; c < 3; ++c)
      data(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) =
          std::log((cells[k].rgb[c] + kDarkest) / (std::max(0.0, model[c]) + kDarkest));
  }
  double least = data.squaredNorm(), best = std::numeric_limits<double>::infinity();
  Eigen::MatrixXd chosen = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(kCoefficients), 3);
  for (double smoothness = 1e-4; smoothness < 1e5; smoothness *= 2) {
    const Eigen::MatrixXd inverse = (basis.transpose() * basis + smoothness * rough).inverse();
    const Eigen::MatrixXd coefficients = inverse * basis.transpose() * data;
    const Eigen::VectorXd leverage = (basis * inverse * basis.transpose()).diagonal();
    const Eigen::MatrixXd rest = data - basis * coefficients;
    double error = 0;
    for (Eigen::Index k = 0; k < rest.rows(); ++k)
      error += rest.row(k).squaredNorm() / std::pow(std::max(1e-6, 1 - leverage[k]), 2);
    if (error < least) least = error, best = smoothness, chosen = coefficients;
  }
  for (std::size_t i = 0; i < kCoefficients; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      palette.spline[i][c] = chosen(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c));
  return best;
}

std::vector<double> differences(const Palette& palette, const std::vector<Cell>& cells) {
  std::vector<double> out;
  for (const Cell& cell : cells) out.push_back(difference(color_of(palette, cell.opacity, cell.time), cell.rgb));
  return out;
}

}  // namespace

std::array<double, 3> color_of(const Palette& palette, double opacity, double time) {
  const brdf::Rgb<double> rgb = palette.color(weights(), opacity, time);
  return {rgb.r, rgb.g, rgb.b};
}

double difference(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return image::delta_e_2000(image::lab_of_rec709(a), image::lab_of_rec709(b));
}

PaletteFit fit_palette(const Table& table) {
  std::set<double> opacities, times;
  for (const Cell& cell : table.cells) opacities.insert(cell.opacity), times.insert(cell.time);
  if (table.cells.size() < 12 || opacities.size() < 2 || times.size() < 2)
    throw std::invalid_argument("has " + std::to_string(table.cells.size()) + " cells at " +
                                std::to_string(opacities.size()) + " opacities and " + std::to_string(times.size()) +
                                " times; 12, 2 and 2 are needed");
  PaletteFit fit;
  fit.palette = fit_spectra(table.cells);
  fit.spectral = differences(fit.palette, table.cells);
  fit.smoothness = fit_spline(fit.palette, table.cells);
  fit.fitted = differences(fit.palette, table.cells);
  constexpr std::size_t kFifths = 5;
  fit.held_out.resize(table.cells.size());
  for (std::size_t fold = 0; fold < kFifths; ++fold) {
    std::vector<Cell> others;
    for (std::size_t k = 0; k < table.cells.size(); ++k)
      if (k % kFifths != fold) others.push_back(table.cells[k]);
    Palette palette = fit_spectra(others);
    palette.longest = fit.palette.longest;
    fit_spline(palette, others);
    const std::vector<double> all = differences(palette, table.cells);
    for (std::size_t k = fold; k < all.size(); k += kFifths) fit.held_out[k] = all[k];
  }
  return fit;
}

image::Picture picture_of(const Palette& palette, int width, int height) {
  image::Picture out(width, height);
  for (int y = 0; y < height; ++y) {
    const double time = 60 * std::expm1((y + 0.5) / height * std::log1p(palette.longest / 60));
    for (int x = 0; x < width; ++x) {
      const std::array<double, 3> rgb = color_of(palette, (x + 0.5) / width, time);
      for (std::size_t c = 0; c < 3; ++c) out.at(x, y)[c] = static_cast<float>(rgb[c]);
    }
  }
  return out;
}

}  // namespace likeness::blood
