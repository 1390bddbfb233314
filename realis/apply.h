#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "realis/bake_file.h"
#include "realis/surface_maps.h"
#include "render/capture/capture.h"
#include "render/image/picture.h"

// A baked subject under light that nobody photographed (spec: Realis, Run time).
namespace likeness::realis {

// A light from one direction.
struct Beam {
  glm::dvec3 to_light{0, 0, 1};    // unit
  glm::dvec3 irradiance{1, 1, 1};  // on a surface that faces it, in units of the capture's unit light
};

struct Relit {
  image::Picture render, realis;  // without and with the residual; linear, >= 0, 0 outside the subject
};

// `camera` is the one of the bake, whose view the surface is shaded for. Throws files::InputError if surface and bake are
// not of one size.
Relit relight(const capture::Capture& capture, const StoredBake& stored, const capture_fit::Fit& surface,
              std::span<const Beam> beams);

// An environment (latitude and longitude, y up, its middle at -z: behind the subject) as at most `count` beams: the
// picture is halved where both halves send the same, again and again, and each part shines from its middle. What comes from
// below the horizon of a texel is left to its cosine. All of its light is kept: the beams' irradiances sum to the
// integral of the radiance. Empty for a black picture; what is negative or not finite counts as black.
// Source  Debevec 2005, "A Median Cut Algorithm for Light Probe Sampling".
std::vector<Beam> beams_of(const image::Picture& environment, std::size_t count);

}  // namespace likeness::realis
