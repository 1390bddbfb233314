#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/callisto.h"
#include "fit/result/result.h"
#include "render/capture/capture.h"
#include "render/capture/sight.h"
#include "render/image/picture.h"

// What a camera's photographs under one light at a time say about the surface: a normal and a base color of each pixel, and
// one Callisto material that all pixels share.
//
//     photo(light) = exposure E (base_color D(l, v, n) + S(l, v, n)),   E = max(cos_i, 0), or max(cos_i, 0) / d^2 of a near light
//
// D and S are the diffuse part of unit base color and the specular part of Callisto's f [1/sr], terminator included. Nothing
// casts a shadow and light is not scattered twice: samples that say otherwise are given less weight (docs/fit_capture.md).
namespace likeness::capture_fit {

enum class NormalSource : unsigned char { kGiven, kEstimate };
inline constexpr std::array<std::string_view, 2> kNormalSources{"given", "estimate"};

struct Options {
  std::optional<NormalSource> normals{};     // absent: given where the camera has the layer, else estimated
  std::uint64_t seed = 1;                    // of the pixels that the shared parameters are searched on
  std::size_t pixels = 1500;                 // how many of them
  std::size_t bytes = std::size_t{1} << 30;  // of photographs held at a time; larger captures are read in bands of rows
  std::vector<std::size_t> leave_out{};      // lights (in Capture::lights) whose photographs are not looked at
};

// What was seen and what was not, in pixels inside the mask and in samples (a pixel under a light).
struct Counts {
  std::size_t lights = 0;            // with a photograph and a known place, less what is left out
  std::size_t light_directions = 0;  // of them that differ by more than a quarter of a degree
  std::size_t pixels = 0;            // inside the mask
  std::size_t without_normal = 0;    // of them: stored or found as 0
  std::size_t seen_by_none = 0;      // without a usable sample above the noise
  std::size_t seen_by_few = 0;       // by 1 or 2 lights: no normal can be found
  std::size_t in_one_plane = 0;      // the lights that reach it lie in one plane: no normal can be found
  std::size_t without_color = 0;     // no light that its normal faces
  std::size_t samples = 0, clipped = 0, not_finite = 0, negative = 0;
  std::size_t bands = 1;  // how often each photograph was read in a pass over them
};

// How near the fit comes, over samples that are lit and weighted as the fit weights them.
struct Residuals {
  double lambert_rms = 0, callisto_rms = 0;    // of (photo - fit) / the pixel's own level, robust weights [1]
  double lambert_loss = 0, callisto_loss = 0;  // mean of ln(1 + (r / scale)^2), one scale for both [1]
  double scale = 0;                            // 1.4826 median |r| of the Lambert fit, in the pixel's own level [1]
};

struct Fit {
  std::size_t camera = 0;
  NormalSource normals_from = NormalSource::kGiven;
  image::Picture normals;      // world, unit; (0, 0, 0): not known
  image::Picture base_colors;  // reflectance of the diffuse part, linear Rec. 709, >= 0; 0 where nothing is known
  // [0, 1] each. R: sum of weights over the number of lights. G: 1 - the normal's standard error over 10 degrees (0 without
  // one, 1 for normals that are given). B: 1 - the relative standard error of the color, at least 0.
  image::Picture confidence;
  brdf::Callisto<double> material;  // shared; base_color is the median over the pixels
  // What fits leave at 0 and a bake finds (realis/terminator.h): how cosines are spread within a pixel (soft_cosine.h), and
  // what light there is at least, as a share of what the diffuse part returns of a light that the surface faces.
  double spread = 0, least = 0;
  double exposure = 1;  // photo over what the material returns of a unit light; 1: the light is absolute
  std::vector<fit::Estimate> estimates;  // of each parameter: value, sigma, and why one was not fitted
  std::vector<fit::Step> convergence;    // of the shared parameters' robust loss
  Residuals residuals;
  Counts counts;
  std::vector<std::string> notes;  // what the user should know before using it; whole sentences
  double read_seconds = 0, normal_seconds = 0, material_seconds = 0, color_seconds = 0;  // wall time
};

// Reads the photographs of a camera and fits. `goes_on(share, what)` is asked between pieces of work from the calling
// thread; where it says no, files::Interrupted is thrown. Throws files::InputError for files that cannot be used, and
// files::UsageError for what cannot be fitted: normals given of a camera without the layer, no photograph of a light with
// a known place, near lights without positions of the surface. The same input gives the same numbers for any number of
// threads.
using GoesOn = std::function<bool(double share, std::string_view what)>;
Fit fit_capture(const capture::Capture& capture, std::size_t camera, const Options& options, const GoesOn& goes_on);

// The two parts of what the fit says a camera sees under a light, of each pixel, exposure and E included; 0 without normal.
struct Shading {
  std::vector<float> diffuse;  // of unit base color
  std::vector<float> specular;
};

// Any light of the capture over the surface that was found: those that were left out too. Keeps references.
class Relighting {
 public:
  Relighting(const capture::Capture& capture, const Fit& fit);
  Shading shading(std::size_t light) const;
  image::Picture render(std::size_t light) const;  // base_color diffuse + specular, the photo's unit

 private:
  const capture::Capture& capture_;
  const Fit& fit_;
  capture::Positions positions_;
};

}  // namespace likeness::capture_fit
