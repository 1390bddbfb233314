#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "brdf/cost/ladder.h"
#include "brdf/normal_length.h"

namespace likeness::cost {
namespace {

// ---- diffuse: a draw is alpha, then the light and the viewer as unit vectors.

void set_vectors(const double* draw, Inputs& in) {
  const char* names[]{"light_x", "light_y", "light_z", "view_x", "view_y", "view_z"};
  for (int i = 0; i < 6; ++i) in.set(names[i], draw[1 + i]);
}
void set_base_alpha(const double* draw, Inputs& in) {
  set_vectors(draw, in);
  in.set("base_color", 1);
  in.set("alpha", draw[0]);
}
void set_angles_alpha(const double* draw, Inputs& in) {
  in.set("alpha", draw[0]);
  in.set("theta_i", std::atan2(std::hypot(draw[1], draw[2]), draw[3]));
  in.set("theta_o", std::atan2(std::hypot(draw[4], draw[5]), draw[6]));
  in.set("phi", std::atan2(draw[2], draw[1]) - std::atan2(draw[5], draw[4]));
}
// What tests/brdf/cost/fit_callisto.py found: the intensities linear in alpha, the falloffs constant.
void set_callisto(const double* draw, Inputs& in) {
  set_vectors(draw, in);
  in.set("base_color", 1);
  in.set("specular", 0);
  in.set("specular_fresnel_falloff", 0);
  in.set("diffuse_fresnel", 1 - 0.788 * draw[0]);
  in.set("diffuse_fresnel_falloff", 0.980);
  in.set("diffuse_fresnel_tangent_falloff", 0.572);
  in.set("retroreflection", 1 + 11.944 * draw[0]);
  in.set("retroreflection_falloff", 0.688);
  in.set("retroreflection_tangent_falloff", 0.882);
}

void cosine_direction(Random& random, double* w) {
  const double r = std::sqrt(random.uniform()), phi = random.uniform(0, 2 * std::numbers::pi);
  w[0] = r * std::cos(phi);
  w[1] = r * std::sin(phi);
  w[2] = std::sqrt(1 - r * r);
}

// ---- Fresnel: a draw is a cosine, then eta and k of a metal.

double conductor(double cosine, double eta, double k) {
  const std::complex<double> m(eta, k);
  const std::complex<double> inner = std::sqrt(m * m - (1 - cosine * cosine));
  const double s = std::norm((cosine - inner) / (cosine + inner));
  const double p = std::norm((m * m * cosine - inner) / (m * m * cosine + inner));
  return 0.5 * (s + p);
}
double f0_of(const double* draw) { return conductor(1, draw[1], draw[2]); }

}  // namespace

Family diffuse_family() {
  Family family;
  family.name = "diffuse";
  family.title = "Diffuse reflection of rough surfaces";
  family.text =
      "A surface of Lambertian facets with GGX normals, unshadowed (Heitz 2014 with G2 = 1): what a rough diffuse "
      "normal map looks like from afar. Lambert, Burley and Callisto were made for other ends and know nothing of its "
      "alpha; Proxima was made for it. RMS and worst error are of f cos_i cos_o, the light that a pair of directions "
      "exchanges over a patch: f alone rises as 1 / (cos_i cos_o), and a few grazing draws would decide. The albedo is "
      "compared for views up to 60 degrees; beyond, that of the integral exceeds 1 without bound (nothing is "
      "shadowed), "
      "which no form that keeps energy can follow, nor should.";
  family.compared = "f cos_i cos_o";
  family.value_weight = [](const double* d) { return d[3] * d[6]; };
  family.negligible = 1e-2;
  family.distribution = "alpha uniform in [0, 1]; light and viewer with the density of the cosine over the hemisphere";
  family.draw_names = {"alpha", "light_x", "light_y", "light_z", "view_x", "view_y", "view_z"};
  family.draw = [](Random& random, double* draw) {
    draw[0] = random.uniform();
    cosine_direction(random, draw + 1);
    cosine_direction(random, draw + 4);
  };
  family.energy_name = "albedo, views to 60°";
  family.energy_weight = [](const double* d) { return d[6] < 0.5 ? 0.0 : 1.0; };  // the light's density is the cosine
  family.energy_bins = 16;
  family.energy_bin = [](const double* d) {
    return std::size_t(4 * std::min(d[0], 0.999)) * 4 + std::size_t(8 * std::clamp(d[6] - 0.5, 0.0, 0.499));
  };
  family.rungs = {
      {.label = "Lambert",
       .evaluator = "lambert",
       .inputs = [](const double* d, Inputs& in) { set_vectors(d, in), in.set("base_color", 1); }},
      {.label = "Oren-Nayar (Fujii)",
       .evaluator = "oren_nayar",
       .inputs = [](const double* d,
                    Inputs& in) { set_vectors(d, in), in.set("base_color", 1), in.set("sigma", d[0]); },
       .note = "sigma = alpha"},
      {.label = "Proxima", .evaluator = "proxima", .inputs = set_base_alpha},
      {.label = "our fit", .evaluator = "microfacet_diffuse_fit", .inputs = set_base_alpha},
      {.label = "Burley 2012",
       .evaluator = "burley_diffuse",
       .inputs = [](const double* d,
                    Inputs& in) { set_vectors(d, in), in.set("base_color", 1), in.set("roughness", std::sqrt(d[0])); }},
      {.label = "Callisto, fitted in alpha",
       .evaluator = "callisto",
       .inputs = set_callisto,
       .note = "diffuse part, six numbers fitted to this very function (tests/brdf/cost/fit_callisto.py); at its "
               "defaults it is Lambert; the time is that of the whole model"},
      {.label = "3D table, phi = 0", .evaluator = "microfacet_diffuse_lut", .inputs = set_angles_alpha},
      {.label = "3D table, three azimuths", .evaluator = "microfacet_diffuse_azimuth_lut", .inputs = set_angles_alpha},
      {.label = "quadrature", .evaluator = "microfacet_diffuse", .inputs = set_angles_alpha, .is_reference = true},
  };
  return family;
}

Family fresnel_family() {
  Family family;
  family.name = "fresnel";
  family.title = "Fresnel reflectance of metals";
  family.text =
      "Reflectance at an angle, from the complex index of refraction. Each form is given the exact reflectance at "
      "normal "
      "incidence; F82 also the exact one at 82 degrees.";
  family.distribution =
      "cosine uniform in [0, 1]; eta uniform in [0.15, 3], k uniform in [1.5, 7]: the range of common metals";
  family.draw_names = {"cos_i", "eta", "k"};
  family.draw = [](Random& random, double* draw) {
    draw[0] = random.uniform();
    draw[1] = random.uniform(0.15, 3);
    draw[2] = random.uniform(1.5, 7);
  };
  family.energy_name = "hemispherical reflectance";
  family.energy_weight = [](const double* d) { return d[0]; };
  family.energy_bins = 9;
  family.energy_bin = [](const double* d) {
    return std::size_t(3 * std::min((d[1] - 0.15) / 2.85, 0.999)) * 3 +
           std::size_t(3 * std::min((d[2] - 1.5) / 5.5, 0.999));
  };
  const auto schlick = [](const double* d, Inputs& in) { in.set("cos_i", d[0]), in.set("f0", f0_of(d)); };
  family.rungs = {
      {.label = "constant f0",
       .evaluator = "schlick_falloff",
       .inputs = [=](const double* d, Inputs& in) { schlick(d, in), in.set("specular_fresnel_falloff", 0); },
       .note = "Callisto's falloff at 0; the time is that of any falloff"},
      {.label = "Schlick", .evaluator = "schlick", .inputs = schlick},
      {.label = "Callisto's falloff, 0.47",
       .evaluator = "schlick_falloff",
       .inputs = [=](const double* d, Inputs& in) { schlick(d, in), in.set("specular_fresnel_falloff", 0.47); },
       .note = "an artist's control, not a fit of metals: the power is 5.3"},
      {.label = "F82",
       .evaluator = "f82",
       .inputs =
           [=](const double* d, Inputs& in) {
             schlick(d, in);
             const double f0 = f0_of(d), rise = std::pow(1 - 1.0 / 7, 5);
             in.set("tint", std::min(1.0, conductor(1.0 / 7, d[1], d[2]) / (f0 + (1 - f0) * rise)));
           }},
      {.label = "exact",
       .evaluator = "fresnel_conductor",
       .inputs = [](const double* d, Inputs& in) { in.set("cos_i", d[0]), in.set("eta", d[1]), in.set("k", d[2]); },
       .is_reference = true},
  };
  return family;
}

Family normal_length_family() {
  Family family;
  family.name = "normal_length";
  family.title = "Roughness from the length of an averaged normal";
  family.text =
      "The inverse of the mean normal length of GGX (Chan 2018): what a mip filter does once for each texel. It has no "
      "closed "
      "form; the exact one iterates from the cheap one.";
  family.distribution = "lengths of alpha uniform in [0.01, 1]";
  family.draw_names = {"length"};
  family.draw = [](Random& random, double* draw) { draw[0] = brdf::normal_length(random.uniform(0.01, 1)); };
  const auto set = [](const double* d, Inputs& in) { in.set("length", d[0]); };
  family.rungs = {
      {.label = "leading term", .evaluator = "roughness_near_normal_length", .inputs = set, .output = "alpha"},
      {.label = "one step of Newton's method",
       .evaluator = "roughness_from_normal_length_1",
       .inputs = set,
       .output = "alpha"},
      {.label = "two steps", .evaluator = "roughness_from_normal_length_2", .inputs = set, .output = "alpha"},
      {.label = "three steps",
       .evaluator = "roughness_from_normal_length",
       .inputs = set,
       .output = "alpha",
       .is_reference = true},
  };
  return family;
}

Family tonemap_family() {
  Family family;
  family.name = "tonemap";
  family.title = "GT tonemapper";
  family.text =
      "The curve of Gran Turismo (Uchimura 2017) at its defaults: a power for the toe and an exponential for the "
      "shoulder, both computed and one kept; or a table of 512 values over the logarithm of the light.";
  family.distribution = "luminance logarithmic in [1e-3, 30]";
  family.draw_names = {"x"};
  family.draw = [](Random& random, double* draw) { draw[0] = 1e-3 * std::pow(3e4, random.uniform()); };
  const auto set = [](const double* d, Inputs& in) { in.set("x", d[0]); };
  family.rungs = {{.label = "table", .evaluator = "gt_tonemap_table", .inputs = set},
                  {.label = "exact", .evaluator = "gt_tonemap", .inputs = set, .is_reference = true}};
  return family;
}

Family realis_family() {
  Family family;
  family.name = "realis";
  family.title = "Realis: a lobe of a baked residual";
  family.text =
      "One windowed spherical Gaussian with its stored coefficient: with the exponential, and with the fourth power of "
      "a "
      "polynomial in its place. A texel has eight. What rounding a coefficient to a byte costs is 4e-3.";
  family.distribution =
      "1 - cos uniform over the lobe's support, sharpness logarithmic in [2.5, 100], bytes uniform from 1 to 255";
  family.draw_names = {"x", "z", "sharpness", "byte"};
  family.draw = [](Random& random, double* draw) {
    draw[2] = 2.5 * std::pow(40.0, random.uniform());
    const double versine = random.uniform() * std::log(100.0) / draw[2];
    draw[0] = std::sqrt(versine * (2 - versine));
    draw[1] = 1 - versine;
    draw[3] = std::floor(random.uniform(1, 256));
  };
  const auto set = [](const double* d, Inputs& in) {
    in.set("x", d[0]), in.set("z", d[1]), in.set("sharpness", d[2]), in.set("byte", d[3]);
  };
  for (const char* degree : {"3", "5", "7"})
    family.rungs.push_back({.label = "polynomial of degree " + std::string(degree),
                            .evaluator = "realis_lobe_" + std::string(degree),
                            .inputs = set});
  family.rungs.push_back({.label = "exponential", .evaluator = "realis_lobe", .inputs = set, .is_reference = true});
  return family;
}

}  // namespace likeness::cost
