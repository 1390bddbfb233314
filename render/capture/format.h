#pragma once

#include <string_view>

#include "render/json/section.h"

// The keys of a capture's four files, stated once (render/json/section.h): the reader checks by these rows, and the tables
// of docs/capture.md are written from them.
namespace likeness::capture {

extern const json::Section kCaptureSection;   // capture.json
extern const json::Section kPipelineSection;  // in it
extern const json::Section kFlipSection;      // in it
extern const json::Section kVariantSection;   // in it
extern const json::Section kCamerasSection;   // cameras.json
extern const json::Section kCameraSection;    // a row of it
extern const json::Section kLayersSection;    // of a camera
extern const json::Section kLightsSection;    // lights.json
extern const json::Section kLightSection;     // a row of it
extern const json::Section kFramesSection;    // frames.json
extern const json::Section kFrameSection;     // a row of it
extern const json::Section kPatternSection;   // rows by a pattern
extern const json::Section kEncodingSection;  // what every row has unless it says otherwise

inline constexpr std::string_view kCaptureFile = "capture.json", kCamerasFile = "cameras.json",
                                  kLightsFile = "lights.json", kFramesFile = "frames.json";
inline constexpr std::string_view kCaptureType = "olat capture", kCamerasType = "olat cameras",
                                  kLightsType = "olat lights", kFramesType = "olat frames";
inline constexpr int kFormatVersion = 1;
// Of cameras.json: 2 has `lens` and more than five numbers of `distortion`. A file that needs neither is written as 1.
inline constexpr int kCamerasVersion = 2;

}  // namespace likeness::capture
