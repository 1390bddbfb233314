#pragma once

#include "brdf/evaluator.h"
#include "brdf/lighting/gt_tonemap.h"
#include "brdf/lighting/gt_tonemap_table.h"
#include "brdf/lighting/zone.h"

// The tonemapper and exposure zones as rows of `likeness eval`.
namespace likeness::brdf {

struct Tonemap : Plain<Tonemap> {
  static constexpr std::string_view kName = "gt_tonemap";
  static constexpr std::string_view kText = "the Gran Turismo tonemapper";
  static constexpr auto kInputs = joined(std::array{Parameter{.name = "x",
                                                              .initial = 0.18,
                                                              .range = {-1e30, 1e30},
                                                              .typical = {0, 16},
                                                              .role = Role::kCoordinate,
                                                              .text = "scene light, linear"}},
                                         GtTonemap<double>::kParameters);
  static constexpr std::array kOutputs{Output{.name = "y", .text = "display light, linear"},
                                       Output{.name = "part", .text = "of the curve: 0 toe, 1 line, 2 shoulder"}};
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const auto curve = model_from_channels<GtTonemap, S>(f + 1);
    out[0] = curve.eval(f[0]);
    out[1] = curve.part(f[0]);
  }
};

struct TonemapTable : Plain<TonemapTable> {
  static constexpr std::string_view kName = "gt_tonemap_table";
  static constexpr std::string_view kText = "the Gran Turismo tonemapper at its defaults, from a table";
  static constexpr std::array kInputs{Tonemap::kInputs[0]};
  static constexpr std::array kOutputs{Tonemap::kOutputs[0]};
  using Tables = GtTonemapTable;
  static const Tables& tables() {
    static const Tables kTables;
    return kTables;
  }
  template <Scalar S>
  static void evaluate(const Tables& tables, const S* f, S* out) {
    out[0] = tables.eval(f[0]);
  }
};

struct TonemapInverse {
  static constexpr std::string_view kName = "gt_tonemap_inverse";
  static constexpr std::string_view kText = "the scene light that the Gran Turismo tonemapper shows as a display light";
  static constexpr auto kInputs = joined(std::array{Parameter{.name = "y",
                                                              .initial = 0.18,
                                                              .range = {-1e30, 1e30},
                                                              .typical = {0, 1},
                                                              .role = Role::kCoordinate,
                                                              .text = "display light, linear"}},
                                         GtTonemap<double>::kParameters);
  static constexpr std::array kOutputs{Output{.name = "x", .text = "scene light, linear"}};
  static constexpr std::size_t kFeatures = 8;  // the inputs, and P - y
  struct Form {
    static constexpr const auto& kInputs = TonemapInverse::kInputs;
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      for (int i = 0; i < 7; ++i) features[i] = in[i];
      features[7] = in[1] - in[0];
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = model_from_channels<GtTonemap, S>(f + 1).inverse(f[0], f[7]);
  }
};

struct ExposureZone : Plain<ExposureZone> {
  static constexpr std::string_view kName = "zone";
  static constexpr std::string_view kText = "the exposure zone of a luminance";
  // clang-format off
  static constexpr std::array kInputs{
      Parameter{.name = "luminance", .initial = 0.18, .range = {-1e30, 1e30}, .typical = {0, 64}, .role = Role::kCoordinate,
                .text = "scene light, linear, on the scale of middle_grey"},
      Parameter{.name = "middle_grey", .initial = 0.18, .range = {1e-6, 1e6}, .typical = {0.1, 0.5}, .role = Role::kScale,
                .text = "luminance of the middle of grey_zone"},
      Parameter{.name = "grey_zone", .initial = 5, .range = {0, 16}, .typical = {5, 8},
                .text = "zone of middle grey: 5 is Adams's V, 8 makes the numbering symmetric"},
  };
  static constexpr std::array kOutputs{
      Output{.name = "zone", .may_be_negative = true, .text = "as a continuous number, whole in the middle of a zone"},
      Output{.name = "index", .text = "0 to 16"},
      Output{.name = "ev", .may_be_negative = true, .text = "stops above middle grey"},
  };
  // clang-format on
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = zone_of(f[0], f[1], f[2]);
    out[1] = zone_index(out[0]);
    out[2] = exposure_of(f[0], f[1]);
  }
};

}  // namespace likeness::brdf
