#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

// What web viewers of RTI multiply coefficients by, as the reader OpenLIME has it (cnr-isti-vclab/openlime, src/ShaderRTI.js)
// and the writer relight (cnr-isti-vclab/relight, src/cli/rtibuilder.cpp).
//
// Directions  unit, in the frame of the picture: x right, y up, z towards the camera; z >= 0.
namespace likeness::realis {

enum class Format : unsigned char {
  kLp,        // pictures and a list of lights: no coefficients
  kPtm,       // 1, x, y, x^2, x y, y^2 of each color
  kHsh,       // 9 hemispherical harmonics of each color; lights lower than 0.15 rad count as at 0.15 rad
  kBilinear,  // a grid of 8 x 8 directions, the hemisphere unfolded (octahedron); principal components of all their colors
  kRbf        // 96 directions, blended by Gaussians; principal components of all their colors
};

struct FormatRow {
  Format format;
  std::string_view name;
  std::size_t terms;    // what a picture is blended from: of each color
  bool has_components;  // terms are shared; a texel keeps coordinates in their principal components
  std::string_view text;
};
inline constexpr std::size_t kGrid = 8, kNodes = 96;
inline constexpr std::array kFormats{
    FormatRow{Format::kLp, "lp", 0, false,
              "pictures under one light each, and their list: RTIBuilder, relight, likeness"},
    FormatRow{Format::kPtm, "ptm", 6, false, "planes of polynomials; smooth, 18 bytes a pixel"},
    FormatRow{Format::kHsh, "hsh", 9, false, "planes of hemispherical harmonics; 27 bytes a pixel"},
    FormatRow{Format::kBilinear, "bilinear", kGrid* kGrid, true, "planes of components of an 8 x 8 grid of lights"},
    FormatRow{Format::kRbf, "rbf", kNodes, true, "planes of components of 96 lights, blended by Gaussians"},
};
constexpr const FormatRow& row_of(Format format) { return kFormats[static_cast<std::size_t>(format)]; }

// `count` directions, spread evenly over the disc on which viewers move the light (x, y): the spiral of Vogel.
std::vector<glm::dvec3> on_disc(std::size_t count);

// The directions that kRbf blends, and the width of its Gaussians (`sigma` of info.json).
std::vector<glm::dvec3> nodes();
double node_width();

// What each term counts for under a light: row_of(format).terms numbers. `format` is none but those of planes.
std::vector<double> terms_of(Format format, const glm::dvec3& to_light);

}  // namespace likeness::realis
