#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace likeness::view {

// Turns `count` interleaved RGB pixels of linear Rec. 709 light, finite, into display values, which are in [0, 1] for an
// SDR view but not promised to be.
using PixelTransform = std::function<void(float* rgb, long count)>;

// A view of an OpenColorIO config file; empty texts: $OCIO and the default display. Throws files::InputError.
PixelTransform view_of_config(const std::string& config, const std::string& display, const std::string& view);

// What a config offers. The first display, and the first view of each, are their defaults.
struct ConfigDisplay {
  std::string name;
  std::vector<std::string> views;
};
struct ConfigViews {
  std::string file;
  bool is_of_environment = false;  // named by $OCIO
  std::vector<ConfigDisplay> displays;
};

// Of the config file that is named, or else that $OCIO names; nothing where neither does. Throws files::InputError, one line,
// for a config that cannot be read.
std::optional<ConfigViews> views_of_config(const std::string& config);

// ACES 1.0 SDR Video for sRGB, from OpenColorIO's built-in transforms.
PixelTransform aces_view();

// The same as a function of GLSL ES 3.00, `vec4 aces_view(vec4)`, that reads no texture: OpenColorIO's own text, which
// agrees with its CPU path to rounding.
std::string aces_shader_text();

}  // namespace likeness::view
