#pragma once

#include "brdf/vector.h"

// What every model that can be sampled offers, beside eval():
//
//     Sample<S> sample(const Vec3<S>& to_view, const S& choice, const S& u, const S& v) const;
//     S pdf(const Vec3<S>& to_light, const Vec3<S>& to_view) const;      // [1/sr], over solid angle
//
// choice, u and v are independent and uniform in [0, 1); choice selects a lobe and is then used up. There is no branch
// on a value: all three lobes of a batch are sampled and one is kept in each lane.
namespace likeness::brdf {

// A direction that a model proposes. Where pdf is 0 there is none: weight is 0 and to_light is the normal.
template <Scalar S>
struct Sample {
  Vec3<S> to_light;  // unit, leaving the surface
  S pdf = S(0.0);    // [1/sr]: of all lobes together, the same number that pdf(to_light, to_view) gives
  Rgb<S> weight;     // f cos_i / pdf
};

// A model that can be sampled.
template <class M>
concept Sampled = requires(const M& model, const Vec3<double>& w, double u) {
  model.sample(w, u, u, u);
  model.pdf(w, w);
};

}  // namespace likeness::brdf
