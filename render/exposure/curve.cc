#include "render/exposure/curve.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "brdf/lighting/zone.h"
#include "render/image/tone_curve.h"
#include "render/view/view.h"

namespace likeness::exposure {
namespace {

scene::View without_exposure(const scene::View& view) {
  scene::View out = view;
  out.ev = 0;
  return out;
}

image::Picture greys(const std::vector<float>& light) {
  image::Picture out(static_cast<int>(light.size()), 1);
  for (std::size_t i = 0; i < out.rgb.size(); ++i) out.rgb[i] = light[i / 3];
  return out;
}

// The least float between two for which `holds`, which is false at `low` and true at `high`; both are above 0.
template <class Holds>
double border(float low, float high, Holds holds) {
  std::uint32_t from = std::bit_cast<std::uint32_t>(low), to = std::bit_cast<std::uint32_t>(high);
  while (to - from > 1) {
    const std::uint32_t middle = from + (to - from) / 2;
    (holds(std::bit_cast<float>(middle)) ? to : from) = middle;
  }
  return static_cast<double>(std::bit_cast<float>(to));
}

std::array<double, 2> limits_by_slope(const view::Shower& shower) {
  constexpr int kSteps = 16, kFirst = -12 * kSteps, kLast = 8 * kSteps;  // of a stop
  std::vector<double> light, gamma;
  double before_x = 0, before_y = 0;
  for (int k = kFirst; k <= kLast; ++k) {
    const double x = brdf::Zones::kMiddleGrey * std::exp2(static_cast<double>(k) / kSteps);
    std::array<float, 3> c{static_cast<float>(x), static_cast<float>(x), static_cast<float>(x)};
    shower.encode(c);
    const double y = image::srgb_decode(static_cast<double>(c[1]));
    if (k > kFirst) {
      light.push_back(std::sqrt(x * before_x));
      gamma.push_back(y > 0 && before_y > 0 ? std::log(y / before_y) / std::log(x / before_x) : 0);
    }
    before_x = x;
    before_y = y;
  }
  constexpr double kFactor = 1.5;
  const double middle = gamma[-kFirst];
  const auto is_line = [&](std::size_t i) { return gamma[i] > middle / kFactor && gamma[i] < middle * kFactor; };
  std::size_t first = -kFirst, last = first;
  while (first > 0 && is_line(first - 1)) --first;
  while (last + 1 < gamma.size() && is_line(last + 1)) ++last;
  return {first == 0 ? 0 : light[first], light[last]};
}

bool is_gt(const scene::View& view) { return view.name == "gt" && view.config.empty() && view.display.empty(); }

}  // namespace

brdf::GtTonemap<float> float_curve(const brdf::GtTonemap<double>& gt) {
  return {static_cast<float>(gt.max_brightness), static_cast<float>(gt.contrast), static_cast<float>(gt.linear_start),
          static_cast<float>(gt.linear_length),  static_cast<float>(gt.black),    static_cast<float>(gt.pedestal)};
}

std::array<double, 2> curve_limits(const scene::View& view, const brdf::GtTonemap<double>& gt) {
  if (is_gt(view)) return {gt.linear_start, gt.shoulder_start()};
  return limits_by_slope(view::Shower(without_exposure(view)));
}

Curve curve_of(const scene::View& view, const brdf::GtTonemap<double>& gt) {
  const view::Shower shower(without_exposure(view), float_curve(gt));
  const auto limits = is_gt(view) ? curve_limits(view, gt) : limits_by_slope(shower);
  Curve out{limits[0], limits[1], 0, std::numeric_limits<double>::infinity()};

  constexpr int kFirst = -64, kLast = 32, kSteps = 8;  // [stop], and of a stop
  std::vector<float> light;
  for (int k = kFirst * kSteps; k <= kLast * kSteps; ++k) light.push_back(std::exp2(static_cast<float>(k) / kSteps));
  const image::DisplayPicture shown = shower.show(greys(light));
  const auto codes = [](const image::DisplayPicture& p, std::size_t i) {
    const auto c = p.at(static_cast<int>(i), 0);
    return std::minmax({c[0], c[1], c[2]});
  };
  const auto most_at = [&](float x) { return codes(shower.show(greys({x})), 0).second; };
  std::size_t dark = 0, full = light.size();
  while (dark < light.size() && codes(shown, dark).second == 0) ++dark;
  while (full > 0 && codes(shown, full - 1).second == 255) --full;
  if (dark > 0 && dark < light.size())
    out.crushed_below = border(light[dark - 1], light[dark], [&](float x) { return most_at(x) > 0; });
  else if (dark == light.size()) out.crushed_below = std::numeric_limits<double>::infinity();
  if (full > 0 && full < light.size())
    out.clipped_from = border(light[full - 1], light[full], [&](float x) { return most_at(x) == 255; });
  else if (full == 0) out.clipped_from = 0;
  return out;
}

}  // namespace likeness::exposure
