#pragma once

#include <array>
#include <cstddef>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "brdf/any_brdf.h"

// A surface model as a renderer calls it: some functions that were compiled for exactly what a material needs, chosen
// once, and called without a further question.
namespace likeness::surface {

struct ResidualAt;  // residual.h

// The model's parameters at a point: a model in floats, as kernel's functions know it.
struct Bound {
  const void* model = nullptr;
  // With dual normals, in the frame of the surface: unit. (The frame of other materials is that of their normal.)
  glm::vec3 diffuse_normal{0, 0, 1}, specular_normal{0, 0, 1};
  // Alpha of bumps that are too small to be seen, in the diffuse; what distant kernels read. 0: there are none.
  float bumps = 0;
  const ResidualAt* residual = nullptr;  // of a material with a bake, whose kernel reads it
};

// f cos_i [1/sr], and the density with which sample() gives that direction [1/sr]. 0 at and below the horizon.
struct Value {
  glm::vec3 f_cos{0, 0, 0};
  float pdf = 0;
};
// weight = f cos_i / pdf. pdf = 0: there is none.
struct Direction {
  glm::vec3 to_light{0, 0, 1};
  float pdf = 0;
  glm::vec3 weight{0, 0, 0};
};
// The parts of f cos_i that pictures are kept of.
struct Lobes {
  glm::vec3 diffuse{0, 0, 0}, specular{0, 0, 0};
};

// Directions are unit, in the local frame, and leave the surface. Never throws.
struct Kernel {
  Value (*eval)(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) = nullptr;
  // The first part of eval() alone: for light that no other way of choosing directions finds.
  glm::vec3 (*f_cos)(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) = nullptr;
  Direction (*sample)(const Bound& bound, const glm::vec3& to_view, float choice, const glm::vec2& u) = nullptr;
  Lobes (*lobes)(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) = nullptr;
  // The model's base_color, or what stands for it (f0): what a picture of the albedo shows.
  glm::vec3 (*base_color)(const Bound& bound) = nullptr;
};

// The kernel of a Callisto material that needs `parts` (brdf::Callisto::Part), with one normal or two. Sets that cannot
// be are those of a superset that can.
Kernel callisto_kernel(unsigned parts, bool has_dual_normals);

// The same with Proxima of Bound::bumps in the place of Lambert. Parts without a diffuse: the same kernel.
Kernel distant_callisto_kernel(unsigned parts, bool has_dual_normals);

// The kernel of any other model. Callisto: the whole of it.
Kernel kernel_of(const brdf::AnyBrdf& model);

// Bytes that hold any model in floats.
inline constexpr std::size_t kModelBytes = 160;
struct alignas(16) ModelBytes {
  std::array<std::byte, kModelBytes> bytes;
};

}  // namespace likeness::surface
