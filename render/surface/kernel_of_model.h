#pragma once

#include <concepts>

#include <glm/common.hpp>

#include "brdf/sampling.h"
#include "render/surface/kernel.h"

// The functions of a Kernel as templates; each source file instantiates those of its models.
namespace likeness::surface {

inline glm::vec3 to_glm(const brdf::Rgb<float>& c) { return {c.r, c.g, c.b}; }
inline glm::vec3 to_glm(const brdf::Vec3<float>& v) { return {v.x, v.y, v.z}; }

template <class M>
const M& model_of(const Bound& bound) {
  return *static_cast<const M*>(bound.model);
}

// A model, or the part of one, as the functions below use it.
template <class M>
struct Whole {
  static brdf::Rgb<float> eval(const Bound& b, const brdf::Geometry<float>& g) { return model_of<M>(b).eval(g); }
  static auto lobes(const Bound& b, const brdf::Vec3<float>& to_view) { return model_of<M>(b).lobes(to_view); }
};
template <unsigned kParts>
struct PartOfCallisto {
  using M = brdf::Callisto<float>;
  static brdf::Rgb<float> eval(const Bound& b, const brdf::Geometry<float>& g) {
    return model_of<M>(b).eval<kParts>(g);
  }
  static auto lobes(const Bound& b, const brdf::Vec3<float>& to_view) { return model_of<M>(b).lobes<kParts>(to_view); }
};

template <class M, class How>
Value eval_with(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) {
  const brdf::Vec3<float> view(to_view);
  const brdf::Geometry<float> g(to_light, view);
  if (!g.above) return {};
  return {to_glm(How::eval(bound, g)) * g.cos_i, brdf::lobes_pdf(How::lobes(bound, view), g)};
}

template <class M, class How>
glm::vec3 f_cos_with(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) {
  const brdf::Geometry<float> g{brdf::Vec3<float>(to_light), brdf::Vec3<float>(to_view)};
  if (!g.above) return glm::vec3(0);
  return to_glm(How::eval(bound, g)) * g.cos_i;
}

template <class Lobes>
brdf::Vec3<float> light_of(const Lobes& lobes, const brdf::Vec3<float>& view, float choice, const glm::vec2& u) {
  if constexpr (requires { lobes.light(view, choice, u.x, u.y); }) return lobes.light(view, choice, u.x, u.y);
  else return lobes.light(view, u.x, u.y);
}

template <class M, class How>
Direction sample_with(const Bound& bound, const glm::vec3& to_view, float choice, const glm::vec2& u) {
  const brdf::Vec3<float> view(to_view);
  const auto lobes = How::lobes(bound, view);
  const brdf::Vec3<float> light = light_of(lobes, view, choice, u);
  const brdf::Geometry<float> g(light, view);
  if (!g.above) return {};
  const float pdf = lobes.density(g);
  if (!(pdf > 0)) return {};
  return {to_glm(light), pdf, to_glm(How::eval(bound, g)) * (g.cos_i / pdf)};
}

template <class M>
concept IsCallisto = std::derived_from<M, brdf::Callisto<float>>;

// The diffuse and the specular part of Callisto. Another model is one of them as a whole.
template <class M, class How = Whole<M>>
Lobes lobes_with(const Bound& bound, const glm::vec3& to_light, const glm::vec3& to_view) {
  const M& model = model_of<M>(bound);
  const brdf::Geometry<float> g{brdf::Vec3<float>(to_light), brdf::Vec3<float>(to_view)};
  if (!g.above) return {};
  const glm::vec3 whole = to_glm(How::eval(bound, g)) * g.cos_i;
  if constexpr (IsCallisto<M>) {
    const auto t = model.terms(g);
    const auto specular = model.for_channels([&](float rho, float, float, float o) {
      return M::specular_part(t, model.metallic, model.specular, rho) * brdf::mix(1.0f, t.shade, o);
    });
    const glm::vec3 glossy = to_glm(specular) * g.cos_i;
    return {glm::max(whole - glossy, glm::vec3(0)), glossy};
  } else if constexpr (requires { model.f0; }) {
    return {glm::vec3(0), whole};
  } else {
    return {whole, glm::vec3(0)};
  }
}

template <class M>
glm::vec3 base_color_of(const Bound& bound) {
  if constexpr (requires(const M& m) { m.base_color; }) return to_glm(model_of<M>(bound).base_color);
  else return to_glm(model_of<M>(bound).f0);
}

template <class M, class How>
constexpr Kernel kernel_with() {
  return {&eval_with<M, How>, &f_cos_with<M, How>, &sample_with<M, How>, &lobes_with<M>, &base_color_of<M>};
}

}  // namespace likeness::surface
