#pragma once

#include <cstddef>
#include <numbers>
#include <vector>

#include "brdf/hair/far_lobes.h"

// The far field of a fibre as tables, for one index of refraction: what a shader reads instead of an integral over the
// width of the fibre. brdf/hair/lut_bake.h makes them.
namespace likeness::brdf {

// Where x in [0, n - 1] lies on an axis of n nodes: the node below, and the way to the next one in [0, 1]. Whatever x
// is, NaN included, both nodes exist.
template <Scalar S>
struct Place {
  S node, way;
};
template <Scalar S>
Place<S> place_on(int n, const S& x) {
  const S held = smaller(positive(x), constant<S>(n - 1));
  const S node = smaller(S(floor(held)), constant<S>(n - 2));
  return {node, S(held - node)};
}

// Numbers over phi (fastest), cosine and width, with `values` of them at each node.
struct HairGrid {
  int phi = 0, cosine = 0, width = 0, values = 1;
  std::vector<float> data{};

  std::size_t count() const {
    return std::size_t(phi) * std::size_t(cosine) * std::size_t(width) * std::size_t(values);
  }
  std::size_t index(int at_phi, int at_cosine, int at_width) const {
    return std::size_t(((at_width * cosine + at_cosine) * phi + at_phi) * values);
  }
  // Trilinear, the numbers of one node together; x, y and z are in [0, 1], out has `values` entries.
  template <Scalar S>
  void read(const S& x, const S& y, const S& z, S* out) const {
    const auto along = [](int n, const S& t) { return place_on(n, S(t * constant<S>(n - 1))); };
    const Place<S> a = along(phi, x), b = along(cosine, y), c = along(width, z);
    const S step = constant<S>(values), line = constant<S>(phi * values), plane = constant<S>(phi * cosine * values);
    const S corner = c.node * plane + b.node * line + a.node * step;
    for (int i = 0; i < values; ++i) {
      const S here = corner + constant<S>(i), over = here + plane;
      const auto row = [&](const S& k) { return mix(at(data.data(), k), at(data.data(), S(k + step)), a.way); };
      out[i] = mix(mix(row(here), row(S(here + line)), b.way), mix(row(over), row(S(over + line)), b.way), c.way);
    }
  }
};

// Where the widths s of the tables begin and end, [rad]: beta_n = 0.1 and 1 are 0.0241 and 4.28. Beyond, the nearer end
// holds: narrower lobes are shown as wide as the least.
inline constexpr double kHairLutLeastWidth = 0.024, kHairLutMostWidth = 4.5;
inline constexpr double kHairLutLogRange = 5.233778845410465;  // ln(most / least)

// The place of a width among the tables' widths, in [0, 1]: by its logarithm.
template <Scalar S>
S hair_lut_width(const S& s) {
  const S held = smaller(larger(s, constant<S>(kHairLutLeastWidth)), constant<S>(kHairLutMostWidth));
  return log(S(held * constant<S>(1 / kHairLutLeastWidth))) * constant<S>(1 / kHairLutLogRange);
}

// [0, pi] to [0, 1], dense near 0: the slope is (1 + 1/k) / pi there, and k / (1 + k) / pi at the other end.
template <Scalar S>
S bent(double k, const S& phi) {
  return phi * constant<S>(1 + k) / (phi + constant<S>(k * std::numbers::pi));
}
inline double unbent(double k, double t) { return k * std::numbers::pi * t / (1 + k - t); }

// The tables, for lobes as hair_far has them: attenuation by Fresnel and absorption included.
//
// Stored are ln N_R, ln(N_TT / cos^2), ln(N_TRT / cos^2) without absorption: tails of logistics are straight lines in
// them, and the zero of the Fresnel terms at 90 degrees is taken out. Between nodes they are linear; each row over phi is
// scaled so that what is read from it has the energy of the row that it samples. R is dense near phi = pi, TRT near 0;
// cosines are evenly spaced, widths in their logarithm. Departures from the Enemies table (brdf/hair/talk_lut.h): the
// attenuation is inside the integral, and each lobe has axes of its own.
struct HairLut {
  double eta = 1.55;
  HairGrid r{.phi = 40, .cosine = 16, .width = 16};
  HairGrid tt{.phi = 64, .cosine = 40, .width = 20};
  HairGrid trt{.phi = 80, .cosine = 72, .width = 20};
  HairGrid ways{.phi = 56, .cosine = 40, .width = 12, .values = 4};  // more and curve of TT, then of TRT
  HairGrid longer{.phi = 1, .cosine = 32, .width = 1, .values = 3};  // ln(2 pi N / cos), way of a pass, u / cos
  double dense_r = 0.3, dense_trt = 0.4;                             // of bent()

  std::size_t bytes() const {
    return sizeof(float) * (r.count() + tt.count() + trt.count() + ways.count() + longer.count());
  }

  //     distance   |phi|, in [0, pi]
  //     cos_theta  of the inclination, in [0, 1]
  //     width      hair_lut_width(s)
  //     sigma_a    absorption per radius, >= 0
  //     log_factor logarithm of a factor for each lobe
  template <Scalar S>
  HairFarLobes<S> read(const S& distance, const S& cos_theta, const S& width, const Rgb<S>& sigma_a,
                       const HairLogFactors<S>& log_factor = no_factors<S>()) const {
    const S pi = constant<S>(std::numbers::pi), turn = distance * constant<S>(1 / std::numbers::pi);
    S log_r, log_tt, log_trt, way[4];
    r.read(bent(dense_r, S(pi - distance)), cos_theta, width, &log_r);
    tt.read(turn, cos_theta, width, &log_tt);
    trt.read(bent(dense_trt, distance), cos_theta, width, &log_trt);
    ways.read(turn, cos_theta, width, way);

    const S least = hair_least_way(eta, cos_theta), cos2 = cos_theta * cos_theta;
    HairFarLobes<S> n;
    n.r = exp(S(log_r + log_factor[0]));
    log_tt = log_tt + log_factor[1];
    log_trt = log_trt + log_factor[2];
    n.tt = for_channels(
        sigma_a, [&](const S& sigma) { return exp(S(log_tt - hair_depth(sigma, least, way[0], way[1]))) * cos2; });
    n.trt = for_channels(sigma_a, [&](const S& sigma) {
      return exp(S(log_trt - hair_depth(sigma, S(least + least), way[2], way[3]))) * cos2;
    });

    S rest[3];
    const Place<S> c = place_on(longer.cosine, S(cos_theta * constant<S>(longer.cosine - 1)));
    for (int i = 0; i < 3; ++i) {
      const S k = c.node * S(3) + constant<S>(i);
      rest[i] = mix(at(longer.data.data(), k), at(longer.data.data(), S(k + S(3))), c.way);
    }
    const S bare = exp(S(rest[0] + log_factor[3])) * cos_theta * constant<S>(0.5 / std::numbers::pi);
    const S u = larger(S(rest[2] * cos_theta), constant<S>(kTiny<S>));
    n.longer = for_channels(sigma_a, [&](const S& sigma) { return hair_longer_share(S(sigma * rest[1]), u) * bare; });
    return n;
  }
};

}  // namespace likeness::brdf
