#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "olat/pair/state.h"
#include "render/capture/capture.h"
#include "render/image/picture.h"

// The picture of a state, made by the processor: what the viewer's shader (olat/viewer/view.glsl) must show, and does
// within 1 / 255 (tests/olat/view).
namespace likeness::olat_pair {

// What is compared: one camera and one light.
struct Pair {
  image::Picture photo;                         // linear Rec. 709; without pixels: there is none
  image::Picture render;                        // of the same size, or without pixels
  std::vector<std::uint8_t> flaws;              // of the photo's pixels, bits of capture::Flaw
  std::array<float, 3> gain{1, 1, 1};           // of the render
  float noise = kUnknownNoise;                  // noise floor [light]
  std::array<double, 2> flip_exposures{-4, 3};  // of HDR-FLIP [stop]

  // Where nobody measured it: a fifth of a step of 11 bits.
  static constexpr float kUnknownNoise = 1e-4f;

  int width() const { return photo.width > 0 ? photo.width : render.width; }
  int height() const { return photo.height > 0 ? photo.height : render.height; }
};

// Positions of a state's ids in the lists of its capture; empty ids are the first ones, of the
// variants the first whose folder exists. variant is capture::kAbsent where
// the capture has none.
struct Place {
  std::size_t camera = 0, light = 0, variant = capture::kAbsent;
};
// Throws files::UsageError: an id that the capture does not have, with the nearest; a capture without cameras or lights.
Place place_of(const capture::Capture& capture, const State& state);

// Reads both files, and finds the gain. A photo or a render that is not there leaves that picture empty. Throws
// files::InputError: a damaged file; a render of another size.
Pair load_pair(const capture::Capture& capture, const State& state);

// What the render is multiplied by to be the photo, channel by channel or for all three, from the pixels without flaws:
// registration::gain_between, as `olat compare` has it. 1 where too few pixels count.
std::array<double, 3> match_gain(const Pair& pair, bool by_channel);
// The gain of a state: match_gain of its pair, or the median of those of at most 16 pairs evenly drawn from the capture.
std::array<double, 3> gain_of(const capture::Capture& capture, const State& state, const Pair& pair);

// Exposed light below which the view's curve is its toe, and above which it is its shoulder (exposure::curve_limits).
std::array<double, 2> curve_limits(const State& state);

// The picture, as large as the photo (twice as wide side by side): zoom and place are the window's affair. A picture that
// is not there is the surround's grey.
image::DisplayPicture picture_of(const State& state, const Pair& pair);

// Map of FLIP and of HDR-FLIP, 0 to 1, row by row: what the shader is given, since it cannot filter.
std::vector<float> flip_map(const State& state, const Pair& pair);

// Display colors of a signed map at -1, -1/2, 0, 1/2, 1, and of the surround. Those of zones and of the curve's parts are
// in render/exposure/overlay.h.
extern const std::array<std::array<float, 3>, 5> kSignedColors;
inline constexpr std::array<float, 3> kSensorStripe{0.90f, 0.10f, 0.70f}, kDisplayStripe{0.08f, 0.08f, 0.08f};
inline constexpr float kSurround = 0.22f;  // display value of what is not a picture, and of what a mask leaves out

}  // namespace likeness::olat_pair
