#pragma once

#include <string>
#include <vector>

#include "brdf/any_brdf.h"

namespace likeness::fit {

// The variables of a fit, derived from a model's parameter table and a tier.
//
// A parameter and its tint are only known as a product, so a fit solves for the product: where the tier
// exposes the tint there is one variable a color channel, where it does not one variable for all three. In the
// vector of channels (table order, what the kernel takes) the product stands in the tint's three places and
// the intensity's own place is fixed at 1.
struct Coordinate {
  std::string name;                      // of the parameter that it sets: the tint, where a product is fitted
  int color = -1;                        // 0, 1, 2 or -1: all channels of the parameter
  std::vector<int> channels;             // of the model, all set to the coordinate's value
  double low = 0, high = 1;              // bounds
  double start_low = 0, start_high = 1;  // where starts are drawn
  bool logarithmic = false;              // starts are drawn evenly in the logarithm
  bool signed_scale = false;             // a product whose channels must share a sign (smooth_terminator)
  bool reflectance = false;              // base_color: starts are drawn around the data's own diffuse level
};

struct Coordinates {
  std::size_t model = 0;      // index in AnyBrdf
  std::vector<double> fixed;  // channels that no coordinate sets
  std::vector<Coordinate> variables;

  std::size_t size() const { return variables.size(); }
  std::vector<double> channels_at(const std::vector<double>& x) const;
  std::vector<double> at_channels(const std::vector<double>& channels) const;  // x nearest to some channels, in bounds
};

// Variables of a tier; for Tier::kPlain of Callisto those of Lambert + GGX. Throws files::UsageError for a
// tier that the model does not have.
Coordinates coordinates_of(const brdf::AnyBrdf& model, brdf::Tier tier);

// Whether some parameter of the model is first exposed at this tier.
bool has_tier(const brdf::AnyBrdf& model, brdf::Tier tier);

// The folded channels of a model, and back: an intensity takes the largest channel of the product (with its
// sign), the tint the rest; a product of 0 has a white tint.
std::vector<double> folded(const brdf::AnyBrdf& model);
brdf::AnyBrdf unfolded(std::size_t model, const std::vector<double>& channels);

// The channels as the evaluators take them (intensity and tint apart).
std::vector<double> plain_channels(const brdf::AnyBrdf& model);

}  // namespace likeness::fit
