#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "brdf/hair/fibre.h"
#include "brdf/hair/talk_lut.h"

// Fills the tables of brdf/hair/lut.h and talk_lut.h, in double, once.
namespace likeness::brdf {

// The sum over logistics of width s, centred at `centre` in [0, pi] and at its mirror image, at an azimuth in [0, pi].
// trimmed_logistic of both, with the exponential of a difference taken as a product, so that a sum over many centres
// and azimuths needs one exponential for each of them and none for each pair.
struct HairLogisticPair {
  double scale, turn;  // 1 / (s tanh(pi / 2 s)); e^(-2 pi / s)

  explicit HairLogisticPair(double s)
      : scale(1 / (s * std::tanh(std::numbers::pi / 2 / s))), turn(std::exp(-2 * std::numbers::pi / s)) {}
  // a = e^(-azimuth / s), b = e^(-centre / s), and their reciprocals.
  double operator()(double a, double b, double over_a, double over_b) const {
    const double near = std::min(a * over_b, over_a * b), far = std::max(a * b, turn * over_a * over_b);
    return scale * (near / ((1 + near) * (1 + near)) + far / ((1 + far) * (1 + far)));
  }
};

// A fibre lit at one inclination, as sums over offsets h = sin(gamma) >= 0 (the other half is the mirror image): the
// midpoint rule in gamma. Between two offsets Phi moves by 0.026 at most, so that logistics of s >= 0.02 add up to 1e-7;
// the ends of the range cost 2e-6.
class HairOffsets {
 public:
  static constexpr int kCount = 240;
  static constexpr double kSigma = 1.6;  // the absorption at which the bend of ln N is measured

  // Of one lobe at one azimuth and width: N without absorption, the same weighted by the way travelled, N at kSigma.
  struct Sums {
    double bare = 0, travelled = 0, absorbed = 0;
  };

  HairOffsets(double eta, double cos_theta) {
    for (int i = 0; i < kCount; ++i) {
      const double step = std::numbers::pi / 2 / kCount, gamma = (i + 0.5) * step, cos_h = std::cos(gamma);
      const FibrePath<double> path(gamma, std::sin(gamma), cos_h, cos_theta, eta);
      const auto none = hair_attenuations(path.reflected, path.transmitted, 0.0);
      const auto some = hair_attenuations(path.reflected, path.transmitted, 2 * kSigma * path.chord);
      // Of the paths beyond TRT: three passes, and each further one with probability f.
      const double passes[kHairLobes]{0, 1, 2, 3 + path.reflected / path.transmitted};
      for (std::size_t p = 0; p < kHairLobes; ++p) {
        const double phi = std::abs(2 * (double(p) * path.gamma_t - path.gamma_i) + double(p) * std::numbers::pi);
        centre_[p][i] = std::abs(std::remainder(phi, 2 * std::numbers::pi));
        bare_[p][i] = none[p] * cos_h * step;
        absorbed_[p][i] = some[p] * cos_h * step;
        even_[i] = cos_h * step;
        travelled_[p][i] = bare_[p][i] * 2 * path.chord * passes[p];
      }
    }
  }

  // The whole energy of a lobe: its integral over all azimuths.
  Sums energy(std::size_t p) const {
    Sums sum;
    for (int i = 0; i < kCount; ++i) {
      sum.bare += bare_[p][i];
      sum.travelled += travelled_[p][i];
      sum.absorbed += absorbed_[p][i];
    }
    return sum;
  }

  // Chooses the lobe and the width of the calls that follow.
  void choose(std::size_t p, double s) {
    p_ = p;
    s_ = s;
    for (int i = 0; i < kCount; ++i) {
      b_[i] = std::exp(-centre_[p][i] / s);
      over_b_[i] = 1 / b_[i];
    }
  }
  double bare(double phi) const {
    const HairLogisticPair pair(s_);
    const double a = std::exp(-phi / s_), over_a = 1 / a;
    double sum = 0;
    for (int i = 0; i < kCount; ++i) sum += bare_[p_][i] * pair(a, b_[i], over_a, over_b_[i]);
    return 0.5 * sum;
  }
  // The distribution alone: as if nothing were attenuated.
  double distribution(double phi) const {
    const HairLogisticPair pair(s_);
    const double a = std::exp(-phi / s_), over_a = 1 / a;
    double sum = 0;
    for (int i = 0; i < kCount; ++i) sum += even_[i] * pair(a, b_[i], over_a, over_b_[i]);
    return 0.5 * sum;
  }
  Sums sums(double phi) const {
    const HairLogisticPair pair(s_);
    const double a = std::exp(-phi / s_), over_a = 1 / a;
    Sums sum;
    for (int i = 0; i < kCount; ++i) {
      const double d = 0.5 * pair(a, b_[i], over_a, over_b_[i]);
      sum.bare += bare_[p_][i] * d;
      sum.travelled += travelled_[p_][i] * d;
      sum.absorbed += absorbed_[p_][i] * d;
    }
    return sum;
  }

 private:
  using Column = std::array<double, kCount>;
  std::array<Column, kHairLobes> centre_, bare_, travelled_, absorbed_;
  Column even_{}, b_{}, over_b_{};
  std::size_t p_ = 0;
  double s_ = 1;
};

class HairLutBake {
 public:
  static HairLut bake(const HairLut& shape) {
    HairLutBake made(shape);
    const HairLut& lut = made.lut_;
    const double pi = std::numbers::pi, k_r = lut.dense_r, k_trt = lut.dense_trt;
    made.fill(0, made.lut_.r, [=](double t) { return pi - unbent(k_r, t); });
    made.fill(1, made.lut_.tt, [=](double t) { return pi * t; });
    made.fill(2, made.lut_.trt, [=](double t) { return unbent(k_trt, t); });
    made.fill_ways();
    made.fill_longer();
    return made.lut_;
  }

 private:
  explicit HairLutBake(const HairLut& shape) : lut_(shape) {}

  // At exactly 90 degrees the numbers that are stored are limits.
  static double cosine_at(const HairGrid& g, int i) { return std::max(1e-4, i / (g.cosine - 1.0)); }
  static double width_at(const HairGrid& g, int i) {
    return kHairLutLeastWidth * std::exp(kHairLutLogRange * i / (g.width - 1.0));
  }

  template <class F>
  void fill(std::size_t p, HairGrid& g, F&& phi_of) {
    g.data.resize(g.count());
    std::vector<double> row(static_cast<std::size_t>(g.phi));
    for (int c = 0; c < g.cosine; ++c) {
      const double cosine = cosine_at(g, c);
      HairOffsets offsets(lut_.eta, cosine);
      const double energy = offsets.energy(p).bare;
      for (int w = 0; w < g.width; ++w) {
        offsets.choose(p, width_at(g, w));
        for (int i = 0; i < g.phi; ++i) row[std::size_t(i)] = std::log(offsets.bare(phi_of(i / (g.phi - 1.0))));
        const double raise = std::log(energy / energy_of(row, phi_of)) - (p > 0 ? 2 * std::log(cosine) : 0);
        for (int i = 0; i < g.phi; ++i) g.data[g.index(i, c, w)] = float(row[std::size_t(i)] + raise);
      }
    }
  }
  // The integral over all azimuths of what is read from a row of logarithms.
  template <class F>
  static double energy_of(const std::vector<double>& row, F&& phi_of) {
    constexpr int kParts = 8;
    const double cells = double(row.size() - 1);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < row.size(); ++i)
      for (int j = 0; j < kParts; ++j) {
        const double way = (j + 0.5) / kParts, low = (double(i) + double(j) / kParts) / cells;
        const double high = (double(i) + (j + 1.0) / kParts) / cells;
        sum += std::exp(row[i] * (1 - way) + row[i + 1] * way) * std::abs(phi_of(high) - phi_of(low));
      }
    return 2 * sum;
  }

  // The two numbers of hair_depth() from sums of one lobe.
  void store_way(const HairOffsets::Sums& sums, double least, float* out) const {
    const double more = std::max(0.0, sums.travelled / sums.bare - least);
    const double seen = std::log(sums.bare / sums.absorbed) / HairOffsets::kSigma - least;  // more / (1 + curve sigma)
    out[0] = float(more);
    out[1] = seen > 1e-7 ? float(std::max(0.0, (more / seen - 1) / HairOffsets::kSigma)) : 0.0f;
  }
  void fill_ways() {
    HairGrid& g = lut_.ways;
    g.data.resize(g.count());
    for (int c = 0; c < g.cosine; ++c) {
      HairOffsets offsets(lut_.eta, cosine_at(g, c));
      const double least = hair_least_way(lut_.eta, cosine_at(g, c));
      for (int w = 0; w < g.width; ++w)
        for (std::size_t p = 1; p <= 2; ++p) {
          offsets.choose(p, width_at(g, w));
          for (int i = 0; i < g.phi; ++i)
            store_way(offsets.sums(std::numbers::pi * i / (g.phi - 1.0)), double(p) * least,
                      &g.data[g.index(i, c, w) + 2 * (p - 1)]);
        }
    }
  }
  // Way and share let out that give hair_longer_share() the slope at sigma = 0, and its value at kSigma.
  void fill_longer() {
    HairGrid& g = lut_.longer;
    g.data.resize(g.count());
    for (int c = 0; c < g.cosine; ++c) {
      const double cosine = cosine_at(g, c);
      const auto energy = HairOffsets(lut_.eta, cosine).energy(3);
      const double mean = energy.travelled / energy.bare, share = energy.absorbed / energy.bare;
      const auto way_of = [&](double u) { return mean / (2 + 1 / u); };  // 3 passes and (1 - u) / u further ones
      double low = 0, high = 1;
      for (int i = 0; i < 60; ++i) {
        const double u = 0.5 * (low + high);
        (hair_longer_share(HairOffsets::kSigma * way_of(u), u) > share ? low : high) = u;
      }
      float* out = &g.data[g.index(0, c, 0)];
      out[0] = float(std::log(energy.bare / cosine));
      out[1] = float(way_of(high));
      out[2] = float(high / cosine);
    }
  }

  HairLut lut_;
};

// The tables in the shape asked for (grid sizes and index of refraction of `shape`).
inline HairLut bake_hair_lut(const HairLut& shape = {}) { return HairLutBake::bake(shape); }

inline HairTalkLut bake_hair_talk_lut(const HairTalkLut& shape = {}) {
  HairTalkLut lut = shape;
  HairGrid& g = lut.distribution;
  g.data.resize(g.count());
  for (int c = 0; c < g.cosine; ++c) {
    HairOffsets offsets(lut.eta, std::max(1e-4, c / (g.cosine - 1.0)));
    for (int w = 0; w < g.width; ++w)
      for (std::size_t p = 0; p < 3; ++p) {
        const double least = HairTalkLut::kLeastBeta;
        offsets.choose(p, hair_width(least + (1 - least) * w / (g.width - 1.0)));
        for (int i = 0; i < g.phi; ++i)
          g.data[g.index(i, c, w) + p] = float(offsets.distribution(std::numbers::pi * i / (g.phi - 1.0)));
      }
  }
  return lut;
}

}  // namespace likeness::brdf
