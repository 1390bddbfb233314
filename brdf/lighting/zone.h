#pragma once

#include "brdf/scalar.h"

namespace likeness::brdf {

// Exposure zones: 17 of them, each one stop wide, after Adams's eleven. Middle grey is in the middle of its zone: by
// default 0.18 is zone V, so that 0 to XVI are -5 to +11 EV; with grey_zone 8 the numbering is symmetric: the zone
// less 8 runs from -8 to +8.
//
// Source  "The Rendering of The Callisto Protocol": 17 zones in place of 11, for high dynamic range.
struct Zones {
  static constexpr int kCount = 17;
  static constexpr double kMiddleGrey = 0.18, kGreyZone = 5;
};

// Stops above middle grey, log2(luminance / middle_grey). Luminance at or below 1e-30, 0, negative and NaN are taken as
// 1e-30 (97 stops below), and above 1e30 as 1e30 (102 above): the result is finite.
template <Scalar S>
S exposure_of(const S& luminance, const S& middle_grey) {
  const S kept = smaller(larger(luminance, constant<S>(1e-30)), constant<S>(1e30));
  return log(S(kept / middle_grey)) * constant<S>(1.4426950408889634);
}

// The zone as a continuous number: whole in the middle of a zone, not limited to the 17.
template <Scalar S>
S zone_of(const S& luminance, const S& middle_grey, const S& grey_zone) {
  return grey_zone + exposure_of(luminance, middle_grey);
}

// The zone's index, 0 to 16: what is darker than zone 0 is in it, and what is brighter than XVI in that.
template <Scalar S>
S zone_index(const S& zone) {
  return smaller(positive(S(floor(S(zone + S(0.5))))), S(Zones::kCount - 1));
}

// The luminance in the middle of a zone.
template <Scalar S>
S luminance_of_zone(const S& zone, const S& middle_grey, const S& grey_zone) {
  return middle_grey * exp(S((zone - grey_zone) * constant<S>(0.6931471805599453)));
}

}  // namespace likeness::brdf
