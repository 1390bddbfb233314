#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "brdf/any_brdf.h"
#include "datasets_synthetic/table.h"

namespace likeness::datasets_synthetic {

// What goes wrong when a material is measured. At these defaults nothing does.
struct Faults {
  double invalid = 0, invalid_above = 90, nan = 0, negative = 0;
  double noise = 0, flare = 0, flare_angle = 8, clip = 0;
  bool noise_by_angle = false;
  bool half_bin = false;     // samples taken half a bin below where a reader expects them, on every axis
  std::size_t truncate = 0;  // bytes cut from the end of the file
};

// The only statement of the numeric faults: options, bounds, help, manifest and docs come from it.
struct FaultRow {
  std::string_view name;  // of the option, after --, and of the manifest's entry
  double Faults::* value;
  brdf::Interval range;
  std::string_view text;
};
inline constexpr std::array kFaults{
    FaultRow{"invalid", &Faults::invalid, {0, 1}, "share of the samples marked 'not measured'"},
    FaultRow{"invalid-above",
             &Faults::invalid_above,
             {0, 90},
             "angle [deg]: samples whose light or viewer is farther from the normal are marked 'not measured'"},
    FaultRow{"nan", &Faults::nan, {0, 1}, "share of the samples with NaN in one channel"},
    FaultRow{"negative", &Faults::negative, {0, 1}, "share of the samples with one channel turned negative"},
    FaultRow{
        "noise", &Faults::noise, {0, 10}, "standard deviation of the noise over the value, each channel on its own"},
    FaultRow{"flare", &Faults::flare, {0, 1}, "lens flare around the mirror peak, over the peak at normal incidence"},
    FaultRow{"flare-angle", &Faults::flare_angle, {0.1, 90}, "theta_h [deg] at which the flare ends"},
    FaultRow{"clip", &Faults::clip, {0, 1e9}, "value [1/sr] above which the sensor saturates; 0: never"},
};

// How many samples each fault changed. Every sample is in one of the first six; the last three count changes
// of values that stayed in the file.
struct Counts {
  std::size_t below_horizon = 0, measured = 0, invalid = 0, invalid_above = 0, nan = 0, negative = 0;
  std::size_t noise = 0, flare = 0, clip = 0;
  std::size_t negative_by_noise = 0;  // of those `measured`: the noise carried a channel below 0
};

// Applies all faults but truncation, in the order of a measurement: flare, noise, clipping, then what a sample is
// lost to (not measured, else NaN, else negative). The same seed gives the same faults.
Counts apply(const Faults& faults, const brdf::AnyBrdf& brdf, std::uint64_t seed, Table& table);

}  // namespace likeness::datasets_synthetic
