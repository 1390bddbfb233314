#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "render/capture/capture.h"
#include "render/image/picture.h"

// What a camera and a renderer saw of a subject, texel by texel: texture space is the picture (spec: an image-space
// subject).
namespace likeness::realis {

// What a renderer says of a camera under a light of the capture, in the unit of the photo, and how the light met the
// surface. A mesh gives the same: pictures in texture space.
struct Rendered {
  image::Picture light;
  std::vector<float> cosine;  // of each pixel: light and normal; may be negative, or empty: not known, as if it were 1
};
using Renderer = std::function<Rendered(std::size_t light)>;

// The photographs of one light, inside the subject.
struct LightCensus {
  std::size_t samples = 0, clipped = 0, not_finite = 0, negative = 0;  // negative: of luminance below 0
  double sum = 0;                                                      // of luminance, of those that are neither
  void add(const std::array<float, 3>& photo, std::uint8_t flaws);     // bits of capture::Flaw
};

// Of each sample (a texel under a light), texel by texel, in each the lights.
struct Subject {
  std::size_t camera = 0;
  int width = 0, height = 0;
  std::vector<std::uint32_t> pixels;  // of each texel, in the picture: those inside the mask
  std::vector<std::size_t> lights;    // in Capture::lights: those with a photograph and a place
  std::vector<glm::dvec3> to_lights;  // unit, from the world's origin: where captures have their subject
  std::vector<double> irradiance;  // there, of each light of intensity 1: 1, or 1 / d^2 of a near one [1/m^2]; empty: 1
  std::vector<std::array<float, 3>> photo, render;
  std::vector<float> cosine;
  std::vector<float> weight;  // [0, 1], how far the photo can be trusted: 0 where it is clipped, black or not finite
  std::vector<LightCensus> census{};  // of each light
  // The same photographs through crossed polarizers, of each sample; NaN: there is none, or it is clipped. Empty: of no light.
  std::vector<std::array<float, 3>> crossed{};

  // Of each texel: what its diffuse part returns of a light of irradiance 1 that it faces; empty: not known. What is seen is
  // taken to be `least` of it under any light.
  std::vector<std::array<float, 3>> facing{};
  double least = 0;

  // The least light of a sample.
  float least_of(std::size_t texel, std::size_t light, std::size_t channel) const {
    return facing.empty()
               ? 0.0f
               : static_cast<float>(least * irradiance_of(light) * static_cast<double>(facing[texel][channel]));
  }
  double irradiance_of(std::size_t light) const { return irradiance.empty() ? 1 : irradiance[light]; }
  std::size_t texels() const { return pixels.size(); }
  std::size_t samples_of(std::size_t texel) const { return texel * lights.size(); }  // the first of them
};

// Reads the photographs of a camera once. `goes_on` is asked in between; where it says no, files::Interrupted is thrown.
// Lights in `leave_out` (of Capture::lights) are not looked at. Throws files::InputError for files that cannot be used, and
// files::UsageError if no light with a place has a photograph.
using GoesOn = std::function<bool(double share, std::string_view what)>;
Subject read_subject(const capture::Capture& capture, std::size_t camera, const Renderer& render,
                     std::span<const std::size_t> leave_out, const GoesOn& goes_on);

}  // namespace likeness::realis
