#include "render/runtime/residual_maps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tbb/parallel_for.h>

namespace likeness::runtime {
namespace {

constexpr int kWidth = 96, kHeight = 48, kPoints = 4;  // cells of the sky, and points on a side of each
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

struct Source {
  glm::vec3 direction, light;  // light: radiance times solid angle
};

std::vector<Source> sources_of(const light::Environment& environment) {
  std::vector<Source> out(static_cast<std::size_t>(kWidth * kHeight));
  tbb::parallel_for(0, kHeight, [&](int y) {
    for (int x = 0; x < kWidth; ++x) {
      glm::vec3 sum(0);
      const auto place = [&](int cell, int i, int cells) {
        return (static_cast<float>(cell) + (static_cast<float>(i) + 0.5f) / kPoints) / static_cast<float>(cells);
      };
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i)
          sum += environment.radiance(environment.direction_at({place(x, i, kWidth), place(y, j, kHeight)}));
      const float top = std::numbers::pi_v<float> * static_cast<float>(y) / kHeight,
                  bottom = std::numbers::pi_v<float> * static_cast<float>(y + 1) / kHeight;
      const float solid_angle = (std::cos(top) - std::cos(bottom)) * 2 * std::numbers::pi_v<float> / kWidth;
      out[static_cast<std::size_t>(y * kWidth + x)] = {
          environment.direction_at({(static_cast<float>(x) + 0.5f) / kWidth, (static_cast<float>(y) + 0.5f) / kHeight}),
          sum * (solid_angle / (kPoints * kPoints))};
    }
  });
  return out;
}

}  // namespace

ResidualMaps::ResidualMaps(const light::Environment& environment, const world::World& world) {
  const std::vector<Source> sources = sources_of(environment);
  std::map<std::vector<float>, std::size_t> known;  // of the same bake in the same turn one table
  std::vector<std::pair<const baked::Residual*, glm::mat3>> wanted;
  for (std::size_t i = 0; i < world.scene.instances.size(); ++i) {
    const auto& residual = world.scene.materials[world.scene.instances[i].material].residual;
    table_of_.push_back(kNone);
    if (!residual) continue;
    const glm::mat3& turn = world.surfaces.turn(static_cast<scene::Index>(i));
    std::vector<float> key(&turn[0][0], &turn[0][0] + 9);
    key.push_back(static_cast<float>(residual->bake));
    const auto [at, fresh] = known.try_emplace(key, wanted.size());
    if (fresh) wanted.emplace_back(&world.scene.bakes[residual->bake], turn);
    table_of_.back() = at->second;
  }
  tables_.resize(wanted.size());
  for (std::size_t table = 0; table < wanted.size(); ++table) {
    const auto& [bake, turn] = wanted[table];
    tables_[table].resize(brdf::RealisLobes::kMost);
    tbb::parallel_for(std::size_t{0}, bake->lobe_count, [&, bake = bake, turn = turn](std::size_t k) {
      Lobe& lobe = tables_[table][k];
      glm::vec3 from(0);
      float whole = 0;
      for (const Source& s : sources) {
        const float g = bake->lobes.eval(k, brdf::Vec3<float>(turn * s.direction));
        if (!(g > 0)) continue;
        lobe.light += g * s.light;
        const float weight = g * (s.light.r + s.light.g + s.light.b);
        from += weight * s.direction, whole += weight;
      }
      if (!(whole > 0)) return;
      lobe.from = from / whole;
      lobe.width = std::sqrt(std::max(1 - glm::dot(lobe.from, lobe.from), 0.0f));
    });
  }
}

glm::vec3 ResidualMaps::light(const surface::Point& point, scene::Index instance) const {
  const surface::ResidualAt& at = point.residual;
  if (table_of_[instance] == kNone || !(at.weight > 0) || at.groups == 0) return glm::vec3(0);
  const baked::Residual& bake = *at.bake;
  const std::vector<Lobe>& table = tables_[table_of_[instance]];
  glm::vec3 sum(0);
  const auto add = [&]<std::size_t kChannels>(const brdf::RealisTexel<kChannels>& texel, float share) {
    for (std::size_t j = 0; j < brdf::kRealisDominant; ++j) {
      const Lobe& lobe = table[texel.lobes[j]];
      const float above = glm::dot(point.normal, lobe.from) + lobe.width;
      if (!(above > 0)) continue;
      const float part = lobe.width > 0 ? std::min(above / (2 * lobe.width), 1.0f) : 1.0f;
      const float gain = share * part * std::max(glm::dot(point.shading_normal, lobe.from), bake.floor);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t channel = kChannels == 1 ? 0 : k;
        sum[static_cast<int>(k)] += static_cast<float>(texel.coefficients[channel][j] - brdf::kRealisZero) *
                                    bake.lobes.lobes[texel.lobes[j]].scale[channel] * gain *
                                    lobe.light[static_cast<int>(k)];
      }
    }
  };
  for (int i = 0; i < at.texels; ++i) {
    const std::size_t texel = at.pixels[static_cast<std::size_t>(i)] * bake.groups;
    const float share = at.shares[static_cast<std::size_t>(i)];
    if (bake.is_rgb()) add(bake.rgb[texel], share);
    else add(bake.luminance[texel], share);
  }
  return at.weight * sum;
}

}  // namespace likeness::runtime
