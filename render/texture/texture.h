#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/scene/scene.h"

// What a texture says at a point of a surface: linear values, bilinear between the centers of texels.
namespace likeness::texture {

// The first three channels of a texel, linear; a grey one three times. 0 <= x < width, 0 <= y < height.
glm::vec3 color_of(const scene::Image& image, scene::Transfer transfer, int x, int y);
float number_of(const scene::Image& image, scene::Transfer transfer, int channel, int x, int y);

// scale * texel + offset. `image` is the texture's. uv may be anything; what is not finite counts as 0.
glm::vec3 color_at(const scene::Image& image, const scene::Texture& texture, const glm::vec2& uv);
float number_at(const scene::Image& image, const scene::Texture& texture, const glm::vec2& uv);

}  // namespace likeness::texture
