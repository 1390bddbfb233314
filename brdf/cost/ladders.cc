#include <stdexcept>

#include "brdf/cost/ladder.h"

namespace likeness::cost {

std::vector<Family> families() {
  return {diffuse_family(),           fresnel_family(),       hair_family(),    diffusion_inverse_family(),
          diffusion_profile_family(), normal_length_family(), tonemap_family(), realis_family()};
}

double* Inputs::find(std::string_view name, int& channels) {
  double* at = values_;
  for (const brdf::Parameter& p : form_.inputs) {
    if (p.name == name) {
      channels = p.channels;
      return at;
    }
    at += p.channels;
  }
  throw std::logic_error("the cost page sets an input that its evaluator has not: " + std::string(name));
}

void Inputs::set(std::string_view name, double value) {
  int channels = 0;
  double* at = find(name, channels);
  for (int c = 0; c < channels; ++c) at[c] = value;
}

void Inputs::set(std::string_view name, double r, double g, double b) {
  int channels = 0;
  double* at = find(name, channels);
  if (channels != 3) throw std::logic_error("the cost page gives three channels to " + std::string(name));
  at[0] = r, at[1] = g, at[2] = b;
}

}  // namespace likeness::cost
