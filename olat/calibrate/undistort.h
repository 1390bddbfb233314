#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "render/capture/capture.h"

// A capture of pinholes from one whose lenses bend lines.
namespace likeness::olat_calibrate {

// The capture with its photographs and layers named by absolute paths, for another folder. Variants are left out: their
// renders lie below the old one.
capture::Capture moved_to(const capture::Capture& capture, const std::string& folder);

struct Undistorted {
  struct View {
    std::string camera;
    double farthest_px = 0;    // by how much the lens had moved a pixel, at most
    double outside_share = 0;  // of the picture, which the photo does not show
  };
  std::vector<View> views;  // what was straightened
  std::size_t files = 0;    // written
  std::vector<std::string> notes;
};

// Writes the frames of each bent camera (lens.h) into `folder` as photos/CAMERA/LIGHT.exr and its layers as
// aux/CAMERA/LAYER.*, and then the capture, whose other photographs stay where they are. The pictures are 32 bit, of
// linear light: black, white and curve are undone; primaries, gain, flat field and the light's intensity stay with the
// capture. Where a clipped pixel had a part, the new one is clipped; what the photo does not show is 0 and outside the
// mask. Throws files::UsageError: nothing is bent, or `folder` holds a capture; files::InputError: a photo that cannot be
// used; files::Interrupted: keep_going said no, and no capture is written.
Undistorted run_undistort(const capture::Capture& capture, const std::string& folder,
                          const std::function<bool(std::string_view what, double share)>& keep_going);

std::string text_of(const Undistorted& undistorted);
std::string json_of(const Undistorted& undistorted);

}  // namespace likeness::olat_calibrate
