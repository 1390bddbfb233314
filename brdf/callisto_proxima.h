#pragma once

#include "brdf/callisto.h"
#include "brdf/proxima.h"

namespace likeness::brdf {

// Parts of Callisto over microfacets of an alpha of their own, which need not be that of its lobes: a surface whose bumps
// are too small to be seen has Lambert's diffuse at alpha 0, and Proxima's as they vanish. Same contract as below.
template <unsigned kParts, Scalar S, Scalar T>
Rgb<S> callisto_over_proxima(const Callisto<S>& model, const Geometry<T>& g, const S& alpha) {
  const S factor = proxima_factor(alpha, g.cos_i, proxima_turn(g));
  return model.template combined<kParts>(g.above, model.template terms<kParts>(g),
                                         S(factor * constant<S>(std::numbers::inv_pi)));
}
// Callisto's lobes, the diffuse one split as Proxima's is. Needs kDiffuse among the parts.
template <unsigned kParts, Scalar S>
auto callisto_over_proxima_lobes(const Callisto<S>& model, const Vec3<S>& to_view, const S& alpha) {
  static_assert((kParts & Callisto<S>::kDiffuse) != 0);
  const auto plain = model.template lobes<kParts>(to_view);
  const S cosine = plain.share(0) * (S(1) - constant<S>(0.55) * alpha),
          rest = plain.share(0) * constant<S>(0.38) * alpha;
  const GgxLobe<S> first(alpha_of_roughness(model.roughness));
  if constexpr ((kParts & Callisto<S>::kSecondLobe) != 0)
    return Mixture<S, CosineLobe<S>, HemisphereLobe<S>, GgxLobe<S>, GgxLobe<S>>(
        {cosine, rest, plain.share(1), plain.share(2)}, {}, {}, first, GgxLobe<S>(model.second_alpha()));
  else return Mixture<S, CosineLobe<S>, HemisphereLobe<S>, GgxLobe<S>>({cosine, rest, plain.share(1)}, {}, {}, first);
}

// The Callisto BRDF over a surface of GGX microfacets: Lambert is replaced by Proxima, everything else is Callisto's.
//
//     f(l, v) = (c1 f_proxima + f_ggx) c2                       [1/sr], cosine not included
//
// Proxima's alpha is that of the sharper lobe, alpha_of_roughness(roughness): one map of roughness, filtered with its
// normals (brdf/normal_length.h), serves the diffuse and the specular.
//
// Source      Jimenez and Petersen, "The Rendering of The Callisto Protocol", SIGGRAPH 2023 Advances ('Callisto BRDF +
//             Proxima BRDF'). The talk calls it an approximation of what Callisto would be on those microfacets.
// Departures  those of Callisto. alpha is kept above 1e-4 as GGX needs it, so roughness 0 is not quite Lambert's diffuse:
//             f is off by at most 1.9e-5 / cos_i of it.
// Frame       local: z along the shading normal.
// Directions  unit, both leaving the surface. If either is at or below the horizon, f = 0.
// Holds       at c1 = 1 and c2 = 1 (its defaults) f is Proxima + GGX, bit for bit.
// Does not    hold f(l, v) = f(v, l): Proxima and c2 see the light's cosine only. Nor does it conserve energy.
template <Scalar S>
struct CallistoProxima : Callisto<S> {
  static constexpr std::string_view kName = "callisto_proxima";
  static constexpr std::string_view kText = "Callisto with Proxima in the place of its Lambert";
  static constexpr Promises kPromises{.reciprocal = false, .energy = Energy::kUnbounded, .fades = false};
  static constexpr bool kFitted = false;  // made for filtered materials at a distance, not for measured ones

  template <Scalar T>
  Rgb<S> eval(const Geometry<T>& g) const {
    return callisto_over_proxima<Callisto<S>::kAllParts>(*this, g, alpha_of_roughness(this->roughness));
  }
  // f cos_i, [1/sr]: Proxima is not divided by the cosine.
  template <Scalar T>
  Rgb<S> eval_cos(const Geometry<T>& g) const {
    const S factor = proxima_factor_cos(alpha_of_roughness(this->roughness), g.cos_i, proxima_turn(g));
    auto terms = this->terms(g);
    terms.lobe = terms.lobe * g.cos_i;
    return this->combined(g.above, terms, S(factor * constant<S>(std::numbers::inv_pi)));
  }
  Rgb<S> eval(const Vec3<S>& to_light, const Vec3<S>& to_view) const { return eval(Geometry<S>(to_light, to_view)); }
  Rgb<S> eval_cos(const Vec3<S>& to_light, const Vec3<S>& to_view) const {
    return eval_cos(Geometry<S>(to_light, to_view));
  }

  auto lobes(const Vec3<S>& to_view) const {
    return callisto_over_proxima_lobes<Callisto<S>::kAllParts>(*this, to_view, alpha_of_roughness(this->roughness));
  }
  Sample<S> sample(const Vec3<S>& to_view, const S& choice, const S& u, const S& v) const {
    return sample_lobes(*this, to_view, choice, u, v);
  }
  S pdf(const Vec3<S>& to_light, const Vec3<S>& to_view) const {
    return lobes_pdf(lobes(to_view), Geometry<S>(to_light, to_view));
  }
};

}  // namespace likeness::brdf
