#include "render/exposure/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace likeness::exposure {

Distribution::Distribution(std::span<const Bin> bins) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (bins[i].weight == 0) continue;
    light_.push_back(Histogram::light_of(i, bins[i]));
    up_to_.push_back(sum += bins[i].weight);
  }
}

std::uint64_t Distribution::below(double light) const {
  const auto count = std::lower_bound(light_.begin(), light_.end(), light) - light_.begin();
  return count == 0 ? 0 : up_to_[static_cast<std::size_t>(count - 1)];
}

double Distribution::percentile(double share) const {
  const double wanted = std::clamp(share, 0.0, 1.0) * static_cast<double>(weight());
  const auto at = std::lower_bound(up_to_.begin(), up_to_.end(), wanted,
                                   [](std::uint64_t sum, double rank) { return static_cast<double>(sum) < rank; });
  return light_[std::min(static_cast<std::size_t>(at - up_to_.begin()), light_.size() - 1)];
}

// Within a bin the mean of logarithms is that of the place but for the square of the bin's width.
double Distribution::mean_log2() const {
  double sum = 0;
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < light_.size(); ++i) {
    sum += static_cast<double>(up_to_[i] - before) * std::log2(light_[i]);
    before = up_to_[i];
  }
  return sum / static_cast<double>(weight());
}

Meter::Meter(const Histogram& histogram, const Curve& curve)
    : curve_(curve),
      luminance_(histogram.luminance()),
      brightest_(histogram.brightest()),
      weight_(histogram.weight()),
      black_(histogram.black_weight()) {}

std::uint64_t Meter::weight_between(double low, double high, double ev) const {
  const double scale = std::exp2(-ev);
  const std::uint64_t before = luminance_.below(scale * low);
  const std::uint64_t with = luminance_.below(std::nextafter(scale * high, std::numeric_limits<double>::infinity()));
  return std::max(with, before) - before;
}
std::uint64_t Meter::clipped_weight(double ev) const {
  return brightest_.weight() - brightest_.below(std::exp2(-ev) * curve_.clipped_from);
}
std::uint64_t Meter::crushed_weight(double ev) const { return luminance_.below(std::exp2(-ev) * curve_.crushed_below); }

Shares Meter::shares(double ev) const {
  Shares out;
  if (weight_ == 0) return out;
  const auto share = [&](std::uint64_t weight) { return static_cast<double>(weight) / static_cast<double>(weight_); };
  std::uint64_t before = 0;
  for (int zone = 0; zone < brdf::Zones::kCount; ++zone) {
    const double end =
        std::exp2(-ev) * brdf::luminance_of_zone<double>(zone + 0.5, brdf::Zones::kMiddleGrey, brdf::Zones::kGreyZone);
    const std::uint64_t up_to = zone + 1 < brdf::Zones::kCount ? luminance_.below(end) : luminance_.weight();
    out.zones[static_cast<std::size_t>(zone)] = share(up_to - before + (zone == 0 ? black_ : 0));
    before = up_to;
  }
  const std::uint64_t toe = luminance_.below(std::exp2(-ev) * curve_.toe_end), linear = linear_weight(ev);
  out.toe = share(toe + black_);
  out.linear = share(linear);
  out.shoulder = share(luminance_.weight() - toe - linear);
  out.clipped = share(clipped_weight(ev));
  out.crushed = share(crushed_weight(ev));
  out.black = share(black_);
  return out;
}

}  // namespace likeness::exposure
