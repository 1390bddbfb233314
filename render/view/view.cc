#include "render/view/view.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "render/files/files.h"
#include "render/image/tone_curve.h"
#include "render/view/agx.h"
#include "render/view/color_config.h"
#include "render/view/khronos_neutral.h"

namespace likeness::view {

struct Shower::Curve {
  enum class Kind : std::uint8_t { kSrgb, kGt, kKhronos, kAgx, kConfig };
  Kind kind = Kind::kSrgb;
  double scale = 1;
  brdf::GtTonemap<float> gt;
  PixelTransform transform;

  // Products in double: the scale of 100 stops and a small light have a float only together.
  float exposed(float v) const { return static_cast<float>(std::clamp(scale * static_cast<double>(v), -1e38, 1e38)); }
};

namespace {

// Three floats of a row through a tonemapper of colors.
template <class Tonemapper>
void through(std::span<float> rgb) {
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    const std::array<float, 3> out = Tonemapper::eval({rgb[i], rgb[i + 1], rgb[i + 2]});
    std::copy(out.begin(), out.end(), rgb.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

Shower::Shower(const scene::View& view, const brdf::GtTonemap<float>& gt) {
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
    curve->gt = gt;
  } else if (is_own && view.name == "khronos") {
    curve->kind = Curve::Kind::kKhronos;
  } else if (is_own && view.name == "agx") {
    curve->kind = Curve::Kind::kAgx;
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

void Shower::encode(std::span<float> rgb) const {
  const Curve& curve = *curve_;
  using Kind = Curve::Kind;
  for (float& v : rgb) v = curve.exposed(v);
  switch (curve.kind) {
    case Kind::kSrgb:
      break;
    case Kind::kGt:
      for (float& v : rgb) v = curve.gt.eval(v);
      break;
    case Kind::kKhronos:
      through<KhronosNeutral>(rgb);
      break;
    case Kind::kAgx:
      through<Agx>(rgb);
      return;
    case Kind::kConfig:
      for (float& v : rgb) v = std::isnan(v) ? 0 : std::clamp(v, -65504.0f, 65504.0f);
      curve.transform(rgb.data(), static_cast<long>(rgb.size() / 3));
      break;
  }
  if (curve.kind != Kind::kConfig)
    for (float& v : rgb) v = static_cast<float>(image::srgb_encode(static_cast<double>(v)));
  for (float& v : rgb) v = v > 0 ? std::min(v, 1.0f) : 0;  // NaN is 0
}

image::DisplayPicture Shower::show(const image::Picture& picture) const {
  const Curve& curve = *curve_;
  using Kind = Curve::Kind;
  image::DisplayPicture out(picture.width, picture.height);
  const std::size_t row = 3 * static_cast<std::size_t>(picture.width);
  // Where the sRGB curve comes last, its thresholds are faster than its power.
  const auto show_row = [&](std::size_t y, std::vector<float>& light) {
    const float* const from = picture.rgb.data() + y * row;
    std::uint8_t* const to = out.rgb.data() + y * row;
    switch (curve.kind) {
      case Kind::kSrgb:
        for (std::size_t i = 0; i < row; ++i) to[i] = image::srgb_encode8(curve.exposed(from[i]));
        break;
      case Kind::kGt:
        for (std::size_t i = 0; i < row; ++i) to[i] = image::srgb_encode8(curve.gt.eval(curve.exposed(from[i])));
        break;
      case Kind::kKhronos:
        light.resize(row);
        std::transform(from, from + row, light.begin(), [&](float v) { return curve.exposed(v); });
        through<KhronosNeutral>(light);
        for (std::size_t i = 0; i < row; ++i) to[i] = image::srgb_encode8(light[i]);
        break;
      case Kind::kAgx:
      case Kind::kConfig:
        light.assign(from, from + row);
        encode(light);
        for (std::size_t i = 0; i < row; ++i) to[i] = static_cast<std::uint8_t>(255 * light[i] + 0.5f);
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
