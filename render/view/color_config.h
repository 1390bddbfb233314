#pragma once

#include <functional>
#include <string>

namespace likeness::view {

// Turns `count` interleaved RGB pixels of linear Rec. 709 light, finite, into display values, which are in [0, 1] for an
// SDR view but not promised to be.
using PixelTransform = std::function<void(float* rgb, long count)>;

// A view of an OpenColorIO config file; empty texts: $OCIO and the default display. Throws files::InputError.
PixelTransform view_of_config(const std::string& config, const std::string& display, const std::string& view);

// ACES 1.0 SDR Video for sRGB, from OpenColorIO's built-in transforms.
PixelTransform aces_view();

// The same as a function of GLSL ES 3.00, `vec4 aces_view(vec4)`, that reads no texture: OpenColorIO's own text, which
// agrees with its CPU path to rounding.
std::string aces_shader_text();

}  // namespace likeness::view
