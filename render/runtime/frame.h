#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/image/picture.h"
#include "render/image/plane.h"
#include "render/scene/scene.h"

// What the passes of a frame read and write.
namespace likeness::runtime {

// A tile is what one group of lanes works on: neighbors, which mostly show one material in one light.
inline constexpr int kTileWidth = 8, kTileHeight = 4, kTilePixels = kTileWidth * kTileHeight;

enum class Buffer : std::uint8_t {
  kHits,        // Frame::hits: what each camera ray met
  kSurfaces,    // Frame::cells: what each pixel shows
  kParameters,  // Frame::parameters: what textures say there
  kTiles,       // Frame::tiles: what each tile contains, and where
  kLightLists,  // Frame::lights: the lights that may reach each tile
  kRadiance,    // Frame::radiance: linear light
  kCount
};
inline constexpr std::string_view kBufferNames[]{"hits", "surfaces", "parameters", "tiles", "light lists", "radiance"};

// What a camera ray met; written where it is a surface.
struct HitCell {
  float distance = 0, u = 0, v = 0;  // as in ray::Hit
  scene::Index instance = scene::kNone, triangle = 0;
};
// What a pixel shows.
struct Cell {
  glm::vec3 position{0, 0, 0};
  glm::vec3 normal{0, 0, 1};          // geometric, on the viewer's side
  glm::vec3 shading_normal{0, 0, 1};  // z of the kernel's frame
  glm::vec2 uv{0, 0};
  scene::Index material = scene::kNone;  // kNone: the environment, or nothing that reflects

  bool is_surface() const { return material != scene::kNone; }
};
// With dual normals, in the frame about shading_normal.
struct DualCell {
  glm::vec3 diffuse_normal{0, 0, 1}, specular_normal{0, 0, 1};
};

struct Tile {
  int x = 0, y = 0, width = 0, height = 0;  // [pixel]
  int surfaces = 0;                         // pixels that show one
  // Of those: where they are, and a cone about their shading normals (a cosine of -1: all directions).
  glm::vec3 low{0, 0, 0}, high{0, 0, 0}, axis{0, 0, 1};
  float cosine = -1;
  std::uint32_t first_light = 0, lights = 0;  // in Frame::lights, from first_light on
};

struct Frame {
  int width = 0, height = 0;
  // Not Cell's defaults before the visibility pass, which writes all of them.
  image::Plane<Cell> cells;
  image::Plane<DualCell> dual_cells;  // empty without dual normals
  // Empty without textures. For each pixel parameter_stride numbers: Bound::bumps, then those of Prepared::varying.
  std::vector<HitCell> hits;
  std::vector<float> parameters;
  std::size_t parameter_stride = 0;
  std::vector<Tile> tiles;
  std::vector<scene::Index> lights;
  image::Picture radiance;

  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

}  // namespace likeness::runtime
