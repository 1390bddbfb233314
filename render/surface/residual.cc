#include "render/surface/residual.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "brdf/realis/jitter.h"
#include "brdf/realis/shade.h"
#include "brdf/realis/soft_cosine.h"
#include "render/ray/frame.h"
#include "render/surface/surfaces.h"

namespace likeness::surface {
namespace {

constexpr std::size_t kLobes = brdf::kRealisDominant;

// e of one texel by several loops over eight lobes that need no vector type to become vectors.
template <std::size_t kChannels>
glm::vec3 sum_of(const brdf::RealisLobes& lobes, const brdf::RealisTexel<kChannels>& texel, const glm::vec3& v) {
  std::array<float, kLobes> g;
  for (std::size_t j = 0; j < kLobes; ++j) {
    const brdf::RealisLobes::Lobe& lobe = lobes.lobes[texel.lobes[j]];
    const float x = lobe.x - v.x, y = lobe.y - v.y, z = lobe.z - v.z;
    g[j] = std::min(lobe.reach * (x * x + y * y + z * z), 1.0f);
  }
  for (std::size_t j = 0; j < kLobes; ++j) g[j] = brdf::windowed_decay_within(g[j]);
  glm::vec3 sum(0);
  for (std::size_t c = 0; c < kChannels; ++c)
    for (std::size_t j = 0; j < kLobes; ++j)
      sum[static_cast<int>(c)] += static_cast<float>(texel.coefficients[c][j] - brdf::kRealisZero) *
                                  (lobes.lobes[texel.lobes[j]].scale[c] * g[j]);
  return kChannels == 1 ? glm::vec3(sum.x) : sum;
}

template <std::size_t kChannels>
glm::vec3 residual_of(const ResidualAt& at, const std::vector<brdf::RealisTexel<kChannels>>& texels,
                      const glm::vec3& v) {
  const baked::Residual& bake = *at.bake;
  if (at.drawn > 0) {
    const auto e = brdf::jittered_residual(bake.lobes, texels[at.pixels[0] * bake.groups], brdf::Vec3<float>(v), at.u,
                                           static_cast<std::size_t>(at.drawn));
    if constexpr (kChannels == 1) return glm::vec3(e);
    else return {e.r, e.g, e.b};
  }
  glm::vec3 sum(0);
  for (int i = 0; i < at.texels; ++i) {
    const std::size_t first = at.pixels[static_cast<std::size_t>(i)] * bake.groups;
    for (std::size_t group = 0; group < at.groups; ++group)
      sum += at.shares[static_cast<std::size_t>(i)] * sum_of(bake.lobes, texels[first + group], v);
  }
  return sum;
}

glm::vec3 mixed_residual(const ResidualAt& at, const glm::vec3& v) {
  const baked::Residual& bake = *at.bake;
  const std::size_t each = bake.mixes.count;
  brdf::RealisMixes::Towards mixes;
  bake.mixes.towards(brdf::Vec3<float>(v), bake.channels, mixes);
  glm::vec3 sum(0);
  for (int i = 0; i < at.texels; ++i) {
    const std::uint8_t* bytes = bake.mixed.data() + at.pixels[static_cast<std::size_t>(i)] * bake.channels * each;
    for (std::size_t c = 0; c < bake.channels; ++c, bytes += each)
      sum[static_cast<int>(c)] += at.shares[static_cast<std::size_t>(i)] * bake.mixes.eval(mixes[c], bytes);
  }
  return bake.is_rgb() ? sum : glm::vec3(sum.x);
}

glm::vec3 with_residual(const Bound& bound, glm::vec3 f_cos, const glm::vec3& to_light) {
  const ResidualAt& at = *bound.residual;
  const glm::vec3 e = at.towards(to_light);
  glm::vec3 least(0);
  if (at.is_soft && at.weight > 0) {
    const glm::vec3 diffuse = at.plain->base_color(bound) * (at.weight * std::numbers::inv_pi_v<float>);
    f_cos += diffuse * brdf::beyond_hard(to_light.z, static_cast<float>(at.bake->surface->spread));
    least = diffuse * static_cast<float>(at.bake->surface->least);
  }
  const auto out = brdf::with_residual(brdf::Rgb<float>(f_cos.r, f_cos.g, f_cos.b), brdf::Rgb<float>(e.r, e.g, e.b),
                                       1.0f, to_light.z, at.bake->floor);
  return glm::max(glm::vec3(out.r, out.g, out.b), least);
}

// Half of the directions are the model's own, half follow the cosine: what the residual adds is as broad as a diffuse.
float pdf_with(const ResidualAt& at, float plain, const glm::vec3& to_light) {
  return 0.5f * plain + 0.5f * std::numbers::inv_pi_v<float> * std::max(glm::dot(at.normal, to_light), 0.0f);
}

Value eval(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) {
  const Value plain = bound.residual->plain->eval(bound, to_light, to_view);
  return {with_residual(bound, plain.f_cos, to_light), pdf_with(*bound.residual, plain.pdf, to_light)};
}

glm::vec3 f_cos(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) {
  return with_residual(bound, bound.residual->plain->f_cos(bound, to_light, to_view), to_light);
}

Direction sample(const Bound& bound, const glm::vec3& to_view, float choice, const glm::vec2& u) {
  const ResidualAt& at = *bound.residual;
  glm::vec3 to_light;
  if (choice < 0.5f) {
    const Direction own = at.plain->sample(bound, to_view, 2 * choice, u);
    if (!(own.pdf > 0)) return {};
    to_light = own.to_light;
  } else {
    const float r = std::sqrt(u.x), phi = 2 * std::numbers::pi_v<float> * u.y;
    to_light = ray::Frame(at.normal).world({r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(1 - u.x, 0.0f))});
  }
  const Value value = eval(bound, to_light, to_view);
  if (!(value.pdf > 0)) return {};
  return {to_light, value.pdf, value.f_cos / value.pdf};
}

// The residual is diffuse; where it takes light away, first from the diffuse and then from the specular.
Lobes lobes(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) {
  const Lobes plain = bound.residual->plain->lobes(bound, to_light, to_view);
  const glm::vec3 whole = with_residual(bound, plain.diffuse + plain.specular, to_light);
  const glm::vec3 specular = glm::min(plain.specular, whole);
  return {whole - specular, specular};
}

glm::vec3 base_color(const Bound& bound) { return bound.residual->plain->base_color(bound); }

}  // namespace

void ResidualAt::place(const glm::vec2& uv, int lobes_drawn, const glm::vec2& choice) {
  const auto axis = [](float t, int size, int& first, int& second) {
    if (!(t > 0)) t = 0;  // NaN too
    const float x = std::min(t, 1.0f) * static_cast<float>(size) - 0.5f, below = std::floor(x);
    first = std::clamp(static_cast<int>(below), 0, size - 1);
    second = std::clamp(static_cast<int>(below) + 1, 0, size - 1);
    return x - below;
  };
  int x0, x1, y0, y1;
  const float tx = axis(uv.x, bake->width, x0, x1), ty = axis(uv.y, bake->height, y0, y1);
  const std::array<int, 4> xs{x0, x1, x0, x1}, ys{y0, y0, y1, y1};
  const std::array<float, 4> parts{(1 - tx) * (1 - ty), tx * (1 - ty), (1 - tx) * ty, tx * ty};
  texels = 0, drawn = lobes_drawn, u = choice.y;
  float before = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(parts[i] > 0)) continue;
    const auto pixel =
        static_cast<std::uint32_t>(ys[i]) * static_cast<std::uint32_t>(bake->width) + static_cast<std::uint32_t>(xs[i]);
    if (drawn > 0) {
      pixels[0] = pixel, shares[0] = 1, texels = 1;
      before += parts[i];
      if (choice.x < before) break;
      continue;
    }
    const auto at = static_cast<std::size_t>(texels++);
    pixels[at] = pixel, shares[at] = parts[i];
  }
}

glm::vec3 ResidualAt::towards(const glm::vec3& to_light) const {
  if (!(weight > 0) || is_empty()) return glm::vec3(0);
  const glm::vec3 v = model_from_local * to_light;
  if (bake->has_mixes()) return weight * mixed_residual(*this, v);
  return weight * (bake->is_rgb() ? residual_of(*this, bake->rgb, v) : residual_of(*this, bake->luminance, v));
}

float faded(const ResidualAt& at, const brdf::RealisFade& fade, const glm::vec3* base_color, const float* roughness,
            const glm::vec3& normal) {
  const baked::Surface& surface = *at.bake->surface;
  glm::vec3 color(0), direction(0);
  for (int i = 0; i < at.texels; ++i) {
    const std::size_t pixel = 3 * std::size_t{at.pixels[static_cast<std::size_t>(i)]};
    const float share = at.shares[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < 3; ++k) {
      color[static_cast<int>(k)] += share * surface.base_colors.rgb[pixel + k];
      direction[static_cast<int>(k)] += share * surface.normals.rgb[pixel + k];
    }
  }
  const float length = glm::length(direction);
  if (!(length > 0)) return 0;  // the bake knew no normal: it has no residual there
  const float baked_roughness = static_cast<float>(surface.material.roughness);
  const glm::vec3 now = base_color != nullptr ? *base_color : color;
  return fade.weight(
      brdf::Rgb<float>(color.r, color.g, color.b), baked_roughness, brdf::Rgb<float>(now.r, now.g, now.b),
      roughness != nullptr ? *roughness : baked_roughness,
      brdf::versine_between(brdf::Vec3<float>(glm::vec3(direction / length)), brdf::Vec3<float>(normal)));
}

Kernel residual_kernel() { return {&eval, &f_cos, &sample, &lobes, &base_color}; }

void bind_residual(const glm::mat3& model_from_world, float weight, Point& p) {
  ResidualAt& at = p.residual;
  at.bake = p.material->bake, at.plain = &p.material->plain_kernel, at.weight = weight;
  at.normal = p.frame.local(p.normal);
  at.model_from_local = model_from_world * glm::mat3(p.frame.x, p.frame.y, p.frame.z);
  at.groups = static_cast<std::uint32_t>(at.bake->groups);
  at.is_soft = at.bake->surface && (at.bake->surface->spread > 0 || at.bake->surface->least > 0);
  at.place(p.uv, 0, glm::vec2(0));
  p.bound.residual = &at;
}

// The back of a surface was not photographed. Of a roughness that bumps changed the material's own is compared.
void Surfaces::add_residual(scene::Index instance, Point& p) const {
  const Prepared& material = *p.material;
  const scene::Material::BakedResidual& baked = *material.material->residual;
  bind_residual(turns_[instance], p.is_back ? 0 : baked.strength, p);
  if (!baked.fade || p.is_back) return;
  const auto number = [&](const void* model, std::size_t place) {
    float x;
    std::memcpy(&x, static_cast<const std::byte*>(model) + place * sizeof x, sizeof x);
    return x;
  };
  glm::vec3 color(0);
  float roughness = 0;
  const bool has_color = material.base_color_at != kNoPlace, has_roughness = material.roughness_at != kNoPlace;
  if (has_color)
    for (std::size_t k = 0; k < 3; ++k) color[static_cast<int>(k)] = number(p.bound.model, material.base_color_at + k);
  if (has_roughness) {
    const bool varies = std::any_of(material.slots.begin(), material.slots.end(),
                                    [&](const Prepared::Slot& slot) { return slot.at == material.roughness_at; });
    roughness = number(varies ? p.bound.model : &material.model, material.roughness_at);
  }
  p.residual.weight *= faded(p.residual, *baked.fade, has_color ? &color : nullptr,
                             has_roughness ? &roughness : nullptr, turns_[instance] * p.shading_normal);
}

glm::mat3 model_from_world(const glm::mat3& world_from_object) {
  const glm::vec3 x = glm::normalize(world_from_object[0]);
  const glm::vec3 y = glm::normalize(world_from_object[1] - glm::dot(world_from_object[1], x) * x);
  glm::vec3 z = glm::cross(x, y);
  if (glm::dot(z, world_from_object[2]) < 0) z = -z;
  return glm::transpose(glm::mat3(x, y, z));
}

}  // namespace likeness::surface
