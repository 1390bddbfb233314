#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <tuple>
#include <utility>

#include "brdf/geometry.h"
#include "brdf/warp.h"

// What every model that can be sampled offers, beside eval():
//
//     Sample<S> sample(const Vec3<S>& to_view, const S& choice, const S& u, const S& v) const;
//     S pdf(const Vec3<S>& to_light, const Vec3<S>& to_view) const;      // [1/sr], over solid angle
//
// choice, u and v are independent and uniform in [0, 1); choice selects a lobe and is then used up. There is no branch
// on a value: all lobes of a batch are sampled and one is kept in each lane.
//
// A model states lobes(to_view): one lobe, or a Mixture of them, each with light(to_view, u, v), which proposes a
// direction, and density(geometry), [1/sr], of a pair above the horizon. sample_lobes() and lobes_pdf() do the rest.
namespace likeness::brdf {

// A direction that a model proposes. Where pdf is 0 there is none: weight is 0 and to_light is the normal. That is so of
// a view at or below the horizon, and of directions proposed below it: the pdf integrates to 1 less their share.
template <Scalar S>
struct Sample {
  Vec3<S> to_light;  // unit, leaving the surface
  S pdf = S(0.0);    // [1/sr]: of all lobes together, the same number that pdf(to_light, to_view) gives
  Rgb<S> weight;     // f cos_i / pdf
};

// A model that can be sampled.
template <class M>
concept Sampled = requires(const M& model, const Vec3<double>& w, double u) {
  { model.sample(w, u, u, u) } -> std::same_as<Sample<double>>;
  { model.pdf(w, w) } -> std::same_as<double>;
};

// cos_i / pi, for what scatters evenly. No direction is proposed below the horizon, and none above it has no density: the
// cosine is kept above kTiny, because a denormal one times 1 / pi would be 0.
template <Scalar S>
struct CosineLobe {
  Vec3<S> light(const Vec3<S>&, const S& u, const S& v) const { return cosine_hemisphere(u, v); }
  S density(const Geometry<S>& g) const {
    return larger(g.cos_i, constant<S>(kTiny<S>)) * constant<S>(std::numbers::inv_pi);
  }
};

// Lobes in proportion to `energies`, which are >= 0. If all are 0 the last lobe is taken.
template <Scalar S, class... Lobes>
class Mixture {
 public:
  static constexpr std::size_t kLobes = sizeof...(Lobes);

  explicit Mixture(const std::array<S, kLobes>& energies, const Lobes&... lobes) : lobes_(lobes...) {
    S sum(0.0);
    for (std::size_t i = 0; i < kLobes; ++i) up_to_[i] = sum = sum + energies[i];
    const auto usable = greater(sum, constant<S>(kTiny<S>));
    const S whole = pick(usable, sum, S(1));
    // Divided, not multiplied by a reciprocal: before a last lobe of energy 0 the shares reach 1 exactly.
    for (std::size_t i = 0; i + 1 < kLobes; ++i) up_to_[i] = pick(usable, S(up_to_[i] / whole), S(0));
    up_to_[kLobes - 1] = S(1);
  }

  // The part of the samples that goes to lobe i.
  S share(std::size_t i) const { return i == 0 ? up_to_[0] : S(up_to_[i] - up_to_[i - 1]); }

  Vec3<S> light(const Vec3<S>& to_view, const S& choice, const S& u, const S& v) const {
    Vec3<S> kept = std::get<kLobes - 1>(lobes_).light(to_view, u, v);
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      ((kept =
            keep(greater(up_to_[kLobes - 2 - I], choice), std::get<kLobes - 2 - I>(lobes_).light(to_view, u, v), kept)),
       ...);
    }(std::make_index_sequence<kLobes - 1>{});
    return kept;
  }

  S density(const Geometry<S>& g) const {
    S sum(0.0);
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      ((sum = sum + share(I) * std::get<I>(lobes_).density(g)), ...);
    }(std::make_index_sequence<kLobes>{});
    return sum;
  }

 private:
  template <class Mask>
  static Vec3<S> keep(const Mask& first, const Vec3<S>& a, const Vec3<S>& b) {
    return {pick(first, a.x, b.x), pick(first, a.y, b.y), pick(first, a.z, b.z)};
  }

  std::tuple<Lobes...> lobes_;
  std::array<S, kLobes> up_to_;  // share of this lobe and those before it
};

// The density of what `lobes` propose, [1/sr]: 0 if either direction is at or below the horizon.
template <class Lobes, Scalar S>
S lobes_pdf(const Lobes& lobes, const Geometry<S>& g) {
  return pick(g.above, lobes.density(g), S(0));
}

// A sample of the lobes that `model` states. `choice` is left alone by a model of one lobe.
template <class M, Scalar S>
Sample<S> sample_lobes(const M& model, const Vec3<S>& to_view, const S& choice, const S& u, const S& v) {
  const auto lobes = model.lobes(to_view);
  Vec3<S> l;
  if constexpr (requires { lobes.light(to_view, choice, u, v); }) l = lobes.light(to_view, choice, u, v);
  else l = lobes.light(to_view, u, v);
  const Geometry<S> g(l, to_view);
  const S pdf = lobes_pdf(lobes, g);
  const auto usable = greater(pdf, S(0));
  const S scale = pick(usable, S(g.cos_i / pick(usable, pdf, S(1))), S(0));
  const Rgb<S> f = model.eval(g);
  Sample<S> sample;
  sample.to_light = {pick(usable, l.x, S(0)), pick(usable, l.y, S(0)), pick(usable, l.z, S(1))};
  sample.pdf = pick(usable, pdf, S(0));
  sample.weight = {pick(usable, S(f.r * scale), S(0)), pick(usable, S(f.g * scale), S(0)),
                   pick(usable, S(f.b * scale), S(0))};
  return sample;
}

}  // namespace likeness::brdf
