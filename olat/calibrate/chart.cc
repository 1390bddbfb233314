#include "olat/calibrate/chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>

#include "olat/calibrate/perspective.h"
#include "olat/metric/formulas.h"
#include "render/files/files.h"

namespace likeness::olat_calibrate {
namespace {

using PatchColors = std::array<std::array<double, 3>, kPatches>;
using Eigen::Matrix3d;
using Eigen::Vector3d;

const Vector3d kD50(0.9642957, 1, 0.8251046);  // ASTM E308, 2 degrees, as ICC profiles have it

// Cone responses of Bradford (Lam 1985), in which white balance multiplies.
const Matrix3d kBradford =
    (Matrix3d() << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296).finished();

Matrix3d xyz_of_rec709() {
  Matrix3d m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = image::kXyzOfRec709[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return m;
}

Matrix3d adapted(const Vector3d& from_white, const Vector3d& to_white) {
  const Vector3d gain = (kBradford * to_white).cwiseQuotient(kBradford * from_white);
  return kBradford.inverse() * gain.asDiagonal() * kBradford;
}

// Linear Rec. 709 to XYZ under D50, where the reference is.
const Matrix3d& to_d50() {
  static const Matrix3d matrix = adapted(xyz_of_rec709() * Vector3d::Ones(), kD50) * xyz_of_rec709();
  return matrix;
}

image::Lab lab_of(const Vector3d& xyz) {
  return image::lab_of_xyz({xyz[0], xyz[1], xyz[2]}, {kD50[0], kD50[1], kD50[2]});
}

Vector3d xyz_of(const image::Lab& lab) {
  const auto inverse = [](double f) {
    constexpr double kDelta = 6.0 / 29;
    return f > kDelta ? f * f * f : 3 * kDelta * kDelta * (f - 4.0 / 29);
  };
  const double y = (lab.l + 16) / 116;
  return {kD50[0] * inverse(y + lab.a / 500), kD50[1] * inverse(y), kD50[2] * inverse(y - lab.b / 200)};
}

Vector3d vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

std::array<double, kPatches> errors(const Matrix3d& matrix, const PatchColors& patches, const Reference& reference) {
  std::array<double, kPatches> out{};
  for (std::size_t i = 0; i < kPatches; ++i)
    out[i] = metric::delta_e_2000(lab_of(to_d50() * matrix * vector(patches[i])), reference.lab[i]);
  return out;
}

// The matrix with the least sum of fourth powers of Delta E, from `start`: Levenberg's steps on squared errors with
// slopes by differences (24 residuals, 9 unknowns).
Matrix3d refined(const Matrix3d& start, const PatchColors& patches, const Reference& reference) {
  using Residuals = Eigen::Matrix<double, kPatches, 1>;
  const auto residuals = [&](const Matrix3d& m) {
    const auto e = errors(m, patches, reference);
    Residuals r;
    for (std::size_t i = 0; i < kPatches; ++i) r[static_cast<int>(i)] = e[i] * e[i];
    return r;
  };
  Matrix3d best = start;
  Residuals now = residuals(best);
  double damping = 1e-2;
  for (int step = 0; step < 200 && damping < 1e8; ++step) {
    Eigen::Matrix<double, kPatches, 9> slopes;
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 9; ++k) {
      Matrix3d up = best, down = best;
      up(k / 3, k % 3) += kStep;
      down(k / 3, k % 3) -= kStep;
      slopes.col(k) = (residuals(up) - residuals(down)) / (2 * kStep);
    }
    Eigen::Matrix<double, 9, 9> normal = slopes.transpose() * slopes;
    normal.diagonal() *= 1 + damping;
    normal.diagonal().array() += 1e-12;
    const Eigen::Matrix<double, 9, 1> delta = normal.ldlt().solve(-slopes.transpose() * now);
    Matrix3d next = best;
    for (int k = 0; k < 9; ++k) next(k / 3, k % 3) += delta[k];
    const Residuals there = residuals(next);
    if (there.squaredNorm() < now.squaredNorm()) {
      const double gained = now.squaredNorm() - there.squaredNorm();
      best = next, now = there, damping = std::max(1e-9, damping / 10);
      if (gained < 1e-12 * now.squaredNorm()) break;
    } else {
      damping *= 10;
    }
  }
  return best;
}

glm::dmat3 glm_of(const Matrix3d& m) {
  glm::dmat3 out;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[j][i] = m(i, j);
  return out;
}

}  // namespace

Reference reference_of(std::string_view text, const std::string& name) {
  PatchColors values{};
  std::array<bool, kPatches> found{};
  bool is_xyy = true;
  std::size_t line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string row(text.substr(at, end - at));
    at = end + 1;
    ++line;
    if (!row.empty() && row.back() == '\r') row.pop_back();
    if (row.empty() || row[0] == '#' || (line == 1 && row.starts_with("patch"))) continue;
    const std::string place = name + ":" + std::to_string(line) + ": ";
    int patch = 0, used = 0;
    std::array<double, 3> v{};
    if (std::sscanf(row.c_str(), "%d,%lf,%lf,%lf%n", &patch, &v[0], &v[1], &v[2], &used) != 4 ||
        used != static_cast<int>(row.size()) || !std::isfinite(v[0] + v[1] + v[2]))
      throw files::InputError(place + files::in_quotes(row) + " is no row of patch,c0,c1,c2");
    if (patch < 1 || patch > static_cast<int>(kPatches) || found[static_cast<std::size_t>(patch - 1)])
      throw files::InputError(place + "patch " + std::to_string(patch) + " is outside 1 to 24, or there twice");
    found[static_cast<std::size_t>(patch - 1)] = true;
    values[static_cast<std::size_t>(patch - 1)] = v;
    is_xyy = is_xyy && v[0] > 0 && v[1] > 0 && v[0] + v[1] <= 1 && v[2] >= 0 && v[2] <= 1;
  }
  for (std::size_t i = 0; i < kPatches; ++i)
    if (!found[i]) throw files::InputError(name + ": patch " + std::to_string(i + 1) + " of 24 is missing");
  Reference out;
  out.space = is_xyy ? "xyY" : "Lab";
  for (std::size_t i = 0; i < kPatches; ++i) {
    const auto& [a, b, c] = values[i];
    out.lab[i] = is_xyy ? lab_of({a / b * c, c, (1 - a - b) / b * c}) : image::Lab{a, b, c};
    if (!(out.lab[i].l >= 0 && out.lab[i].l <= 110))
      throw files::InputError(name + ": patch " + std::to_string(i + 1) +
                              " has L* = " + files::number_text(out.lab[i].l) + ", outside 0 to 110");
  }
  return out;
}

Reference read_reference(const std::filesystem::path& file) {
  return reference_of(files::read_whole(file, 1 << 20), file.string());
}

PatchColors patches_of(const image::Picture& photo, const Corners& corners) {
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &p = corners[i], &q = corners[(i + 1) % 4], &r = corners[(i + 2) % 4];
    const double turn = (q[0] - p[0]) * (r[1] - q[1]) - (q[1] - p[1]) * (r[0] - q[0]);
    const bool inside = p[0] >= 0 && p[1] >= 0 && p[0] <= photo.width && p[1] <= photo.height;
    if (!inside)
      throw files::UsageError("corner " + files::number_text(p[0]) + "," + files::number_text(p[1]) +
                              " lies outside the picture of " + std::to_string(photo.width) + " x " +
                              std::to_string(photo.height));
    if (!(turn > 1))
      throw files::UsageError(
          "the corners must go round the chart clockwise, from that of patch 1 (dark skin) over those of 6 (bluish "
          "green) "
          "and 24 (black) to that of 19 (white)");
  }
  const std::array<Point, 4> cells{{{0, 0}, {kPatchColumns, 0}, {kPatchColumns, kPatchRows}, {0, kPatchRows}}};
  const Perspective seen = perspective_of(cells, corners);
  PatchColors out{};
  constexpr int kSamples = 24;
  constexpr double kMiddle = 0.4;  // of a cell, a side: frames and shadows of frames stay out
  for (std::size_t patch = 0; patch < kPatches; ++patch) {
    std::array<std::vector<double>, 3> values;
    for (int j = 0; j < kSamples; ++j)
      for (int i = 0; i < kSamples; ++i) {
        const double x = static_cast<double>(patch % kPatchColumns) + 0.5 + kMiddle * ((i + 0.5) / kSamples - 0.5);
        const double y = static_cast<double>(patch / kPatchColumns) + 0.5 + kMiddle * ((j + 0.5) / kSamples - 0.5);
        const auto [u, v] = seen(x, y);
        const int px = std::clamp(static_cast<int>(u), 0, photo.width - 1);
        const int py = std::clamp(static_cast<int>(v), 0, photo.height - 1);
        for (std::size_t c = 0; c < 3; ++c) values[c].push_back(static_cast<double>(photo.at(px, py)[c]));
      }
    for (std::size_t c = 0; c < 3; ++c) {
      const auto middle = values[c].begin() + kSamples * kSamples / 2;
      std::nth_element(values[c].begin(), middle, values[c].end());
      out[patch][c] = *middle;
    }
  }
  return out;
}

ChartFit fit_chart(const PatchColors& patches, const Reference& reference) {
  ChartFit fit;
  // One exposure, by the luminance of the greys but the last, which flare lifts.
  double seen = 0, known = 0;
  for (std::size_t i = kFirstGrey; i + 1 < kPatches; ++i) {
    const double y = (to_d50() * vector(patches[i]))[1], truth = xyz_of(reference.lab[i])[1];
    seen += y * y;
    known += y * truth;
  }
  if (!(seen > 0 && known > 0)) throw files::UsageError("the grey patches are black; are these the chart's corners?");
  const double exposure = known / seen;
  fit.exposure_ev = std::log2(exposure);
  PatchColors exposed = patches;
  for (auto& color : exposed)
    for (double& v : color) v *= exposure;

  Vector3d grey = Vector3d::Zero(), truth = Vector3d::Zero();
  for (std::size_t i = kFirstGrey; i + 1 < kPatches; ++i) {
    grey += to_d50() * vector(exposed[i]);
    truth += xyz_of(reference.lab[i]);
  }
  if (!((kBradford * grey).minCoeff() > 0))
    throw files::UsageError("the grey patches have a channel without light; are these the chart's corners?");
  const Matrix3d balance = to_d50().inverse() * adapted(grey, truth) * to_d50();
  // Least squares in light, each patch by its own luminance, is where the refinement begins; or the balance, if that is
  // better.
  Eigen::Matrix<double, kPatches, 3> in, out;
  for (std::size_t i = 0; i < kPatches; ++i) {
    const Vector3d xyz = xyz_of(reference.lab[i]);
    const double weight = 1 / std::cbrt(xyz[1] * xyz[1] + 1e-4);
    in.row(static_cast<int>(i)) = weight * vector(exposed[i]).transpose();
    out.row(static_cast<int>(i)) = weight * (to_d50().inverse() * xyz).transpose();
  }
  const Matrix3d linear = in.colPivHouseholderQr().solve(out).transpose();
  const auto fourth = [&](const Matrix3d& m) {
    double sum = 0;
    for (const double e : errors(m, exposed, reference)) sum += e * e * e * e;
    return sum;
  };
  const Matrix3d a = refined(linear, exposed, reference), b = refined(balance, exposed, reference);
  const Matrix3d matrix = fourth(a) < fourth(b) ? a : b;
  fit.balance = glm_of(balance);
  fit.matrix = glm_of(matrix);
  const std::array<Matrix3d, 3> steps{Matrix3d::Identity(), balance, matrix};
  for (std::size_t k = 0; k < 3; ++k) {
    fit.delta_e[k] = errors(steps[k], exposed, reference);
    Stage& stage = fit.stages[k];
    for (std::size_t i = 0; i < kPatches; ++i) {
      stage.mean += fit.delta_e[k][i] / kPatches;
      if (fit.delta_e[k][i] > stage.largest) stage.largest = fit.delta_e[k][i], stage.worst = i;
    }
  }
  return fit;
}

}  // namespace likeness::olat_calibrate
