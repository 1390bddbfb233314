#pragma once

#include <array>
#include <memory>
#include <span>
#include <string_view>

#include "brdf/lighting/gt_tonemap.h"
#include "render/image/picture.h"
#include "render/scene/scene.h"

// The way of linear light (Rec. 709 primaries) to a screen: exposure, then a view.
//
//   srgb     the sRGB curve alone; what is above 1 is clipped
//   gt       the Gran Turismo tonemapper on each channel (docs/models/gt_tonemap.md), then the sRGB curve
//   khronos  the Khronos PBR Neutral tonemapper (render/view/khronos_neutral.h), then the sRGB curve
//   agx      AgX, base look (render/view/agx.h)
//   aces     ACES 1.0 SDR Video for an sRGB screen (OpenColorIO's built-in transforms, no config file)
//   NAME     a view of an OpenColorIO config: scene::View::config, else $OCIO, on scene::View::display, else on the
//            config's default display. Light enters as the config's linear Rec. 709 (lin_rec709, lin_srgb and the names
//            of the ACES configs), or through its role aces_interchange, else as scene_linear.
//
// With a config or a display named, the own views are looked up there as any NAME is.
namespace likeness::view {

// The views that need no config, by name; for the parametric one, gt, the defaults.
inline constexpr std::array<std::string_view, 5> kOwnViews{"srgb", "gt", "khronos", "agx", "aces"};

// A view made ready once for many pictures. Light that is NaN is shown as black; beyond +-65504, the largest of a half,
// OpenColorIO is given that. May be used from several threads at once.
class Shower {
 public:
  // Throws files::InputError, one line: an exposure beyond +-100 stops; a config that cannot be read; a display or a
  // view that it does not have, with those that it has.
  explicit Shower(const scene::View& view, const brdf::GtTonemap<float>& gt = {});
  ~Shower();
  Shower(Shower&&) noexcept;
  Shower& operator=(Shower&&) noexcept;

  // Rows are shared among TBB's threads; the result does not depend on their number.
  image::DisplayPicture show(const image::Picture& picture) const;

  // The same before it is rounded to 8 bits, in place: interleaved RGB, linear light in, display values in [0, 1] out.
  void encode(std::span<float> rgb) const;

 private:
  struct Curve;
  std::unique_ptr<const Curve> curve_;
};

// One picture.
image::DisplayPicture show(const image::Picture& picture, const scene::View& view);

}  // namespace likeness::view
