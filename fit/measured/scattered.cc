#include "fit/measured/scattered.h"

#include <algorithm>
#include <cmath>

namespace likeness::measured {

// The squared distance of (l, v) and (l', v') at the azimuth psi at which it is least:
//
//     min over psi of |l - e^(i psi) l'|^2 + |v - e^(i psi) v'|^2
//         = 4 sin^2(d theta_i / 2) + 4 sin^2(d theta_o / 2) + 2 (a + b) - 2 sqrt((a + b)^2 - 2 a b (1 - cos d phi))
//
// with a = sin theta_i sin theta_i', b = sin theta_o sin theta_o'. The last two terms are written as one fraction, which
// cancels nowhere; it grows with a, b and d phi, so that the corner of a box that has the least of each bounds it.
struct ScatteredSamples::Search {
  static constexpr int kMost = 7;  // the last one sets the radius
  struct Near {
    double distance2;
    const Scattered* sample;
  };

  explicit Search(const Elevations& at, double reach)
      : angles{at.theta_i, at.theta_o, at.phi},
        sin_i(std::sin(at.theta_i)),
        sin_o(std::sin(at.theta_o)),
        limit(reach * reach) {}

  double distance2(double d_i, double d_o, double d_phi, double other_sin_i, double other_sin_o) const {
    const double half_i = std::sin(d_i / 2), half_o = std::sin(d_o / 2), half_phi = std::sin(d_phi / 2);
    const double a = sin_i * other_sin_i, b = sin_o * other_sin_o, sum = a + b;
    const double cost = 4 * a * b * half_phi * half_phi;  // 2 a b (1 - cos d phi)
    const double below = sum + std::sqrt(std::max(0.0, sum * sum - cost));
    return 4 * (half_i * half_i + half_o * half_o) + (below > 0 ? 2 * cost / below : 0);
  }

  double to(const Scattered& s) const {
    return distance2(angles[0] - s.angles[0], angles[1] - s.angles[1], angles[2] - s.angles[2],
                     std::sin(double{s.angles[0]}), std::sin(double{s.angles[1]}));
  }

  double to(const Box& box) const {
    std::array<double, 3> d;
    for (int i = 0; i < 3; ++i) d[i] = std::max({0.0, box.low[i] - angles[i], angles[i] - box.high[i]});
    return distance2(d[0], d[1], d[2], std::sin(double{box.low[0]}), std::sin(double{box.low[1]}));
  }

  void offer(const Scattered& sample) {
    const double d = to(sample);
    if (d > limit) return;
    int place = count < kMost ? count++ : kMost - 1;
    for (; place > 0 && near[place - 1].distance2 > d; --place) near[place] = near[place - 1];
    near[place] = {d, &sample};
    if (count == kMost) limit = near[kMost - 1].distance2;
  }

  std::array<double, 3> angles;
  double sin_i, sin_o, limit;
  std::array<Near, kMost> near{};
  int count = 0;
};

int ScatteredSamples::widest(const Box& box) {
  const std::array<float, 3> side{box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]};
  // An azimuth counts by the smaller circle it moves a direction on.
  const float phi = side[2] * std::min(1.0f, std::min(box.high[0], box.high[1]));
  return side[0] >= side[1] ? (side[0] >= phi ? 0 : 2) : (side[1] >= phi ? 1 : 2);
}

ScatteredSamples::ScatteredSamples(std::vector<Scattered> samples, double reach)
    : samples_(std::move(samples)), reach_(reach) {
  std::sort(samples_.begin(), samples_.end(), [](const auto& a, const auto& b) { return a.angles < b.angles; });
  build(0, samples_.size(), {});
}

void ScatteredSamples::build(std::size_t begin, std::size_t end, const Box& box) {
  if (end - begin <= kLeaf) return;
  const int axis = widest(box);
  const std::size_t middle = (begin + end) / 2;
  std::nth_element(samples_.begin() + begin, samples_.begin() + middle, samples_.begin() + end,
                   [axis](const auto& a, const auto& b) { return a.angles[axis] < b.angles[axis]; });
  Box low = box, high = box;
  low.high[axis] = high.low[axis] = samples_[middle].angles[axis];
  build(begin, middle, low);
  build(middle + 1, end, high);
}

void ScatteredSamples::visit(std::size_t begin, std::size_t end, const Box& box, Search& search) const {
  if (begin == end || search.to(box) > search.limit) return;
  if (end - begin <= kLeaf) {
    for (std::size_t i = begin; i < end; ++i) search.offer(samples_[i]);
    return;
  }
  const int axis = widest(box);
  const std::size_t middle = (begin + end) / 2;
  Box low = box, high = box;
  low.high[axis] = high.low[axis] = samples_[middle].angles[axis];
  const bool low_first = search.angles[axis] < samples_[middle].angles[axis];
  if (low_first) visit(begin, middle, low, search);
  search.offer(samples_[middle]);
  visit(middle + 1, end, high, search);
  if (!low_first) visit(begin, middle, low, search);
}

bool ScatteredSamples::interpolate(const Elevations& at, Rgb& f) const {
  Search search(at, reach_);
  visit(0, samples_.size(), {}, search);
  if (search.count == 0) return false;
  const auto value = [](const Scattered& s) { return Rgb{s.r, s.g, s.b}; };
  // Angles are stored in float: nearer than 1e-6 is the sample itself.
  if (search.near[0].distance2 < 1e-12) {
    f = value(*search.near[0].sample);
    return true;
  }
  const bool full = search.count == Search::kMost;
  const double radius = full ? std::sqrt(search.near[Search::kMost - 1].distance2) : reach_ * 1.0001;
  double total = 0;
  Rgb sum;
  for (int k = 0; k < search.count - (full ? 1 : 0); ++k) {
    const double weight = brdf::squared(1 / std::sqrt(search.near[k].distance2) - 1 / radius);
    total += weight;
    sum = sum + value(*search.near[k].sample) * weight;
  }
  f = total > 0 ? sum * (1 / total) : value(*search.near[0].sample);
  return true;
}

}  // namespace likeness::measured
