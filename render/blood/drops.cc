#include "render/blood/drops.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace likeness::blood {
namespace {

constexpr double kGravity = 9.81;
constexpr double kLeastSine = 0.05;  // 2.9 degrees: what flies flatter glances off
// A vertical wall holds about this much; what is above it runs [mm].
constexpr double kHeldThickness = 0.3;
// What has lost more of its speed drifts with the air, and falls.
constexpr double kLeastSpeedLeft = 0.1;

double air_reynolds(double velocity, double diameter) {
  return kAirDensity * velocity * diameter * 1e-3 / kAirViscosity;
}

double drag_coefficient(double reynolds) {
  if (reynolds > 1000) return 0.44;
  return 24 / std::max(reynolds, 1e-9) * (1 + 0.15 * std::pow(reynolds, 0.687));
}

// dv/ds over v: what of its speed a drop loses a metre.
double loss_per_metre(double velocity, double diameter) {
  return 0.75 * drag_coefficient(air_reynolds(velocity, diameter)) * kAirDensity / (kBloodDensity * diameter * 1e-3);
}

// Draws of one drop.
class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t number) : state_(mixed(mixed(seed) + number)) {}
  double uniform() {
    state_ = mixed(state_ + 1);
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  double within(const std::array<double, 2>& range) { return range[0] * std::pow(range[1] / range[0], uniform()); }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  // Steele, Lea and Flood 2014, SplitMix64.
  static std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
  }
  std::uint64_t state_;
};

// What a wall holds: blood is counted in squares of kPoolSide, and what is too much for one runs down from the drop that
// came last.
class Pool {
 public:
  void take(Drop& drop) {
    const auto square = [](double mm) { return static_cast<long>(std::clamp(std::floor(mm / kPoolSide), -1e9, 1e9)); };
    // A stain wider than a square is a square of its own size.
    const double area = std::max(kPoolSide * kPoolSide, std::numbers::pi / 4 * drop.width * drop.length);
    double& volume = volume_[{square(drop.at[0]), square(drop.at[1])}];
    volume += std::numbers::pi / 6 * std::pow(drop.diameter, 3);
    const double surplus = volume - kHeldThickness * area;
    if (surplus <= 0) return;
    volume -= surplus;
    drop.run_width = std::max(kLeastTrack, drop.width / 3);
    drop.run = std::min(kLongestRun, surplus / (drop.run_width * kTrackThickness));
  }

 private:
  static constexpr double kPoolSide = 5, kLeastTrack = 0.8, kLongestRun = 1000;  // [mm]
  std::map<std::array<long, 2>, double> volume_;                                 // [mm^3]
};

}  // namespace

double speed_after(double velocity, double diameter, double distance) {
  // Steps of a tenth of the length over which drag takes the speed; the logarithm of speed is nearly straight within one.
  double left = distance;
  while (left > 0 && velocity > 1e-6) {
    const double step = std::min(left, 0.1 / loss_per_metre(velocity, diameter));
    const double middle = velocity * std::exp(-0.5 * step * loss_per_metre(velocity, diameter));
    velocity *= std::exp(-step * loss_per_metre(middle, diameter));
    left -= step;
  }
  return velocity > 1e-6 ? velocity : 0;
}

double falling_speed(double diameter) {
  // g = loss(v) v^2, by halving: the left side does not depend on v and the right grows with it.
  double low = 1e-9, high = 100;
  for (int i = 0; i < 80; ++i) {
    const double middle = std::sqrt(low * high);
    (loss_per_metre(middle, diameter) * middle * middle < kGravity ? low : high) = middle;
  }
  return low;
}

double diameter_of_stain(double width, double velocity) {
  double low = 1e-6 * width, high = width;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * spread(velocity, middle) < width ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double spread(double velocity, double diameter) {
  const double reynolds = kBloodDensity * velocity * diameter * 1e-3 / kBloodViscosity;
  return std::max(1.0, 0.5 * std::pow(reynolds, 0.25));
}

int spines(double velocity, double diameter) {
  const double weber = kBloodDensity * velocity * velocity * diameter * 1e-3 / kBloodTension;
  return static_cast<int>(std::min(200.0, 1.14 * std::sqrt(weber)));
}

Spatter spatter_of(const SpatterOptions& options) {
  const SpeedRow& row = kSpeeds[static_cast<std::size_t>(options.speed)];
  const int count = options.drops < 0 ? row.drops : options.drops;
  const double tilt = options.angle_deg * std::numbers::pi / 180, cone = row.cone_deg * std::numbers::pi / 180;
  // The receiver is the plane z = 0, y up on it; the axis comes from below, in the plane x = 0.
  const std::array<double, 3> axis{0, std::cos(tilt), -std::sin(tilt)}, aside{0, std::sin(tilt), std::cos(tilt)};
  const double metres = std::max(0.0, options.distance);
  Spatter out;
  Pool pool;
  for (int i = 0; i < count; ++i) {
    Draw draw(options.seed, static_cast<std::uint64_t>(i));
    const bool is_mist = draw.uniform() < row.mist;
    Drop drop;
    const double velocity = draw.within(row.velocity), size = draw.within(is_mist ? kMistDiameter : row.stain);
    drop.diameter = is_mist ? size : diameter_of_stain(size, velocity);
    const double across = 0.5 * cone * draw.normal(), upwards = 0.5 * cone * draw.normal();
    out.thrown += 1, out.thrown_mist += is_mist ? 1 : 0;
    // The direction: the axis, leant by two angles.
    std::array<double, 3> way{std::tan(std::clamp(across, -1.4, 1.4)), 0, 0};
    const double lean = std::tan(std::clamp(upwards, -1.4, 1.4));
    for (std::size_t k = 0; k < 3; ++k) way[k] += axis[k] + lean * aside[k];
    const double length = std::hypot(way[0], way[1], way[2]);
    for (double& part : way) part /= length;
    const double sine = -way[2];
    if (sine < kLeastSine) continue;
    const double path = metres * std::sin(tilt) / sine;  // [m]
    drop.velocity = speed_after(velocity, drop.diameter, path);
    if (drop.velocity < kLeastSpeedLeft * velocity) continue;
    // Where the line from the source meets the plane, from where the axis does.
    drop.at = {1e3 * path * way[0], 1e3 * (path * way[1] - metres * axis[1])};
    drop.angle_deg = std::asin(sine) * 180 / std::numbers::pi;
    drop.width = drop.diameter * spread(drop.velocity * sine, drop.diameter);
    drop.length = drop.width / sine;
    drop.turn = std::atan2(way[1], way[0]);
    drop.spines = spines(drop.velocity * sine, drop.diameter);
    const double out_of_axis = std::hypot(across, upwards) / cone;
    drop.part = is_mist             ? Part::kMist
                : out_of_axis < 0.5 ? Part::kCore
                : out_of_axis < 1   ? Part::kBorder
                                    : Part::kOuterBorder;
    if (options.is_wall) pool.take(drop);
    out.drops.push_back(drop);
  }
  return out;
}

}  // namespace likeness::blood
