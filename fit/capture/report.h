#pragma once

#include <string>
#include <vector>

#include "fit/capture/capture_fit.h"
#include "render/image/picture.h"

// What a fit of a capture is told as: a page for the eye and a file for programs.
namespace likeness::capture_fit {

// A photograph beside what the fit says that it is.
struct Shown {
  std::size_t light = 0;  // in Capture::lights
  image::Picture photo, render;
};

// What was asked for, to be repeated.
struct Asked {
  std::string capture, command;
  Options options;
};

// One HTML page that needs nothing outside itself and no script.
std::string report_html(const capture::Capture& capture, const Fit& fit, const std::vector<Shown>& shown,
                        const Asked& asked);

// fit.json; its fields are listed in docs/fit_capture.md.
std::string fit_json(const capture::Capture& capture, const Fit& fit, const Asked& asked);

}  // namespace likeness::capture_fit
