#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "brdf/any_brdf.h"
#include "render/capture/capture.h"
#include "render/capture/sight.h"
#include "render/image/picture.h"

// Renders of a capture that has normals and no scene: each pixel is a piece of surface with the normal of the camera's
// layer and the one color that explains its photographs best. Nothing casts a shadow and light is not scattered twice, so
// what differs from the photograph is shadow, interreflection, highlights and wrong normals.
//
//     render(light) = color * s(light),   s = f(l, v) cos_i for a distant light,  f(l, v) cos_i / d^2 for a near one
//
// with f = 1 / pi (Lambert), or a material's. color is the least-squares fit of the photographs over s, channel by
// channel, over the lights that the surface faces; then once more without those that are off by more than half
// (highlights and cast shadows).
namespace likeness::olat_render {

class NormalRenderer {
 public:
  // Reads the photographs of the camera, one at a time, and asks `goes_on` in between; throws files::Interrupted if it
  // says no. Throws files::InputError, and files::UsageError for what cannot be shaded: no normals, a light without a
  // place, a near light without positions of the surface.
  template <class GoesOn>
  NormalRenderer(const capture::Capture& capture, std::size_t camera, const std::optional<brdf::AnyBrdf>& material,
                 const GoesOn& goes_on)
      : NormalRenderer(capture, camera, material) {
    for (int round = 0; round < kRounds; ++round) {
      begin_round();
      for (std::size_t light = 0; light < capture.lights.size(); ++light) {
        goes_on(static_cast<double>(static_cast<std::size_t>(round) * capture.lights.size() + light) /
                static_cast<double>(kRounds * capture.lights.size()));
        add_photo(light, round);
      }
      end_round();
    }
  }

  image::Picture render(std::size_t light) const;
  // The fitted colors: reflectance for Lambert, a factor of the material otherwise. 0 without a normal.
  const image::Picture& colors() const { return colors_; }

 private:
  static constexpr int kRounds = 2;
  NormalRenderer(const capture::Capture& capture, std::size_t camera, const std::optional<brdf::AnyBrdf>& material);
  void begin_round();
  void add_photo(std::size_t light, int round);
  void end_round();
  image::Picture shading(std::size_t light) const;

  const capture::Capture& capture_;
  std::size_t camera_;
  std::optional<brdf::AnyBrdf> material_;
  capture::FrameTable frames_;
  image::Picture normals_;
  capture::Positions positions_;
  image::Picture colors_;
  std::vector<double> photo_shading_, shading_shading_;  // sums of p s and s s, three a pixel
};

}  // namespace likeness::olat_render
