#include "render/exposure/histogram.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace likeness::exposure {
namespace {

constexpr int kPlaceBits = 13;  // 23 of a float's mantissa less the 10 that say the bin
constexpr std::uint32_t kPlaces = 1u << kPlaceBits;
constexpr std::uint32_t kFirstTop = static_cast<std::uint32_t>(127 + Histogram::kFirstOctave)
                                    << 10;  // of the bits' top
constexpr std::uint32_t kLastTop = kFirstTop + static_cast<std::uint32_t>(Histogram::kBins) - 1;

constexpr float kLargest = std::numeric_limits<float>::max();

// Light above 0: a positive float's bits are ordered as it is.
void put(std::span<Bin> bins, float light, std::uint64_t weight) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(light), top = bits >> kPlaceBits;
  const std::uint32_t kept = std::clamp(top, kFirstTop, kLastTop);
  Bin& bin = bins[kept - kFirstTop];
  bin.weight += weight;
  bin.place += weight * (top < kFirstTop ? 0 : top > kLastTop ? kPlaces - 1 : bits & (kPlaces - 1));
}

std::uint64_t whole_weight(float weight) {
  if (!(weight > 0)) return 0;  // NaN too
  return static_cast<std::uint64_t>(std::min(weight, 1.0f) * static_cast<float>(Histogram::kWhole) + 0.5f);
}

void add_bins(std::span<Bin> to, std::span<const Bin> from) {
  for (std::size_t i = 0; i < to.size(); ++i)
    if (from[i].weight != 0) to[i].weight += from[i].weight, to[i].place += from[i].place;
}

}  // namespace

// Adds pixels, one by one.
class Histogram::Counter {
 public:
  Counter(Histogram& to, float floor) : to_(to), luminance_(to.luminance_), brightest_(to.brightest_), floor_(floor) {}

  void add(std::span<const float, 3> rgb, std::uint64_t weight) {
    ++to_.counts_.all;
    if (weight == 0) {
      ++to_.counts_.masked;
      return;
    }
    float y = luminance_of(rgb), most = std::max({rgb[0], rgb[1], rgb[2]});
    if (!std::isfinite(rgb[0] + rgb[1] + rgb[2]) || !std::isfinite(y)) {
      if (std::isnan(rgb[0]) || std::isnan(rgb[1]) || std::isnan(rgb[2])) {
        ++to_.counts_.not_number;
        return;
      }
      to_.counts_.infinite += std::isinf(rgb[0]) || std::isinf(rgb[1]) || std::isinf(rgb[2]);
      const auto finite = [](float v) { return static_cast<double>(std::clamp(v, -kLargest, kLargest)); };
      y = static_cast<float>(std::clamp(0.2126 * finite(rgb[0]) + 0.7152 * finite(rgb[1]) + 0.0722 * finite(rgb[2]),
                                        -finite(kLargest), finite(kLargest)));
      most = std::clamp(most, -kLargest, kLargest);
    }
    to_.counts_.negative += std::min({rgb[0], rgb[1], rgb[2]}) < 0;
    to_.counts_.denormal += y > 0 && y < std::numeric_limits<float>::min();
    to_.weight_ += weight;
    if (most > 0) put(brightest_, most, weight);
    if (y > floor_) put(luminance_, y, weight);
    else to_.black_ += weight;
  }

 private:
  Histogram& to_;
  std::span<Bin> luminance_, brightest_;
  float floor_;
};

Histogram::Histogram() : luminance_(kBins), brightest_(kBins) {}

void Histogram::add(const image::Picture& picture, std::span<const float> weights, float floor) {
  const std::size_t count = picture.rgb.size() / 3;
  if (!weights.empty() && weights.size() != count)
    throw std::invalid_argument("Histogram::add: " + std::to_string(weights.size()) + " weights for " +
                                std::to_string(count) + " pixels");
  const float least = std::max(floor, 0.0f);
  const auto add_pixels = [&](Histogram& to, std::size_t first, std::size_t last) {
    Counter counter(to, least);
    for (std::size_t i = first; i < last; ++i)
      counter.add(std::span<const float, 3>(picture.rgb.data() + 3 * i, 3),
                  weights.empty() ? kWhole : whole_weight(weights[i]));
  };
  constexpr std::size_t kFew = 1 << 16;
  if (count <= kFew) {
    add_pixels(*this, 0, count);
    return;
  }
  tbb::enumerable_thread_specific<Histogram> parts;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kFew),
                    [&](const auto& range) { add_pixels(parts.local(), range.begin(), range.end()); });
  for (const Histogram& part : parts) add(part);
}

void Histogram::add(const Histogram& other) {
  counts_.all += other.counts_.all;
  counts_.masked += other.counts_.masked;
  counts_.not_number += other.counts_.not_number;
  counts_.infinite += other.counts_.infinite;
  counts_.negative += other.counts_.negative;
  counts_.denormal += other.counts_.denormal;
  weight_ += other.weight_;
  black_ += other.black_;
  add_bins(luminance_, other.luminance_);
  add_bins(brightest_, other.brightest_);
}

double Histogram::light_of(std::size_t bin, const Bin& content) {
  const std::uint32_t bits = (kFirstTop + static_cast<std::uint32_t>(bin)) << kPlaceBits;
  const double low = std::bit_cast<float>(bits), high = std::bit_cast<float>(bits + kPlaces);
  if (content.weight == 0) return low;
  return low + (high - low) * (static_cast<double>(content.place) / static_cast<double>(content.weight)) / kPlaces;
}

std::size_t Histogram::bin_of(float light) {
  return std::clamp(std::bit_cast<std::uint32_t>(light) >> kPlaceBits, kFirstTop, kLastTop) - kFirstTop;
}

}  // namespace likeness::exposure
