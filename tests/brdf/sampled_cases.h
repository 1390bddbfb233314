#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "tests/brdf/evaluate.h"
#include "tests/brdf/half_vector_map.h"

// What the tests of energy and of sampling run every model on.
namespace likeness::brdf {

// The slope roughness of a model's narrowest lobe, 1 if it has none: the scale that its integrals are resolved at.
double sharpest(const auto&) { return 1; }
inline double sharpest(const Ggx<double>& m) { return alpha_of_roughness(m.roughness); }
template <std::derived_from<Callisto<double>> M>
double sharpest(const M& m) {
  return alpha_of_roughness(m.roughness);
}
inline double sharpest(const Disney2012<double>& m) {
  const double across = std::max(m.roughness * m.roughness * std::sqrt(1 - 0.9 * m.anisotropic), 0.001);
  return m.clearcoat > 0 ? std::min(across, 0.1 + (0.001 - 0.1) * m.clearcoat_gloss) : across;
}

// Views along the normal, in between and near the horizon; the azimuth is no symmetry of an anisotropic lobe.
inline constexpr std::array kViewHeights{1.0, 0.5, 0.08};
inline Vec3<double> view_at(double height) { return Random::direction_at(height, 1.1); }

// The integral of g(light) over the light's hemisphere. Relative errors of an albedo by 96 x 4 x 48 nodes, against ten times
// as many, at heights of 0.01 and more: 1e-13 for Lambert and Burley, 1e-7 for GGX, 1e-6 for Disney (1e-4 at its full
// anisotropy), 5e-6 for Callisto, whose masks have cusps and kinks; 1e-4 for Oren and Nayar, with a kink at cos_i = cos_o,
// and 2e-4 for Proxima, whose slope is infinite where light and view are at right angles.
template <class M, class G>
double over_lights(const M& model, const Vec3<double>& to_view, G&& g, int along = 96, int across = 48) {
  double sum = 0;
  for_each_light(to_view, sharpest(model), along, across,
                 [&](const Vec3<double>& l, double weight) { sum += weight * g(l); });
  return sum;
}
// The part of the light of a white sky that a channel of the model sends to the viewer.
template <class M>
double albedo(const M& model, const Vec3<double>& to_view, int channel = 0) {
  return over_lights(model, to_view, [&](const Vec3<double>& l) {
    return channels(model.eval(l, to_view))[std::size_t(channel)] * l.z;
  });
}

// A model at its defaults, with everything drawn, and drawn with a narrow lobe.
constexpr std::size_t kParameterSets = 3;
template <class M>
std::array<M, kParameterSets> parameter_sets() {
  Random random(21);
  const auto drawn = [&] { return random_model<M>(random, [](const Parameter& row) { return row.typical; }); };
  std::array<M, kParameterSets> sets{M{}, drawn(), drawn()};
  for_each_parameter(sets[2], [&]<class V>(const Parameter& row, V& value) {
    if (row.name == "roughness") value = V(0.04);
  });
  return sets;
}

// Half of the parameters at an end of their range, the others within it.
template <class M>
M random_edges(Random& random) {
  return random_model<M>(random, [&](const Parameter& row) -> Interval {
    switch (random.index(4)) {
      case 0:
        return {row.range.low, row.range.low};
      case 1:
        return {row.range.high, row.range.high};
      default:
        return random.index(2) ? row.range : row.typical;
    }
  });
}

}  // namespace likeness::brdf
