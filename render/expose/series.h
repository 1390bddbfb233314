#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/expose/request.h"
#include "render/image/picture.h"
#include "render/scene/scene.h"

// What is exposed together: pictures, all lights of a camera of a capture, or a quick look at a scene.
namespace likeness::expose {

// How a camera took a picture, where it is known.
struct Taken {
  std::optional<double> f_number, seconds, iso;
  std::optional<double> ev100() const;
  bool operator==(const Taken&) const = default;
};

struct Shot {
  image::Picture light;        // linear Rec. 709
  std::vector<float> weights;  // of its pixels; empty: all 1
  float floor = 0;             // luminance at or below it is black
  Taken taken;
};

struct Frame {
  std::string name;            // on messages and in the page
  std::string stem;            // of the file that is written of it
  std::function<Shot()> read;  // throws files::InputError
};

struct Series {
  std::string name;
  std::vector<Frame> frames;        // at least one
  scene::View view{0, "", "", ""};  // what a scene or a capture says of it; without a name: nothing does
};

// Looks at names, reads captures, and renders scenes (at most 480 pixels a side, by the run-time pipeline); pictures are
// read when a frame is. Throws files::UsageError and files::InputError.
Series series_of(const Request& request, const Options& options);

}  // namespace likeness::expose
