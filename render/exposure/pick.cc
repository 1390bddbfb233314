#include "render/exposure/pick.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace likeness::exposure {
namespace {

using brdf::Zones;

Pick limited(double ev) { return {std::clamp(ev, -kMostStops, kMostStops), false}; }

// How good an exposure is: first what it exceeds the limits by, then what it has in the linear part.
struct Score {
  double excess = 0;
  std::uint64_t linear = 0;
  bool operator==(const Score&) const = default;
  bool is_better_than(const Score& other) const {
    return excess < other.excess || (excess == other.excess && linear > other.linear);
  }
};

Score score_of(const Meter& meter, const Limits& limits, double ev) {
  const double all = static_cast<double>(meter.weight());
  const double clipped = static_cast<double>(meter.clipped_weight(ev)) / all;
  const double crushed = static_cast<double>(meter.crushed_weight(ev)) / all;
  return {std::max(clipped - limits.clipped, 0.0) + std::max(crushed - limits.crushed, 0.0),
          meter.weight_between(line_start(meter.curve()), meter.curve().shoulder_start, ev)};
}

}  // namespace

double ev_for(double luminance, double zone) {
  return zone - Zones::kGreyZone - std::log2(luminance / Zones::kMiddleGrey);
}

double white_zone() { return Zones::kGreyZone + std::log2(1 / Zones::kMiddleGrey); }

double ev100(double f_number, double seconds, double iso) {
  return std::log2(f_number * f_number / seconds * 100 / iso);
}

double line_start(const Curve& curve) {
  constexpr double kFirstTexture = 1.5;  // the lower border of zone II
  return curve.toe_end > 0 ? curve.toe_end
                           : brdf::luminance_of_zone<double>(kFirstTexture, Zones::kMiddleGrey, Zones::kGreyZone);
}

std::optional<Pick> pick_average(const Meter& meter) {
  if (meter.luminance().is_empty()) return std::nullopt;
  return limited(std::log2(Zones::kMiddleGrey) - meter.luminance().mean_log2());
}

std::optional<Pick> pick_percentile(const Meter& meter, double share, double zone) {
  if (meter.luminance().is_empty()) return std::nullopt;
  return limited(ev_for(meter.luminance().percentile(share), zone));
}

std::optional<Pick> pick_linear(const Meter& meter, const Limits& limits) {
  const auto average = pick_average(meter);
  if (!average) return std::nullopt;
  constexpr int kMost = static_cast<int>(kMostStops) * kStepsAStop;
  std::vector<Score> scores;
  scores.reserve(2 * kMost + 1);
  for (int k = -kMost; k <= kMost; ++k) scores.push_back(score_of(meter, limits, static_cast<double>(k) / kStepsAStop));
  Score best = scores[0];
  for (const Score& s : scores)
    if (s.is_better_than(best)) best = s;

  const double wanted = average->ev * kStepsAStop + kMost;
  std::size_t nearest = scores.size();
  for (std::size_t i = 0; i < scores.size(); ++i)
    if (scores[i] == best && (nearest == scores.size() || std::abs(static_cast<double>(i) - wanted) <
                                                              std::abs(static_cast<double>(nearest) - wanted)))
      nearest = i;
  std::size_t first = nearest, last = nearest;
  while (first > 0 && scores[first - 1] == best) --first;
  while (last + 1 < scores.size() && scores[last + 1] == best) ++last;
  const auto middle = static_cast<int>((first + last) / 2) - kMost;
  return Pick{static_cast<double>(middle) / kStepsAStop, best.excess > 0};
}

PatchLight light_of_patch(const image::Picture& picture, const Patch& patch) {
  PatchLight out;
  double logs = 0, squares = 0;
  std::uint64_t lit = 0;
  for (int y = patch.y; y < patch.y + patch.height; ++y)
    for (int x = patch.x; x < patch.x + patch.width; ++x) {
      const auto rgb = picture.at(x, y);
      if (!std::isfinite(rgb[0]) || !std::isfinite(rgb[1]) || !std::isfinite(rgb[2])) {
        ++out.left_out;
        continue;
      }
      ++out.pixels;
      for (std::size_t c = 0; c < 3; ++c) out.rgb[c] += static_cast<double>(rgb[c]);
      const double light = static_cast<double>(luminance_of(rgb));
      if (light > 0) {
        const double stops = std::log2(light);
        logs += stops, squares += stops * stops, ++lit;
      }
    }
  if (out.pixels == 0) return out;
  for (double& v : out.rgb) v /= static_cast<double>(out.pixels);
  out.luminance = 0.2126 * out.rgb[0] + 0.7152 * out.rgb[1] + 0.0722 * out.rgb[2];
  if (lit > 0) {
    const double n = static_cast<double>(lit), mean = logs / n;
    out.spread_stops = std::sqrt(std::max(squares / n - mean * mean, 0.0));
  }
  return out;
}

}  // namespace likeness::exposure
