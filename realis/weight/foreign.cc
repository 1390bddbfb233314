#include "realis/weight/foreign.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "realis/weight/specular.h"

namespace likeness::realis::weight {
namespace {

constexpr std::size_t kNear = 5,
                      kFewest = 4;      // lights that a prediction takes; fewer lights than kFewest predict nothing
constexpr double kLeastReceived = 0.3;  // cosine that a residual is divided by at least
constexpr double kDarkest = 0.25;       // of a prediction: what is darker is a shadow
constexpr double kColored = 0.2;        // of what a texel usually shows: what is darker has no color to speak of
constexpr double kGrazing = 4;          // times the limits: an object even where light grazes or does not reach
constexpr double kWeak = 0.3;           // of the limits: what is off that much belongs to an object that it touches
const double kMirror = std::cos(30 * std::numbers::pi / 180);

enum : std::uint8_t { kUsual = 0, kSlightlyOff = 1, kOff = 2, kSeen = 3 };

// Of each light the nearest others, nearest first.
std::vector<std::vector<std::size_t>> neighbours_of(const Samples& s) {
  std::vector<std::vector<std::size_t>> out(s.lights());
  for (std::size_t l = 0; l < s.lights(); ++l) {
    std::vector<std::size_t> others;
    for (std::size_t k = 0; k < s.lights(); ++k)
      if (k != l) others.push_back(k);
    const std::size_t count = std::min(kNear, others.size());
    std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(count), others.end(),
                      [&](std::size_t a, std::size_t b) {
                        const double x = glm::dot(s.to_lights[l], s.to_lights[a]);
                        const double y = glm::dot(s.to_lights[l], s.to_lights[b]);
                        return x != y ? x > y : a < b;
                      });
    others.resize(count);
    out[l] = std::move(others);
  }
  return out;
}

// Red and blue over luminance.
std::array<double, 2> chroma_of(const Color& c) {
  const double y = luminance(c);
  return {static_cast<double>(c[0]) / y, static_cast<double>(c[2]) / y};
}

struct Usual {
  double light = 0;          // of the photographs where the texel is lit, over what is received: the median
  double low = 0, high = 0;  // e where the texel is lit: the quarters
  double deviation = 0;      // of e from its neighbours'
  std::array<double, 2> chroma{}, chroma_deviation{};
};

double deviation_of(std::vector<double>& values, double middle) {
  for (double& x : values) x = std::abs(x - middle);
  return 1.4826 * quantile(values, 0.5);
}

// Which samples of a texel are off.
void mark_texel(const Samples& s, const std::vector<std::vector<std::size_t>>& neighbours,
                const ForeignSettings& settings, std::size_t t, std::uint8_t* marks) {
  const std::size_t lights = s.lights();
  thread_local std::vector<double> e, received, some;
  e.resize(lights), received.resize(lights);
  const auto cosine_of = [&](std::size_t l) {
    return s.cosine.empty() ? 1 : static_cast<double>(s.cosine[t * lights + l]);
  };
  // Numbers of those lights that reach the texel.
  const auto quantile_of = [&](double share, const auto& number) {
    some.clear();
    for (std::size_t l = 0; l < lights; ++l)
      if (cosine_of(l) > kLeastReceived)
        if (const double x = number(l); std::isfinite(x)) some.push_back(x);
    return quantile(some, share);
  };
  for (std::size_t l = 0; l < lights; ++l) {
    const std::size_t at = t * lights + l;
    received[l] = std::max(cosine_of(l), kLeastReceived) * s.irradiance_of(l);
    e[l] = (luminance(s.photo[at]) - luminance(s.render[at])) / received[l];
    if (!std::isfinite(e[l])) e[l] = 0;
  }
  const auto shown = [&](std::size_t l) { return luminance(s.photo[t * lights + l]) / received[l]; };
  Usual usual;
  const double brightest = quantile_of(0.9, shown);
  const auto bright = [&](std::size_t l) {
    return shown(l) > kColored * brightest ? shown(l) : std::numeric_limits<double>::quiet_NaN();
  };
  usual.light = std::max(quantile_of(0.5, bright), 0.0);
  const auto is_colored = [&](std::size_t l) { return shown(l) > kColored * usual.light; };
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto lit = [&](std::size_t l) { return is_colored(l) ? e[l] : none; };
  usual.low = quantile_of(0.25, lit), usual.high = quantile_of(0.75, lit);
  some.clear();
  for (std::size_t l = 0; l < lights; ++l) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::size_t k : neighbours[l]) nearest = std::min(nearest, std::abs(e[l] - e[k]));
    some.push_back(nearest);
  }
  usual.deviation = 1.4826 * quantile(some, 0.5);
  for (std::size_t c = 0; c < 2; ++c) {
    const auto chroma = [&](std::size_t l) { return is_colored(l) ? chroma_of(s.photo[t * lights + l])[c] : none; };
    usual.chroma[c] = quantile_of(0.5, chroma);
    usual.chroma_deviation[c] = deviation_of(some, usual.chroma[c]);
  }
  for (std::size_t l = 0; l < lights; ++l) {
    const std::size_t at = t * lights + l;
    if (!std::isfinite(luminance(s.photo[at]))) continue;
    // Between what neighbouring lights and the others show, anything may be: each of them may be in a shadow.
    double low = std::min(usual.low, 0.0), high = std::max(usual.high, 0.0);
    for (const std::size_t k : neighbours[l])
      if (cosine_of(k) > kLeastReceived) low = std::min(low, e[k]), high = std::max(high, e[k]);
    const double difference = e[l] > high ? e[l] - high : e[l] < low ? e[l] - low : 0;
    const double most = std::max(settings.deviations * usual.deviation,
                                 settings.share * usual.light * s.irradiance_of(l) / received[l]);
    const bool is_shadow = luminance(s.photo[at]) < kDarkest * (luminance(s.render[at]) + low * received[l]);
    double off = most > 0 ? std::abs(difference) / most : difference != 0 ? 2 * kGrazing : 0;
    if (difference < 0 && is_shadow) off = 0;
    // About the mirror direction renders are off by highlights: alone that is no sign of an object.
    if (half_cosine(s, t, l) > kMirror) off = std::min(off, 1.0);
    const bool reaches = cosine_of(l) > kLeastReceived;
    if (is_colored(l) && reaches && usual.light > 0) {
      const std::array<double, 2> chroma = chroma_of(s.photo[at]);
      for (std::size_t c = 0; c < 2; ++c) {
        const double way = chroma[c] - usual.chroma[c], to_white = 1 - usual.chroma[c];
        if (way * to_white > 0 && std::abs(way) <= std::abs(to_white)) continue;  // what a highlight does
        off = std::max(off, std::abs(way) / std::max(settings.share, settings.deviations * usual.chroma_deviation[c]));
      }
    }
    if (off > kWeak) marks[l] = off > (reaches ? 1 : kGrazing) ? kOff : kSlightlyOff;
  }
}

}  // namespace

Weights foreign(const Samples& s, const ForeignSettings& settings) {
  Weights out(s.samples(), 1.0f);
  const std::size_t lights = s.lights();
  if (lights < kFewest) return out;
  std::vector<std::uint8_t> marks(s.samples(), kUsual);
  const auto neighbours = neighbours_of(s);
  tbb::parallel_for(std::size_t{0}, s.texels(),
                    [&](std::size_t t) { mark_texel(s, neighbours, settings, t, marks.data() + t * lights); });
  const int width = s.width, height = s.height;
  std::vector<std::ptrdiff_t> texel_at(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), -1);
  for (std::size_t t = 0; t < s.texels(); ++t) texel_at[s.pixels[t]] = static_cast<std::ptrdiff_t>(t);
  const auto around = [&](std::size_t t, const auto& visit) {
    const int x = static_cast<int>(s.pixels[t]) % width, y = static_cast<int>(s.pixels[t]) / width;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
        if (const std::ptrdiff_t n =
                texel_at[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u)];
            n >= 0)
          visit(static_cast<std::size_t>(n));
  };
  // Each light has its own marks and weights, so that lights can go at the same time.
  tbb::parallel_for(std::size_t{0}, lights, [&](std::size_t l) {
    std::vector<std::size_t> region;
    for (std::size_t first = 0; first < s.texels(); ++first) {
      if (marks[first * lights + l] != kOff) continue;
      region.assign(1, first);
      std::size_t strong = 1;
      marks[first * lights + l] = kSeen;
      for (std::size_t i = 0; i < region.size(); ++i)
        around(region[i], [&](std::size_t n) {
          std::uint8_t& mark = marks[n * lights + l];
          if (mark == kUsual || mark == kSeen) return;
          strong += mark == kOff, mark = kSeen;
          region.push_back(n);
        });
      if (static_cast<double>(strong) < settings.least) continue;
      for (const std::size_t t : region) around(t, [&](std::size_t n) { out[n * lights + l] = 0; });
    }
  });
  return out;
}

}  // namespace likeness::realis::weight
