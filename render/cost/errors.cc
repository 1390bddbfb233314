#include "render/cost/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "render/image/light_error.h"
#include "render/world/camera.h"

namespace likeness::scene_cost {

std::vector<std::uint8_t> mask_of(const world::World& world, std::size_t index) {
  const world::Camera camera(world.scene.cameras[index]);
  std::vector<std::uint8_t> mask;
  mask.reserve(static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height()));
  constexpr int kMostLightsPassed = 64;
  for (int y = 0; y < camera.height(); ++y)
    for (int x = 0; x < camera.width(); ++x) {
      ray::Ray ray = camera.ray(glm::vec2(x, y) + 0.5f);
      ray::Hit hit = world.tracer.closest(ray);
      for (int i = 0; hit.is_some() && hit.surface >= world.scene.instances.size() && i < kMostLightsPassed; ++i) {
        ray.near = hit.distance * (1 + 1e-5f);
        hit = world.tracer.closest(ray);
      }
      mask.push_back(hit.is_some() && hit.surface < world.scene.instances.size() ? 1 : 0);
    }
  return mask;
}

Judge::Judge(image::Picture reference, std::vector<std::uint8_t> mask, const scene::View& view)
    : reference_(std::move(reference)),
      mask_(std::move(mask)),
      shower_(view),
      shown_(shower_.show(reference_)),
      epsilon_(0.01 * std::exp2(-2 * view.ev)) {}

double Judge::share_of_surfaces() const {
  const auto count = std::count(mask_.begin(), mask_.end(), std::uint8_t{1});
  return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(mask_.size(), 1));
}

Judge::Verdict Judge::judge(const image::Picture& picture) const {
  Verdict out;
  out.shown = shower_.show(picture);
  out.map = image::flip(shown_, out.shown);
  out.errors.flip = out.map.mean;
  out.errors.relmse = image::relative_mse(reference_, picture, epsilon_).value;
  const image::StopsError stops = image::error_in_stops(reference_, picture, 1e-3, mask_);
  const double none = std::numeric_limits<double>::quiet_NaN();
  out.errors.stops_median = stops.pixels > 0 ? stops.median : none;
  out.errors.stops_p95 = stops.pixels > 0 ? stops.p95 : none;
  return out;
}

image::DisplayPicture reduced(const image::DisplayPicture& picture, int most) {
  const int by = (picture.width + most - 1) / most;
  if (by <= 1) return picture;
  image::DisplayPicture out((picture.width + by - 1) / by, (picture.height + by - 1) / by);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      int sum[3] = {0, 0, 0}, count = 0;
      for (int v = y * by; v < std::min((y + 1) * by, picture.height); ++v)
        for (int u = x * by; u < std::min((x + 1) * by, picture.width); ++u, ++count)
          for (std::size_t c = 0; c < 3; ++c) sum[c] += picture.at(u, v)[c];
      for (std::size_t c = 0; c < 3; ++c) out.at(x, y)[c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
    }
  return out;
}

}  // namespace likeness::scene_cost
