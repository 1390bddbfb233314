#include "render/runtime/residual_maps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tbb/parallel_for.h>

#include "brdf/realis/octahedron.h"
#include "brdf/realis/soft_cosine.h"

namespace likeness::runtime {
namespace {

constexpr brdf::Octahedron kNormals{33};
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

// For each normal of kNormals what a gain of the source's direction and its cosine, summed over the sources, makes.
template <class F>
void for_each_normal(std::size_t each, std::vector<glm::vec3>& out, F&& sum) {
  out.assign(kNormals.count() * each, glm::vec3(0));
  tbb::parallel_for(0, kNormals.side, [&](int y) {
    for (int x = 0; x < kNormals.side; ++x) {
      const brdf::Vec3<float> n = kNormals.direction(x, y);
      sum(glm::vec3(n.x, n.y, n.z), out.data() + static_cast<std::size_t>(y * kNormals.side + x) * each);
    }
  });
}

std::vector<glm::vec3> light_of_mixes(const baked::Residual& bake, const glm::mat3& turn,
                                      const std::vector<Source>& sources) {
  const std::size_t each = bake.mixes.count;
  std::vector<float> towards(sources.size() * each);
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const brdf::Octahedron::Three near = bake.mixes.places.about(brdf::Vec3<float>(turn * sources[s].direction));
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < each; ++j)
        towards[s * each + j] += near.shares[i] * bake.mixes.values[near.places[i] * each + j];
  }
  std::vector<glm::vec3> out;
  for_each_normal(each, out, [&](const glm::vec3& normal, glm::vec3* sums) {
    for (std::size_t s = 0; s < sources.size(); ++s) {
      const float cosine = glm::dot(normal, sources[s].direction);
      if (!(cosine > 0)) continue;
      const glm::vec3 light = std::max(cosine, bake.floor) * sources[s].light;
      for (std::size_t j = 0; j < each; ++j) sums[j] += towards[s * each + j] * light;
    }
  });
  return out;
}

std::vector<glm::vec3> light_of_soft_end(float spread, const std::vector<Source>& sources) {
  std::vector<glm::vec3> out;
  for_each_normal(1, out, [&](const glm::vec3& normal, glm::vec3* sum) {
    for (const Source& s : sources)
      *sum += brdf::beyond_hard(glm::dot(normal, s.direction), spread) * std::numbers::inv_pi_v<float> * s.light;
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
    if (bake->has_mixes()) tables_[table].mixes = light_of_mixes(*bake, turn, sources);
    if (bake->surface && bake->surface->spread > 0)
      tables_[table].soft = light_of_soft_end(static_cast<float>(bake->surface->spread), sources);
    tables_[table].lobes.resize(brdf::RealisLobes::kMost);
    tbb::parallel_for(std::size_t{0}, bake->lobe_count, [&, bake = bake, turn = turn](std::size_t k) {
      Lobe& lobe = tables_[table].lobes[k];
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
  if (table_of_[instance] == kNone || !(at.weight > 0)) return glm::vec3(0);
  const Table& table = tables_[table_of_[instance]];
  glm::vec3 sum(0);
  if (!table.soft.empty()) {
    const brdf::Octahedron::Three near = kNormals.about(brdf::Vec3<float>(point.shading_normal));
    for (std::size_t i = 0; i < 3; ++i) sum += near.shares[i] * table.soft[near.places[i]];
    sum *= at.plain->base_color(point.bound);
  }
  if (!at.is_empty()) sum += at.bake->has_mixes() ? of_mixes(point, table) : of_lobes(point, table);
  return at.weight * sum;
}

glm::vec3 ResidualMaps::of_mixes(const surface::Point& point, const Table& table) const {
  const surface::ResidualAt& at = point.residual;
  const baked::Residual& bake = *at.bake;
  const std::size_t each = bake.mixes.count;
  const brdf::Octahedron::Three near = kNormals.about(brdf::Vec3<float>(point.shading_normal));
  brdf::RealisMixes::Towards mixes{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < each; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        mixes[k][j] += near.shares[i] * bake.mixes.scale[k % bake.channels][j] *
                       table.mixes[near.places[i] * each + j][static_cast<int>(k)];
  glm::vec3 sum(0);
  for (int i = 0; i < at.texels; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      sum[static_cast<int>(k)] +=
          at.shares[static_cast<std::size_t>(i)] *
          bake.mixes.eval(
              mixes[k],
              bake.mixed.data() + (at.pixels[static_cast<std::size_t>(i)] * bake.channels + k % bake.channels) * each);
  return sum;
}

glm::vec3 ResidualMaps::of_lobes(const surface::Point& point, const Table& table) const {
  const surface::ResidualAt& at = point.residual;
  const baked::Residual& bake = *at.bake;
  glm::vec3 sum(0);
  const auto add = [&]<std::size_t kChannels>(const brdf::RealisTexel<kChannels>& texel, float share) {
    for (std::size_t j = 0; j < brdf::kRealisDominant; ++j) {
      const Lobe& lobe = table.lobes[texel.lobes[j]];
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
  return sum;
}

}  // namespace likeness::runtime
