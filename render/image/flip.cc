#include "render/image/flip.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "render/image/flip_steps.h"
#include "render/image/tone_curve.h"

namespace likeness::image {
namespace {

using flip_steps::Opponent;
using flip_steps::Term;
using flip_steps::Triple;
using Plane = std::vector<float>;

struct Size {
  std::size_t width, height;
  std::size_t count() const { return width * height; }
};

template <class Row>
void for_rows(const Size& size, const Row& row) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size.height, 8), [&](const auto& range) {
    for (std::size_t y = range.begin(); y != range.end(); ++y) row(y);
  });
}

// Beyond its edge a picture goes on as its edge pixels.
Plane filtered_along_rows(const Plane& in, const Size& size, const std::vector<float>& taps) {
  Plane out(size.count());
  const std::size_t radius = taps.size() / 2;
  for_rows(size, [&](std::size_t y) {
    const float* const from = in.data() + y * size.width;
    thread_local std::vector<float> padded;
    padded.resize(size.width + 2 * radius);
    std::fill_n(padded.begin(), radius, from[0]);
    std::copy_n(from, size.width, padded.begin() + static_cast<std::ptrdiff_t>(radius));
    std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, from[size.width - 1]);
    float* const to = out.data() + y * size.width;
    const float* const source = padded.data();
    for (std::size_t t = 0; t < taps.size(); ++t) {
      const float tap = taps[t];
      for (std::size_t x = 0; x < size.width; ++x) to[x] += tap * source[x + t];
    }
  });
  return out;
}

// Adds weight * the filtered plane to `out`.
void filter_along_columns(const Plane& in, const Size& size, const std::vector<float>& taps, float weight, Plane& out) {
  const auto radius = static_cast<std::ptrdiff_t>(taps.size() / 2);
  for_rows(size, [&](std::size_t y) {
    float* const to = out.data() + y * size.width;
    for (std::size_t t = 0; t < taps.size(); ++t) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(y) + static_cast<std::ptrdiff_t>(t) - radius;
      const auto row =
          static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, static_cast<std::ptrdiff_t>(size.height) - 1));
      const float* const from = in.data() + row * size.width;
      const float tap = weight * taps[t];
      for (std::size_t x = 0; x < size.width; ++x) to[x] += tap * from[x];
    }
  });
}

Plane filtered(const Plane& in, const Size& size, const std::vector<Term>& terms) {
  Plane out(size.count());
  for (const Term& term : terms)
    filter_along_columns(filtered_along_rows(in, size, term.taps), size, term.taps, term.weight, out);
  return out;
}

struct Filters {
  std::array<std::vector<Term>, 3> contrast;
  flip_steps::FeatureFilters features;

  explicit Filters(const FlipOptions& options) : features() {
    const double ppd = options.pixels_per_degree;
    if (!(ppd >= 1 && ppd <= 1000))
      throw std::invalid_argument("flip: pixels_per_degree = " + std::to_string(ppd) + " is outside [1, 1000]");
    contrast = {contrast_filter(Opponent::kAchromatic, ppd), contrast_filter(Opponent::kRedGreen, ppd),
                contrast_filter(Opponent::kBlueYellow, ppd)};
    features = flip_steps::feature_filters(ppd);
  }
};

// What is compared of one picture.
struct Seen {
  std::vector<Triple> color;  // filtered, Hunt-adjusted CIELAB
  Plane edges, points;        // how strong each is
};

// The length of the two derivatives.
Plane feature_strength(const Plane& y, const Size& size, const Plane& smooth_rows, const std::vector<float>& along,
                       const std::vector<float>& across) {
  Plane dx(size.count()), dy(size.count());
  filter_along_columns(filtered_along_rows(y, size, along), size, across, 1, dx);
  filter_along_columns(smooth_rows, size, along, 1, dy);
  for_rows(size, [&](std::size_t row) {
    for (std::size_t i = row * size.width; i < (row + 1) * size.width; ++i)
      dx[i] = std::sqrt(dx[i] * dx[i] + dy[i] * dy[i]);
  });
  return dx;
}

// `linear(i)` is the light of pixel i in [0, 1].
template <class Linear>
Seen seen(const Size& size, const Filters& filters, const Linear& linear) {
  std::array<Plane, 3> opponent;
  for (Plane& plane : opponent) plane.resize(size.count());
  for_rows(size, [&](std::size_t row) {
    for (std::size_t i = row * size.width; i < (row + 1) * size.width; ++i) {
      const Triple c = flip_steps::ycxcz_of_linear(linear(i));
      opponent[0][i] = c.x;
      opponent[1][i] = c.y;
      opponent[2][i] = c.z;
    }
  });
  Seen out;
  {
    std::array<Plane, 3> smooth;
    for (std::size_t c = 0; c < 3; ++c) smooth[c] = filtered(opponent[c], size, filters.contrast[c]);
    out.color.resize(size.count());
    for_rows(size, [&](std::size_t row) {
      for (std::size_t i = row * size.width; i < (row + 1) * size.width; ++i) {
        const Triple rgb = flip_steps::linear_of_ycxcz({smooth[0][i], smooth[1][i], smooth[2][i]});
        const auto inside = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
        out.color[i] = flip_steps::hunt_lab({inside(rgb.x), inside(rgb.y), inside(rgb.z)});
      }
    });
  }
  Plane& y = opponent[0];
  for (float& v : y) v = (v + 16) / 116;
  const Plane smooth_rows = filtered_along_rows(y, size, filters.features.across);
  out.edges = feature_strength(y, size, smooth_rows, filters.features.edge, filters.features.across);
  out.points = feature_strength(y, size, smooth_rows, filters.features.point, filters.features.across);
  return out;
}

// The larger of what is there and the difference of the two, pixel by pixel.
void raise_to_difference(const Seen& p, const Seen& q, const Size& size, Plane& error) {
  for_rows(size, [&](std::size_t row) {
    for (std::size_t i = row * size.width; i < (row + 1) * size.width; ++i) {
      const float color = flip_steps::color_difference(flip_steps::hyab(p.color[i], q.color[i]));
      const float feature = std::max(std::abs(p.edges[i] - q.edges[i]), std::abs(p.points[i] - q.points[i]));
      const float power = 1 - std::min(1.0f, std::sqrt(feature * static_cast<float>(std::sqrt(0.5))));
      error[i] = std::max(error[i], std::clamp(std::pow(color, power), 0.0f, 1.0f));
    }
  });
}

template <class P>
Size size_of_both(const P& reference, const P& render) {
  const auto text = [](const P& p) { return std::to_string(p.width) + " x " + std::to_string(p.height); };
  if (reference.width != render.width || reference.height != render.height)
    throw std::invalid_argument("flip: reference is " + text(reference) + ", render is " + text(render) +
                                "; both must have the same size");
  return {static_cast<std::size_t>(reference.width), static_cast<std::size_t>(reference.height)};
}

double mean_of(const Plane& error) {
  double sum = 0;
  for (const float e : error) sum += static_cast<double>(e);
  return error.empty() ? 0 : sum / static_cast<double>(error.size());
}

// Light that has a place on a screen: not negative, finite.
Picture finite(const Picture& picture, std::size_t& not_finite) {
  Picture out = picture;
  for (float& v : out.rgb) {
    if (!std::isfinite(v)) ++not_finite;
    if (!(v > 0)) v = 0;  // NaN too
    v = std::min(v, std::numeric_limits<float>::max());
  }
  return out;
}

// Start and stop of hdr_flip().
std::array<double, 2> exposures_of(const Picture& reference) {
  std::vector<double> lit;
  for (std::size_t i = 0; i < reference.rgb.size(); i += 3) {
    const double luminance = 0.2126 * static_cast<double>(reference.rgb[i]) +
                             0.7152 * static_cast<double>(reference.rgb[i + 1]) +
                             0.0722 * static_cast<double>(reference.rgb[i + 2]);
    if (luminance > 0) lit.push_back(luminance);
  }
  if (lit.empty()) return {0, 0};
  const double largest = *std::ranges::max_element(lit);
  const std::size_t all = reference.rgb.size() / 3, dark = all - lit.size();
  // The median of all pixels (the mean of the two middle ones) where that is lit.
  std::ranges::sort(lit);
  const bool is_mostly_lit = (all - 1) / 2 >= dark;
  const std::size_t low = is_mostly_lit ? (all - 1) / 2 - dark : (lit.size() - 1) / 2;
  const std::size_t high = is_mostly_lit ? all / 2 - dark : lit.size() / 2;
  const double median = std::max(0.5 * (lit[low] + lit[high]), std::ldexp(largest, -24));
  const double at = flip_steps::light_of_tone_085();
  return {std::log2(at / largest), std::log2(at / median)};
}

}  // namespace

ErrorMap flip(const DisplayPicture& reference, const DisplayPicture& render, const FlipOptions& options) {
  const Size size = size_of_both(reference, render);
  const Filters filters(options);
  ErrorMap out{reference.width, reference.height, Plane(size.count()), 0};
  if (size.count() == 0) return out;
  std::array<float, 256> decoded{};
  for (std::size_t k = 0; k < 256; ++k) decoded[k] = static_cast<float>(srgb_decode8(static_cast<std::uint8_t>(k)));
  const auto seen_of = [&](const DisplayPicture& picture) {
    return seen(size, filters, [&](std::size_t i) -> Triple {
      const std::uint8_t* const p = picture.rgb.data() + 3 * i;
      return {decoded[p[0]], decoded[p[1]], decoded[p[2]]};
    });
  };
  raise_to_difference(seen_of(reference), seen_of(render), size, out.error);
  out.mean = mean_of(out.error);
  return out;
}

namespace {

HdrErrorMap largest_over(const Picture& reference, const Picture& render, const std::optional<Exposures>& exposures,
                         const FlipOptions& options) {
  const Size size = size_of_both(reference, render);
  const Filters filters(options);
  HdrErrorMap out;
  out.width = reference.width;
  out.height = reference.height;
  out.error.resize(size.count());
  if (size.count() == 0) return out;
  const Picture truth = finite(reference, out.not_finite), found = finite(render, out.not_finite);
  const auto [start, stop] = exposures ? std::array{exposures->first_ev, exposures->last_ev} : exposures_of(truth);
  out.start_ev = start;
  out.stop_ev = stop;
  out.exposures = stop > start ? std::max(2, static_cast<int>(std::ceil(stop - start))) : 1;
  for (int i = 0; i < out.exposures; ++i) {
    const double ev = start + (stop - start) * i / std::max(1, out.exposures - 1);
    const double scale = std::exp2(ev);
    const auto seen_of = [&](const Picture& picture) {
      return seen(size, filters, [&](std::size_t at) -> Triple {
        const float* const p = picture.rgb.data() + 3 * at;
        // In double: the scale of the darkest pictures is no float.
        const auto toned = [&](float v) {
          return flip_steps::tone_curve(static_cast<float>(std::min(scale * static_cast<double>(v), 1e6)));
        };
        return {toned(p[0]), toned(p[1]), toned(p[2])};
      });
    };
    raise_to_difference(seen_of(truth), seen_of(found), size, out.error);
  }
  out.mean = mean_of(out.error);
  return out;
}

}  // namespace

HdrErrorMap hdr_flip(const Picture& reference, const Picture& render, const FlipOptions& options) {
  return largest_over(reference, render, {}, options);
}

HdrErrorMap hdr_flip_over(const Exposures& exposures, const Picture& reference, const Picture& render,
                          const FlipOptions& options) {
  const auto& [first, last] = exposures;
  if (!(std::isfinite(first) && std::isfinite(last) && first <= last && last - first <= 64))
    throw std::invalid_argument("hdr_flip: exposures from " + std::to_string(first) + " to " + std::to_string(last) +
                                " stops; the first must not be above the last, nor 64 stops below it");
  return largest_over(reference, render, exposures, options);
}

}  // namespace likeness::image
