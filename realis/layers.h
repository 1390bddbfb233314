#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "realis/subject.h"
#include "realis/weight/table.h"
#include "render/baked/bake.h"
#include "render/capture/capture.h"

// What a bake of a picture was made of, to be looked at: variants of the capture, which `likeness olat view` shows beside the
// photographs.
namespace likeness::realis {

inline constexpr std::string_view kRawErrorLayer = "raw_error", kDemodulatedLayer = "demodulated";
inline constexpr std::string_view kWeightLayer = "weight_", kCoefficientLayer = "coefficient_";  // and a name, a number

// Writes FOLDER/layers/LAYER/CAMERA/LIGHT.exr, linear floats, 0 outside the mask:
//
//     weight_NAME      each of `weights`, and as weight_all what Subject::weight holds: [0, 1], in all channels
//     raw_error        photo - render [unit of the photo], with sign; where the photo is not finite it is not either
//     demodulated      the same / (irradiance max(cos_i, floor)) [1/sr], of which the bake is a fit
//
// and FOLDER/layers/LAYER/CAMERA.exr, which no light changes:
//
//     coefficient_007  that coefficient of the bake [1/sr], with sign; of luminance in all channels. Lobes or mixes as
//                      bake.json lists them; as many as a capture has room for (capture::kMostVariants)
//
// Variants of these names that an earlier bake left in the capture are taken out of it first (their files stay). FOLDER is
// below the capture's root, or absolute. Throws files::Interrupted, and std::runtime_error for what cannot be written.
void write_layers(capture::Capture& capture, const Subject& subject, const baked::Bake& bake,
                  std::span<const weight::Layer> weights, const std::filesystem::path& folder);

}  // namespace likeness::realis
