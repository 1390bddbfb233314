#pragma once

#include <cstddef>
#include <numbers>

#include "brdf/diffuse/microfacet_diffuse.h"
#include "brdf/grid.h"

namespace likeness::brdf {

// microfacet_diffuse() from a table over (alpha, theta_o, theta_i), for one azimuth or for all.
//
//     microfacet_diffuse ~= q(alpha, x_o, x_i) s(cos_o) s(cos_i) / (pi cos_o cos_i)
//     s(c) = (c + sqrt(c^2 + alpha^2 (1 - c^2))) / 2
//
// s is the projected area of the facets that face a direction; q, which the table holds, is how much more often than by
// chance a facet faces both. It stays between 0 and 20 at every angle, so nothing blows up in the table. Its axes are
// sqrt(alpha), which is the roughness, and x = tan(half the angle whose tangent is alpha tan(theta)): what happens at
// grazing angles of a smooth surface spreads over the table as what happens everywhere on a rough one.
//
// Source  The Callisto Protocol (SIGGRAPH 2023, Advances), which holds light and viewer coplanar, phi_v = phi_l: both
//         on the same side of the normal. What is tabulated, the axes and the azimuths of the second form are this
//         project's.
// Error   at the azimuths it holds: 0.3 % at most from alpha = 0.02 on, 1.4 % at grazing angles below, 0.08 % rms.
//         docs/models/microfacet_diffuse.md has it by axis, and what the one azimuth costs at others.

// kAzimuths = 1: phi = 0, and taken as that whatever phi is. kAzimuths = 3: phi = 0, pi / 2 and pi, and the parabola in
// cos(phi) through them between.
template <std::size_t kAzimuths>
class MicrofacetDiffuseTable {
  static_assert(kAzimuths == 1 || kAzimuths == 3);

 public:
  static constexpr std::size_t kAlphas = 32, kAngles = 16;

  MicrofacetDiffuseTable() {
    for (std::size_t a = 0; a < kAlphas; ++a)
      for (std::size_t o = 0; o < kAngles; ++o)
        for (std::size_t i = 0; i <= o; ++i)
          for (std::size_t azimuth = 0; azimuth < kAzimuths; ++azimuth) {
            const float q = baked(a, o, i, azimuth);
            q_.data[q_.index(i, o, a) + azimuth] = q_.data[q_.index(o, i, a) + azimuth] = q;
          }
  }

  // f / rho and f cos_i / rho as microfacet_diffuse() has them. alpha = 0 is Lambert exactly.
  template <Scalar S>
  Reflected<S> eval(const S& alpha, const PolarPair<S>& p) const {
    const auto above = both(greater(p.cos_o, S(0)), greater(p.cos_i, S(0)));
    const auto rough = greater(alpha, constant<S>(kTiny<S>));
    const S a = pick(rough, smaller(alpha, S(1)), constant<S>(kTiny<S>));
    const Lean<S> o(a, pick(above, larger(p.cos_o, constant<S>(kTiny<S>)), S(1)), p.sin_o);
    const Lean<S> i(a, pick(above, larger(p.cos_i, constant<S>(kTiny<S>)), S(1)), p.sin_i);
    S q[kAzimuths];
    q_.lookup(i.x, o.x, S(sqrt(a)), q);
    if constexpr (kAzimuths == 3) {
      const S slope = S(0.5) * (q[0] - q[2]), bend = S(0.5) * (q[0] + q[2]) - q[1];
      q[0] = q[1] + p.cos_phi * (slope + p.cos_phi * bend);
    }
    const S f_cos = q[0] * o.area * i.area / o.cosine * constant<S>(std::numbers::inv_pi);
    const S lambert = constant<S>(std::numbers::inv_pi);
    return {pick(above, pick(rough, S(f_cos / i.cosine), lambert), S(0)),
            pick(above, pick(rough, f_cos, S(lambert * i.cosine)), S(0))};
  }

  // q at a node.
  double at_node(std::size_t alpha, std::size_t o, std::size_t i, std::size_t azimuth) const {
    return double(q_.data[q_.index(i, o, alpha) + azimuth]);
  }

 private:
  using Table = Grid<kAngles, kAngles, kAlphas, kAzimuths>;

  template <Scalar S>
  struct Lean {
    S cosine, area, x;
    Lean(const S& alpha, const S& cosine_in, const S& sine) : cosine(cosine_in) {
      const S leaning = alpha * sine, sum = cosine + sqrt(S(cosine * cosine + leaning * leaning));
      area = S(0.5) * sum;
      x = leaning / sum;
    }
  };

  static float baked(std::size_t a, std::size_t o, std::size_t i, std::size_t azimuth) {
    // The first node stands for the smooth surfaces up to the second one: its own alpha would hold nothing.
    const double alpha = a == 0 ? 1e-4 : squared(Table::coordinate(2, a)), phi = double(azimuth) * std::numbers::pi / 2;
    const auto theta = [&](double x) { return atan2(2 * x, alpha * (1 - x) * (1 + x)); };
    PolarPair<double> p = PolarPair<double>::at(theta(Table::coordinate(1, o)), theta(Table::coordinate(0, i)), phi);
    if (o == kAngles - 1) p.cos_o = 0;  // not the cosine of pi / 2 rounded
    if (i == kAngles - 1) p.cos_i = 0;
    return float(MicrofacetSlopes<double>(alpha).projected(p) /
                 (Lean<double>(alpha, p.cos_o, p.sin_o).area * Lean<double>(alpha, p.cos_i, p.sin_i).area));
  }

  Table q_;
};

}  // namespace likeness::brdf
