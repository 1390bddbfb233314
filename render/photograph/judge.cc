#include "render/photograph/judge.h"

#include <algorithm>
#include <cmath>

namespace likeness::photograph {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kLeastNoise = 0.01;  // [stops]

double median_of(std::vector<double>& values) {
  if (values.empty()) return kNaN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

double log2_luminance(const std::array<double, 3>& logs, const std::array<double, 3>& worths, double log2_time) {
  for (const double worth : worths)
    if (!(worth >= kComparedHat)) return kNaN;
  return std::log2(0.2126 * std::exp2(logs[0]) + 0.7152 * std::exp2(logs[1]) + 0.0722 * std::exp2(logs[2])) - log2_time;
}

Judgement judge(const Samples& samples, std::span<const float> lights, std::span<const float> worths,
                std::span<const double> exposures) {
  const std::size_t frames = samples.frames;
  std::vector<std::vector<double>> steps(frames < 2 ? 0 : frames - 1);
  std::array<std::vector<double>, 16> rests;
  std::vector<double> seen(frames);
  for (std::size_t i = 0; i < samples.pixels; ++i) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t j = 0; j < frames; ++j) {
      std::array<double, 3> logs{}, worth{};
      for (std::size_t c = 0; c < 3; ++c) {
        logs[c] = static_cast<double>(lights[(i * frames + j) * 3 + c]);
        worth[c] = static_cast<double>(worths[(i * frames + j) * 3 + c]);
      }
      seen[j] = log2_luminance(logs, worth, std::log2(exposures[j]));
      if (std::isfinite(seen[j])) sum += seen[j], ++count;
    }
    for (std::size_t j = 0; j < frames; ++j) {
      if (!std::isfinite(seen[j])) continue;
      if (j + 1 < frames && std::isfinite(seen[j + 1])) steps[j].push_back(seen[j + 1] - seen[j]);
      // Of n frames with the same noise, one differs from the mean of the others by sqrt(n / (n - 1)) of it.
      if (count > 1) {
        const auto n = static_cast<double>(count);
        const double others = (sum - seen[j]) / (n - 1);
        const auto bin = static_cast<std::size_t>(std::clamp(16 * static_cast<double>(samples.at(i, j, 1)), 0.0, 15.0));
        rests[bin].push_back(std::abs(seen[j] - others) * std::sqrt((n - 1) / n));
      }
    }
  }
  Judgement out;
  for (std::vector<double>& step : steps) {
    Ratio ratio{kNaN, step.size()};
    if (step.size() >= kFewestCompared) ratio.stops = median_of(step);
    out.ratios.push_back(ratio);
  }
  for (std::size_t j = 0; j < frames; ++j) {
    const double before = j > 0 ? out.ratios[j - 1].stops : kNaN, after = j + 1 < frames ? -out.ratios[j].stops : kNaN;
    out.errors.push_back(std::isnan(before) ? after : std::isnan(after) ? before : (before + after) / 2);
  }
  for (std::size_t bin = 0; bin < 16; ++bin) {
    const double middle = rests[bin].size() >= kFewestCompared ? 1.4826 * median_of(rests[bin]) : kNaN;
    out.noise[bin] = middle;
  }
  // A sixteenth that nothing is known of has what the nearest known one has.
  const std::array<double, 16> known = out.noise;
  for (int bin = 0; bin < 16; ++bin) {
    double value = kLeastNoise;
    for (int away = 0, found = 0; away < 16 && found == 0; ++away)
      for (const int at : {bin - away, bin + away})
        if (at >= 0 && at < 16 && !std::isnan(known[static_cast<std::size_t>(at)]))
          value = std::max(value, known[static_cast<std::size_t>(at)]), found = 1;
    out.noise[static_cast<std::size_t>(bin)] = value;
  }
  return out;
}

}  // namespace likeness::photograph
