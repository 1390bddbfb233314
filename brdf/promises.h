#pragma once

namespace likeness::brdf {

// The albedo of a surface model: the part of the light from all around, of one unit in every direction, that reaches a
// viewer.
enum class Energy {
  kUnbounded,  // exceeds 1 for some parameters of the range; the model's page says by how much
  kAtMostOne,  // never exceeds 1
  kBaseColor   // is base_color, channel by channel, from every view
};

// What holds for a model at all parameters of its range. Tested for every model of AnyBrdf (tests/brdf).
struct Promises {
  bool reciprocal = false;  // f(l, v) = f(v, l)
  Energy energy = Energy::kUnbounded;
  bool fades = true;  // f cos_i goes to 0 with cos_i
};

}  // namespace likeness::brdf
