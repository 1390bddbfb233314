#include "fit/pattern.h"

#include <cmath>
#include <numbers>

namespace likeness::fit {

namespace {

// The model without its specular lobes: for Callisto c1 c2 rho / pi; for other models the whole.
measured::Rgb diffuse_of(const brdf::AnyBrdf& model, const brdf::Geometry<double>& g) {
  if (const auto* callisto = std::get_if<brdf::Callisto<double>>(&model)) {
    auto terms = callisto->terms(g);
    terms.lobe = 0;
    const auto channel = [&](double rho, double f, double r, double o) {
      return brdf::Callisto<double>::combine(terms, callisto->metallic, callisto->specular, rho,
                                             f * callisto->diffuse_fresnel, r * callisto->retroreflection,
                                             o * callisto->smooth_terminator);
    };
    const auto &base = callisto->base_color, &f = callisto->diffuse_fresnel_tint, &r = callisto->retroreflection_tint,
               &o = callisto->smooth_terminator_tint;
    return {channel(base.r, f.r, r.r, o.r), channel(base.g, f.g, r.g, o.g), channel(base.b, f.b, r.b, o.b)};
  }
  return std::visit([&](const auto& m) { return m.eval(g); }, model);
}

// A patch of the slice [deg].
struct Patch {
  int h_low, h_high, d_low, d_high;
};
constexpr Patch kMiddle{25, 45, 25, 45}, kTop{10, 40, 65, 78}, kRight{65, 78, 10, 40}, kCorner{55, 68, 55, 68};

double mean_luminance(const brdf::AnyBrdf& model, const Patch& patch) {
  double sum = 0;
  int count = 0;
  for (int h = patch.h_low; h < patch.h_high; ++h)
    for (int d = patch.d_low; d < patch.d_high; ++d, ++count) {
      constexpr double kDegree = std::numbers::pi / 180;
      const auto f =
          diffuse_of(model, brdf::geometry_at((h + 0.5) * kDegree, (d + 0.5) * kDegree, std::numbers::pi / 2));
      sum += 0.2126 * f.r + 0.7152 * f.g + 0.0722 * f.b;
    }
  return sum / count;
}

std::string towards(const char* edge, double stops) {
  constexpr double kFlat = 0.25;
  return std::string(edge) + (stops > kFlat ? " brighter" : stops < -kFlat ? " darker" : " flat");
}

}  // namespace

Pattern pattern_of(const brdf::AnyBrdf& model) {
  constexpr double kLeast = 1e-3 * std::numbers::inv_pi;  // an albedo of 0.001
  const double middle = mean_luminance(model, kMiddle);
  Pattern pattern;
  if (middle < kLeast) {
    pattern.group = "no diffuse reflection";
    return pattern;
  }
  const auto stops = [&](const Patch& patch) {
    return std::log2(std::max(mean_luminance(model, patch), kLeast / 16) / middle);
  };
  pattern.fresnel_stops = stops(kTop);
  pattern.retroreflection_stops = stops(kRight);
  pattern.corner_stops = stops(kCorner);
  pattern.group = towards("Fresnel edge", pattern.fresnel_stops) + ", " +
                  towards("retroreflection", pattern.retroreflection_stops) +
                  (pattern.corner_stops < -0.25 ? ", dark corner" : "");
  return pattern;
}

}  // namespace likeness::fit
