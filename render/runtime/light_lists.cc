#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/runtime/pass.h"

namespace likeness::runtime {
namespace {

template <class... F>
struct Cases : F... {
  using F::operator()...;
};

float distance_to(const Tile& tile, const glm::vec3& p) { return glm::distance(p, glm::clamp(p, tile.low, tile.high)); }

// Whether some surface of the tile may face something within `reach` of `center`: conservative. A tile's surfaces are in
// a sphere; every direction from it to the light is within an angle of that between the centers, and every normal within
// the cone.
bool may_face(const Tile& tile, const glm::vec3& center, float reach) {
  if (tile.cosine <= 0) return true;
  const glm::vec3 middle = 0.5f * (tile.low + tile.high), way = center - middle;
  const float distance = glm::length(way), spread = reach + 0.5f * glm::length(tile.high - tile.low);
  if (distance <= spread) return true;
  // A surface faces it if the angle between normal and light is below 90 degrees:
  // angle(axis, way) - cone - spread < 90 degrees.
  const float angle = std::acos(glm::clamp(glm::dot(tile.axis, way) / distance, -1.0f, 1.0f));
  return angle - std::acos(tile.cosine) - std::asin(spread / distance) < 1.5708f;
}

bool may_reach(const Tile& tile, const scene::Light& light) {
  const auto in_range = [&](const glm::vec3& center, float reach) {
    return light.range == scene::kForever || distance_to(tile, center) < light.range + reach;
  };
  // Whether a corner of the tile's box is on the light's side of its plane.
  const auto before = [&](const glm::vec3& center, const glm::vec3& normal, bool is_two_sided) {
    if (is_two_sided) return true;
    const glm::vec3 farthest{normal.x > 0 ? tile.high.x : tile.low.x, normal.y > 0 ? tile.high.y : tile.low.y,
                             normal.z > 0 ? tile.high.z : tile.low.z};
    return glm::dot(farthest - center, normal) > 0;
  };
  return std::visit(
      Cases{
          [&](const scene::PointLight& l) { return in_range(l.position, 0) && may_face(tile, l.position, 0); },
          [&](const scene::SpotLight& l) {
            if (!in_range(l.position, 0) || !may_face(tile, l.position, 0)) return false;
            const glm::vec3 middle = 0.5f * (tile.low + tile.high), way = middle - l.position;
            const float distance = glm::length(way), spread = 0.5f * glm::length(tile.high - tile.low);
            if (distance <= spread) return true;
            const float angle = std::acos(glm::clamp(glm::dot(way, l.direction) / distance, -1.0f, 1.0f));
            return angle < l.outer + std::asin(spread / distance);
          },
          [&](const scene::DirectionalLight& l) {
            return tile.cosine <= 0 ||
                   std::acos(glm::clamp(-glm::dot(tile.axis, l.direction), -1.0f, 1.0f)) - std::acos(tile.cosine) <
                       1.5708f;
          },
          [&](const scene::RectangleLight& l) {
            const float reach = glm::length(l.half_u) + glm::length(l.half_v);
            return in_range(l.center, reach) && before(l.center, glm::cross(l.half_u, l.half_v), l.two_sided) &&
                   may_face(tile, l.center, reach);
          },
          [&](const scene::DiskLight& l) {
            return in_range(l.center, l.radius) && before(l.center, l.normal, l.two_sided) &&
                   may_face(tile, l.center, l.radius);
          },
          [&](const scene::SphereLight& l) {
            return in_range(l.center, l.radius) && may_face(tile, l.center, l.radius);
          },
      },
      light.shape);
}

}  // namespace

Pass light_list_pass(const plan::Plan&) {
  return {"light lists",
          "for each tile the lights that may reach it: by range, by cones of normals and spots, by the side of a light",
          {Buffer::kTiles},
          {Buffer::kLightLists},
          [](Context& c) {
            const auto& lights = c.world.scene.lights;
            // Surfaces that shine follow the scene's lights; the environment has a pass of its own.
            const std::size_t all = c.world.lights.count() - (c.world.lights.samples_environment() ? 1 : 0);
            const auto stride = static_cast<std::uint32_t>(all);
            c.frame.lights.resize(c.frame.tiles.size() * all);
            for_tiles(c.frame, true, [&](Tile& tile) {
              tile.first_light = static_cast<std::uint32_t>(&tile - c.frame.tiles.data()) * stride;
              tile.lights = 0;
              for (std::size_t i = 0; i < all; ++i)
                if (i >= lights.size() || may_reach(tile, lights[i]))
                  c.frame.lights[tile.first_light + tile.lights++] = static_cast<scene::Index>(i);
            });
          }};
}

}  // namespace likeness::runtime
