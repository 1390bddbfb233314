#include "realis/texture/texel_surface.h"

#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace likeness::realis {
namespace {

glm::vec3 corner(const float* vertices, scene::Index index) {
  const float* p = vertices + 3 * static_cast<std::size_t>(index);
  return {p[0], p[1], p[2]};
}

}  // namespace

void over_texels(const world::World& world, scene::Index instance, const Unwrapped& unwrapped,
                 const std::function<void(std::size_t, const surface::Point&)>& f) {
  const scene::Mesh& mesh = world.scene.meshes[world.scene.instances[instance].mesh];
  const float* vertices = world.tracer.vertices(instance);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, unwrapped.pixels.size(), 1024),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      surface::Point point;
                      for (std::size_t t = range.begin(); t < range.end(); ++t) {
                        const auto& corners = mesh.triangles[unwrapped.triangles[t]];
                        const glm::vec3 a = corner(vertices, corners[0]), b = corner(vertices, corners[1]),
                                        c = corner(vertices, corners[2]);
                        glm::vec3 way = glm::cross(b - a, c - a);
                        const float length = glm::length(way);
                        way = length > 0 ? way / length : glm::vec3(0, 0, 1);
                        ray::Hit hit;
                        hit.distance = 1, hit.u = unwrapped.corners[t].x, hit.v = unwrapped.corners[t].y;
                        hit.surface = instance, hit.triangle = unwrapped.triangles[t], hit.normal = way;
                        for (const float side : {1.0f, -1.0f}) {
                          ray::Ray ray;
                          ray.direction = -side * way;
                          world.surfaces.at<surface::Detail::kTextures>(ray, hit, point);
                          if (!point.is_back) break;
                        }
                        f(t, point);
                      }
                    });
}

TexelSurface surface_of(const world::World& world, scene::Index instance, const Unwrapped& unwrapped) {
  TexelSurface out;
  out.positions.resize(unwrapped.pixels.size());
  out.geometric.resize(unwrapped.pixels.size());
  out.normals.resize(unwrapped.pixels.size());
  over_texels(world, instance, unwrapped, [&](std::size_t t, const surface::Point& point) {
    out.positions[t] = point.position, out.geometric[t] = point.normal, out.normals[t] = point.shading_normal;
  });
  return out;
}

TexelStep step_of(const world::World& world, scene::Index instance, std::uint32_t triangle, int size) {
  const scene::Mesh& mesh = world.scene.meshes[world.scene.instances[instance].mesh];
  const float* vertices = world.tracer.vertices(instance);
  const auto& i = mesh.triangles[triangle];
  const glm::dvec3 a(corner(vertices, i[0])), ab = glm::dvec3(corner(vertices, i[1])) - a,
                                              ac = glm::dvec3(corner(vertices, i[2])) - a;
  const glm::dvec2 origin(mesh.uvs[i[0]]), b = static_cast<double>(size) * (glm::dvec2(mesh.uvs[i[1]]) - origin),
                                           c = static_cast<double>(size) * (glm::dvec2(mesh.uvs[i[2]]) - origin);
  const double area = b.x * c.y - c.x * b.y;
  if (!(std::abs(area) > 1e-12)) return {};
  return {(ab * c.y - ac * b.y) / area, (ac * b.x - ab * c.x) / area};
}

}  // namespace likeness::realis
