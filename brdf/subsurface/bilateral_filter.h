#pragma once

#include "brdf/subsurface/burley_profile.h"
#include "brdf/vector.h"

// The screen-space filter: what its samples weigh, and their mean.
//
//     I = sum_i w_i L_i / sum_i w_i,   w_i = R(sqrt(r_i^2 + d_i^2)) / p(r_i)
//
// r_i  distance of sample i from the center, on the disk it was drawn on; p its density over that disk
// d_i  difference of depth between the sample's surface and the disk: the profile is taken at the true distance
//
// Dividing by the sum keeps the energy: what is lit alike stays as it is, whatever the depths do to the weights.
// Assumes  the disk stands in for the surface: the area that a sample stands for is that of the disk.
// Source   'Efficient Screen-Space Subsurface Scattering' (SIGGRAPH 2018 Advances), 'Bilateral Filtering'.
namespace likeness::brdf {

// w / A of a radius that was drawn for the shape s_drawn, [1]. With s_drawn of the widest channel (BurleyDisk::widest) no
// weight exceeds s / s_drawn. At depth 0 and s = s_drawn it is 1 at every r, and it falls as exp(-s |depth| / 3). Where s
// is less than s_drawn it grows with r without end; it is held below exp(60).
//
// R and p are divided before either rounds to 0: with D = sqrt(r^2 + d^2),
//     w / A = s r / (s_drawn D) exp(-e / 3) (1 + exp(-2 s D / 3)) / (1 + exp(-2 s_drawn r / 3))
//     e = s D - s_drawn r = (s - s_drawn) D + s_drawn d^2 / (D + r)
template <Scalar S>
struct BilateralWeight {
  S excess, scale, x, x_drawn;  // e, s r / (s_drawn D), s D, s_drawn r

  // r >= 0, depth of either sign.
  static BilateralWeight at(const S& r, const S& depth, const S& s, const S& s_drawn) {
    const S held = larger(r, constant<S>(kTiny<S>)), d2 = depth * depth;
    const S length = sqrt(S(held * held + d2));
    return {S((s - s_drawn) * length + s_drawn * (d2 / (length + held))), S(s / s_drawn * (held / length)),
            S(s * length), S(s_drawn * held)};
  }
  S value() const {
    const S third = constant<S>(-1.0 / 3.0), two = S(2) * third;
    return scale * exp(smaller(S(excess * third), S(60))) * (S(1) + exp(S(x * two))) / (S(1) + exp(S(x_drawn * two)));
  }
};

// The mean of the samples around one pixel, by channel. The center's own radiance joins with the weight 2^-40: where all
// other weights are 0, because everything around lies far in front or behind, it is the result, to the last bit; and as
// the weights vanish the mean turns to it without a jump.
template <Scalar S>
class BilateralMean {
 public:
  static constexpr double kCenter = 0x1p-40;

  explicit BilateralMean(const Rgb<S>& center) : sum_(center * constant<S>(kCenter)), weights_(constant<S>(kCenter)) {}

  // `weight` >= 0 by channel: BilateralWeight of that channel's s, or any R / p whose scale is 1.
  void add(const Rgb<S>& weight, const Rgb<S>& radiance) {
    sum_ = sum_ + weight * radiance;
    weights_ = weights_ + weight;
  }
  Rgb<S> value() const { return {S(sum_.r / weights_.r), S(sum_.g / weights_.g), S(sum_.b / weights_.b)}; }

 private:
  Rgb<S> sum_, weights_;
};

}  // namespace likeness::brdf
