#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "brdf/lighting/zone.h"
#include "render/exposure/measure.h"
#include "render/image/picture.h"

// Exposures chosen from light [stop]: light is multiplied by 2^ev before the view. All answers move by -1 where light is
// doubled, exactly; for other scales by the scale's -log2 to within 1/710 stop (percentile), 1/64 + 1/355 stop (linear), and
// 4e-7 (average).
namespace likeness::exposure {

enum class Mode : unsigned char { kLinear, kAverage, kPercentile, kPatch, kCard };

struct ModeRow {
  Mode mode;
  std::string_view name, text;
  bool needs_patch = false;
};
inline constexpr std::array kModes{
    ModeRow{Mode::kLinear, "linear",
            "the most pixels in the linear part of the curve, with clipped and crushed shares under their limits"},
    ModeRow{Mode::kAverage, "average", "the mean of log luminance on middle grey, zone V"},
    ModeRow{Mode::kPercentile, "percentile", "a percentile of luminance in a zone: the 99th on light 1"},
    ModeRow{Mode::kPatch, "patch", "the mean luminance of a patch in a zone", true},
    ModeRow{Mode::kCard, "card", "a patch is an 18 % grey card: on middle grey, zone V", true},
};

// EV that puts a luminance, above 0, in the middle of a zone, which need not be whole.
double ev_for(double luminance, double zone);

// The zone of light 1, the reference white: V and log2(1 / 0.18) = 7.47.
double white_zone();

// EV100, the exposure that a camera is set to: log2(N^2 / t * 100 / S) of f-number, seconds and ISO speed, all above 0.
// Source  ISO 2720:1974, as EV is given at ISO 100.
double ev100(double f_number, double seconds, double iso);

// What `linear` keeps to: shares of all counted weight.
struct Limits {
  double clipped = 0.01, crushed = 0.05;
};

struct Pick {
  double ev = 0;
  // Of `linear`: no exposure keeps to the limits, and this is the one that exceeds them least: the sum of both excesses.
  bool is_over_limits = false;
};

// The EVs that `linear` chooses from: multiples of 1/64 stop.
inline constexpr int kStepsAStop = 64;
// No exposure is beyond it [stop]: the view's own limit.
inline constexpr double kMostStops = 100;

// Where the linear part begins for `linear`: where the curve says; of a curve without a toe (srgb) at zone II less half a
// stop. Below it the Zone System has tone but no texture, and without a beginning the darkest picture would be the best.
double line_start(const Curve& curve);

// The multiple of 1/64 stop that puts the most weight in the linear part while both shares are at or under their limits.
// Of several that share the maximum, the middle of the run that holds the one nearest to `average`. Nothing where no pixel
// has light.
std::optional<Pick> pick_linear(const Meter& meter, const Limits& limits = {});
std::optional<Pick> pick_average(const Meter& meter);
// `share` in [0, 1] of the pixels with light are at or below the zone's middle.
std::optional<Pick> pick_percentile(const Meter& meter, double share, double zone);

// A rectangle of pixels.
struct Patch {
  int x = 0, y = 0, width = 0, height = 0;
};
struct PatchLight {
  double luminance = 0;                    // mean of its finite pixels; may be 0 or negative
  double spread_stops = 0;                 // standard deviation of log2 luminance: how evenly it is lit
  std::array<double, 3> rgb{};             // mean
  std::uint64_t pixels = 0, left_out = 0;  // not finite
};
// The patch must lie in the picture.
PatchLight light_of_patch(const image::Picture& picture, const Patch& patch);

}  // namespace likeness::exposure
