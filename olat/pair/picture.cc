#include "olat/pair/picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "brdf/lighting/zone.h"
#include "olat/metric/formulas.h"
#include "olat/metric/metric.h"
#include "render/capture/pixels.h"
#include "render/exposure/curve.h"
#include "render/exposure/overlay.h"
#include "render/image/cie_lab.h"
#include "render/image/flip.h"
#include "render/image/tone_curve.h"
#include "render/view/view.h"

namespace likeness::olat_pair {

// Blue: the render is brighter. Orange: the photo is. Further is lighter, so that it reads without color.
const std::array<std::array<float, 3>, 5> kSignedColors{{{0.66f, 0.88f, 1.00f},
                                                         {0.13f, 0.42f, 0.80f},
                                                         {0.16f, 0.16f, 0.17f},
                                                         {0.80f, 0.42f, 0.08f},
                                                         {1.00f, 0.86f, 0.62f}}};

namespace {

using Color = std::array<float, 3>;

float luminance(const Color& c) { return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]; }

Color mixed(const Color& from, const Color& to, float share) {
  return {from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]),
          from[2] + share * (to[2] - from[2])};
}

// What of light the channel shows, on all three.
Color selected(Channel channel, const Color& light) {
  switch (channel) {
    case Channel::kRed:
      return {light[0], light[0], light[0]};
    case Channel::kGreen:
      return {light[1], light[1], light[1]};
    case Channel::kBlue:
      return {light[2], light[2], light[2]};
    case Channel::kLuma: {
      const float y = luminance(light);
      return {y, y, y};
    }
    case Channel::kColor:
    case Channel::kCoverage:
    case Channel::kSigned:
      break;
  }
  return light;
}

// The value of a metric's formula that a pixel has: luminance, or the channel that is shown.
float scalar_of(Channel channel, const Color& light) {
  const bool is_luminance = channel == Channel::kColor || channel == Channel::kCoverage || channel == Channel::kSigned;
  return is_luminance ? luminance(light) : selected(channel, light)[0];
}

image::Lab lab_of(const Color& shown) {
  return image::lab_of_rec709({image::srgb_decode(static_cast<double>(shown[0])),
                               image::srgb_decode(static_cast<double>(shown[1])),
                               image::srgb_decode(static_cast<double>(shown[2]))});
}

scene::View scene_view(const State& state) { return {state.ev, state.view, "", ""}; }

// Bright stripes of four in eight pixels: along one diagonal, or the other.
bool on_stripe(int x, int y, bool rising) { return ((rising ? x + y : x - y) & 7) < 4; }

class Painter {
 public:
  Painter(const State& state, const Pair& pair)
      : state_(state),
        pair_(pair),
        shower_(scene_view(state), exposure::float_curve(state.gt)),
        limits_(curve_limits(state)),
        scale_(static_cast<float>(std::exp2(state.ev))) {
    const auto metric = metric::metric_of(state.metric);
    if (state.mode == Mode::kDifference && (metric == metric::Metric::kFlip || metric == metric::Metric::kHdrFlip))
      flip_ = flip_map(state, pair);
  }

  // The color of one picture at a pixel.
  Color shown(int x, int y, bool is_render) const {
    const image::Picture& from = is_render ? pair_.render : pair_.photo;
    if (from.width == 0) return {kSurround, kSurround, kSurround};
    const std::uint8_t flaw = pair_.flaws[index(x, y)];
    if (state_.channel == Channel::kCoverage) {
      const float v = (flaw & capture::kMasked) != 0 ? 0.1f : 1.0f;
      return {v, v, v};
    }
    const Color light = light_at(x, y, is_render);
    if (state_.channel == Channel::kSigned) return map_color(luminance(light) * scale_, true);
    Color out = encoded(selected(state_.channel, light));
    const float exposed = luminance(light) * scale_;
    if (state_.overlay == Overlay::kZones) out = exposure::zone_color(exposed, x, y);
    if (state_.overlay == Overlay::kCurve) {
      const Color grey = encoded({luminance(light), luminance(light), luminance(light)});
      out = exposure::curve_color(grey, exposed, limits_, x, y);
    }
    if (state_.zebra) {
      const Color color = encoded(light);
      const bool is_full = std::max({color[0], color[1], color[2]}) >= 254.5f / 255;
      const bool is_clipped = !is_render && (flaw & (capture::kClipped | capture::kNotFinite)) != 0;
      if (is_full && on_stripe(x, y, true)) out = kDisplayStripe;
      if (is_clipped && on_stripe(x, y, false)) out = kSensorStripe;
    }
    return out;
  }

  Color difference(int x, int y) const {
    const Color surround{kSurround, kSurround, kSurround};
    if (pair_.photo.width == 0 || pair_.render.width == 0) return surround;
    if ((pair_.flaws[index(x, y)] & capture::kMasked) != 0) return surround;
    const auto metric = metric::metric_of(state_.metric);
    const float range = static_cast<float>(state_.range > 0 ? state_.range : scale_of(state_.metric));
    const Color photo = light_at(x, y, false), render = light_at(x, y, true);
    const float p = scalar_of(state_.channel, photo), r = scalar_of(state_.channel, render);
    float value = 0;
    switch (metric) {
      case metric::Metric::kStops:
        value = metric::stops(p, r, std::max(pair_.noise, metric::kLeastNoise));
        break;
      case metric::Metric::kSigned:
        value = metric::signed_difference(p, r) * scale_;
        break;
      case metric::Metric::kAbsolute:
        value = metric::absolute_difference(p, r) * scale_;
        break;
      case metric::Metric::kSmape:
        value = metric::smape(p, r, std::max(pair_.noise, metric::kLeastNoise));
        break;
      case metric::Metric::kDeltaE:
        value = static_cast<float>(metric::delta_e_2000(lab_of(encoded(selected(state_.channel, photo))),
                                                        lab_of(encoded(selected(state_.channel, render)))));
        break;
      case metric::Metric::kFlip:
      case metric::Metric::kHdrFlip:
        value = flip_[index(x, y)];
        break;
    }
    return map_color(value / range, metric::row_of(metric).is_signed);
  }

  Color wedge(int x, int width) const {
    const int zone = x * brdf::Zones::kCount / width;
    const float light =
        static_cast<float>(brdf::luminance_of_zone<double>(zone, brdf::Zones::kMiddleGrey, brdf::Zones::kGreyZone));
    return encoded({light, light, light});
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(pair_.width()) + static_cast<std::size_t>(x);
  }
  // With the gain, and without what is not a number: as the viewer is sent it.
  Color light_at(int x, int y, bool is_render) const {
    const float* const from = (is_render ? pair_.render : pair_.photo).rgb.data() + 3 * index(x, y);
    Color out{};
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = std::isfinite(from[c]) ? std::clamp(from[c], -65504.0f, 65504.0f) : from[c] > 0 ? 65504.0f : 0.0f;
      out[c] = is_render ? v * pair_.gain[c] : v;
    }
    return out;
  }
  Color encoded(Color light) const {
    shower_.encode(light);
    return light;
  }
  static Color map_color(float t, bool is_signed) {
    if (std::isnan(t)) return {kSurround, kSurround, kSurround};
    if (is_signed) {
      const float at = 2 * (std::clamp(t, -1.0f, 1.0f) + 1);
      const auto low = std::min<std::size_t>(static_cast<std::size_t>(at), kSignedColors.size() - 2);
      return mixed(kSignedColors[low], kSignedColors[low + 1], at - static_cast<float>(low));
    }
    const image::DisplayPicture dot = image::error_picture({1, 1, {t}, 0});
    return {static_cast<float>(dot.rgb[0]) / 255, static_cast<float>(dot.rgb[1]) / 255,
            static_cast<float>(dot.rgb[2]) / 255};
  }

  const State& state_;
  const Pair& pair_;
  view::Shower shower_;
  std::array<double, 2> limits_;
  float scale_;
  std::vector<float> flip_;
};

}  // namespace

std::array<double, 2> curve_limits(const State& state) { return exposure::curve_limits(scene_view(state), state.gt); }

std::vector<float> flip_map(const State& state, const Pair& pair) {
  const std::size_t count = pair.flaws.size();
  if (pair.photo.width == 0 || pair.render.width == 0) return std::vector<float>(count, 0);
  image::Picture render = pair.render;
  for (std::size_t i = 0; i < render.rgb.size(); ++i) render.rgb[i] *= pair.gain[i % 3];
  std::vector<float> weight(count);
  for (std::size_t i = 0; i < count; ++i) weight[i] = (pair.flaws[i] & capture::kMasked) != 0 ? 0.0f : 1.0f;
  metric::Pair both{.photo = &pair.photo, .render = &render};
  both.weight = weight;
  both.exposures = {pair.flip_exposures[0], pair.flip_exposures[1]};
  image::DisplayPicture shown_photo, shown_render;
  const auto metric = metric::metric_of(state.metric);
  if (metric == metric::Metric::kFlip) {
    const view::Shower shower(scene_view(state), exposure::float_curve(state.gt));
    shown_photo = shower.show(pair.photo);
    shown_render = shower.show(render);
    both.shown_photo = &shown_photo;
    both.shown_render = &shown_render;
  }
  return metric::map_of(metric, both).values;
}

image::DisplayPicture picture_of(const State& state, const Pair& pair) {
  const Painter painter(state, pair);
  const int width = pair.width(), height = pair.height();
  const bool is_wide = state.mode == Mode::kSide;
  image::DisplayPicture out(is_wide ? 2 * width : width, height);
  const int strip = state.wedge ? std::max(1, height / 12) : 0;
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      Color c{};
      if (y >= height - strip) {
        c = painter.wedge(x, out.width);
      } else if (is_wide) {
        c = x < width ? painter.shown(x, y, false) : painter.shown(x - width, y, true);
      } else if (state.mode == Mode::kDifference) {
        c = painter.difference(x, y);
      } else if (state.mode == Mode::kOnion) {
        c = mixed(painter.shown(x, y, false), painter.shown(x, y, true), static_cast<float>(state.mix));
      } else if (state.mode == Mode::kWipe) {
        c = painter.shown(x, y,
                          static_cast<float>(x) + 0.5f >= static_cast<float>(state.split) * static_cast<float>(width));
      } else {
        c = painter.shown(x, y, state.mode == Mode::kRender);
      }
      for (std::size_t i = 0; i < 3; ++i)
        out.at(x, y)[i] = static_cast<std::uint8_t>(255 * std::clamp(c[i], 0.0f, 1.0f) + 0.5f);
    }
  return out;
}

}  // namespace likeness::olat_pair
