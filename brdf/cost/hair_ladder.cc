#include <cmath>
#include <numbers>

#include "brdf/cost/ladder.h"
#include "brdf/hair/fibre.h"

namespace likeness::cost {
namespace {

// A draw is theta_i, theta_o, phi, beta_m, beta_n, sigma_a.
void set_directions(const double* d, Inputs& in) {
  in.set("theta_i", d[0]), in.set("theta_o", d[1]), in.set("phi", d[2]);
}
void set_fibre(const double* d, Inputs& in) {
  set_directions(d, in);
  in.set("beta_m", d[3]);
  in.set("beta_n", d[4]);
  in.set("sigma_a", d[5]);
}

Rung far_field(const std::string& tolerance, bool is_reference = false) {
  return {.label = "far field, tolerance " + tolerance,
          .evaluator = "hair_fibre_far",
          .inputs = [=](const double* d, Inputs& in) { set_fibre(d, in), in.set("tolerance", std::stod(tolerance)); },
          .output = "f_cos",
          .is_reference = is_reference};
}

}  // namespace

Family hair_family() {
  Family family;
  family.name = "hair";
  family.title = "Hair: one fibre from afar";
  family.text =
      "Scattering of one fibre (R, TT, TRT and longer paths), averaged over its width, times the cosine. Kajiya-Kay "
      "and file "
      "002's forms have no azimuthal roughness and parameters of their own: each is given what matches on the average "
      "(highlight widths, absorption along the axis), so that their errors are those of the form in a renderer that "
      "has "
      "measured hair to show.";
  family.distribution =
      "light uniform over the sphere, theta_o uniform within 70 degrees, beta_m uniform in [0.1, 0.6], beta_n in [0.1, "
      "0.8], "
      "sigma_a logarithmic in [0.01, 3], tilt 2 degrees, index 1.55";
  family.draw_names = {"theta_i", "theta_o", "phi", "beta_m", "beta_n", "sigma_a"};
  family.draw = [](Random& random, double* draw) {
    draw[0] = std::asin(random.uniform(-1, 1));
    draw[1] = random.uniform(-1.22, 1.22);
    draw[2] = random.uniform(-std::numbers::pi, std::numbers::pi);
    draw[3] = random.uniform(0.1, 0.6);
    draw[4] = random.uniform(0.1, 0.8);
    draw[5] = 0.01 * std::pow(300.0, random.uniform());
  };
  family.draws = 2000;
  family.negligible = 1e-2;
  family.energy_name = "energy";
  family.energy_weight = [](const double*) { return 1.0; };  // the light is uniform over the sphere
  family.energy_bins = 8;
  family.energy_bin = [](const double* d) {
    return std::size_t(d[4] > 0.45) * 4 + std::size_t(d[5] > 0.17) * 2 + std::size_t(std::abs(d[1]) > 0.61);
  };
  const auto width = [](const double* d) { return std::sqrt(brdf::hair_variance(d[3])); };
  family.rungs = {
      {.label = "Kajiya-Kay",
       .evaluator = "kajiya_kay",
       .inputs =
           [=](const double* d, Inputs& in) {
             set_directions(d, in);
             const double beta = width(d), through = std::exp(-2 * d[5]);
             in.set("diffuse", 0.05 * through);
             in.set("primary", 0.07);
             in.set("secondary", 0.12 * through * through);
             in.set("transmission", 0.75 * through);
             in.set("primary_exponent", 1 / (beta * beta));
             in.set("secondary_exponent", 0.25 / (beta * beta));
             in.set("transmission_exponent", 4 / (beta * beta));
           },
       .output = "f_cos",
       .note = "energies 0.07, 0.75 and 0.12 without absorption"},
      {.label = "file 002's closed forms",
       .evaluator = "hair_karis",
       .inputs =
           [=](const double* d, Inputs& in) {
             set_directions(d, in);
             in.set("base_color", std::exp(-4 * d[5]));
             in.set("roughness", std::sqrt(std::min(1.0, width(d))));
             in.set("shift", 2 * std::numbers::pi / 180);
           },
       .output = "f_cos",
       .note = "widths of azimuth are fixed in it"},
      {.label = "our closed forms", .evaluator = "hair_closed", .inputs = set_fibre, .output = "f_cos"},
      {.label = "the talk's table", .evaluator = "hair_lut_talk", .inputs = set_fibre, .output = "f_cos"},
      {.label = "our table, Gaussians", .evaluator = "hair_lut_gauss", .inputs = set_fibre, .output = "f_cos"},
      {.label = "our table, M_p", .evaluator = "hair_lut", .inputs = set_fibre, .output = "f_cos"},
      far_field("1e-1"),
      far_field("1e-3"),
      far_field("1e-6"),
      far_field("1e-9", true),
  };
  return family;
}

}  // namespace likeness::cost
