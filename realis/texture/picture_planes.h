#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "realis/bake.h"
#include "realis/noticed.h"
#include "realis/texture/sight.h"
#include "realis/weight/table.h"
#include "render/capture/capture.h"
#include "render/capture/pixels.h"

// What a camera's picture under one light says of the object, ready to be looked up between pixels.
namespace likeness::realis {

// What the pixels of a PictureSurface show where they are lit, per cosine and irradiance (weight/shadow.h). Empty: not known.
struct LitLevels {
  std::vector<float> photo, render;
};
inline constexpr std::size_t kMostLitBytes = std::size_t{1} << 30;  // while they are found

// All pictures of a camera are read once; of so many that they do not fit into kMostLitBytes, every other one, or fewer.
LitLevels lit_levels(const capture::Capture& capture, const capture::Variant& variant, std::size_t camera,
                     const std::vector<std::size_t>& lights, const PictureSurface& picture, const GoesOn& goes_on);

struct PicturePlanes {
  int width = 0, height = 0;
  std::size_t channels = 1;
  std::vector<float> weight;    // of each pixel; 0 where the object is not seen
  std::vector<float> residual;  // photo - render, channels interleaved
  std::vector<float> photo;     // luminance
};

// Of a frame under one light. Weights of sensor and shadow are of the picture, and are in `weight`. Counts what it meets in
// `census`.
PicturePlanes planes_of(const capture::Capture& capture, const capture::Variant& variant, std::size_t frame,
                        const capture::CameraLayers& layers, const PictureSurface& picture, const LitLevels& lit,
                        const weight::Choice& choice, Channels channels, LightCensus& census);

// What a texel sees: the mean over the pixels under it (at most 8 x 8 bilinear looks) by their weights. Pixels of weight 0
// do not count, whatever they hold.
struct Look {
  float weight = 0;  // of the pixels, in [0, 1]
  std::array<float, 3> residual{};
  float photo = 0;
};
Look look_at(const PicturePlanes& planes, const Seen& seen);

// The weights that a mesh, which is baked light by light, can have; the others need all pictures of a camera at once.
inline constexpr std::array<std::string_view, 5> kStreamedWeights{"stretch", "shadow", "clipped", "mask", "cosine"};
// The choice without the others; their names are appended to `left_out`.
weight::Choice streamed(weight::Choice choice, std::vector<std::string>& left_out);
// Throws files::UsageError if one of them is on.
void must_stream(const weight::Choice& choice);

}  // namespace likeness::realis
