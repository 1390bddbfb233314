#include "fit/measured/scattered.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace likeness::measured {
namespace {

constexpr double kPi = std::numbers::pi;

int cell_of(double theta, int cells) { return std::clamp(static_cast<int>(theta / (kPi / 2) * cells), 0, cells - 1); }

}  // namespace

bool ScatteredSamples::by_angles(const Scattered& a, const Scattered& b) {
  return std::tuple(a.theta_i, a.theta_o, a.phi) < std::tuple(b.theta_i, b.theta_o, b.phi);
}

ScatteredSamples::ScatteredSamples(std::vector<Scattered> samples, double reach)
    : samples_(std::move(samples)), reach_(reach) {
  // A chord is at most the angle, and an angle at most 1.12 chords in 0..pi/2: one ring of cells holds the reach.
  cells_ = std::max(1, static_cast<int>(kPi / 2 / (1.12 * reach)));
  const auto cell = [&](const Scattered& s) { return cell_of(s.theta_i, cells_) * cells_ + cell_of(s.theta_o, cells_); };
  std::stable_sort(samples_.begin(), samples_.end(), [&](const Scattered& a, const Scattered& b) {
    return std::pair(cell(a), a.phi) < std::pair(cell(b), b.phi);
  });
  first_.assign(cells_ * cells_ + 1, 0);
  for (const Scattered& s : samples_) ++first_[cell(s) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
}

// The squared distance of (l, v) and (l', v') at the best azimuth psi, with l and v split into height and a
// complex horizontal part:
//
//     min over psi of |l - e^(i psi) l'|^2 + |v - e^(i psi) v'|^2 = 4 - 2 (z z' + w w') - 2 |l conj(l') + v conj(v')|
//
// for unit vectors, z and w their heights. With a = sin theta_i sin theta_i', b = sin theta_o sin theta_o', the
// modulus is sqrt(a^2 + b^2 + 2 a b cos(phi - phi')). A difference of phi alone costs
// 2 (a + b) - 2 |...| >= 2 a b (1 - cos(phi - phi')) / (a + b), which bounds the phi to search.
bool ScatteredSamples::interpolate(const Elevations& e, Rgb& f) const {
  const double theta_i = e.theta_i, theta_o = e.theta_o, phi = e.phi;
  const double sin_i = std::sin(theta_i), cos_i = std::cos(theta_i), sin_o = std::sin(theta_o), cos_o = std::cos(theta_o);
  std::array<Near, kMost + 1> near;
  int count = 0;
  double limit = reach_ * reach_;
  const int ci = cell_of(theta_i, cells_), co = cell_of(theta_o, cells_);
  for (int i = std::max(0, ci - 1); i <= std::min(cells_ - 1, ci + 1); ++i)
    for (int o = std::max(0, co - 1); o <= std::min(cells_ - 1, co + 1); ++o) {
      const auto begin = samples_.begin() + first_[i * cells_ + o], end = samples_.begin() + first_[i * cells_ + o + 1];
      if (begin == end) continue;
      const double least_a = sin_i * std::sin(kPi / 2 * i / cells_), least_b = sin_o * std::sin(kPi / 2 * o / cells_);
      const double both = least_a * least_b;
      const double versine = both > 0 ? limit * (least_a + least_b) / (2 * both) : 2;
      const double window = versine >= 2 ? kPi : std::acos(1 - versine) + 1e-6;
      auto at = std::lower_bound(begin, end, phi - window, [](const Scattered& s, double p) { return s.phi < p; });
      for (; at != end && at->phi <= phi + window; ++at) {
        const double si = std::sin(double{at->theta_i}), zi = std::cos(double{at->theta_i});
        const double so = std::sin(double{at->theta_o}), zo = std::cos(double{at->theta_o});
        const double a = sin_i * si, b = sin_o * so;
        const double modulus2 = a * a + b * b + 2 * a * b * std::cos(phi - at->phi);
        const double distance2 =
            std::max(0.0, 4 - 2 * (cos_i * zi + cos_o * zo) - 2 * std::sqrt(std::max(0.0, modulus2)));
        if (distance2 > limit) continue;
        int place = count < kMost ? count++ : kMost - 1;
        for (; place > 0 && near[place - 1].distance2 > distance2; --place) near[place] = near[place - 1];
        near[place] = {distance2, &*at};
        if (count == kMost) limit = near[kMost - 1].distance2;
      }
    }
  if (count == 0) return false;
  // Squared distances carry a rounding of about 1e-15: nearer than 1e-6 is the sample itself.
  if (near[0].distance2 < 1e-12) {
    f = {near[0].sample->r, near[0].sample->g, near[0].sample->b};
    return true;
  }
  const double radius = count == kMost ? std::sqrt(near[kMost - 1].distance2) : reach_ * 1.0001;
  double total = 0;
  Rgb sum;
  for (int k = 0; k < std::min(count, kMost - 1); ++k) {
    const double weight = brdf::squared(1 / std::sqrt(near[k].distance2) - 1 / radius);
    total += weight;
    sum = sum + Rgb{near[k].sample->r, near[k].sample->g, near[k].sample->b} * weight;
  }
  f = total > 0 ? sum * (1 / total) : Rgb{near[0].sample->r, near[0].sample->g, near[0].sample->b};
  return true;
}

}  // namespace likeness::measured
