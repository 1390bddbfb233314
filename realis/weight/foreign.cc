#include "realis/weight/foreign.h"

#include <cmath>
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
const double kMirror = std::cos(25 * std::numbers::pi / 180);

constexpr double kWeak = 0.3;  // of the limits: what is off that much belongs to an object that it touches

enum : std::uint8_t { kUsual = 0, kSlightlyOff = 1, kOff = 2, kHighlight = 3, kSeen = 4 };

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

// Which samples of a texel are off.
void mark_texel(const Samples& s, const std::vector<std::vector<std::size_t>>& neighbours,
                const ForeignSettings& settings, std::size_t t, std::uint8_t* marks) {
  const std::size_t lights = s.lights();
  thread_local std::vector<double> e, received, difference, some;
  e.resize(lights), received.resize(lights), difference.resize(lights), some.clear();
  for (std::size_t l = 0; l < lights; ++l) {
    const std::size_t at = t * lights + l;
    const double cosine = s.cosine.empty() ? 1 : static_cast<double>(s.cosine[at]);
    received[l] = std::max(cosine, kLeastReceived) * s.irradiance_of(l);
    e[l] = (luminance(s.photo[at]) - luminance(s.render[at])) / received[l];
    if (cosine > kLeastReceived) some.push_back(luminance(s.photo[at]) / received[l]);
    if (!std::isfinite(e[l])) e[l] = 0;
  }
  std::erase_if(some, [](double x) { return !std::isfinite(x); });
  const double usual = std::max(quantile(some, 0.5), 0.0);
  std::vector<double> predicted(lights);
  for (std::size_t l = 0; l < lights; ++l) {
    some.clear();
    for (const std::size_t k : neighbours[l]) some.push_back(e[k]);
    predicted[l] = quantile(some, 0.5);
    difference[l] = e[l] - predicted[l];
  }
  some.assign(difference.begin(), difference.end());
  for (double& x : some) x = std::abs(x);
  const double deviation = settings.deviations * 1.4826 * quantile(some, 0.5);
  // How far a sample is off, over what it takes: as a residual, and as light, so that grazing light counts for little.
  const auto excess = [&](std::size_t l) {
    const double d = std::abs(difference[l]);
    const double most = std::max(deviation, settings.share * usual * s.irradiance_of(l) / received[l]);
    return most > 0 ? d / most : d > 0 ? 2.0 : 0.0;
  };
  for (std::size_t l = 0; l < lights; ++l) {
    const double off = excess(l);
    if (!(off > kWeak)) continue;
    const std::size_t at = t * lights + l;
    const double expected = luminance(s.render[at]) + predicted[l] * received[l];
    if (difference[l] < 0 && luminance(s.photo[at]) < kDarkest * expected) continue;
    // Grazing light shows what renders are worst at: alone it is no sign of an object.
    const bool is_grazing = received[l] <= kLeastReceived * s.irradiance_of(l);
    marks[l] = off <= 1 || is_grazing                                ? kSlightlyOff
               : difference[l] > 0 && half_cosine(s, t, l) > kMirror ? kHighlight
                                                                     : kOff;
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
      if (marks[first * lights + l] != kOff && marks[first * lights + l] != kHighlight) continue;
      region.assign(1, first);
      std::size_t strong = 1, highlights = marks[first * lights + l] == kHighlight;
      marks[first * lights + l] = kSeen;
      for (std::size_t i = 0; i < region.size(); ++i)
        around(region[i], [&](std::size_t n) {
          std::uint8_t& mark = marks[n * lights + l];
          if (mark == kUsual || mark == kSeen) return;
          strong += mark != kSlightlyOff, highlights += mark == kHighlight, mark = kSeen;
          region.push_back(n);
        });
      if (static_cast<double>(strong) < settings.least || 2 * highlights > strong) continue;
      for (const std::size_t t : region) around(t, [&](std::size_t n) { out[n * lights + l] = 0; });
    }
  });
  return out;
}

}  // namespace likeness::realis::weight
