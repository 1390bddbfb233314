#pragma once

#include <array>

#include "render/capture/format.h"

namespace likeness::capture::test {

inline constexpr std::array<const json::Section*, 13> kSections{
    &kCaptureSection,  &kPipelineSection, &kFlipSection,   &kVariantSection, &kCamerasSection,
    &kCameraSection,   &kLayersSection,   &kLightsSection, &kLightSection,   &kFramesSection,
    &kEncodingSection, &kFrameSection,    &kPatternSection};

}  // namespace likeness::capture::test
