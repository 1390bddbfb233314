#pragma once

#include <memory>

#include "fit/capture/capture_fit.h"
#include "realis/subject.h"

// Renders and cosines of a capture's camera, for read_subject().
namespace likeness::realis {

// The pictures of a variant (likeness olat render), and cosines by the camera's layer of normals; without that layer cosines
// are not known. Near lights are met from the camera's layer of positions, or else from the origin. Throws
// files::InputError when it is made, or asked for a light whose render is absent.
Renderer renders_of_variant(const capture::Capture& capture, std::size_t camera, std::size_t variant);

// Those of a fit: the subject has no other scene than its normals and colors. Keeps references.
Renderer renders_of_fit(const capture::Capture& capture, const capture_fit::Fit& fit);

}  // namespace likeness::realis
