#pragma once

#include <algorithm>

#include "brdf/hair/azimuthal.h"

// Azimuthal scattering averaged over the width of a fibre, far field, by adaptive quadrature: the reference that the
// run-time forms are held against. For plain numbers and Jets of doubles; it branches on values, so not for batches.
namespace likeness::brdf {

// A fibre under light from one inclination, as a function of the angle gamma of incidence in the plane across it.
template <Scalar S>
struct FarLobe {
  int p;
  S phi, s, sigma_a, eta, cos_theta;
  S scale = trimmed_logistic_scale(s);

  // A_p(h) D(phi - Phi(p, h)) dh / dgamma at h = sin gamma: analytic up to the ends, where dh / dgamma is 0, but for
  // the cut of the logistic half a turn from its peak.
  S density(double gamma) const {
    const double cos_h = std::cos(gamma);
    const FibrePath<S> path(S(gamma), S(std::sin(gamma)), S(cos_h), cos_theta, eta);
    if (p == 0) return path.reflected * logistic(path) * S(cos_h);
    const S t = exp(S(S(-2) * sigma_a * path.chord)), g2 = path.transmitted * path.transmitted;
    if (p == 1) return g2 * t * logistic(path) * S(cos_h);
    if (p == 2) return g2 * t * t * path.reflected * logistic(path) * S(cos_h);
    return hair_attenuations(path.reflected, path.transmitted, S(S(2) * sigma_a * path.chord))[3] *
           S(cos_h * 0.5 / std::numbers::pi);
  }

 private:
  S logistic(const FibrePath<S>& path) const {
    return trimmed_logistic(azimuth_distance(S(double(p)), phi, path.gamma_i, path.gamma_t), s, scale);
  }
};

// The range of gamma in pieces that hold no kink of the integrand, and no peak but at an end; those that matter first.
class FarPieces {
 public:
  static constexpr int kMost = 192;
  struct Piece {
    double low, high;
    double bound;  // the integral over it is at most so much
  };

  // Of lobe p, light at cosine cos_theta, seen at azimuth phi in [-pi, pi], with a logistic of width s.
  FarPieces(int p, double phi, double s, double eta, double cos_theta) : p_(p), s_(s) {
    const double outer = std::sqrt((eta - 1) * (eta + 1) + cos_theta * cos_theta);
    ratio_ = outer > 0 ? cos_theta / outer : 1;  // sin gamma_t / sin gamma_i
    // Where Phi turns back (a caustic): p cos gamma_i = eta' cos gamma_t.
    const double turn2 = p > 1 ? (p * p - 1 / (ratio_ * ratio_)) / (p * p - 1.0) : 0;
    const double turn = turn2 > 0 ? std::asin(std::sqrt(std::min(turn2, 1.0))) : 0;
    const double sections[]{-kEnd, -turn, turn, kEnd};
    add(-kEnd);
    add(kEnd);
    if (turn > 0) {
      add_around(-turn);
      add_around(turn);
    }
    for (int i = 0; i < 3; ++i) add_targets(sections[i], sections[i + 1], phi);
    std::sort(at_, at_ + count_);
    make_pieces(phi);
  }
  const Piece* begin() const { return pieces_; }
  const Piece* end() const { return pieces_ + piece_count_; }

 private:
  static constexpr double kEnd = std::numbers::pi / 2;

  double deflection(double gamma) const {  // Phi
    const double t = std::asin(std::clamp(std::sin(gamma) * ratio_, -1.0, 1.0));
    return 2 * (p_ * t - gamma) + p_ * std::numbers::pi;
  }
  double slope(double gamma) const {  // its derivative
    const double sine = std::sin(gamma) * ratio_;
    return 2 * (p_ * ratio_ * std::cos(gamma) / std::sqrt(std::max(1 - sine * sine, 1e-30)) - 1);
  }
  void add(double gamma) {
    if (count_ < kMost && std::abs(gamma) <= kEnd) at_[count_++] = gamma;
  }
  // A peak of about s / slope, or sqrt(s) where the slope is 0, and steps away from it that grow fourfold.
  void add_around(double gamma) {
    add(gamma);
    const double width = s_ / std::max(std::abs(slope(gamma)), std::sqrt(s_));
    for (double d = 4 * width; d > 0 && d < 2 * kEnd; d *= 4) {
      add(gamma - d);
      add(gamma + d);
    }
  }
  // Peaks (Phi = phi + 2 k pi) and cuts (half a turn from them) between two gammas, where Phi is monotone.
  void add_targets(double low, double high, double phi) {
    if (!(high > low)) return;
    const double at_low = deflection(low), at_high = deflection(high);
    const double least = std::min(at_low, at_high), most = std::max(at_low, at_high);
    for (double k = std::ceil((least - phi) / std::numbers::pi); phi + k * std::numbers::pi <= most; ++k) {
      const double gamma = find(phi + k * std::numbers::pi, low, high, at_high > at_low);
      if (std::fmod(k, 2) == 0) add_around(gamma);
      else add(gamma);
    }
  }
  // Phi(gamma) = target, by Newton's steps, and by halving where one leaves the bracket.
  double find(double target, double low, double high, bool rising) const {
    double gamma = 0.5 * (low + high);
    for (int i = 0; i < 60 && high - low > 1e-14; ++i) {
      const double over = deflection(gamma) - target, step = over / slope(gamma);
      ((over > 0) == rising ? high : low) = gamma;
      const double next = gamma - step;
      const bool inside = next > low && next < high;
      if (inside && std::abs(step) < 1e-14) return next;
      gamma = inside ? next : 0.5 * (low + high);
    }
    return gamma;
  }
  // The attenuation is at most 1, and the logistic at most what it is at the end that is nearer to its peak.
  void make_pieces(double phi) {
    const double peak = 1 / (s_ * std::tanh(std::numbers::pi / (2 * s_)));
    double before = 0;
    for (int i = 0; i < count_; ++i) {
      const double e = std::exp(-std::abs(std::remainder(phi - deflection(at_[i]), 2 * std::numbers::pi)) / s_);
      const double here = peak * e / ((1 + e) * (1 + e));
      if (i > 0 && at_[i] > at_[i - 1])
        pieces_[piece_count_++] = {at_[i - 1], at_[i], std::max(here, before) * (at_[i] - at_[i - 1])};
      before = here;
    }
    std::sort(pieces_, pieces_ + piece_count_, [](const Piece& a, const Piece& b) { return a.bound > b.bound; });
  }

  int p_, count_ = 0, piece_count_ = 0;
  double s_, ratio_ = 1;
  double at_[kMost];
  Piece pieces_[kMost];
};

// Gauss-Kronrod rule of 7 and 15 points on an interval: the integral and an estimate of its error.
template <Scalar S>
struct FarPiece {
  double low, high, error;
  S sum;

  FarPiece() {}  // NOLINT(cppcoreguidelines-pro-type-member-init): rows of a stack that are never read
  FarPiece(const FarLobe<S>& lobe, double low_, double high_) : low(low_), high(high_) {
    // clang-format off
    constexpr double kNodes[8]{
        0.99145537112081263921, 0.94910791234275852453, 0.86486442335976907279, 0.74153118559939443986,
        0.58608723546769113029, 0.40584515137739716691, 0.2077849550078984676, 0};
    constexpr double kKronrod[8]{
        0.022935322010529224964, 0.063092092629978553291, 0.10479001032225018384, 0.14065325971552591875,
        0.16900472663926790283, 0.19035057806478540991, 0.20443294007529889241, 0.20948214108472782801};
    constexpr double kGauss[8]{
        0, 0.12948496616886969327, 0, 0.2797053914892766679, 0, 0.38183005050511894495, 0, 0.41795918367346938776};
    // clang-format on
    const double half = 0.5 * (high - low), middle = 0.5 * (high + low);
    const S centre = lobe.density(middle);
    double gauss = value(centre) * kGauss[7];
    sum = centre * S(kKronrod[7]);
    for (int i = 0; i < 7; ++i) {
      const S pair = lobe.density(middle - half * kNodes[i]) + lobe.density(middle + half * kNodes[i]);
      sum += pair * S(kKronrod[i]);
      gauss += value(pair) * kGauss[i];
    }
    sum *= S(half);
    // The difference is the error of the 7 points; of the 15 it is about the power 1.5 of that (QUADPACK's scale).
    const double total = std::abs(value(sum)), difference = std::abs(value(sum) - half * gauss);
    error = total > 0 ? total * std::min(difference / total, std::pow(200 * difference / total, 1.5)) : difference;
  }
  static double value(const S& x) { return Arithmetic<S>::value(x); }
  bool operator<(const FarPiece& other) const { return error < other.error; }
};

// N_p(phi) = 1/2 integral of A_p(h) D(phi - Phi(p, h)) over h from -1 to 1, [1/rad], to `tolerance` (relative) by
// quadrature: halves the worst interval until the estimated errors add up to less. Far field of d'Eon 2011.
//
//     p        0 R, 1 TT, 2 TRT, 3 all longer paths (even in phi)
//     phi      azimuth between the two directions, any [rad]
//     s > 0    width of the logistic [rad]
//     sigma_a  absorption per radius, >= 0;  eta >= 1 index;  cos_theta cosine of the inclination, in [0, 1]
template <Scalar S>
S hair_far(int p, const S& phi, const S& s, const S& sigma_a, const S& eta, const S& cos_theta,
           double tolerance = 1e-9) {
  const auto value = [](const S& x) { return double(Arithmetic<S>::value(x)); };
  const FarLobe<S> lobe{p, phi, s, sigma_a, eta, cos_theta};
  // Longer paths have neither a peak nor a cut.
  const FarPieces all(p == 3 ? 0 : p, std::remainder(value(phi), 2 * std::numbers::pi), p == 3 ? 10 : value(s),
                      value(eta), value(cos_theta));
  double left = 0;
  for (const FarPieces::Piece& piece : all) left += piece.bound;
  std::array<FarPiece<S>, 3 * FarPieces::kMost> pieces;
  std::size_t count = 0;
  double total = 0, error = 0;
  for (const FarPieces::Piece& piece : all) {
    if (left < 0.01 * tolerance * total) break;
    pieces[count] = FarPiece<S>(lobe, piece.low, piece.high);
    total += value(pieces[count].sum);
    error += pieces[count++].error;
    left -= piece.bound;
  }
  const auto first = pieces.begin();
  std::make_heap(first, first + count);
  while (error > tolerance * total && count < pieces.size()) {
    std::pop_heap(first, first + count);
    const FarPiece<S> worst = pieces[--count];
    const double middle = 0.5 * (worst.low + worst.high);
    if (!(middle > worst.low && middle < worst.high)) break;
    for (const auto& half : {FarPiece<S>(lobe, worst.low, middle), FarPiece<S>(lobe, middle, worst.high)}) {
      pieces[count++] = half;
      std::push_heap(first, first + count);
    }
    total = error = 0;
    for (std::size_t i = 0; i < count; ++i) {
      total += value(pieces[i].sum);
      error += pieces[i].error;
    }
  }
  S sum = S(0.0);
  for (std::size_t i = 0; i < count; ++i) sum += pieces[i].sum;
  return S(sum * S(0.5));
}

}  // namespace likeness::brdf
