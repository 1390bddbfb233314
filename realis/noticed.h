#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "realis/subject.h"

// What a bake met that a user should know of: nothing of it stops the bake, and no coefficient is large because of it.
namespace likeness::realis {

struct Census {
  std::vector<std::string> ids;       // of each light
  std::vector<glm::dvec3> to_lights;  // unit
  std::vector<double> irradiance;     // of each light of intensity 1
  std::vector<LightCensus> lights;
  std::size_t texels = 0;
  std::size_t unseen = 0;  // by no camera
  std::size_t unlit = 0;   // seen, but no sample of them has a weight
  std::size_t lobes = 0;
  bool is_free = false;  // as many lobes as lights were asked for
  double plain_rms = 0;  // of photo - render
};

// One line each, without an end; none if nothing was met.
std::vector<std::string> noticed(const Census& census);

// Of an image-space subject, as far as it says.
Census census_of(const Subject& subject, const capture::Capture& capture);

}  // namespace likeness::realis
