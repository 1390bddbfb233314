#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "realis/export/terms.h"
#include "realis/subject.h"
#include "render/image/picture.h"

// Coefficients of a relightable picture in 8 bits, which a viewer blends by terms_of() its light:
//
//     coefficient(plane) = (byte / 255 - bias) scale
//     color = sum of terms x coefficients of that color                      without components
//     color = sum of terms x (mean + sum of coefficients x component)        with components, of 8 bits too
//
// Colors are display values: sRGB curve, 1 is white. Planes lie three in a JPEG.
namespace likeness::realis {

// Pictures to fit: the same subject under each of these lights, in display values [0, 1].
struct Lit {
  int width = 0, height = 0;
  std::vector<glm::dvec3> to_lights;                           // as terms_of() takes them
  std::function<image::Picture(std::size_t light)> picture{};  // may be called from several threads at once
};

struct Planes {
  Format format = Format::kPtm;
  int width = 0, height = 0, quality = 95;
  std::vector<double> scale, bias;  // of each plane
  // With components: mean and components of terms x colors, as bytes; component = (byte - 127) / range.
  std::vector<std::uint8_t> basis;
  std::vector<double> range;       // of each component
  std::vector<std::string> jpegs;  // three planes each

  std::size_t count() const { return scale.size(); }
};

inline constexpr std::size_t kComponents = 27;  // planes of formats with components: as many as of kHsh

// Least squares over all lights, each of the same weight. `goes_on` is asked in between; where it says no, files::Interrupted
// is thrown. There may be fewer lights than terms: what they leave open is kept small.
Planes fit_planes(Format format, const Lit& lit, int quality, const GoesOn& goes_on);

// The planes as a viewer decodes them.
class Viewer {
 public:
  explicit Viewer(const Planes& planes);  // keeps the reference
  explicit Viewer(Planes&&) = delete;
  // Display values, in [0, 1].
  image::Picture picture(const glm::dvec3& to_light) const;

 private:
  const Planes& planes_;
  std::vector<image::DisplayPicture> decoded_;
};

// info.json of relight, with the lights of photographs where that format has no directions of its own.
std::string info_text(const Planes& planes, std::span<const glm::dvec3> photographed);

}  // namespace likeness::realis
