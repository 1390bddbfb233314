#include "realis/weight/shadow.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <tbb/parallel_for.h>

namespace likeness::realis::weight {
namespace {

constexpr double kDark = 0.3, kLight = 0.7;  // of v on the two sides of a contour
constexpr double kDeadGap = 0.1;             // [pixel] what two pictures of the same shadow differ by
const float kUnknown = std::numeric_limits<float>::quiet_NaN();

// What each texel shows where it is lit, per cosine and irradiance.
std::vector<double> lit_of(const Samples& s, std::span<const Color> picture) {
  std::vector<double> out(s.texels());
  tbb::parallel_for(std::size_t{0}, s.texels(), [&](std::size_t t) {
    std::vector<double> values;
    for (std::size_t l = 0; l < s.lights(); ++l) {
      const std::size_t at = t * s.lights() + l;
      const double cosine = static_cast<double>(s.cosine[at]), v = luminance(picture[at]);
      if (cosine > kLeastShadowCosine && std::isfinite(v)) values.push_back(v / (cosine * s.irradiance_of(l)));
    }
    out[t] = quantile(values, kLitShare);
  });
  return out;
}

struct Crossing {
  double place;  // along the line, in pixels of it
  bool is_photo, rises;
};

// Where v crosses a half between two neighbours of the line, if it goes from dark to light within one pixel on either side.
void find_crossings(std::span<const float> v, bool is_photo, std::vector<Crossing>& out) {
  for (std::size_t i = 0; i + 1 < v.size(); ++i) {
    if (std::isnan(v[i]) || std::isnan(v[i + 1])) continue;
    const auto a = static_cast<double>(v[i]), b = static_cast<double>(v[i + 1]);
    if ((a < 0.5) == (b < 0.5)) continue;
    const bool rises = b > a;
    double low = std::min(a, b), high = std::max(a, b);
    for (const std::size_t k : {i - 1, i + 2})  // i - 1 of the first is past the end, too
      if (k < v.size() && !std::isnan(v[k]))
        low = std::min(low, static_cast<double>(v[k])), high = std::max(high, static_cast<double>(v[k]));
    if (low < kDark && high > kLight) out.push_back({static_cast<double>(i) + (0.5 - a) / (b - a), is_photo, rises});
  }
}

// Where what is known of a line ends (the subject's border, or a surface that the light grazes) with a shadow in one picture
// only, the other one's contour is behind that end: it counts as if it were there.
void find_hidden(std::span<const float> photo, std::span<const float> render, std::vector<Crossing>& all) {
  // Beyond the picture it is not known that nothing is known.
  const auto is_known = [&](std::size_t k) {
    return k >= photo.size() || !(std::isnan(photo[k]) || std::isnan(render[k]));
  };
  const std::size_t found = all.size();
  for (std::size_t i = 0; i < photo.size(); ++i) {
    if (!is_known(i) || (photo[i] < 0.5f) == (render[i] < 0.5f)) continue;
    const auto place = static_cast<double>(i);
    const auto after = std::find_if(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(found),
                                    [&](const Crossing& c) { return c.place >= place; });
    if (!is_known(i - 1) && after != all.begin() + static_cast<std::ptrdiff_t>(found))
      all.push_back({place, !after->is_photo, after->rises});
    if (!is_known(i + 1) && after != all.begin()) all.push_back({place, !(after - 1)->is_photo, (after - 1)->rises});
  }
}

// The pictures of one light, of the whole picture.
struct Visible {
  std::span<const float> photo, render;
  bool has_shadows = false;  // both have
};

bool has_contours(std::span<const float> picture, std::size_t width, std::size_t height) {
  std::vector<Crossing> found;
  for (std::size_t y = 0; y < height && found.size() < 4; ++y)
    find_crossings(picture.subspan(y * width, width), false, found);
  return found.size() >= 4;
}

// One line through the picture: pixels first, first + stride, ... `count` of them.
void weigh_line(const Visible& v, std::size_t first, std::size_t stride, std::size_t count, double step,
                const ShadowSettings& settings, std::vector<float>& weights) {
  thread_local std::vector<float> photo, render;
  thread_local std::vector<Crossing> all;
  photo.resize(count), render.resize(count), all.clear();
  for (std::size_t i = 0; i < count; ++i)
    photo[i] = v.photo[first + i * stride], render[i] = v.render[first + i * stride];
  find_crossings(photo, true, all);
  find_crossings(render, false, all);
  if (all.empty()) return;
  const auto sort = [&] {
    std::sort(all.begin(), all.end(), [](const Crossing& a, const Crossing& b) {
      return a.place != b.place ? a.place < b.place : a.is_photo < b.is_photo;
    });
  };
  sort();
  if (v.has_shadows) all.reserve(all.size() + 2 * count), find_hidden(photo, render, all), sort();
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    const Crossing &a = all[k], &b = all[k + 1];
    const double gap = (b.place - a.place) * step;
    if (a.is_photo == b.is_photo || a.rises != b.rises || gap > settings.longest) continue;
    const double w = 1 - std::clamp((gap - kDeadGap) / (settings.full - kDeadGap), 0.0, 1.0);
    const auto begin = static_cast<std::size_t>(a.place);
    const auto end = std::min(static_cast<std::size_t>(std::ceil(b.place)), count - 1);
    for (std::size_t i = begin; i <= end; ++i) {
      float& to = weights[first + i * stride];
      to = std::min(to, static_cast<float>(w));
    }
  }
}

}  // namespace

std::vector<float> shadow_of_light(int width_, int height_, std::span<const float> photo, std::span<const float> render,
                                   const ShadowSettings& settings) {
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  const Visible v{photo, render, has_contours(render, width, height) && has_contours(photo, width, height)};
  std::vector<float> weights(width * height, 1.0f);
  const auto line = [&](std::size_t first, std::size_t stride, std::size_t count, double step) {
    weigh_line(v, first, stride, count, step, settings, weights);
  };
  for (std::size_t y = 0; y < height; ++y) line(y * width, 1, width, 1);
  for (std::size_t x = 0; x < width; ++x) line(x, width, height, 1);
  for (std::size_t x = 0; x < width; ++x) {
    line(x, width + 1, std::min(width - x, height), std::numbers::sqrt2);
    line(x, width - 1, std::min(x + 1, height), std::numbers::sqrt2);
  }
  for (std::size_t y = 1; y < height; ++y) {
    line(y * width, width + 1, std::min(width, height - y), std::numbers::sqrt2);
    line(y * width + width - 1, width - 1, std::min(width, height - y), std::numbers::sqrt2);
  }
  return weights;
}

Weights shadow(const Samples& s, const ShadowSettings& settings) {
  Weights out(s.samples(), 1.0f);
  if (s.cosine.empty() || s.samples() == 0) return out;
  const std::vector<double> lit_photo = lit_of(s, s.photo), lit_render = lit_of(s, s.render);
  const std::size_t pixels = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height);
  tbb::parallel_for(std::size_t{0}, s.lights(), [&](std::size_t l) {
    std::vector<float> photo(pixels, kUnknown), render(pixels, kUnknown);
    for (std::size_t t = 0; t < s.texels(); ++t) {
      const std::size_t at = t * s.lights() + l;
      const double received = static_cast<double>(s.cosine[at]) * s.irradiance_of(l);
      if (!(static_cast<double>(s.cosine[at]) > kLeastShadowCosine)) continue;
      if (lit_photo[t] > 0) photo[s.pixels[t]] = static_cast<float>(luminance(s.photo[at]) / (received * lit_photo[t]));
      if (lit_render[t] > 0)
        render[s.pixels[t]] = static_cast<float>(luminance(s.render[at]) / (received * lit_render[t]));
    }
    const std::vector<float> weights = shadow_of_light(s.width, s.height, photo, render, settings);
    for (std::size_t t = 0; t < s.texels(); ++t) out[t * s.lights() + l] = weights[s.pixels[t]];
  });
  return out;
}

}  // namespace likeness::realis::weight
