#include "render/view/view.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "brdf/lighting/gt_tonemap.h"
#include "render/files/files.h"
#include "render/image/tone_curve.h"
#include "render/view/color_config.h"

namespace likeness::view {

struct Shower::Curve {
  enum class Kind : std::uint8_t { kSrgb, kGt, kConfig };
  Kind kind = Kind::kSrgb;
  double scale = 1;
  brdf::GtTonemap<float> gt;
  PixelTransform transform;
};

Shower::Shower(const scene::View& view) {
  constexpr double kMostStops = 100;
  if (!(std::abs(view.ev) <= kMostStops))
    throw files::InputError("view: ev = " + files::number_text(view.ev) +
                            " is outside [-100, 100] (stops of exposure)");
  auto curve = std::make_unique<Curve>();
  curve->scale = std::exp2(view.ev);
  const bool is_own = view.config.empty() && view.display.empty();
  if (is_own && view.name == "srgb") {
    curve->kind = Curve::Kind::kSrgb;
  } else if (is_own && view.name == "gt") {
    curve->kind = Curve::Kind::kGt;
  } else {
    curve->kind = Curve::Kind::kConfig;
    curve->transform =
        is_own && view.name == "aces" ? aces_view() : view_of_config(view.config, view.display, view.name);
  }
  curve_ = std::move(curve);
}

Shower::~Shower() = default;
Shower::Shower(Shower&&) noexcept = default;
Shower& Shower::operator=(Shower&&) noexcept = default;

image::DisplayPicture Shower::show(const image::Picture& picture) const {
  const Curve& curve = *curve_;
  image::DisplayPicture out(picture.width, picture.height);
  const std::size_t row = 3 * static_cast<std::size_t>(picture.width);
  // Products in double: the scale of 100 stops and a small light have a float only together.
  const auto exposed = [&](float v) {
    return static_cast<float>(std::clamp(curve.scale * static_cast<double>(v), -1e38, 1e38));
  };
  const auto show_row = [&](std::size_t y, std::vector<float>& light) {
    const float* const from = picture.rgb.data() + y * row;
    std::uint8_t* const to = out.rgb.data() + y * row;
    switch (curve.kind) {
      case Curve::Kind::kSrgb:
        for (std::size_t i = 0; i < row; ++i) to[i] = image::srgb_encode8(exposed(from[i]));
        break;
      case Curve::Kind::kGt:
        for (std::size_t i = 0; i < row; ++i) to[i] = image::srgb_encode8(curve.gt.eval(exposed(from[i])));
        break;
      case Curve::Kind::kConfig:
        light.resize(row);
        for (std::size_t i = 0; i < row; ++i) {
          const float v = exposed(from[i]);
          light[i] = std::isnan(v) ? 0 : std::clamp(v, -65504.0f, 65504.0f);
        }
        curve.transform(light.data(), picture.width);
        for (std::size_t i = 0; i < row; ++i) {
          const float v = light[i] > 0 ? std::min(light[i], 1.0f) : 0;  // NaN is 0
          to[i] = static_cast<std::uint8_t>(255 * v + 0.5f);
        }
        break;
    }
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, static_cast<std::size_t>(picture.height), 4),
                    [&](const auto& rows) {
                      std::vector<float> light;
                      for (std::size_t y = rows.begin(); y != rows.end(); ++y) show_row(y, light);
                    });
  return out;
}

image::DisplayPicture show(const image::Picture& picture, const scene::View& view) {
  return Shower(view).show(picture);
}

}  // namespace likeness::view
