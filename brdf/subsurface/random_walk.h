#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "brdf/fresnel/dielectric.h"

// The reference for diffusion profiles: Monte Carlo of a medium that fills the half space under a flat boundary.
// In double alone, and with branches: it is not for batches.
//
// Lengths     mean free paths (1 / sigma_t); multiply radii by the mean free path, divide R by its square.
// Light       enters at the origin, all of it: R is per unit of flux that has passed the boundary. It leaves where it
//             crosses the boundary from below; the angle at which it leaves is summed over.
// Source      the walk is that of Prahl et al. 1989 and Wang, Jacques and Zheng 1995 (MCML). Departures: the part that
//             leaves at the end of a flight is counted by its expectation, and the walk goes on with the rest.
namespace likeness::brdf {

struct HalfSpace {
  double alpha = 0.9;  // single-scattering albedo, in [0, 1]
  double g = 0;        // mean cosine of Henyey and Greenstein's phase function, in (-1, 1); 0 scatters alike everywhere
  double eta = 1;      // index of refraction inside over outside, > 0; 1 neither reflects nor refracts
};

enum class Incidence {
  kPencil,  // along the normal at one point: 'searchlight'
  kDiffuse  // at one point with a density of cos / pi inside: 'diffuse surface transmission'
};

enum class Estimator {
  kWeighted,  // absorption and escape lower a weight; Russian roulette ends small ones
  kAnalog     // absorption and escape end the walk: the plain simulation, to test the other by
};

// Steele, Lea and Flood's SplitMix64, one stream for each walk, so that a walk depends on the seed and its number alone.
class WalkRandom {
 public:
  WalkRandom(std::uint64_t seed, std::uint64_t walk) : state_(mixed(mixed(seed + kStep) + walk * kStep)) {}
  // In (0, 1), never its ends.
  double uniform() { return (double(mixed(state_ += kStep) >> 12) + 0.5) * 0x1p-52; }
  // A point of the unit disk, uniformly: its square distance from the center, in (0, 1), is uniform too.
  struct DiskPoint {
    double x, y, square;
  };
  DiskPoint in_disk() {
    DiskPoint p{};
    do {
      p.x = 2 * uniform() - 1;
      p.y = 2 * uniform() - 1;
      p.square = p.x * p.x + p.y * p.y;
    } while (p.square >= 1);
    return p;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15;
  static std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

// Where the light of a walk went. The four add up to 1 in every single walk; `roulette` has the expectation 0.
struct WalkLedger {
  double reflected = 0, absorbed = 0;
  double roulette = 0;    // taken away by Russian roulette, less what it has given
  double unfinished = 0;  // still inside after kMostCollisions
  std::int64_t collisions = 0;
};

inline constexpr int kMostCollisions = 1000000;

// Cosine of the angle between the directions before and after a collision, from u in (0, 1).
// Source  Henyey and Greenstein 1941: the inverse of its CDF, multiplied out so that g -> 0 divides by nothing.
inline double scattered_cosine(double g, double u) {
  const double s = 2 * u - 1, d = 1 + g * s;
  return (s + g * ((s * s + 3) / 2 + g * (s + g * (s * s - 1) / 2))) / (d * d);
}

// A unit vector in a medium below the plane z = 0, where z points into the medium.
struct WalkDirection {
  double x = 0, y = 0, z = 1;

  // At an angle to z, in the azimuth of p.
  static WalkDirection at(double cosine, const WalkRandom::DiskPoint& p) {
    const double across = std::sqrt(std::max(0.0, 1 - cosine * cosine) / p.square);
    return {p.x * across, p.y * across, cosine};
  }
  // Any direction. Source  Marsaglia 1972, 'Choosing a Point from the Surface of a Sphere'.
  static WalkDirection anywhere(const WalkRandom::DiskPoint& p) {
    const double across = 2 * std::sqrt(1 - p.square);
    return {p.x * across, p.y * across, 1 - 2 * p.square};
  }
  // This one turned by the angle of `cosine`; the frame is that of Duff et al. 2017.
  WalkDirection turned(double cosine, const WalkRandom::DiskPoint& p) const {
    const WalkDirection d = at(cosine, p);
    const double sign = std::copysign(1.0, z), a = -1 / (sign + z), b = x * y * a;
    const WalkDirection t{1 + sign * x * x * a, sign * b, -sign * x}, o{b, sign + y * y * a, -y};
    const WalkDirection sum{t.x * d.x + o.x * d.y + x * d.z, t.y * d.x + o.y * d.y + y * d.z,
                            t.z * d.x + o.z * d.y + z * d.z};
    const double norm = 1 / std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
    return {sum.x * norm, sum.y * norm, sum.z * norm};
  }
};

// One walk. Calls on_exit(radius, weight) for light that leaves, weight > 0; in kWeighted that is many times a walk.
template <class OnExit>
WalkLedger random_walk(const HalfSpace& medium, Incidence incidence, Estimator estimator, WalkRandom& random,
                       OnExit&& on_exit) {
  constexpr double kFar = 40;  // deeper than this along a ray nothing is added: exp(-40) = 4e-18
  // Below it Russian roulette: a part weight / (2 least) goes on, with the weight 2 least. Never after one collision.
  const double least = 0.1 * medium.alpha;
  const bool analog = estimator == Estimator::kAnalog;
  WalkLedger ledger;
  double x = 0, y = 0, z = 0, weight = 1;
  WalkDirection to;
  if (incidence == Incidence::kDiffuse) {
    const WalkRandom::DiskPoint p = random.in_disk();  // lifted to the hemisphere: Malley
    to = {p.x, p.y, std::sqrt(1 - p.square)};
  }
  while (ledger.collisions < kMostCollisions) {
    double flight = kFar;
    const double way_out = to.z < 0 ? z / -to.z : kFar;
    if (way_out >= kFar) {
      flight = -std::log(random.uniform());
    } else {
      const double exit_x = x + way_out * to.x, exit_y = y + way_out * to.y;
      const double returned = medium.eta == 1 ? 0 : fresnel_dielectric(-to.z, 1 / medium.eta);
      bool at_boundary = false;
      if (analog) {
        flight = -std::log(random.uniform());
        at_boundary = flight >= way_out;
        if (at_boundary && (returned == 0 || random.uniform() >= returned)) {
          ledger.reflected += weight;
          on_exit(std::sqrt(exit_x * exit_x + exit_y * exit_y), weight);
          return ledger;
        }
      } else {
        const double reaches = std::exp(-way_out), leaves = reaches * (1 - returned);
        if (leaves > 0) {
          ledger.reflected += weight * leaves;
          on_exit(std::sqrt(exit_x * exit_x + exit_y * exit_y), weight * leaves);
        }
        weight *= 1 - leaves;
        if (weight <= 0) return ledger;
        // What is left has either collided on its way or been returned by the boundary.
        at_boundary = returned > 0 && random.uniform() * (1 - leaves) < reaches * returned;
        if (!at_boundary) flight = -std::log(1 - random.uniform() * (1 - reaches));
      }
      if (at_boundary) {
        x = exit_x, y = exit_y, z = 0, to.z = -to.z;
        continue;
      }
    }
    x += flight * to.x, y += flight * to.y, z = std::max(0.0, z + flight * to.z);
    ++ledger.collisions;
    if (analog) {
      if (random.uniform() >= medium.alpha) {
        ledger.absorbed += weight;
        return ledger;
      }
    } else {
      ledger.absorbed += weight * (1 - medium.alpha);
      weight *= medium.alpha;
      if (weight <= least) {
        if (random.uniform() * 2 * least >= weight) {
          ledger.roulette += weight;
          return ledger;
        }
        ledger.roulette += weight - 2 * least;
        weight = 2 * least;
      }
    }
    if (medium.g == 0) to = WalkDirection::anywhere(random.in_disk());
    else to = to.turned(scattered_cosine(medium.g, random.uniform()), random.in_disk());
  }
  ledger.unfinished += weight;
  return ledger;
}

// The mean of independent numbers and its standard error; the error of a single number counts as 1.
class WalkMean {
 public:
  void add(double value) {
    ++count_;
    sum_ += value;
    squares_ += value * value;
  }
  double mean() const { return sum_ / double(count_); }
  double error() const {
    const double n = double(count_);
    return n < 2 ? 1 : std::sqrt(std::max(0.0, squares_ - sum_ * sum_ / n) / (n * (n - 1)));
  }

 private:
  std::int64_t count_ = 0;
  double sum_ = 0, squares_ = 0;
};

// ---- a whole profile.

struct WalkProfile {
  // Between edges[i] and edges[i + 1]: R, [1 / mean free path^2], its mean over the ring, and its standard error.
  std::vector<double> reflectance, error;
  WalkMean total;    // of the reflected part: the surface albedo A
  WalkLedger where;  // summed over the walks
};

// `edges`: at least two radii that grow, the first >= 0. The same seed gives the same profile.
inline WalkProfile random_walk_profile(const HalfSpace& medium, Incidence incidence, std::span<const double> edges,
                                       std::int64_t walks, std::uint64_t seed,
                                       Estimator estimator = Estimator::kWeighted) {
  const std::size_t rings = edges.size() - 1;
  WalkProfile profile;
  std::vector<double> sum(rings), squares(rings), of_walk(rings);
  std::vector<std::size_t> touched;
  for (std::int64_t walk = 0; walk < walks; ++walk) {
    WalkRandom random(seed, std::uint64_t(walk));
    const WalkLedger ledger = random_walk(medium, incidence, estimator, random, [&](double radius, double weight) {
      const auto above = std::upper_bound(edges.begin(), edges.end(), radius);
      if (above == edges.begin() || above == edges.end()) return;
      const auto ring = std::size_t(above - edges.begin() - 1);
      if (of_walk[ring] == 0) touched.push_back(ring);
      of_walk[ring] += weight;
    });
    for (const std::size_t ring : touched) {
      sum[ring] += of_walk[ring];
      squares[ring] += of_walk[ring] * of_walk[ring];
      of_walk[ring] = 0;
    }
    touched.clear();
    profile.total.add(ledger.reflected);
    profile.where.reflected += ledger.reflected;
    profile.where.absorbed += ledger.absorbed;
    profile.where.roulette += ledger.roulette;
    profile.where.unfinished += ledger.unfinished;
    profile.where.collisions += ledger.collisions;
  }
  const double n = double(walks);
  for (std::size_t i = 0; i < rings; ++i) {
    const double area = std::numbers::pi * (edges[i + 1] - edges[i]) * (edges[i + 1] + edges[i]);
    profile.reflectance.push_back(sum[i] / (n * area));
    profile.error.push_back(n < 2 ? 1
                                  : std::sqrt(std::max(0.0, squares[i] - sum[i] * sum[i] / n) / (n * (n - 1))) / area);
  }
  return profile;
}

// ---- one radius.

struct WalkEstimate {
  WalkMean ring;   // the part that leaves through the ring; divide by `area`
  WalkMean total;  // the reflected part
  double area = 1;
};

// R at a radius, as its mean over the ring from radius (1 - width) to radius (1 + width), at least 1e-3 mean free paths
// to either side: a walk never leaves at a given radius. Allocates nothing.
inline WalkEstimate random_walk_at(const HalfSpace& medium, Incidence incidence, double radius, double width,
                                   std::int64_t walks, std::uint64_t seed, Estimator estimator = Estimator::kWeighted) {
  const double half = std::max(radius * width, 1e-3), inner = std::max(0.0, radius - half), outer = radius + half;
  WalkEstimate estimate;
  estimate.area = std::numbers::pi * (outer - inner) * (outer + inner);
  for (std::int64_t walk = 0; walk < walks; ++walk) {
    WalkRandom random(seed, std::uint64_t(walk));
    double through = 0;
    const WalkLedger ledger = random_walk(medium, incidence, estimator, random, [&](double r, double weight) {
      if (r >= inner && r < outer) through += weight;
    });
    estimate.ring.add(through);
    estimate.total.add(ledger.reflected);
  }
  return estimate;
}

}  // namespace likeness::brdf
