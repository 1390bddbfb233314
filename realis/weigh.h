#pragma once

#include <vector>

#include "realis/subject.h"
#include "realis/weight/table.h"
#include "render/image/picture.h"

// The weights of a subject, from its capture.
namespace likeness::realis {

// Multiplies the weights that are on into Subject::weight, and returns each of them if `keeps`. `normals` of the camera's
// pixels, as the renders have them (without pixels: the capture's layer, if it has one). Views are the camera's. Throws
// files::InputError for a layer that cannot be used.
std::vector<weight::Layer> weigh(const capture::Capture& capture, const image::Picture& normals,
                                 const weight::Choice& choice, bool keeps, Subject& subject);

}  // namespace likeness::realis
