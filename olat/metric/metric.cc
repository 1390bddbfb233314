#include "olat/metric/metric.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "olat/metric/formulas.h"
#include "render/files/files.h"
#include "render/image/tone_curve.h"

namespace likeness::metric {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

template <class P>
void require_size(const P* picture, const image::Picture& photo, const char* name) {
  if (picture == nullptr) throw std::invalid_argument(std::string("metric: the pair has no ") + name);
  if (picture->width == photo.width && picture->height == photo.height) return;
  const auto text = [](int width, int height) { return std::to_string(width) + " x " + std::to_string(height); };
  throw std::invalid_argument("metric: photo is " + text(photo.width, photo.height) + ", " + name + " is " +
                              text(picture->width, picture->height) + "; both must have the same size");
}

void check(const Pair& pair, const MetricRow& row) {
  if (pair.photo == nullptr) throw std::invalid_argument("metric: the pair has no photo");
  require_size(pair.render, *pair.photo, "render");
  if (row.of == Of::kDisplay) {
    require_size(pair.shown_photo, *pair.photo, "shown photo");
    require_size(pair.shown_render, *pair.photo, "shown render");
  }
  if (!pair.weight.empty() && pair.weight.size() != pair.photo->rgb.size() / 3)
    throw std::invalid_argument("metric: " + std::to_string(pair.weight.size()) + " weights for " +
                                std::to_string(pair.photo->rgb.size() / 3) + " pixels");
}

template <class Use>
void for_pixels(std::size_t count, const Use& use) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) use(i);
  });
}

bool is_finite(const image::Picture& picture, std::size_t pixel) {
  const float* const p = picture.rgb.data() + 3 * pixel;
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

// A map of three channels by a formula of one value.
template <class Formula>
Map of_channels(const Pair& pair, const Formula& formula) {
  const image::Picture &photo = *pair.photo, &render = *pair.render;
  Map map{photo.width, photo.height, 3, std::vector<float>(photo.rgb.size())};
  for_pixels(photo.rgb.size() / 3, [&](std::size_t i) {
    const bool finite = is_finite(photo, i) && is_finite(render, i);
    for (std::size_t c = 0; c < 3; ++c) {
      const float noise = std::max(pair.noise_floor[c], kLeastNoise);
      map.values[3 * i + c] = finite ? formula(photo.rgb[3 * i + c], render.rgb[3 * i + c], noise) : kNaN;
    }
  });
  return map;
}

Map delta_e(const Pair& pair) {
  const image::DisplayPicture &photo = *pair.shown_photo, &render = *pair.shown_render;
  Map map{photo.width, photo.height, 1, std::vector<float>(photo.rgb.size() / 3)};
  std::array<double, 256> light{};
  for (std::size_t k = 0; k < 256; ++k) light[k] = image::srgb_decode8(static_cast<std::uint8_t>(k));
  const auto lab = [&](const image::DisplayPicture& picture, std::size_t i) {
    const std::uint8_t* const p = picture.rgb.data() + 3 * i;
    return image::lab_of_rec709({light[p[0]], light[p[1]], light[p[2]]});
  };
  for_pixels(map.values.size(), [&](std::size_t i) {
    const bool equal = std::equal(&photo.rgb[3 * i], &photo.rgb[3 * i] + 3, &render.rgb[3 * i]);
    map.values[i] = equal ? 0 : static_cast<float>(delta_e_2000(lab(photo, i), lab(render, i)));
  });
  return map;
}

// Whether a pixel is compared. What is not must not be seen from its neighbours.
bool counts(const Pair& pair, std::size_t pixel) {
  return (pair.weight.empty() || pair.weight[pixel] > 0) && is_finite(*pair.photo, pixel) &&
         is_finite(*pair.render, pixel);
}

// The picture with black where nothing is compared.
template <class P>
P inside(P picture, const Pair& pair) {
  for (std::size_t i = 0; i < picture.rgb.size() / 3; ++i)
    if (!counts(pair, i)) std::fill_n(picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, 0);
  return picture;
}

Map flip_map(image::ErrorMap&& error, const Pair& pair) {
  Map map{error.width, error.height, 1, std::move(error.error)};
  for (std::size_t i = 0; i < map.values.size(); ++i)
    if (!is_finite(*pair.photo, i) || !is_finite(*pair.render, i)) map.values[i] = kNaN;
  return map;
}

struct Weighted {
  float value, weight;
};

// The smallest value at which a share of the weight is reached.
double quantile(std::vector<Weighted>& values, bool equal_weights, double share) {
  const auto less = [](const Weighted& p, const Weighted& q) { return p.value < q.value; };
  if (equal_weights) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
    std::nth_element(values.begin(), at, values.end(), less);
    return static_cast<double>(at->value);
  }
  std::ranges::stable_sort(values, less);
  double total = 0, sum = 0;
  for (const Weighted& v : values) total += static_cast<double>(v.weight);
  for (const Weighted& v : values) {
    sum += static_cast<double>(v.weight);
    if (sum >= share * total) return static_cast<double>(v.value);
  }
  return static_cast<double>(values.back().value);
}

}  // namespace

Metric metric_of(std::string_view id) {
  std::array<std::string_view, kMetrics.size()> names{};
  for (std::size_t k = 0; k < kMetrics.size(); ++k) {
    names[k] = kMetrics[k].id;
    if (id == names[k]) return static_cast<Metric>(k);
  }
  const std::string near = files::nearest_name(id, names.data(), names.size());
  std::string all;
  for (const std::string_view name : names) all += (all.empty() ? "" : ", ") + std::string(name);
  throw files::UsageError("unknown metric " + files::in_quotes(id) +
                          (near.empty() ? "" : "; did you mean " + near + "?") + " There are " + all);
}

Map map_of(Metric metric, const Pair& pair) {
  check(pair, row_of(metric));
  switch (metric) {
    case Metric::kStops:
      return of_channels(pair, stops);
    case Metric::kSigned:
      return of_channels(pair, [](float p, float r, float) { return signed_difference(p, r); });
    case Metric::kAbsolute:
      return of_channels(pair, [](float p, float r, float) { return absolute_difference(p, r); });
    case Metric::kSmape:
      return of_channels(pair, smape);
    case Metric::kDeltaE:
      return delta_e(pair);
    case Metric::kFlip:
      return flip_map(image::flip(inside(*pair.shown_photo, pair), inside(*pair.shown_render, pair), pair.flip), pair);
    case Metric::kHdrFlip:
      return flip_map(
          image::hdr_flip_over(pair.exposures, inside(*pair.photo, pair), inside(*pair.render, pair), pair.flip), pair);
  }
  throw std::invalid_argument("metric: no such metric");
}

Summary summary_of(const Map& map, std::span<const float> weight) {
  const auto channels = static_cast<std::size_t>(map.channels);
  const std::size_t pixels = map.values.size() / channels;
  if (!weight.empty() && weight.size() != pixels)
    throw std::invalid_argument("metric: " + std::to_string(weight.size()) + " weights for " + std::to_string(pixels) +
                                " pixels");
  Summary out;
  std::vector<Weighted> values;
  double total = 0, sum = 0, squares = 0;
  bool equal_weights = true;
  for (std::size_t i = 0; i < pixels; ++i) {
    const float w = weight.empty() ? 1 : weight[i];
    if (!(w > 0)) continue;
    const float* const v = map.values.data() + channels * i;
    if (std::any_of(v, v + channels, [](float x) { return !std::isfinite(x); })) {
      ++out.not_finite;
      continue;
    }
    ++out.pixels;
    for (std::size_t c = 0; c < channels; ++c) {
      const double x = static_cast<double>(v[c]), share = static_cast<double>(w);
      values.push_back({v[c], w});
      equal_weights = equal_weights && w == values.front().weight;
      total += share;
      sum += share * x;
      squares += share * x * x;
      out.largest = std::max(out.largest, std::abs(x));
    }
  }
  if (values.empty()) return out;
  out.mean = sum / total;
  out.rms = std::sqrt(squares / total);
  out.median = quantile(values, equal_weights, 0.5);
  for (Weighted& v : values) v.value = std::abs(v.value);
  out.p95 = quantile(values, equal_weights, 0.95);
  return out;
}

}  // namespace likeness::metric
