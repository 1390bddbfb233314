#include "render/cost/time_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/cost/statistics.h"

namespace likeness::scene_cost {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The setting on whose level the cost of a pass for a point depends.
std::size_t setting_of(std::string_view pass) {
  for (std::size_t i = 0; i < kSettingCount; ++i)
    if (runtime::kSettings[i].pass == pass) return i;
  return kSettingCount;
}

// Rays for each point at a level; 0 where there are none to count (maps).
double rays_of(std::size_t setting, std::size_t level) { return runtime::kSettings[setting].work(level); }

double points_of(const Levels& levels) { return rays_of(kPixelSamples, levels[kPixelSamples]); }

// Fills levels above those that were measured.
void extend(std::size_t setting, std::vector<double>& ms) {
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < ms.size(); ++i)
    if (!std::isnan(ms[i]) && rays_of(setting, i) > 0) known.push_back(i);
  if (known.empty()) return;
  const std::size_t last = known.back(), before = known.size() > 1 ? known[known.size() - 2] : last;
  const double x1 = rays_of(setting, last), y1 = ms[last];
  double slope = y1 / x1;
  if (before != last) slope = std::max(0.0, (y1 - ms[before]) / (x1 - rays_of(setting, before)));
  for (std::size_t i = 0; i < ms.size(); ++i)
    if (std::isnan(ms[i]) && rays_of(setting, i) > 0) ms[i] = std::max(y1 + slope * (rays_of(setting, i) - x1), 0.0);
}

}  // namespace

runtime::Settings settings_of(const Levels& levels) {
  runtime::Settings settings;
  for (std::size_t i = 0; i < kSettingCount; ++i) runtime::kSettings[i].apply(settings, levels[i]);
  return settings;
}

TimeModel::TimeModel(std::span<const FrameTimes> frames) {
  std::vector<double> rest;
  for (const FrameTimes& f : frames) {
    double passes = 0;
    for (const FrameTimes::Pass& pass : f.passes) {
      passes += pass.ms;
      if (std::none_of(parts_.begin(), parts_.end(), [&](const Part& p) { return p.pass == pass.name; }))
        parts_.push_back({pass.name, setting_of(pass.name), {}, {}});
    }
    rest.push_back(f.whole - passes);
  }
  if (!rest.empty()) frame_ = std::max(0.0, median(rest));
  for (Part& part : parts_) {
    const bool varies = part.setting < kSettingCount;
    for (const bool is_alone : {false, true}) {
      std::vector<std::vector<double>> readings(varies ? runtime::kSettings[part.setting].levels.size() : 1);
      for (const FrameTimes& f : frames)
        for (const FrameTimes::Pass& pass : f.passes)
          if (pass.name == part.pass && (points_of(f.levels) == 1) == is_alone)
            readings[varies ? f.levels[part.setting] : 0].push_back(pass.ms / points_of(f.levels));
      for (const auto& r : readings) (is_alone ? part.ms_alone : part.ms).push_back(r.empty() ? kNone : median(r));
    }
    for (std::size_t i = 0; i < part.ms.size(); ++i) {
      if (std::isnan(part.ms[i])) part.ms[i] = part.ms_alone[i];
      if (std::isnan(part.ms_alone[i])) part.ms_alone[i] = part.ms[i];
    }
    if (varies) extend(part.setting, part.ms), extend(part.setting, part.ms_alone);
  }
}

double TimeModel::predict(const Levels& levels) const {
  double ms = 0;
  for (const Part& part : parts_)
    ms += (points_of(levels) == 1 ? part.ms_alone : part.ms)[part.setting < kSettingCount ? levels[part.setting] : 0];
  return frame_ + points_of(levels) * ms;
}

std::vector<double> fit_non_negative(const std::vector<std::vector<double>>& rows, const std::vector<double>& values) {
  const std::size_t columns = rows.empty() ? 0 : rows.front().size();
  std::vector<double> x(columns, 0);
  std::vector<double> residual(rows.size(), 1);  // value / value - sum
  constexpr int kSweeps = 20000;                 // of coordinates: five of them, a dozen rows
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double moved = 0;
    for (std::size_t j = 0; j < columns; ++j) {
      double along = 0, square = 0;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const double a = rows[i][j] / values[i];
        along += a * residual[i], square += a * a;
      }
      if (!(square > 0)) continue;
      const double next = std::max(0.0, x[j] + along / square), step = next - x[j];
      for (std::size_t i = 0; i < rows.size(); ++i) residual[i] -= step * rows[i][j] / values[i];
      x[j] = next;
      moved = std::max(moved, std::abs(step) * std::sqrt(square));
    }
    if (moved < 1e-12) break;
  }
  return x;
}

namespace {

std::vector<double> error_terms(const Levels& levels) {
  const double points = points_of(levels);
  std::vector<double> terms{1, 1 / points};
  for (std::size_t i = 0; i < kSettingCount; ++i) {
    if (i == kPixelSamples) continue;
    const std::size_t count = runtime::kSettings[i].levels.size();
    for (std::size_t level = 0; level + 1 < count; ++level)
      if (rays_of(i, level) == 0) terms.push_back(levels[i] == level ? 1 : 0);
    if (rays_of(i, count - 1) > 0) {
      const double rays = rays_of(i, levels[i]);
      terms.push_back(rays > 0 ? 1 / (points * rays) : 0);
    }
  }
  return terms;
}

}  // namespace

ErrorModel::ErrorModel(std::span<const Measured> measured) {
  std::vector<std::vector<double>> rows;
  std::vector<double> values;
  for (const Measured& m : measured)
    if (m.relmse > 0) rows.push_back(error_terms(m.levels)), values.push_back(m.relmse);
  factors_ = fit_non_negative(rows, values);
  factors_.resize(error_terms({}).size(), 0);
}

double ErrorModel::predict(const Levels& levels) const {
  const std::vector<double> terms = error_terms(levels);
  double sum = 0;
  for (std::size_t j = 0; j < terms.size(); ++j) sum += terms[j] * factors_[j];
  return sum;
}

}  // namespace likeness::scene_cost
