#pragma once

#include <array>
#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "brdf/realis/fade.h"
#include "render/baked/residual.h"
#include "render/surface/kernel.h"

// A baked residual on top of a material's model. It is a kernel around the model's own: whoever calls kernels has it, and
// materials without a bake are called as if there were none.
//
//     f cos_i of a light = max(plain f cos_i + weight e max(cos_i, floor), 0)      (brdf/realis/shade.h)
//
// Where the bake was made over a surface whose light ends softly (baked::Surface::spread, least), the plain f cos_i is that, too:
// weight base_color / pi beyond_hard(cos_i, spread) is added to it, and weight least base_color / pi takes the place of 0.
// That holds above the surface itself (Point), also for directions that the shading normal turns away from. It is cut at 0
// for each direction.
namespace likeness::surface {

// What a bake says at a point. Without a default: one is kept for many points, and most have none.
struct ResidualAt {
  const baked::Residual* bake;
  const Kernel* plain;         // the model's own
  float weight;                // strength and fade
  glm::vec3 normal;            // geometric, in the frame of the kernel
  glm::mat3 model_from_local;  // orthogonal; mirrored instances mirror the light too
  std::array<std::uint32_t, 4> pixels;
  std::array<float, 4> shares;  // bilinear; their sum is 1
  int texels;                   // of those four that count
  std::uint32_t groups;         // of eight lobes that are evaluated; of mixes all are
  int drawn;                    // lobes by jitter (then texels is 1; of mixes all count); 0: all
  float u;                      // of jitter
  bool is_soft;                 // the bake's surface has a spread or a least

  // The texels about uv (clamped), all four or, with jitter, one that `choice` in [0, 1) draws.
  void place(const glm::vec2& uv, int drawn, const glm::vec2& choice);
  // weight e [1/sr] towards a direction of the kernel's frame; e of luminance in all channels.
  glm::vec3 towards(const glm::vec3& to_light) const;
  bool is_empty() const { return groups == 0 && !bake->has_mixes(); }
};

// The bake's own properties at the texels, against those of now: RealisFade's weight. `normal` is in model space.
float faded(const ResidualAt& at, const brdf::RealisFade& fade, const glm::vec3* base_color, const float* roughness,
            const glm::vec3& normal);

// The kernel of materials with a bake, whatever the model; Bound::residual says which.
Kernel residual_kernel();

// The orthogonal part of an instance's placement, transposed: of other than uniform scalings that of Gram and Schmidt.
glm::mat3 model_from_world(const glm::mat3& world_from_object);

}  // namespace likeness::surface
