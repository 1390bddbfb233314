#include "render/texture/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

#include "render/image/tone_curve.h"

namespace likeness::texture {
namespace {

const std::array<float, 256> kFromSrgb = [] {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<float>(image::srgb_decode8(static_cast<std::uint8_t>(i)));
  return table;
}();

float value(const image::Texels& texels, scene::Transfer transfer, std::size_t at) {
  if (texels.bytes.empty()) return texels.floats[at];
  const std::uint8_t byte = texels.bytes[at];
  return transfer == scene::Transfer::kSrgb ? kFromSrgb[byte] : static_cast<float>(byte) * (1.0f / 255);
}

std::size_t start_of(const image::Texels& texels, int x, int y) {
  return (static_cast<std::size_t>(y) * static_cast<std::size_t>(texels.width) + static_cast<std::size_t>(x)) *
         static_cast<std::size_t>(texels.channels);
}

// The two texels that a coordinate lies between, and how far it is from the first.
struct Between {
  int low = 0, high = 0;
  float t = 0;
};
Between between(float u, int count, scene::Wrap wrap) {
  if (!std::isfinite(u)) u = 0;
  if (wrap == scene::Wrap::kRepeat) u -= std::floor(u);
  const float x = std::clamp(u, 0.0f, 1.0f) * static_cast<float>(count) - 0.5f, below = std::floor(x);
  Between b{static_cast<int>(below), static_cast<int>(below) + 1, x - below};
  if (wrap == scene::Wrap::kRepeat) {
    if (b.low < 0) b.low += count;
    if (b.high >= count) b.high -= count;
  } else {
    b.low = std::max(b.low, 0), b.high = std::min(b.high, count - 1);
  }
  return b;
}

template <class Read>
auto bilinear(const scene::Image& image, const scene::Texture& texture, const glm::vec2& uv, Read&& read) {
  const glm::vec2 at = uv * texture.uv_scale + texture.uv_offset;
  const Between x = between(at.x, image.texels.width, texture.wrap);
  const Between y = between(at.y, image.texels.height, texture.wrap);
  const auto top = glm::mix(read(x.low, y.low), read(x.high, y.low), x.t);
  const auto bottom = glm::mix(read(x.low, y.high), read(x.high, y.high), x.t);
  return glm::mix(top, bottom, y.t);
}

}  // namespace

glm::vec3 color_of(const scene::Image& image, scene::Transfer transfer, int x, int y) {
  const std::size_t at = start_of(image.texels, x, y);
  if (image.texels.channels < 3) return glm::vec3(value(image.texels, transfer, at));
  return {value(image.texels, transfer, at), value(image.texels, transfer, at + 1),
          value(image.texels, transfer, at + 2)};
}
float number_of(const scene::Image& image, scene::Transfer transfer, int channel, int x, int y) {
  const int last = image.texels.channels - 1;
  // Opacity is never encoded: the last channel of two or four is linear.
  const bool is_alpha = channel >= last && image.texels.channels % 2 == 0;
  return value(image.texels, is_alpha ? scene::Transfer::kLinear : transfer,
               start_of(image.texels, x, y) + static_cast<std::size_t>(std::min(channel, last)));
}

glm::vec3 color_at(const scene::Image& image, const scene::Texture& texture, const glm::vec2& uv) {
  return texture.offset + texture.scale * bilinear(image, texture, uv, [&](int x, int y) {
                            return color_of(image, texture.transfer, x, y);
                          });
}
float number_at(const scene::Image& image, const scene::Texture& texture, const glm::vec2& uv) {
  return texture.offset.x + texture.scale.x * bilinear(image, texture, uv, [&](int x, int y) {
                              return number_of(image, texture.transfer, texture.channel, x, y);
                            });
}

}  // namespace likeness::texture
