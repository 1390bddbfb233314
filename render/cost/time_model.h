#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "render/runtime/settings.h"

// What a frame will take, from the passes of frames that were measured:
//
//   time = frame + pixel_samples x (sum of its passes, each at the level of the setting that runtime::kSettings ties to it)
//
// A frame of one point a pixel looks through their middles, at neighbors that are more alike: its passes are a tenth
// cheaper, and are kept apart.
namespace likeness::scene_cost {

inline constexpr std::size_t kSettingCount = runtime::kSettings.size();

// A level of each setting, in the order of runtime::kSettings.
using Levels = std::array<std::size_t, kSettingCount>;
inline constexpr std::size_t kPixelSamples = 0, kLightSamples = 1, kEnvironment = 2;
static_assert(runtime::kSettings[kPixelSamples].name == "pixel_samples");
static_assert(runtime::kSettings[kLightSamples].name == "light_samples");
static_assert(runtime::kSettings[kEnvironment].name == "environment");

runtime::Settings settings_of(const Levels& levels);

// One frame: all of it, and its passes, all their samples together [ms].
struct FrameTimes {
  Levels levels{};
  double whole = 0;
  struct Pass {
    std::string name;
    double ms = 0;
  };
  std::vector<Pass> passes;
};

class TimeModel {
 public:
  // Medians over the frames. A level of a pass that no frame had is read off the line through the two highest levels
  // below it, over their numbers of rays; through one level, in proportion.
  explicit TimeModel(std::span<const FrameTimes> frames);

  double predict(const Levels& levels) const;  // [ms]

  struct Part {
    std::string pass;
    std::size_t setting = kSettingCount;  // on whose level it depends; kSettingCount: on none
    // For each level of that setting, or the one cost [ms for each point of a pixel], in frames of several points and of
    // one; what was measured in one of the two only counts for both. NaN: not measured, and no level to tell it from.
    std::vector<double> ms, ms_alone;
  };
  const std::vector<Part>& parts() const { return parts_; }
  double frame_ms() const { return frame_; }

 private:
  std::vector<Part> parts_;
  double frame_ = 0;  // what a frame takes besides its passes
};

// The least squares of a non-negative sum: x >= 0 that makes sum_j rows[i][j] x[j] nearest to values[i], each row
// divided by its value (relative errors). Values above 0.
std::vector<double> fit_non_negative(const std::vector<std::vector<double>>& rows, const std::vector<double>& values);

// relMSE as it falls with the numbers of rays: floor + a fault for each level that is no number of rays + (pixels + lights
// / light_samples + sky / rays) / pixel_samples, each factor fitted to what was measured. Says only which combinations are
// worth a measurement.
class ErrorModel {
 public:
  struct Measured {
    Levels levels{};
    double relmse = 0;
  };
  explicit ErrorModel(std::span<const Measured> measured);
  double predict(const Levels& levels) const;

 private:
  std::vector<double> factors_;
};

}  // namespace likeness::scene_cost
