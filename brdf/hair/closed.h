#pragma once

#include <array>
#include <cstddef>
#include <numbers>

#include "brdf/hair/closed_fit.h"
#include "brdf/hair/far_lobes.h"

namespace likeness::brdf {

// The far field of a fibre in closed form, fitted to hair_far at eta = 1.55 (brdf/hair/fit_closed.py). With
// q = s / (s + 0.3) and coefficients that are polynomials in q and cos(theta):
//
//     N_R      = y exp(a + b y + c y^2)                                 y = sqrt(cos^2(phi/2) + w^2),  w = q (w0 + w1 q)
//     N_TT     = cos^2(theta) exp(a + b x + c x^2 + d x^3)                              x = cos phi
//     N_TRT    = cos^2(theta) exp(a - b g / (sqrt(r^2 + g) + r) + c g)                  g = 4 sin^2(phi/2)
//     longer   = cos(theta) / (2 pi) exp(a + ...)                                       even in azimuth
//
// each but R times what absorption leaves: hair_depth() and hair_longer_share() with fitted ways.
//
// Source   ours. Karis 2016 and file 002 fit exp(a + b cos phi) at one width for TT and TRT; the higher powers, the root
//          and the coefficients' dependence on width and inclination are what is added.
// Holds    against hair_far over beta_n 0.1 to 1, every inclination and azimuth, without absorption: relative rms error
//          over phi 2 % of R, 1.5 % of TT, 6 % of TRT in the mean; energies within 1.5 %, 1.2 % and 5 %.
// Does not resolve the caustics of TRT below beta_n = 0.2 (rms error up to 34 % of TRT there). eta is 1.55.
//
// What depends on the width of the material alone is collapsed when it is made: keep one for each material.
template <Scalar S>
class HairClosed {
 public:
  // Beyond these widths s [rad] of the azimuthal logistic the nearer one is taken: beta_n = 0.1 and 1 are 0.0241, 4.28.
  static constexpr double kLeastWidth = 0.024, kMostWidth = 4.5;

  explicit HairClosed(const S& s) {
    using namespace closed_fit;
    const S held = smaller(larger(s, constant<S>(kLeastWidth)), constant<S>(kMostWidth));
    const S q = held / (held + constant<S>(0.3)), w = S(2) * q - S(1);
    const S edge = q * (constant<S>(kRWidth[0]) + q * constant<S>(kRWidth[1]));
    edge2_ = edge * edge;
    collapse(kR, w, r_);
    collapse(kTt, w, tt_);
    collapse(kTtWay, w, tt_way_);
    collapse(kTrtRoot, w, trt_root_);
    collapse(kTrt, w, trt_);
    collapse(kTrtWay, w, trt_way_);
  }

  //     sine2, cosine2   sin^2 and cos^2 of phi / 2: neither loses digits where it is small
  //     cos_theta        of the inclination, in [0, 1]
  //     sigma_a          absorption per radius, >= 0
  //     log_factor       logarithm of a factor for each lobe
  HairFarLobes<S> read(const S& sine2, const S& cosine2, const S& cos_theta, const Rgb<S>& sigma_a,
                       const HairLogFactors<S>& log_factor = no_factors<S>()) const {
    using namespace closed_fit;
    const S u = S(2) * cos_theta - S(1), x = cosine2 - sine2, g = S(4) * sine2, cos2 = cos_theta * cos_theta;
    const S least = hair_least_way(1.55, cos_theta);
    HairFarLobes<S> n;

    const S y = sqrt(S(cosine2 + edge2_));
    n.r = y * exp(S(at(r_[0], u) + y * (at(r_[1], u) + y * at(r_[2], u)) + log_factor[0]));

    const S log_tt = at(tt_[0], u) + x * (at(tt_[1], u) + x * (at(tt_[2], u) + x * at(tt_[3], u))) + log_factor[1];
    const S more_tt = positive(S(at(tt_way_[0], u) + x * at(tt_way_[1], u)));
    n.tt = for_channels(sigma_a, [&](const S& sigma) {
      return exp(S(log_tt - hair_depth(sigma, least, more_tt, constant<S>(kTtCurve)))) * cos2;
    });

    const S root = at(trt_root_[0], u), r2 = root * root + constant<S>(1e-6);
    const S log_trt =
        at(trt_[0], u) - at(trt_[1], u) * (g / (sqrt(S(r2 + g)) + sqrt(r2))) + at(trt_[2], u) * g + log_factor[2];
    const S more_trt = positive(S(at(trt_way_[0], u) + x * at(trt_way_[1], u)));
    n.trt = for_channels(sigma_a, [&](const S& sigma) {
      return exp(S(log_trt - hair_depth(sigma, S(least + least), more_trt, constant<S>(kTrtCurve)))) * cos2;
    });

    const S bare =
        exp(S(power_series(kLonger, cos_theta) + log_factor[3])) * cos_theta * constant<S>(0.5 / std::numbers::pi);
    const S way = least * power_series(kLongerWay, cos_theta);
    const S let_out = larger(S(cos_theta / power_series(kLongerLoss, cos_theta)), constant<S>(kTiny<S>));
    n.longer = for_channels(sigma_a, [&](const S& sigma) { return hair_longer_share(S(sigma * way), let_out) * bare; });
    return n;
  }

 private:
  template <std::size_t N>
  using Line = std::array<S, N>;  // a polynomial in 2 cos(theta) - 1

  template <std::size_t N>
  static S at(const Line<N>& c, const S& u) {
    S sum = c[N - 1];
    for (std::size_t i = N - 1; i-- > 0;) sum = sum * u + c[i];
    return sum;
  }
  template <std::size_t N>
  static S power_series(const double (&c)[N], const S& x) {
    S sum = constant<S>(c[N - 1]);
    for (std::size_t i = N - 1; i-- > 0;) sum = sum * x + constant<S>(c[i]);
    return sum;
  }
  // The polynomials in 2 q - 1 taken at w.
  template <std::size_t K, std::size_t M, std::size_t N>
  static void collapse(const double (&c)[K][M][N], const S& w, std::array<Line<N>, K>& out) {
    for (std::size_t k = 0; k < K; ++k)
      for (std::size_t j = 0; j < N; ++j) {
        S sum = constant<S>(c[k][M - 1][j]);
        for (std::size_t i = M - 1; i-- > 0;) sum = sum * w + constant<S>(c[k][i][j]);
        out[k][j] = sum;
      }
  }

  S edge2_ = S(0.0);
  std::array<Line<4>, 3> r_;
  std::array<Line<4>, 4> tt_;
  std::array<Line<3>, 2> tt_way_;
  std::array<Line<3>, 1> trt_root_;
  std::array<Line<5>, 3> trt_;
  std::array<Line<3>, 2> trt_way_;
};

}  // namespace likeness::brdf
