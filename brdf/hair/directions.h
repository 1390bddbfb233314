#pragma once

#include "brdf/hair/fibre_evaluators.h"

// How rows about the far field of a fibre are given their directions.
namespace likeness::brdf {

// Two directions as all of these forms read them.
template <Scalar S>
struct HairPair {
  Inclination<S> i, o;
  S theta_sum;             // theta_i + theta_o
  S distance;              // |phi_i - phi_o|, in [0, pi]
  S sin2_half, cos2_half;  // of half of it
};

// The ways to name them: inclinations and azimuth, or unit vectors in the frame of the fibre (x along it).
struct HairAngles {
  static constexpr std::array kInputs{kHairInclinations[0], kHairInclinations[1], kHairAzimuth};
  template <Scalar S>
  static HairPair<S> pair(const S* in) {
    const S half = in[2] * S(0.5);
    return {inclination_at(in[0]), inclination_at(in[1]), S(in[0] + in[1]), azimuth_distance(S(0), in[2], S(0), S(0)),
            squared(S(sin(half))), squared(S(cos(half)))};
  }
};
struct HairAxes {
  static constexpr auto kInputs = Vectors::kInputs;
  template <Scalar S>
  static HairPair<S> pair(const S* in) {
    const auto i = HairFibre<S>::inclination(Vec3<S>(in[0], in[1], in[2]));
    const auto o = HairFibre<S>::inclination(Vec3<S>(in[3], in[4], in[5]));
    const Inclination<S> a = across(in[1], in[2], i.cosine), b = across(in[4], in[5], o.cosine);
    const S apart2 = squared(S(a.sine - b.sine)) + squared(S(a.cosine - b.cosine));
    const S along2 = squared(S(a.sine + b.sine)) + squared(S(a.cosine + b.cosine));
    return {i,
            o,
            S(atan2(i.sine, i.cosine) + atan2(o.sine, o.cosine)),
            S(S(2) * atan2(safe_sqrt(apart2), safe_sqrt(along2))),
            S(apart2 * S(0.25)),
            S(along2 * S(0.25))};
  }

 private:
  // The direction across the fibre as a unit vector (cosine, sine); 0 azimuth for a direction along it.
  template <Scalar S>
  static Inclination<S> across(const S& y, const S& z, const S& length) {
    const auto usable = greater(length, constant<S>(kTiny<S>));
    const S scale = S(1) / pick(usable, length, S(1));
    return {pick(usable, S(z * scale), S(0)), pick(usable, S(y * scale), S(1))};
  }
};

// A row's inputs: directions, then its parameters. Row::store(pair, parameters, features) prepares.
template <class Directions, class Row>
struct HairForm {
  static constexpr auto kInputs = joined(Directions::kInputs, Row::kParameters);
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    Row::store(Directions::template pair<S>(in), in + Directions::kInputs.size(), features);
  }
};
template <class Row>
struct HairForms {
  using Forms = std::tuple<HairForm<HairAngles, Row>, HairForm<HairAxes, Row>>;
  static constexpr std::array kOutputs{HairFibreRow::kOutputs[0], HairFibreRow::kOutputs[1]};
};

}  // namespace likeness::brdf
