#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/scene/scene.h"

// Textures as they look where a pixel covers more than one texel: smaller pictures of them, made once, and where in
// those to look.
namespace likeness::texture {

enum class Filter : std::uint8_t {
  kFull,        // at full size, whatever a pixel covers
  kNearest,     // the level whose texels are about as large as the longer side of what the pixel covers
  kTrilinear,   // between the two levels next to that
  kAnisotropic  // levels of its shorter side, at up to 16 places along the longer one
};
inline constexpr int kMostProbes = 16;

// What a pixel covers: by how much uv moves when the pixel does, one to the right and one down. Zero is a point.
struct Footprint {
  glm::vec2 right{0, 0}, down{0, 0};
};

// What is averaged when texels are.
enum class Meaning : std::uint8_t {
  kValues,     // linear light, numbers
  kNormals,    // unit vectors: their mean is shorter than 1 by what they differ
  kRoughness,  // square roots of GGX's alpha, by what normals of that roughness lose in length
};

// Looks from `first` on in steps of `step` (in uv of the picture, placed), `count` times, between level `fine` and the
// next coarser one; weight `t` of the latter. fine = 0 is full size.
struct Probes {
  int count = 1;
  glm::vec2 first{0, 0}, step{0, 0};
  int fine = 0;
  float t = 0;

  bool is_full() const { return count == 1 && fine == 0 && t == 0; }
};
// `levels`: how many there are, the full size included. A footprint that is not finite is a point.
Probes probes_of(const Footprint& footprint, const scene::Texture& texture, const glm::vec2& uv, int width, int height,
                 int levels, Filter filter);

// The normal of a map's texel in the tangent frame: unit. `strength` multiplies x and y.
glm::vec3 normal_at(const scene::Image& image, const scene::Texture& texture, const glm::vec2& uv, float strength);

// A texture with its levels. Those below full size have at most a third of its texels if it is a square of a power of 2,
// as many if it has one row. Bytes remain bytes (values), normals are three floats and roughness is one.
// Texels that are no finite number are left out of means.
class Levels {
 public:
  // Keeps pointers to both, which must outlive it.
  Levels(const scene::Image& image, const scene::Texture& texture, Meaning meaning, float normal_strength = 1);

  // Whether the levels of this one are those of another texture too, and that texture with them.
  bool serves(const scene::Image& image, const scene::Texture& texture, Meaning meaning, float normal_strength) const;
  Levels placed(const scene::Texture& texture) const;

  int count() const { return 1 + static_cast<int>(smaller_->size()); }
  std::size_t bytes() const;  // of the levels below full size

  // As color_at and number_at of texture.h (which they are at full size), over a footprint.
  glm::vec3 color(const glm::vec2& uv, const Footprint& footprint, Filter filter) const;
  float number(const glm::vec2& uv, const Footprint& footprint, Filter filter) const;

  struct MeanNormal {
    glm::vec3 normal{0, 0, 1};  // unit
    float deficit = 0;          // 1 - the length of the mean; 0 where one texel or none is covered
  };
  MeanNormal normal(const glm::vec2& uv, const Footprint& footprint, Filter filter) const;

 private:
  template <class Read>
  auto mean(const Probes& probes, Read&& read) const;
  void place(const scene::Texture& texture);
  Probes probes(const glm::vec2& uv, const Footprint& footprint, Filter filter) const;

  const scene::Image* image_;
  const scene::Texture* texture_;
  Meaning meaning_;
  float strength_;
  scene::Texture of_levels_;  // how the smaller pictures are read
  std::shared_ptr<const std::vector<scene::Image>> smaller_;
};

}  // namespace likeness::texture
