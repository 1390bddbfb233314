#include "datasets_synthetic/faults.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "datasets_synthetic/random.h"

namespace likeness::datasets_synthetic {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Streams of the seed. New ones go to the end: their order is part of what a seed means.
enum Stream : std::uint64_t { kInvalid, kNan, kNegative, kNoise, kFirstFreeStream };

// A halo with a finite edge, 1 at the mirror direction: (1 - (theta_h / end)^2)^2.
double halo(double theta_h, double end) {
  const double x = theta_h / end;
  return x < 1 ? (1 - x * x) * (1 - x * x) : 0;
}

}  // namespace

Counts apply(const Faults& faults, const brdf::AnyBrdf& brdf, std::uint64_t seed, Table& table) {
  Random invalid(seed, kInvalid), nan(seed, kNan), negative(seed, kNegative), noise(seed, kNoise);
  const brdf::Geometry<double> facing({0, 0, 1}, {0, 0, 1});
  const brdf::Rgb<double> peak = std::visit([&](const auto& model) { return model.eval(facing); }, brdf);
  const std::array<double, 3> flare{faults.flare * peak.r, faults.flare * peak.g, faults.flare * peak.b};
  const double lowest_measured = faults.invalid_above < 90 ? std::cos(faults.invalid_above * kDegree) : 0;
  const bool need_angles = faults.flare > 0 || faults.invalid_above < 90 || faults.noise_by_angle;

  Counts counts;
  std::size_t at = 0;
  for (int i = 0; i < table.grid.bins[0]; ++i)
    for (int j = 0; j < table.grid.bins[1]; ++j)
      for (int k = 0; k < table.grid.bins[2]; ++k, ++at) {
        if (table.state[at] == State::kBelowHorizon) {
          ++counts.below_horizon;
          continue;
        }
        std::array<double, 3> f{table.f[0][at], table.f[1][at], table.f[2][at]};
        double theta_h = 0, lowest_cosine = 1;
        if (need_angles) {
          const auto g = geometry_of(table.grid, i, j, k);
          theta_h = std::atan2(std::sqrt(g.sin2_h), g.cos_h) / kDegree;
          lowest_cosine = std::min(g.cos_i, g.cos_o);
        }

        bool changed = false, below_zero = false;
        if (const double h = halo(theta_h, faults.flare_angle); faults.flare > 0 && h > 0) {
          for (std::size_t c = 0; c < 3; ++c) f[c] += flare[c] * h;
          changed = true;
        }
        const bool has_flare = changed;
        if (faults.noise > 0) {
          // Photons counted go with the cosine, so their relative noise with its root; bounded at 89.4 degrees.
          const double sigma = faults.noise / (faults.noise_by_angle ? std::sqrt(std::max(lowest_cosine, 0.01)) : 1.0);
          for (double& v : f) v *= 1 + sigma * noise.normal();
          below_zero = std::min({f[0], f[1], f[2]}) < 0;
        }
        bool clipped = false;
        if (faults.clip > 0)
          for (double& v : f)
            if (v > faults.clip) {
              v = faults.clip;
              clipped = true;
            }

        // Every stream advances at every sample, whatever the others decide.
        const bool is_invalid = faults.invalid > 0 && invalid.chance(faults.invalid);
        const bool is_nan = faults.nan > 0 && nan.chance(faults.nan);
        const auto nan_channel = faults.nan > 0 ? static_cast<std::size_t>(3 * nan.uniform()) : 0;
        const bool is_negative = faults.negative > 0 && negative.chance(faults.negative);
        const auto negative_channel = faults.negative > 0 ? static_cast<std::size_t>(3 * negative.uniform()) : 0;
        const double depth = faults.negative > 0 ? negative.uniform() : 0;

        State& state = table.state[at];
        if (is_invalid || lowest_cosine < lowest_measured) {
          ++(is_invalid ? counts.invalid : counts.invalid_above);
          state = State::kInvalid;
          continue;
        }
        if (is_nan) {
          ++counts.nan;
          f[nan_channel] = std::numeric_limits<double>::quiet_NaN();
          state = State::kNotFinite;
        } else if (is_negative) {
          ++counts.negative;
          f[negative_channel] = -depth * std::abs(f[negative_channel]) - std::numeric_limits<float>::min();
          state = State::kNegative;
        } else {
          ++counts.measured;
          counts.negative_by_noise += below_zero;
        }
        counts.noise += faults.noise > 0;
        counts.flare += has_flare;
        counts.clip += clipped;
        for (std::size_t c = 0; c < 3; ++c) table.f[c][at] = f[c];
      }
  return counts;
}

}  // namespace likeness::datasets_synthetic
