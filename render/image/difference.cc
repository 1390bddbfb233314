#include "render/image/difference.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace likeness::image {
namespace {

constexpr int kWindow = 11;
constexpr double kSigma = 1.5;

void check_same_size(const DisplayPicture& photo, const DisplayPicture& render) {
  if (photo.width == render.width && photo.height == render.height) return;
  const auto size = [](const DisplayPicture& p) { return std::to_string(p.width) + " x " + std::to_string(p.height); };
  throw std::invalid_argument("difference of pictures: photo is " + size(photo) + ", render is " + size(render) +
                              "; both must have the same size");
}

using LumaPlane = std::vector<double>;

LumaPlane luma(const DisplayPicture& picture) {
  LumaPlane out(picture.rgb.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = 0.2126 * picture.rgb[3 * i] + 0.7152 * picture.rgb[3 * i + 1] + 0.0722 * picture.rgb[3 * i + 2];
  return out;
}

LumaPlane product(const LumaPlane& a, const LumaPlane& b) {
  LumaPlane out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] * b[i];
  return out;
}

std::array<double, kWindow> gaussian() {
  std::array<double, kWindow> weights{};
  double sum = 0;
  for (int i = 0; i < kWindow; ++i) {
    const int from_middle = i - kWindow / 2;
    sum += weights[i] = std::exp(-0.5 * from_middle * from_middle / (kSigma * kSigma));
  }
  for (double& w : weights) w /= sum;
  return weights;
}

// Weighted means over every window that lies inside: (width - 10) x (height - 10). The Gaussian separates.
LumaPlane windowed(const LumaPlane& plane, int width, int height) {
  static const std::array<double, kWindow> kWeights = gaussian();
  const int inner_width = width - kWindow + 1, inner_height = height - kWindow + 1;
  LumaPlane rows(static_cast<std::size_t>(inner_width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < inner_width; ++x) {
      double sum = 0;
      for (int k = 0; k < kWindow; ++k) sum += kWeights[k] * plane[y * width + x + k];
      rows[y * inner_width + x] = sum;
    }
  LumaPlane out(static_cast<std::size_t>(inner_width) * static_cast<std::size_t>(inner_height));
  for (int y = 0; y < inner_height; ++y)
    for (int x = 0; x < inner_width; ++x) {
      double sum = 0;
      for (int k = 0; k < kWindow; ++k) sum += kWeights[k] * rows[(y + k) * inner_width + x];
      out[y * inner_width + x] = sum;
    }
  return out;
}

}  // namespace

double psnr(const DisplayPicture& photo, const DisplayPicture& render) {
  check_same_size(photo, render);
  double sum = 0;
  for (std::size_t i = 0; i < photo.rgb.size(); ++i) {
    const double d = static_cast<double>(photo.rgb[i]) - static_cast<double>(render.rgb[i]);
    sum += d * d;
  }
  if (sum == 0) return std::numeric_limits<double>::infinity();
  return 10 * std::log10(255.0 * 255.0 * static_cast<double>(photo.rgb.size()) / sum);
}

double ssim(const DisplayPicture& photo, const DisplayPicture& render) {
  check_same_size(photo, render);
  const int width = photo.width, height = photo.height;
  if (width < kWindow || height < kWindow)
    throw std::invalid_argument("ssim: the pictures are " + std::to_string(width) + " x " + std::to_string(height) +
                                "; both sides must be at least 11, the size of the window");
  constexpr double kC1 = 0.01 * 255 * 0.01 * 255, kC2 = 0.03 * 255 * 0.03 * 255;
  const LumaPlane x = luma(photo), y = luma(render);
  const LumaPlane mean_x = windowed(x, width, height), mean_y = windowed(y, width, height);
  const LumaPlane xx = windowed(product(x, x), width, height), yy = windowed(product(y, y), width, height),
                  xy = windowed(product(x, y), width, height);
  double sum = 0;
  for (std::size_t i = 0; i < mean_x.size(); ++i) {
    const double mx = mean_x[i], my = mean_y[i];
    const double var_x = xx[i] - mx * mx, var_y = yy[i] - my * my, covariance = xy[i] - mx * my;
    sum += (2 * mx * my + kC1) * (2 * covariance + kC2) / ((mx * mx + my * my + kC1) * (var_x + var_y + kC2));
  }
  return sum / static_cast<double>(mean_x.size());
}

}  // namespace likeness::image
