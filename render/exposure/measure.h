#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "brdf/lighting/zone.h"
#include "render/exposure/curve.h"
#include "render/exposure/histogram.h"

namespace likeness::exposure {

// What an exposure makes of a picture: shares of all counted weight, black included, each 0 to 1.
//
// Zones and parts of the curve go by luminance; black is in zone 0 and in the toe. A pixel is clipped if its brightest
// channel is where a grey has code 255, and crushed if it has light but its luminance is where a grey has code 0. For srgb
// and gt, which treat each channel by itself, clipped pixels are exactly those with a channel of code 255; views that mix
// channels may clip saturated colors earlier or later than greys.
struct Shares {
  std::array<double, brdf::Zones::kCount> zones{};
  double toe = 0, linear = 0, shoulder = 0;
  double clipped = 0, crushed = 0;
  double black = 0;  // no light, at any exposure
};

// A histogram for questions: what is below a light, which light a share is below. A bin counts at its place as a whole, so
// that answers are exact but for pixels within 1/710 stop of what is asked, and exact for pictures of few greys.
class Distribution {
 public:
  explicit Distribution(std::span<const Bin> bins);

  bool is_empty() const { return light_.empty(); }
  std::uint64_t weight() const { return is_empty() ? 0 : up_to_.back(); }
  std::uint64_t below(double light) const;
  // The least light that at least `share` of the weight is at or below (nearest rank). Needs !is_empty().
  double percentile(double share) const;
  // Mean of log2(light), to 2e-7 of that of the pixels. Needs !is_empty().
  double mean_log2() const;

 private:
  std::vector<double> light_;  // rises
  std::vector<std::uint64_t> up_to_;
};

// A histogram made ready for many exposures.
class Meter {
 public:
  Meter(const Histogram& histogram, const Curve& curve);

  // All shares are 0 where nothing is counted.
  Shares shares(double ev) const;
  // Some of them, faster.
  std::uint64_t linear_weight(double ev) const { return weight_between(curve_.toe_end, curve_.shoulder_start, ev); }
  // Of luminance from `low` to `high`, both included, after exposure.
  std::uint64_t weight_between(double low, double high, double ev) const;
  std::uint64_t clipped_weight(double ev) const;
  std::uint64_t crushed_weight(double ev) const;

  const Distribution& luminance() const { return luminance_; }
  const Curve& curve() const { return curve_; }
  std::uint64_t weight() const { return weight_; }

 private:
  Curve curve_;
  Distribution luminance_, brightest_;
  std::uint64_t weight_, black_;
};

}  // namespace likeness::exposure
