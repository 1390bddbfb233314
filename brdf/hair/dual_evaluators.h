#pragma once

#include <memory>

#include "brdf/evaluator.h"
#include "brdf/hair/dual_scattering.h"
#include "brdf/hair/fibre.h"
#include "brdf/hair/strand_count.h"

// Dual scattering as rows of `likeness eval`.
namespace likeness::brdf {

// The fibre of brdf/hair/fibre.h under dual scattering: what a volume of it adds to its own scattering.
struct DualScatteringRow {
  static constexpr std::string_view kName = "dual_scattering";
  static constexpr std::string_view kText = "multiple scattering in a volume of hair (Zinke 2008): global and local";
  // clang-format off
  static constexpr std::array kInputs{
      Parameter{.name = "theta_i", .initial = 0, .range = {-kHalfPi, kHalfPi}, .typical = {-1.4, 1.4}, .unit = "rad",
                .role = Role::kAngle, .text = "inclination of the light from the normal plane of the fibre"},
      Parameter{.name = "theta_o", .initial = 0, .range = {-kHalfPi, kHalfPi}, .typical = {-1.4, 1.4}, .unit = "rad",
                .role = Role::kAngle, .text = "inclination of the viewer"},
      Parameter{.name = "phi", .initial = 0, .range = {-2 * kHalfPi, 4 * kHalfPi}, .typical = {0, 2 * kHalfPi}, .unit = "rad",
                .role = Role::kAngle, .text = "azimuth between them about the fibre; pi is seen against the light"},
      Parameter{.name = "strands", .initial = 1, .range = {0, 1e4}, .typical = {0, 20}, .role = Role::kCoordinate,
                .text = "strands between the fibre and the light; below 1 the rest sees the light directly"},
      Parameter{.name = "density", .initial = 0.7, .range = {0, 1}, .typical = {0.5, 0.9}, .role = Role::kMix,
                .text = "share of a strand's surroundings that is hair: d_f and d_b"},
      Parameter{.name = "sigma_a", .initial = 0.2, .range = {0, 1e6}, .typical = {0, 3}, .unit = "1/radius",
                .text = "absorption inside the fibre, per radius"},
      Parameter{.name = "beta_m", .initial = 0.3, .range = {0, 1}, .typical = {0.05, 0.8},
                .text = "longitudinal roughness; held above 0.01"},
      Parameter{.name = "beta_n", .initial = 0.3, .range = {0, 1}, .typical = {0.05, 0.8},
                .text = "azimuthal roughness; held above 0.01"},
      Parameter{.name = "tilt_deg", .initial = 2, .range = {-20, 20}, .typical = {0, 5}, .unit = "deg",
                .role = Role::kAngle, .text = "tilt of the scales; positive moves R towards the root"},
  };
  static constexpr std::array kOutputs{
      Output{.name = "f", .unit = "1/sr", .text = "local + global + global_local, without the cosine"},
      Output{.name = "direct", .text = "factor of the fibre's own scattering of direct light"},
      Output{.name = "local", .unit = "1/sr", .text = "direct light that comes back from the strands behind"},
      Output{.name = "global", .unit = "1/sr", .text = "light that came through strands, scattered once here"},
      Output{.name = "global_local", .unit = "1/sr", .text = "and back from the strands behind"},
      Output{.name = "a_f", .text = "mean forward attenuation of one strand"},
      Output{.name = "a_b", .text = "mean backward attenuation"},
      Output{.name = "back", .text = "A_b: energy of paths in a row of strands that turn once or three times"},
      Output{.name = "back_of_all", .text = "the same for any number of turns"},
      Output{.name = "shift_b", .unit = "rad", .may_be_negative = true, .text = "Delta_b: mean turn of the inclination"},
      Output{.name = "sigma_b", .unit = "rad", .text = "standard deviation of it"},
  };
  // clang-format on
  static constexpr std::size_t kFeatures = 11;
  struct Form {
    static constexpr const auto& kInputs = DualScatteringRow::kInputs;
    template <Scalar S>
    static void prepare(const S* in, S* f) {
      f[0] = sin(in[0]);
      f[1] = larger(S(cos(in[0])), S(0));
      f[2] = sin(in[1]);
      f[3] = larger(S(cos(in[1])), S(0));
      f[4] = cos(in[2]);
      for (int k = 0; k < 6; ++k) f[5 + k] = in[3 + k];
    }
  };
  using Forms = std::tuple<Form>;
  struct Tables {
    MeanScatteringTable means;
  };
  static const Tables& tables() {
    static const auto made = std::make_unique<Tables>();
    return *made;
  }
  template <Scalar S>
  static void evaluate(const Tables& tables, const S* f, S* out) {
    const Inclination<S> i{f[0], f[1]}, o{f[2], f[3]};
    const S v = hair_variance(f[8]), tilt = f[10] * constant<S>(std::numbers::pi / 180);
    const DualFibre<S> fibre{tables.means.lookup(i.cosine, hair_width(f[9]), f[7]),
                             {S(S(-2) * tilt), tilt, S(S(4) * tilt), S(0)},
                             {v, S(S(0.25) * v), S(S(4) * v), S(S(4) * v)}};
    const DualScattering<S> d = dual_scattering(fibre, f[5], f[6], i, o, f[4]);
    const MeanScatter<S> forward = fibre.forward(), backward = fibre.backward();
    const RowBackscatter<S> row = row_backscatter(forward, backward);
    const S all[]{d.sum(),         d.direct,   d.local,           d.global,  d.global_local,         forward.energy,
                  backward.energy, row.energy, row.energy_of_all, row.shift, safe_sqrt(row.variance)};
    for (int k = 0; k < 11; ++k) out[k] = all[k];
  }
};

// The number of strands towards the light, from four numbers of a volume.
struct StrandCountRow : Plain<StrandCountRow> {
  static constexpr std::string_view kName = "strand_count";
  static constexpr std::string_view kText = "strands towards a direction, from a spherical harmonic of bands 0 and 1";
  // clang-format off
  static constexpr std::array kInputs{
      Parameter{.name = "mean", .initial = 5, .range = {0, 1e4}, .typical = {0, 20}, .role = Role::kCoordinate,
                .text = "mean number of strands over all directions"},
      Parameter{.name = "gradient_x", .initial = 0, .range = {-1e4, 1e4}, .typical = {-20, 20}, .role = Role::kCoordinate,
                .text = "how many more towards +x; the vector is shortened to the mean where it is longer"},
      Parameter{.name = "gradient_y", .initial = 0, .range = {-1e4, 1e4}, .typical = {-20, 20}, .role = Role::kCoordinate, .text = "towards +y"},
      Parameter{.name = "gradient_z", .initial = 0, .range = {-1e4, 1e4}, .typical = {-20, 20}, .role = Role::kCoordinate, .text = "towards +z"},
      Parameter{.name = "light_x", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "unit vector to the light"},
      Parameter{.name = "light_y", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its y"},
      Parameter{.name = "light_z", .initial = 1, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its z"},
  };
  static constexpr std::array kOutputs{Output{.name = "n", .text = "strands"}};
  // clang-format on
  template <Scalar S>
  static void evaluate(const S* in, S* out) {
    const StrandCount<S> count{in[0], Vec3<S>(in[1], in[2], in[3])};
    out[0] = count.kept_positive().eval(Vec3<S>(in[4], in[5], in[6]));
  }
};

using HairDualEvaluators = std::tuple<DualScatteringRow, StrandCountRow>;

}  // namespace likeness::brdf
