#include "render/texture/normal_mips.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "brdf/normal_length.h"
#include "render/texture/halving.h"
#include "render/texture/texture.h"

namespace likeness::texture {
namespace {

using Vec = brdf::Vec3<double>;

// Means of shortened normals; in double, because the length of a mean tells small roughnesses apart by its last digits.
struct Means {
  int width = 0, height = 0;
  std::vector<Vec> at;

  const Vec& of(int x, int y) const {
    return at[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

Means means_of(const scene::Image& image, const scene::Texture& texture, const RoughnessBelow& roughness) {
  Means out{image.texels.width, image.texels.height, {}};
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const glm::vec3 c = 2.0f * (texture.offset + texture.scale * color_of(image, texture.transfer, x, y)) - 1.0f;
      const glm::dvec3 n(c.x, c.y, std::max(c.z, 1e-3f));
      const double length = glm::length(n);
      const glm::vec2 uv{(static_cast<float>(x) + 0.5f) / static_cast<float>(out.width),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(out.height)};
      float below = roughness.everywhere;
      if (roughness.image != nullptr) below = number_at(*roughness.image, roughness.texture, uv);
      const double rough = std::clamp(std::isnan(below) ? 0.5 : static_cast<double>(below), 0.0, 1.0);
      const Vec unit = std::isfinite(length) ? Vec(n.x / length, n.y / length, n.z / length) : Vec(0, 0, 1);
      out.at.push_back(brdf::shortened_normal(unit, rough));
    }
  return out;
}

Means halved(const Means& fine) {
  Means out{half_of(fine.width), half_of(fine.height), {}};
  for (int y = 0; y < out.height; ++y) {
    const Cover rows = cover(y, fine.height, out.height);
    for (int x = 0; x < out.width; ++x) {
      Vec sum;
      double weight = 0;
      for_covered(cover(x, fine.width, out.width), rows,
                  [&](int i, int j, double share) { sum = sum + fine.of(i, j) * share, weight += share; });
      out.at.push_back(sum * (1 / weight));
    }
  }
  return out;
}

NormalMip level_of(const Means& means) {
  NormalMip out{means.width, means.height, {}, {}, {}};
  for (const Vec& mean : means.at) {
    const auto filtered = brdf::filtered_normal(mean);
    out.normals.emplace_back(filtered.normal.x, filtered.normal.y, filtered.normal.z);
    out.roughness.push_back(static_cast<float>(filtered.roughness));
    out.lengths.push_back(static_cast<float>(filtered.length));
  }
  return out;
}

}  // namespace

std::vector<NormalMip> normal_mips(const scene::Image& normals, const scene::Texture& texture,
                                   const RoughnessBelow& roughness, int levels) {
  std::vector<NormalMip> out;
  Means means = means_of(normals, texture, roughness);
  for (;;) {
    out.push_back(level_of(means));
    if (static_cast<int>(out.size()) >= levels || (means.width == 1 && means.height == 1)) return out;
    means = halved(means);
  }
}

}  // namespace likeness::texture
