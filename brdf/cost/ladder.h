#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/catalog/catalog.h"

// What is compared: for each family of evaluators the ladder from its cheapest form to its reference, over inputs that
// are drawn from a stated distribution.
namespace likeness::cost {

// The same numbers on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low = 0, double high = 1) { return low + (high - low) * double(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

// The inputs of an evaluator's first form, by name; they hold the defaults of its table until they are set. A name of a
// color sets its three channels. A name that the evaluator has not is std::logic_error.
class Inputs {
 public:
  Inputs(const catalog::Form& form, double* values) : form_(form), values_(values) {}
  void set(std::string_view name, double value);
  void set(std::string_view name, double r, double g, double b);

 private:
  double* find(std::string_view name, int& channels);
  const catalog::Form& form_;
  double* values_;
};

// One form of a family's function: an evaluator of the catalog, and how a draw becomes its inputs.
struct Rung {
  std::string label;      // what the reader sees
  std::string evaluator;  // name in the catalog
  std::function<void(const double* draw, Inputs& in)> inputs;
  std::string output = {};  // by name, the first channel of a color; empty: the first output
  bool is_reference = false;
  std::string note = {};  // what a reader should know of this form
};

struct Family {
  std::string name, title;
  std::string text;          // what the function is, and what its errors are measured against
  std::string distribution;  // of the draws, in words
  std::vector<std::string> draw_names;
  std::function<void(Random&, double* draw)> draw;
  // What a value counts for in the RMS and the worst error: value x weight is compared. Empty: 1.
  std::function<double(const double* draw)> value_weight = {};
  std::string compared = "the values";  // what value x weight is, in words
  // What a value counts for in the energy (a cosine, a width of radii; 0 leaves the draw out); empty: there is no energy
  // to compare.
  std::function<double(const double* draw)> energy_weight = {};
  // Sums are taken within each of these bins of draws (a range of roughness and of view angles), as an albedo is.
  std::function<std::size_t(const double* draw)> energy_bin = {};
  std::size_t energy_bins = 1;
  std::string energy_name = {};  // "albedo", "energy of the profile"
  std::size_t draws = 20000;     // for the errors
  double negligible = 1e-4;      // of the reference's root mean square: smaller values count as this in relative errors
  std::vector<Rung> rungs;
  // For a family whose reference is random, in place of a rung that is marked as it: two independent estimates of the
  // compared value at every draw. Their mean is the reference, half of what they differ by its noise. `effort`: a share
  // of the usual number of samples.
  std::function<std::array<std::vector<double>, 2>(const std::vector<double>& rows, double effort)> estimates = {};
};

// All families, in the order of the page.
std::vector<Family> families();

Family diffuse_family();
Family fresnel_family();
Family hair_family();
Family diffusion_inverse_family();
Family diffusion_profile_family();
Family normal_length_family();
Family tonemap_family();
Family realis_family();

}  // namespace likeness::cost
