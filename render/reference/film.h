#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "render/image/layers.h"
#include "render/image/picture.h"
#include "render/image/plane.h"
#include "render/reference/path.h"

namespace likeness::reference {

// Sums over the samples of each pixel. Each pixel belongs to one thread at a time; the same samples in the same order
// give the same bits, however many threads and interruptions there were.
class Film {
 public:
  Film() = default;
  Film(int width, int height, bool has_layers);

  int width() const { return width_; }
  int height() const { return height_; }
  bool has_layers() const { return !layers_.empty(); }

  // A sample that is not finite, or negative, counts as black and in rejected().
  void add(std::size_t pixel, const glm::vec3& radiance, const First* first);

  std::uint32_t samples(std::size_t pixel) const { return counts_[pixel]; }
  std::uint32_t least_samples() const;
  std::uint64_t rejected() const;

  image::Picture picture() const;

  // The expected relative mean squared error of picture(): over pixels and channels the mean of
  // variance / (mean^2 + 0.01 m^2), m the mean of the picture. The variance is that of the samples over their number, as
  // if they were independent: stratified samples do better. Infinity below two samples a pixel.
  double relative_error() const;

  // The picture; its `variance` of each pixel's mean; depth, position, normal, shading_normal, uv, base_color, emitted,
  // direct, indirect, diffuse, specular if they were kept.
  image::Layers layers() const;

  // All of it, so that work can go on later, and back. `key` says what it is a film of. Throws files::InputError, with
  // `name`, for what is no film, another film or another version.
  image::Layers state(const std::string& key) const;
  static Film of_state(const image::Layers& state, const std::string& key, const std::string& name);

 private:
  int width_ = 0, height_ = 0;
  image::Plane<std::uint32_t> counts_, rejected_;
  image::Plane<double> sums_, squares_;  // 3 for each pixel
  image::Plane<float> layers_;           // means, kLayerFloats for each pixel
};

}  // namespace likeness::reference
