#pragma once

#include <limits>
#include <vector>

#include "tests/brdf/evaluate.h"

// Directions and parameters where formulas break, shared by the tests of values and of derivatives.
namespace likeness::brdf {

struct Pair {
  const char* name;
  Vec3<double> to_light, to_view;
};

// Directions at height z, in the plane of azimuth phi.
inline Vec3<double> at_height(double z, double phi) { return Random::direction_at(z, phi); }

inline std::vector<Pair> hard_pairs() {
  const double pi = std::numbers::pi, tiny = 1e-7, least = std::numeric_limits<float>::denorm_min();
  return {
      {"both along the normal", {0, 0, 1}, {0, 0, 1}},
      {"ordinary", at_height(0.6, 0.3), at_height(0.7, 2.0)},
      {"mirrored", at_height(0.5, 0), at_height(0.5, pi)},
      {"identical", at_height(0.4, 1), at_height(0.4, 1)},
      {"identical, nearly grazing", at_height(tiny, 1), at_height(tiny, 1)},
      {"light grazing, view normal", at_height(tiny, 0), {0, 0, 1}},
      {"view grazing, light normal", {0, 0, 1}, at_height(tiny, 0)},
      {"both grazing, mirrored: theta_d = 90 deg", {1, 0, tiny}, {-1, 0, tiny}},
      {"both grazing, at right angles", {1, 0, tiny}, {0, 1, tiny}},
      {"least heights, mirrored", {1, 0, least}, {-1, 0, least}},
      {"least heights, identical", {1, 0, least}, {1, 0, least}},
      {"one least height", {0.8, 0, 0.6}, {-1, 0, least}},
  };
}

// At least one direction at or below the horizon: f = 0.
inline std::vector<Pair> dark_pairs() {
  return {
      {"opposite", at_height(0.6, 1), {-at_height(0.6, 1).x, -at_height(0.6, 1).y, -0.6}},
      {"opposite, along the normal", {0, 0, 1}, {0, 0, -1}},
      {"opposite, in the surface", {1, 0, 0}, {-1, 0, 0}},
      {"identical, in the surface", {1, 0, 0}, {1, 0, 0}},
      {"light in the surface", {1, 0, 0}, at_height(0.5, 0)},
      {"view in the surface", at_height(0.5, 0), {1, 0, 0}},
      {"light below", at_height(-0.5, 0), at_height(0.5, 0)},
      {"both below", at_height(-0.5, 0), at_height(-0.5, 2)},
  };
}

// Calls visit(model) at every combination of range ends and the default of the named rows: 3^n models.
template <class M, class F>
void for_ends_of(const std::vector<std::string_view>& names, F&& visit, const M& start = {}, std::size_t at = 0) {
  if (at == names.size()) return visit(start);
  for (int end = 0; end < 3; ++end) {
    M model = start;
    for_each_parameter(model, [&]<class V>(const Parameter& row, V& value) {
      if (row.name == names[at]) value = V(end == 0 ? row.range.low : end == 1 ? row.range.high : row.initial);
    });
    for_ends_of(names, visit, model, at + 1);
  }
}

}  // namespace likeness::brdf
