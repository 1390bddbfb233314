#include "render/texture/levels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "brdf/normal_length.h"
#include "render/image/tone_curve.h"
#include "render/texture/halving.h"
#include "render/texture/texture.h"

namespace likeness::texture {
namespace {

constexpr int kMostChannels = 4;

// Means of texels, in floats.
struct Plane {
  int width = 0, height = 0, channels = 0;
  std::vector<float> values;

  Plane(int w, int h, int c)
      : width(w), height(h), channels(c), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h * c)) {}
  std::size_t at(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

// `read(x, y, values)` gives the channels of a texel of the finer level.
template <class Read>
Plane halved(int width, int height, int channels, const Read& read) {
  Plane out(half_of(width), half_of(height), channels);
  tbb::parallel_for(0, out.height, [&](int y) {
    const Cover rows = cover(y, height, out.height);
    for (int x = 0; x < out.width; ++x) {
      std::array<double, kMostChannels> sums{}, weights{};
      for_covered(cover(x, width, out.width), rows, [&](int i, int j, double share) {
        std::array<float, kMostChannels> values;
        read(i, j, values);
        for (std::size_t k = 0; k < static_cast<std::size_t>(channels); ++k)
          if (std::isfinite(values[k])) sums[k] += share * static_cast<double>(values[k]), weights[k] += share;
      });
      for (std::size_t k = 0; k < static_cast<std::size_t>(channels); ++k)
        out.values[out.at(x, y) + k] = static_cast<float>(sums[k] / weights[k]);  // none is finite: neither is the mean
    }
  });
  return out;
}

glm::vec3 unit_normal(const glm::vec3& texel, float strength) {
  const glm::vec3 c = 2.0f * texel - 1.0f, n(c.x * strength, c.y * strength, std::max(c.z, 1e-3f));
  const float length2 = glm::dot(n, n);
  return length2 > 0 && std::isfinite(length2) ? n / std::sqrt(length2) : glm::vec3(0, 0, 1);
}

bool is_finite(float x) { return std::isfinite(x); }
bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// A level as it is kept: like the picture it is made from, or in floats.
image::Texels kept(const Plane& plane, const scene::Image& full, scene::Transfer transfer, Meaning meaning) {
  image::Texels out{plane.width, plane.height, plane.channels, {}, {}};
  if (meaning == Meaning::kValues && full.texels.floats.empty()) {
    out.bytes.reserve(plane.values.size());
    for (std::size_t i = 0; i < plane.values.size(); ++i) {
      const bool is_alpha = plane.channels % 2 == 0 &&
                            static_cast<int>(i) % plane.channels == plane.channels - 1;  // as texture.cc has it
      const float x = plane.values[i];
      out.bytes.push_back(transfer == scene::Transfer::kSrgb && !is_alpha
                              ? image::srgb_encode8(x)
                              : static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0f, 1.0f))));
    }
  } else if (meaning == Meaning::kRoughness) {
    for (const float deficit : plane.values)
      out.floats.push_back(std::sqrt(static_cast<float>(brdf::alpha_of_normal_deficit(static_cast<double>(deficit)))));
  } else {
    out.floats = plane.values;
  }
  return out;
}

}  // namespace

Probes probes_of(const Footprint& footprint, const scene::Texture& texture, const glm::vec2& uv, int width, int height,
                 int levels, Filter filter) {
  Probes out;
  out.first = uv;
  if (filter == Filter::kFull || levels < 2) return out;
  // The ellipse that the pixel's circle becomes, in texels: its axes are the singular values of (right, down).
  const glm::vec2 texels = texture.uv_scale * glm::vec2(width, height);
  const glm::vec2 r = footprint.right * texels, d = footprint.down * texels;
  const float xx = r.x * r.x + d.x * d.x, yy = r.y * r.y + d.y * d.y, xy = r.x * r.y + d.x * d.y;
  const float middle = 0.5f * (xx + yy), half = std::hypot(0.5f * (xx - yy), xy);
  const float longer = std::sqrt(middle + half), area = std::abs(r.x * d.y - r.y * d.x);
  if (!(longer > 1)) return out;
  if (!std::isfinite(longer)) {  // all of the picture, many times
    out.fine = levels - 1;
    return out;
  }
  float side = longer;
  if (filter == Filter::kAnisotropic) {
    // Places no closer than texels, nor than the shorter side.
    const float shorter = std::max(area / longer, 1.0f);
    out.count = static_cast<int>(std::min(std::ceil(longer / shorter), static_cast<float>(kMostProbes)));
    side = std::max(shorter, longer / static_cast<float>(out.count));
    if (out.count > 1) {
      const float largest = middle + half;
      glm::vec2 axis = xx >= yy ? glm::vec2(largest - yy, xy) : glm::vec2(xy, largest - xx);
      axis *= longer / glm::length(axis);
      // A side along which uv does not move the texture has no part in the axis.
      const auto per_texel = [&](float x, float all) { return all != 0 ? x / all : 0.0f; };
      out.step = glm::vec2(per_texel(axis.x, texels.x), per_texel(axis.y, texels.y)) / static_cast<float>(out.count);
      out.first = uv - 0.5f * static_cast<float>(out.count - 1) * out.step;
    }
  }
  const float level = std::min(std::log2(side), static_cast<float>(levels - 1));
  if (filter == Filter::kNearest) {
    out.fine = static_cast<int>(std::lround(level));
  } else {
    out.fine = std::min(static_cast<int>(level), levels - 1);
    out.t = level - static_cast<float>(out.fine);
  }
  return out;
}

glm::vec3 normal_at(const scene::Image& image, const scene::Texture& texture, const glm::vec2& uv, float strength) {
  return unit_normal(color_at(image, texture, uv), strength);
}

Levels::Levels(const scene::Image& image, const scene::Texture& texture, Meaning meaning, float normal_strength)
    : image_(&image), texture_(&texture), meaning_(meaning), strength_(normal_strength) {
  const image::Texels& full = image.texels;
  place(texture);
  using Channels = std::array<float, kMostChannels>;
  const auto read = [&](int x, int y, Channels& out) {
    if (meaning == Meaning::kValues) {
      for (int k = 0; k < full.channels; ++k)
        out[static_cast<std::size_t>(k)] = number_of(image, texture.transfer, k, x, y);
    } else if (meaning == Meaning::kNormals) {
      const glm::vec3 texel = texture.offset + texture.scale * color_of(image, texture.transfer, x, y);
      const glm::vec3 unit = unit_normal(texel, strength_);
      out[0] = unit.x, out[1] = unit.y, out[2] = unit.z;
    } else {
      const float roughness =
          texture.offset.x + texture.scale.x * number_of(image, texture.transfer, texture.channel, x, y);
      const float r = std::clamp(roughness, 0.0f, 1.0f);  // NaN stays, and is left out
      out[0] = std::isfinite(roughness) ? brdf::normal_deficit(r * r) : roughness;
    }
  };
  const int channels = meaning == Meaning::kValues ? full.channels : meaning == Meaning::kNormals ? 3 : 1;
  const auto smaller = std::make_shared<std::vector<scene::Image>>();
  smaller_ = smaller;
  if (full.width <= 1 && full.height <= 1) return;
  Plane plane = halved(full.width, full.height, channels, read);
  for (;;) {
    smaller->push_back({image.name, kept(plane, image, texture.transfer, meaning)});
    if (plane.width == 1 && plane.height == 1) return;
    plane = halved(plane.width, plane.height, channels, [&](int x, int y, Channels& out) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(channels); ++k) out[k] = plane.values[plane.at(x, y) + k];
    });
  }
}

void Levels::place(const scene::Texture& texture) {
  texture_ = &texture;
  of_levels_ = texture;
  if (meaning_ == Meaning::kValues) return;
  // Normals and roughness are kept as what they are, and no longer as a picture has them.
  of_levels_.scale = glm::vec3(1), of_levels_.offset = glm::vec3(0), of_levels_.channel = 0;
  of_levels_.transfer = scene::Transfer::kLinear;
}

bool Levels::serves(const scene::Image& image, const scene::Texture& texture, Meaning meaning,
                    float normal_strength) const {
  if (&image != image_ || meaning != meaning_ || texture.transfer != texture_->transfer) return false;
  if (meaning == Meaning::kValues) return true;
  if (texture.scale != texture_->scale || texture.offset != texture_->offset) return false;
  return meaning == Meaning::kNormals ? normal_strength == strength_ : texture.channel == texture_->channel;
}

Levels Levels::placed(const scene::Texture& texture) const {
  Levels out = *this;
  out.place(texture);
  return out;
}

std::size_t Levels::bytes() const {
  std::size_t sum = 0;
  for (const scene::Image& level : *smaller_)
    sum += level.texels.bytes.size() + sizeof(float) * level.texels.floats.size();
  return sum;
}

// `read(level, uv)`, level 0 at full size. What is not finite is left out, unless nothing else is there.
template <class Read>
auto Levels::mean(const Probes& p, Read&& read) const {
  const auto at = [&](const glm::vec2& uv) {
    const auto fine = read(p.fine, uv);
    if (p.t == 0) return fine;
    const auto coarse = read(p.fine + 1, uv);
    return !is_finite(fine) ? coarse : !is_finite(coarse) ? fine : glm::mix(fine, coarse, p.t);
  };
  auto sum = at(p.first);
  if (p.count == 1) return sum;
  int finite = is_finite(sum) ? 1 : 0;
  for (int i = 1; i < p.count; ++i) {
    const auto next = at(p.first + static_cast<float>(i) * p.step);
    if (!is_finite(next)) continue;
    if (finite++ == 0) sum = next;
    else sum += next;
  }
  return finite > 1 ? sum / static_cast<float>(finite) : sum;
}

Probes Levels::probes(const glm::vec2& uv, const Footprint& footprint, Filter filter) const {
  return probes_of(footprint, *texture_, uv, image_->texels.width, image_->texels.height, count(), filter);
}

glm::vec3 Levels::color(const glm::vec2& uv, const Footprint& footprint, Filter filter) const {
  return mean(probes(uv, footprint, filter), [&](int level, const glm::vec2& at) {
    return level == 0 ? color_at(*image_, *texture_, at)
                      : color_at((*smaller_)[static_cast<std::size_t>(level - 1)], of_levels_, at);
  });
}

float Levels::number(const glm::vec2& uv, const Footprint& footprint, Filter filter) const {
  return mean(probes(uv, footprint, filter), [&](int level, const glm::vec2& at) {
    return level == 0 ? number_at(*image_, *texture_, at)
                      : number_at((*smaller_)[static_cast<std::size_t>(level - 1)], of_levels_, at);
  });
}

Levels::MeanNormal Levels::normal(const glm::vec2& uv, const Footprint& footprint, Filter filter) const {
  const Probes p = probes(uv, footprint, filter);
  const glm::vec3 m = mean(p, [&](int level, const glm::vec2& at) {
    return level == 0 ? normal_at(*image_, *texture_, at, strength_)
                      : color_at((*smaller_)[static_cast<std::size_t>(level - 1)], of_levels_, at);
  });
  if (p.is_full()) return {m, 0};
  const float length = glm::length(m);
  // Normals that cancel one another face nowhere; what they are on faces along z.
  return length > 1e-6f ? MeanNormal{m / length, std::max(1 - length, 0.0f)} : MeanNormal{{0, 0, 1}, 1};
}

}  // namespace likeness::texture
