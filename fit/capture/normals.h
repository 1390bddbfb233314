#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "fit/capture/site.h"
#include "fit/capture/stack.h"

// Photometric stereo that doubts its samples: the normal of a pixel from its brightness under lights whose place is known.
//
//     y_l = albedo D(n . l_l) (n . e_l)      for the lights that the normal faces; e = irradiance times direction
//
// 1. Start   least squares over the samples that are lit and in the middle of their ranks: neither in shadow nor in a
//            highlight, as far as ranks can say (Shi et al. 2010 and later: thresholds by rank).
// 2. Weights 1 / (1 + (r / s)^2), Cauchy, s = 1.4826 median |r| over the lights that the normal faces, and 0 for the others;
//            weighted least squares, repeated (Holland and Welsch 1977).
// 3. D       how the surface departs from Lambert as a function of the cosine, one curve for all pixels: the median over a
//            sample of pixels of what each light's brightness is over Lambert's, in bins of the cosine; found in turn
//            with the normals of these pixels, and then held. It is what makes the difference on real surfaces: without
//            it a normal leans so that Lambert's law fits best (docs/fit_capture.md has the numbers).
namespace likeness::capture_fit {

// D, linear between equally spaced cosines from 0 to 1. Its mean over the samples is 1.
struct Curve {
  static constexpr std::size_t kBins = 20;
  std::array<double, kBins + 1> values;
  Curve() { values.fill(1); }
  double at(double cosine) const;
};

// What a pixel's lights are good for.
enum class Seen : unsigned char {
  kWell,
  kByNone,     // no usable sample above the noise
  kByFew,      // by 1 or 2 lights
  kInOnePlane  // the directions it is lit from lie within half a degree of a plane
};

struct NormalOfPixel {
  glm::dvec3 normal{0};  // world, unit, turned no further than the horizon of the view; 0: not known
  double albedo = 0;     // brightness of Lambert's 1 / pi is albedo / pi: mean of the channels
  double sigma = 0;      // standard error of the direction [rad], residuals taken as independent
  Seen seen = Seen::kByNone;
};

// Mean of the channels of a pixel, NaN where the stack has it; for all lights.
void brightness_of(const Stack& stack, std::size_t pixel, std::vector<double>& out);

// The brightness that only one sample in ten is above, and always at least one: what a well-lit sample is measured by.
// Samples that are NaN do not count. 0 if there is none above 0.
double level_of(std::span<const double> brightness, std::vector<double>& scratch);

// How a pixel is seen, from samples above `noise`.
Seen seen_by(const Site& site, std::span<const double> brightness, double noise);

// Room for the numbers of one pixel, so that a loop allocates once.
struct Workspace {
  Site site;
  std::vector<double> y, weights, scratch;
};

NormalOfPixel normal_of(const Site& site, std::span<const double> brightness, double noise, const Curve& curve,
                        Workspace& work);

// D from some pixels. Deterministic.
Curve curve_of(const Stack& sample, const Sites& sites, double noise);

}  // namespace likeness::capture_fit
