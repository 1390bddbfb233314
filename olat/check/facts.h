#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "olat/registration/gain.h"
#include "olat/registration/noise.h"
#include "olat/registration/order.h"
#include "olat/registration/shift.h"
#include "render/capture/capture.h"
#include "render/image/picture.h"

namespace likeness::olat_check {

// Layers of a camera, read once.
struct View {
  std::vector<float> mask;                // 1 inside
  std::optional<image::Picture> normals;  // if the camera has that layer
  std::size_t inside = 0;                 // pixels
};

// What is asked of one photo and, if there is one, of its render.
struct Request {
  std::size_t frame = 0;
  const capture::Variant* variant = nullptr;
  bool reads_hash = true;
  bool measures_shift = true;
};

// What a photo and its render say; numbers only, so that a capture of any size fits.
struct Facts {
  std::size_t light = 0, frame = 0;
  std::string unreadable;                               // the message; nothing else is then known
  std::optional<std::array<int, 2>> size;               // of the file, where it is not the camera's
  std::string sha256;                                   // of the file, where it is not the frame's
  std::string attributes;                               // what the EXR says otherwise
  double attributes_ev = 0;                             // the largest difference [stop]
  std::size_t inside = 0, clipped = 0, not_finite = 0;  // pixels
  std::array<double, 3> mean{};                         // light inside the mask, of pixels without flaws
  registration::Darkness darkness;
  registration::Sketch sketch;

  bool has_render = false;     // read; what follows is against it
  bool has_reference = false;  // a render, or else the cosine
  std::string render_unreadable;
  bool is_stale = false;
  std::string render_header;  // what it says otherwise
  std::size_t render_not_finite = 0;
  registration::Sketch reference;
  registration::Curve curve;
  registration::Gain gain;
  registration::Shift shift;
};

// Opens the files of a frame. Files that cannot be used are facts, not exceptions.
Facts facts_of(const capture::Capture& capture, const View& view, const Request& request);

// The direction towards a light from the middle of the world; nothing where it is not known.
std::optional<std::array<double, 3>> to_light_of(const capture::Light& light);

}  // namespace likeness::olat_check
