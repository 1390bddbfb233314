#include "realis/texture/sight.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "render/files/files.h"
#include "render/ray/offset.h"
#include "render/scene/read_scene.h"

namespace likeness::realis {
namespace {

constexpr double kJump = 4;           // of a surface from one pixel to the next, over a pixel's width on it
constexpr double kLeastCosine = 0.1;  // that a slant counts for there
constexpr std::size_t kAtOnce = 1 << 14;

}  // namespace

Projection::Projection(const capture::Camera& camera)
    : camera_(camera),
      camera_from_world_(glm::inverse(camera.world_from_camera)),
      inverse_(glm::inverse(camera.intrinsics)),
      position_(camera.world_from_camera[3]),
      axis_(camera.world_from_camera[2]) {
  if (!camera.is_undistorted)
    throw files::UsageError("camera " + files::in_quotes(camera.id) +
                            " has photographs with lens distortion; `likeness olat calibrate CAPTURE --undistort --out "
                            "NEW` undoes it");
}

Projection::Place Projection::of(const glm::dvec3& point) const {
  const glm::dvec3 p(camera_from_world_ * glm::dvec4(point, 1));
  if (camera_.is_orthographic) {
    const glm::dvec3 q = camera_.intrinsics * glm::dvec3(p.x, p.y, 1);
    return {q.x, q.y, 1};
  }
  const glm::dvec3 q = camera_.intrinsics * p;
  return {q.x / q.z, q.y / q.z, p.z};
}

std::array<double, 2> Projection::moved(const glm::dvec3& point, const glm::dvec3& step) const {
  const glm::dvec3 d(glm::dmat3(camera_from_world_) * step);
  if (camera_.is_orthographic) {
    const glm::dvec3 q = camera_.intrinsics * glm::dvec3(d.x, d.y, 0);
    return {q.x, q.y};
  }
  const glm::dvec3 q = camera_.intrinsics * glm::dvec3(camera_from_world_ * glm::dvec4(point, 1));
  const glm::dvec3 dq = camera_.intrinsics * d;
  return {(dq.x - q.x / q.z * dq.z) / q.z, (dq.y - q.y / q.z * dq.z) / q.z};
}

glm::dvec3 Projection::to_view(const glm::dvec3& point) const {
  return camera_.is_orthographic ? -axis_ : glm::normalize(position_ - point);
}

ray::Ray Projection::ray(int x, int y) const {
  const glm::dmat3 turn(camera_.world_from_camera);
  const glm::dvec3 on_picture = inverse_ * glm::dvec3(x + 0.5, y + 0.5, 1);
  ray::Ray out;
  if (camera_.is_orthographic) {
    out.origin = glm::vec3(position_ + turn * glm::dvec3(on_picture.x, on_picture.y, -back_));
    out.direction = glm::vec3(axis_);
  } else {
    out.origin = glm::vec3(position_);
    out.direction = glm::vec3(glm::normalize(turn * on_picture));
  }
  return out;
}

double Projection::pixel_width(double depth) const {
  return camera_.is_orthographic ? 1 / camera_.intrinsics[0][0] : depth / camera_.intrinsics[0][0];
}

namespace {

// What the middles of all pixels see of the object.
PictureSurface picture_of(const world::World& world, scene::Index instance, const capture::Camera& camera,
                          const Projection& projection) {
  const auto width = static_cast<std::size_t>(camera.width), height = static_cast<std::size_t>(camera.height);
  std::vector<std::uint8_t> is_there(width * height, 0);
  std::vector<glm::vec3> positions(width * height), normals(width * height);
  std::vector<float> reach(width * height);  // how far the surface may be at the next pixel [m]
  tbb::parallel_for(std::size_t{0}, height, [&](std::size_t y) {
    std::vector<ray::Ray> rays(width);
    std::vector<ray::Hit> hits(width);
    for (std::size_t x = 0; x < width; ++x) rays[x] = projection.ray(static_cast<int>(x), static_cast<int>(y));
    world.tracer.closest(rays, hits);
    surface::Point point;
    for (std::size_t x = 0; x < width; ++x) {
      if (hits[x].surface != instance) continue;
      world.surfaces.at<surface::Detail::kTextures>(rays[x], hits[x], point);
      if (point.is_back) continue;
      const std::size_t at = y * width + x;
      const double depth = projection.of(glm::dvec3(point.position)).depth;
      const double cosine = static_cast<double>(std::abs(glm::dot(point.normal, rays[x].direction)));
      is_there[at] = 1, positions[at] = point.position, normals[at] = point.shading_normal;
      reach[at] = static_cast<float>(kJump * projection.pixel_width(depth) / std::max(cosine, kLeastCosine));
    }
  });
  PictureSurface out;
  const auto joins = [&](std::size_t a, std::size_t b) {
    return is_there[b] != 0 && glm::length(positions[a] - positions[b]) <= std::max(reach[a], reach[b]);
  };
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t at = y * width + x;
      if (is_there[at] == 0) continue;
      // The end of the picture is no end of the object.
      if ((x > 0 && !joins(at, at - 1)) || (x + 1 < width && !joins(at, at + 1)) || (y > 0 && !joins(at, at - width)) ||
          (y + 1 < height && !joins(at, at + width)))
        continue;
      out.pixels.push_back(static_cast<std::uint32_t>(at));
      out.positions.push_back(positions[at]), out.normals.push_back(normals[at]);
    }
  return out;
}

}  // namespace

CameraSight sight_of(const world::World& world, scene::Index instance, const Unwrapped& unwrapped,
                     const TexelSurface& surface, const capture::Camera& camera) {
  Projection projection(camera);
  const scene::Bounds all = scene::bounds(world.scene);
  if (projection.is_orthographic() && !all.is_empty())
    projection.step_back(static_cast<double>(glm::length(all.high - all.low)) +
                         glm::length(glm::dvec3(all.low + all.high) * 0.5 - projection.position()));
  CameraSight out;
  out.picture = picture_of(world, instance, camera, projection);

  std::vector<Seen> found(std::min(kAtOnce, unwrapped.pixels.size()));
  std::vector<std::uint8_t> is_seen(found.size());
  for (std::size_t begin = 0; begin < unwrapped.pixels.size(); begin += kAtOnce) {
    const std::size_t end = std::min(begin + kAtOnce, unwrapped.pixels.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, 256), [&](const auto& range) {
      for (std::size_t t = range.begin(); t < range.end(); ++t) {
        is_seen[t - begin] = 0;
        const glm::dvec3 p(surface.positions[t]);
        const glm::dvec3 to_view = projection.to_view(p);
        if (!(glm::dot(glm::dvec3(surface.geometric[t]), to_view) > 0)) continue;
        const Projection::Place place = projection.of(p);
        if (!(place.depth > 0 && place.x >= 0 && place.y >= 0 && place.x < camera.width && place.y < camera.height))
          continue;
        ray::Ray ray;
        ray.origin = ray::beside(surface.positions[t], surface.geometric[t]);
        ray.direction = projection.is_orthographic() ? glm::vec3(to_view)
                                                     : glm::vec3(projection.position() - glm::dvec3(ray.origin));
        ray.far = projection.is_orthographic() ? ray::kFar : 1.0f;
        if (world.tracer.occluded(ray)) continue;
        const TexelStep step = step_of(world, instance, unwrapped.triangles[t], unwrapped.size);
        const auto r = projection.moved(p, step.right), d = projection.moved(p, step.down);
        // Of the inverse of (r d), in clip space: from -1 to 1 across the picture.
        const double area = r[0] * d[1] - r[1] * d[0];
        const double along_x = (d[1] * d[1] + r[1] * r[1]) * camera.width * camera.width / 4.0;
        const double along_y = (d[0] * d[0] + r[0] * r[0]) * camera.height * camera.height / 4.0;
        const double gradient =
            std::abs(area) > 1e-12 ? std::sqrt(along_x + along_y) / std::abs(area) / unwrapped.size : 0;
        found[t - begin] = {static_cast<std::uint32_t>(t),
                            static_cast<float>(place.x),
                            static_cast<float>(place.y),
                            {static_cast<float>(r[0]), static_cast<float>(r[1])},
                            {static_cast<float>(d[0]), static_cast<float>(d[1])},
                            static_cast<float>(gradient)};
        is_seen[t - begin] = 1;
      }
    });
    for (std::size_t i = 0; i < end - begin; ++i)
      if (is_seen[i] != 0) out.seen.push_back(found[i]);
  }
  return out;
}

void stretch_all(std::vector<CameraSight>& sights, const weight::StretchSettings& settings) {
  struct Weighted {
    float gradient, pixels;
  };
  std::vector<Weighted> all;
  double total = 0;
  for (const CameraSight& sight : sights)
    for (const Seen& seen : sight.seen) {
      const float pixels = std::abs(seen.right[0] * seen.down[1] - seen.right[1] * seen.down[0]);
      if (seen.gradient > 0 && std::isfinite(seen.gradient)) all.push_back({seen.gradient, pixels});
    }
  std::sort(all.begin(), all.end(), [](const Weighted& a, const Weighted& b) {
    return a.gradient != b.gradient ? a.gradient < b.gradient : a.pixels < b.pixels;
  });
  for (const Weighted& w : all) total += static_cast<double>(w.pixels);
  double median = 0, passed = 0;
  for (const Weighted& w : all) {
    passed += static_cast<double>(w.pixels), median = static_cast<double>(w.gradient);
    if (passed >= 0.5 * total) break;
  }
  for (CameraSight& sight : sights)
    for (Seen& seen : sight.seen)
      seen.strength = median > 0 && seen.gradient > 0
                          ? static_cast<float>(stretch_strength(static_cast<double>(seen.gradient) / median, settings))
                          : 0.0f;
}

}  // namespace likeness::realis
