#include "olat/calibrate/lens.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "olat/calibrate/call_opencv.h"
#include "render/files/files.h"

namespace likeness::olat_calibrate {
namespace {

using capture::Camera;
using capture::Lens;
using image::Picture;

// OpenCV's pixels have their middles at whole numbers, a capture's at halves.
constexpr double kMiddle = 0.5;

// What is undone: of a camera without distortion, nothing.
likeness_lens lens_of(const Camera& camera) {
  static constexpr std::array<double, 8> kStraight{};
  const glm::dmat3& k = camera.intrinsics;
  const bool is_fisheye = camera.lens == Lens::kFisheye && !camera.is_undistorted;
  return {.focal_x = k[0][0],
          .focal_y = k[1][1],
          .center_x = k[2][0] - kMiddle,
          .center_y = k[2][1] - kMiddle,
          .is_fisheye = is_fisheye,
          .terms = static_cast<int>(capture::kLensTerms[is_fisheye ? 1 : 0]),
          .distortion = camera.is_undistorted ? kStraight.data() : camera.distortion.data()};
}

// Distance from the middle, of a point at r, by the radial terms alone.
double bent(const Camera& camera, double r) {
  const auto& k = camera.distortion;
  if (camera.lens == Lens::kFisheye) {
    const double t = std::atan(r), q = t * t;
    return t * (1 + q * (k[0] + q * (k[1] + q * (k[2] + q * k[3]))));
  }
  const double q = r * r;
  return r * (1 + q * (k[0] + q * (k[1] + q * k[4]))) / (1 + q * (k[5] + q * (k[6] + q * k[7])));
}

// Up to where the lens keeps order [x / z]; beyond it a polynomial turns back, and would show the photo a second time.
double last_radius(const Camera& camera, double largest) {
  constexpr int kSteps = 4096;
  double before = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double r = largest * i / kSteps, now = bent(camera, r);
    if (!(now > before)) return largest * (i - 1) / kSteps;
    before = now;
  }
  return largest;
}

// Weights of the pixels -1, 0, 1 and 2 at t in [0, 1) between 0 and 1: the cubic that keeps ramps and parabolas as they
// are (Keys 1981, a = -1/2). OpenCV's (a = -3/4) moves an edge by up to 0.06 pixel.
std::array<double, 4> catmull_rom(double t) {
  return {t * (-0.5 + t * (1 - 0.5 * t)), 1 + t * t * (-2.5 + 1.5 * t), t * (0.5 + t * (2 - 1.5 * t)),
          t * t * (-0.5 + 0.5 * t)};
}

}  // namespace

bool is_bent(const Camera& camera) { return !camera.is_undistorted || camera.intrinsics[1][0] != 0; }

Camera straightened(const Camera& camera) {
  Camera out = camera;
  out.lens = Lens::kBrownConrady;
  out.distortion = {};
  out.is_undistorted = true;
  out.intrinsics[1][0] = 0;
  return out;
}

Straightener::Straightener(const Camera& camera) : width_(camera.width), height_(camera.height) {
  const auto refuse = [&](const std::string& text) {
    throw files::UsageError("camera " + files::in_quotes(camera.id) + " " + text);
  };
  if (camera.is_orthographic) refuse("is orthographic; distortion is undone of pictures that a lens projects");
  const auto width = static_cast<std::size_t>(width_), count = width * static_cast<std::size_t>(height_);
  x_.resize(count), y_.resize(count), inside_.resize(count);
  const likeness_lens lens = lens_of(camera);
  call_opencv<likeness_lens_map_function>(kLensMapName, &lens, width_, height_, x_.data(), y_.data());

  const double skew = camera.intrinsics[1][0] / lens.focal_y;  // OpenCV has none
  const double far_x = std::max(lens.center_x, width_ - lens.center_x) / lens.focal_x + 1e-9,
               far_y = std::max(lens.center_y, height_ - lens.center_y) / lens.focal_y + 1e-9;
  const double farthest = std::hypot(far_x, far_y),
               last = camera.is_undistorted ? farthest : last_radius(camera, farthest);
  const float right = static_cast<float>(width_ - kMiddle), bottom = static_cast<float>(height_ - kMiddle);
  for (std::size_t i = 0; i < count; ++i) {
    float &x = x_[i], &y = y_[i];
    x += static_cast<float>(skew * (static_cast<double>(y) - lens.center_y));
    const double r = std::hypot((static_cast<double>(i % width) - lens.center_x) / lens.focal_x,
                                (static_cast<double>(i / width) - lens.center_y) / lens.focal_y);
    inside_[i] = r <= last && x >= -0.5f && y >= -0.5f && x <= right && y <= bottom;
  }
}

Picture Straightener::smooth(const Picture& photo) const {
  Picture out(width_, height_);
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    if (inside_[i] == 0) continue;
    const float x = std::floor(x_[i]), y = std::floor(y_[i]);
    const auto across = catmull_rom(static_cast<double>(x_[i] - x)), down = catmull_rom(static_cast<double>(y_[i] - y));
    std::array<double, 3> sum{};
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) {
        const auto from = photo.at(std::clamp(static_cast<int>(x) - 1 + k, 0, width_ - 1),
                                   std::clamp(static_cast<int>(y) - 1 + j, 0, height_ - 1));
        const double weight = across[static_cast<std::size_t>(k)] * down[static_cast<std::size_t>(j)];
        for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * static_cast<double>(from[c]);
      }
    for (std::size_t c = 0; c < 3; ++c) out.rgb[3 * i + c] = static_cast<float>(sum[c]);
  }
  return out;
}

Picture Straightener::nearest(const Picture& photo) const {
  Picture out(width_, height_);
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    if (inside_[i] == 0) continue;
    const auto from = photo.at(std::clamp(static_cast<int>(std::lround(x_[i])), 0, width_ - 1),
                               std::clamp(static_cast<int>(std::lround(y_[i])), 0, height_ - 1));
    std::copy(from.begin(), from.end(), out.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return out;
}

std::vector<std::uint8_t> Straightener::touched(const std::vector<std::uint8_t>& flags) const {
  constexpr int kReach = 2;  // of the bicubic's four pixels from the nearest one
  std::vector<std::uint8_t> out(flags.size());
  if (std::find(flags.begin(), flags.end(), 1) == flags.end()) return out;
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    if (inside_[i] == 0) continue;
    const int x = static_cast<int>(std::lround(x_[i])), y = static_cast<int>(std::lround(y_[i]));
    for (int v = std::max(0, y - kReach); v <= std::min(height_ - 1, y + kReach); ++v)
      for (int u = std::max(0, x - kReach); u <= std::min(width_ - 1, x + kReach); ++u)
        for (std::size_t c = 0; c < 3; ++c)
          out[3 * i + c] |=
              flags[3 * (static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)) +
                    c];
  }
  return out;
}

std::array<double, 2> in_photo(const Camera& camera, double x, double y) {
  const likeness_lens lens = lens_of(camera);
  std::array<double, 2> at{x, y};
  call_opencv<likeness_bend_function>(kBendName, &lens, at.data(), 1);
  at[0] += camera.intrinsics[1][0] / lens.focal_y * (at[1] - lens.center_y);
  return {at[0] + kMiddle, at[1] + kMiddle};
}

}  // namespace likeness::olat_calibrate
