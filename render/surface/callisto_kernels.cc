#include <numbers>
#include <utility>

#include "brdf/dual_normal.h"
#include "brdf/proxima.h"
#include "render/surface/kernel_of_model.h"

namespace likeness::surface {
namespace {

using C = brdf::Callisto<float>;

// Rises need the diffuse that they raise.
constexpr unsigned possible(unsigned parts) {
  return (parts & (C::kRise | C::kRetro)) != 0 ? parts | C::kDiffuse : parts;
}

template <unsigned... P>
constexpr std::array<Kernel, sizeof...(P)> kernels_for(std::integer_sequence<unsigned, P...>) {
  return {kernel_with<C, PartOfCallisto<possible(P)>>()...};
}
constexpr auto kKernels = kernels_for(std::make_integer_sequence<unsigned, C::kAllParts + 1>{});

// ---- dual normals: the whole of the model, with Proxima of Bound::bumps, which is Lambert where there are none; the frame
// is that of the surface.

struct Pairs {
  brdf::Geometry<float> diffuse, specular;

  Pairs(const Bound& bound, const brdf::Vec3<float>& light, const brdf::Vec3<float>& view)
      : diffuse(brdf::geometry_about(brdf::Vec3<float>(bound.diffuse_normal), light, view)),
        specular(brdf::geometry_about(brdf::Vec3<float>(bound.specular_normal), light, view)) {}

  glm::vec3 f_cos(const C& model, float bumps) const {
    const float shape =
        std::numbers::inv_pi_v<float> * brdf::proxima_factor(bumps, diffuse.cos_i, brdf::proxima_turn(diffuse));
    return to_glm(brdf::dual_normal(model, diffuse, specular, shape));
  }
};

// A frame about a normal, and a view in it that is above its horizon.
struct About {
  brdf::Vec3<float> x, y, z, view;

  About(const glm::vec3& n, const glm::vec3& to_view) : z(n) {
    const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    x = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    y = {b, sign + n.y * n.y * a, -n.y};
    const brdf::Vec3<float> v(to_view);
    const float up = brdf::dot(v, z), across2 = std::max(1 - up * up, 0.0f);
    constexpr float kLeast = 1e-3f;
    const float lift = up < kLeast && across2 > 0 ? std::sqrt((1 - kLeast * kLeast) / across2) : 1.0f;
    view = {brdf::dot(v, x) * lift, brdf::dot(v, y) * lift, std::max(up, kLeast)};
  }
  brdf::Vec3<float> local(const glm::vec3& w) const {
    const brdf::Vec3<float> v(w);
    return {brdf::dot(v, x), brdf::dot(v, y), brdf::dot(v, z)};
  }
  glm::vec3 out(const brdf::Vec3<float>& w) const { return to_glm(x * w.x + y * w.y + z * w.z); }
};

// Lobes are sampled about the normal of the part that they belong to, in the shares that the model has at the surface.
struct DualLobes {
  const C& model;
  About diffuse, specular;
  float diffuse_share, cosine_share;  // the latter: of the diffuse one's samples
  brdf::GgxLobe<float> first, second;

  DualLobes(const Bound& bound, const glm::vec3& to_view)
      : model(model_of<C>(bound)),
        diffuse(bound.diffuse_normal, to_view),
        specular(bound.specular_normal, to_view),
        diffuse_share(model.lobes(diffuse.view).share(0)),
        cosine_share(bound.bumps > 0 ? brdf::Proxima<float>{.alpha = bound.bumps}.lobes(diffuse.view).share(0) : 1),
        first(brdf::alpha_of_roughness(model.roughness)),
        second(model.second_alpha()) {}

  glm::vec3 light(float choice, const glm::vec2& u) const {
    if (choice < diffuse_share * cosine_share)
      return diffuse.out(brdf::CosineLobe<float>{}.light(diffuse.view, u.x, u.y));
    if (choice < diffuse_share) return diffuse.out(brdf::HemisphereLobe<float>{}.light(diffuse.view, u.x, u.y));
    const bool takes_first = choice - diffuse_share < (1 - diffuse_share) * (1 - model.dual_specular_opacity);
    return specular.out((takes_first ? first : second).light(specular.view, u.x, u.y));
  }
  float density(const glm::vec3& to_light) const {
    const brdf::Vec3<float> below = diffuse.local(to_light), above = specular.local(to_light);
    float sum = 0;
    if (below.z > 0) {
      const brdf::Geometry<float> g(below, diffuse.view);
      sum += diffuse_share *
             brdf::mix(brdf::HemisphereLobe<float>{}.density(g), brdf::CosineLobe<float>{}.density(g), cosine_share);
    }
    if (above.z > 0) {
      const brdf::Geometry<float> g(above, specular.view);
      sum += (1 - diffuse_share) * brdf::mix(first.density(g), second.density(g), model.dual_specular_opacity);
    }
    return sum;
  }
};

Value eval_dual(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) {
  if (!(to_light.z > 0) || !(to_view.z > 0)) return {};
  const Pairs pairs(bound, to_light, to_view);
  return {pairs.f_cos(model_of<C>(bound), bound.bumps), DualLobes(bound, to_view).density(to_light)};
}

glm::vec3 f_cos_dual(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) {
  if (!(to_light.z > 0) || !(to_view.z > 0)) return glm::vec3(0);
  return Pairs(bound, to_light, to_view).f_cos(model_of<C>(bound), bound.bumps);
}

Direction sample_dual(const Bound& bound, const glm::vec3& to_view, float choice, const glm::vec2& u) {
  if (!(to_view.z > 0)) return {};
  const DualLobes lobes(bound, to_view);
  const glm::vec3 light = lobes.light(choice, u);
  const float pdf = lobes.density(light);
  if (!(light.z > 0) || !(pdf > 0)) return {};
  const Pairs pairs(bound, light, to_view);
  return {light, pdf, pairs.f_cos(lobes.model, bound.bumps) / pdf};
}

Lobes lobes_dual(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) {
  if (!(to_light.z > 0) || !(to_view.z > 0)) return {};
  const Pairs pairs(bound, to_light, to_view);
  const C& model = model_of<C>(bound);
  const glm::vec3 whole = pairs.f_cos(model, bound.bumps);
  C black = model;
  black.base_color = brdf::Rgb<float>(0.0f);
  const glm::vec3 glossy = model.metallic >= 1 ? whole : pairs.f_cos(black, bound.bumps);
  return {glm::max(whole - glossy, glm::vec3(0)), glossy};
}

}  // namespace

Kernel callisto_kernel(unsigned parts, bool has_dual_normals) {
  if (has_dual_normals) return {&eval_dual, &f_cos_dual, &sample_dual, &lobes_dual, &base_color_of<C>};
  return kKernels[parts & C::kAllParts];
}

}  // namespace likeness::surface
