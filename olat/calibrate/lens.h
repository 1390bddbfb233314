#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/capture/capture.h"
#include "render/image/picture.h"

// The picture that a pinhole would have taken in the place of a lens that bends lines.
namespace likeness::olat_calibrate {

// Whether the files of a camera are other than those of a pinhole without skew.
bool is_bent(const capture::Camera& camera);

// The camera of the straightened picture: of the same size, place, focal lengths and center, without distortion and skew.
capture::Camera straightened(const capture::Camera& camera);

// Where each pixel of the straightened picture lies in the photo, and the picture there. A pixel is outside if the photo
// does not reach so far, or if the lens's polynomial turns back before it.
class Straightener {
 public:
  // Throws files::UsageError for an orthographic camera.
  explicit Straightener(const capture::Camera& camera);

  // Bicubic; 0 outside. A constant photo stays constant to 2e-7 of its value.
  image::Picture smooth(const image::Picture& photo) const;
  // The nearest pixel, for what has no mean; 0 outside.
  image::Picture nearest(const image::Picture& photo) const;
  // Likewise of single values, three a pixel: what is set within the 5 x 5 pixels that smooth may have read.
  std::vector<std::uint8_t> touched(const std::vector<std::uint8_t>& flags) const;
  // 1 where the photo shows what a pixel asks for.
  const std::vector<std::uint8_t>& inside() const { return inside_; }

 private:
  int width_, height_;
  std::vector<float> x_, y_;  // of OpenCV's pixels in the photo
  std::vector<std::uint8_t> inside_;
};

// Where a point of the camera (x / z, y / z) lies in its photo [pixel, from the top left corner].
std::array<double, 2> in_photo(const capture::Camera& camera, double x, double y);

}  // namespace likeness::olat_calibrate
