#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "render/photograph/response.h"

// What the frames of a bracket say about each other: whether the stated times are true, and how noisy codes are.
namespace likeness::photograph {

// Below it a code says too little to be compared: 0.1 of the hat, code 13 to 242 of 8 bits.
inline constexpr double kComparedHat = 0.1;

// Frames come in the order of their exposures, shortest first.
struct Ratio {
  double stops = std::numeric_limits<double>::quiet_NaN();  // how much more light than stated the longer frame shows
  std::size_t pixels = 0;                                   // that both show well; NaN below kFewestCompared
};
inline constexpr std::size_t kFewestCompared = 30;

struct Judgement {
  std::vector<Ratio> ratios;  // frame k + 1 against frame k; one fewer than frames
  // How each frame stands between its neighbors [stops]: above 0 it is brighter than its stated exposure. At the ends,
  // against the one neighbor. NaN where that is not known.
  std::vector<double> errors;
  // Standard deviation of log2 luminance [stops] at each sixteenth of the green code, robust (median of absolute
  // deviations): grain, noise, and what is left of misalignment.
  std::array<double, 16> noise{};
};

// A pixel's log2 luminance (Rec. 709) per unit of time in a frame; NaN where a channel is worth less than kComparedHat.
// `logs` are log2 exposures of the channels, `worths` those of the codes that they came from.
double log2_luminance(const std::array<double, 3>& logs, const std::array<double, 3>& worths, double log2_time);

// `lights` are the log2 exposures of the samples' codes, `worths` their worths, laid out as those.
Judgement judge(const Samples& samples, std::span<const float> lights, std::span<const float> worths,
                std::span<const double> exposures);

}  // namespace likeness::photograph
