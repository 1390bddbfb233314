#pragma once

#include "brdf/subsurface/bilateral_filter.h"
#include "brdf/subsurface/burley_disk.h"
#include "brdf/subsurface/diffusion_evaluators.h"
#include "brdf/subsurface/slab_transmission.h"

// What a filter over the surface and a slab are made of, as rows of `likeness eval`.
namespace likeness::brdf {

// clang-format off
namespace filter_rows {
inline constexpr Parameter kThickness{.name = "thickness", .initial = 1, .range = {0, 1e9}, .typical = {0.01, 10}, .unit = "length",
                                      .logarithmic = true, .text = "of the slab, along its normal"};
inline constexpr Parameter kColor{.name = "albedo", .initial = 0.8, .range = {0, 1}, .typical = {0.1, 0.95}, .role = Role::kScale,
                                  .channels = 3, .text = "surface albedo, linear RGB"};
inline constexpr Parameter kShapes{.name = "s", .initial = 1, .range = {1e-6, 1e6}, .typical = {0.1, 10}, .unit = "1/length",
                                   .channels = 3, .logarithmic = true, .text = "shape by channel: 1 / s is the scattering distance"};
inline constexpr Parameter kCosine{.name = "cos_i", .initial = -1, .range = {-1, 1}, .typical = {-1, 0}, .role = Role::kCoordinate,
                                   .text = "between the normal of the front and the light; below 0 from behind"};
inline constexpr Output kThrough{.name = "f", .unit = "1/sr", .channels = 3,
                                 .text = "radiance of the front over the light's irradiance on a surface that faces it"};
}  // namespace filter_rows

struct SlabTransmission {
  static constexpr std::string_view kName = "slab_transmission";
  static constexpr std::string_view kText = "Burley's profile integrated over the lit back of a slab";
  static constexpr std::array kOutputs{Output{.name = "T", .text = "part of the light that comes through"}};
  static constexpr std::size_t kFeatures = 1;
  struct Form {
    static constexpr std::array kInputs{filter_rows::kThickness, diffusion_rows::kShape};
    template <Scalar S>
    static void prepare(const S* in, S* features) { features[0] = in[0] * in[1]; }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) { out[0] = burley_beyond(f[0]); }
};

// Albedo, s thickness by channel, then two more: 8 features from 6 inputs in front of the two.
template <Scalar S>
void prepare_slab(const S* in, const S& thickness, const S& facing, const S& more, S* features) {
  for (int i = 0; i < 3; ++i) {
    features[i] = in[i];
    features[3 + i] = in[3 + i] * thickness;
  }
  features[6] = facing;
  features[7] = more;
}
template <Scalar S>
void evaluate_slab(const S* f, const S& lit, S* out) {
  const Rgb<S> through = translucency(Rgb<S>(f[0], f[1], f[2]), Rgb<S>(f[3], f[4], f[5]), lit);
  out[0] = through.r;
  out[1] = through.g;
  out[2] = through.b;
}

struct ThinTranslucency {
  static constexpr std::string_view kName = "thin_translucency";
  static constexpr std::string_view kText = "light from behind a thin object that shadows front and back alike";
  static constexpr std::array kOutputs{filter_rows::kThrough};
  static constexpr std::size_t kFeatures = 8;
  struct Form {
    static constexpr std::array kInputs{
        filter_rows::kColor, filter_rows::kShapes, filter_rows::kThickness, filter_rows::kCosine,
        Parameter{.name = "shadow", .initial = 1, .range = {0, 1}, .typical = {0, 1}, .text = "of the front; 1 where the light is seen"}};
    template <Scalar S>
    static void prepare(const S* in, S* features) { prepare_slab(in, in[6], S(-in[7]), in[8], features); }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) { evaluate_slab(f, lit_thin(f[6], f[7]), out); }
};

struct ThickTranslucency {
  static constexpr std::string_view kName = "thick_translucency";
  static constexpr std::string_view kText = "light from behind a thick object, weakened by the way through it";
  static constexpr std::array kOutputs{filter_rows::kThrough};
  static constexpr std::size_t kFeatures = 8;
  struct Form {
    static constexpr std::array kInputs{
        filter_rows::kColor, filter_rows::kShapes, filter_rows::kThickness,
        Parameter{.name = "shadow_thickness", .initial = 0, .range = {0, 1e9}, .typical = {0.01, 10}, .unit = "length",
                  .logarithmic = true, .text = "the same from a shadow map; the larger of the two counts"},
        filter_rows::kCosine,
        Parameter{.name = "wrap", .initial = 0, .range = {0, 1}, .typical = {0, 0.5}, .text = "how far light reaches round the edge of the back"}};
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      prepare_slab(in, slab_thickness(in[6], in[7]), S(in[9] - in[8]), in[9], features);
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) { evaluate_slab(f, lit_thick(f[6], f[7]), out); }
};

struct BurleyDiskSample {
  static constexpr std::string_view kName = "burley_disk_sample";
  static constexpr std::string_view kText = "a point of the disk drawn by Burley's profile of a color, and its weight";
  static constexpr std::array kOutputs{
      Output{.name = "x", .unit = "length", .may_be_negative = true, .text = "on the disk"},
      Output{.name = "y", .unit = "length", .may_be_negative = true, .text = "on the disk"},
      Output{.name = "pdf", .unit = "1/length^2", .text = "over the area of the disk, mean of the three channels"},
      Output{.name = "weight", .channels = 3, .text = "R / (A pdf); its mean is 1"}};
  static constexpr std::size_t kFeatures = 8;
  struct Form {
    static constexpr std::array kInputs{
        filter_rows::kShapes,
        Parameter{.name = "choice", .initial = 0.5, .range = {0, 1}, .typical = {0, 1}, .role = Role::kCoordinate, .text = "chooses the channel that is drawn for"},
        Parameter{.name = "u", .initial = 0.5, .range = {0, 1}, .typical = {0, 1}, .role = Role::kCoordinate, .text = "chooses the distance; 1 counts as 1 - 1e-30"},
        Parameter{.name = "v", .initial = 0.5, .range = {0, 1}, .typical = {0, 1}, .role = Role::kCoordinate, .text = "chooses the azimuth"}};
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const S angle = in[5] * constant<S>(2 * std::numbers::pi);
      for (int i = 0; i < 5; ++i) features[i] = in[i];
      features[5] = S(1) - in[4];
      features[6] = cos(angle);
      features[7] = sin(angle);
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const DiskSample<S> at = BurleyDisk<S>{Rgb<S>(f[0], f[1], f[2])}.sample(f[3], f[4], f[5], f[6], f[7]);
    out[0] = at.x;
    out[1] = at.y;
    out[2] = at.pdf;
    out[3] = at.weight.r;
    out[4] = at.weight.g;
    out[5] = at.weight.b;
  }
};

struct BilateralWeightRow {
  static constexpr std::string_view kName = "bilateral_weight";
  static constexpr std::string_view kText = "what a sample of the screen-space filter weighs, by its difference of depth";
  static constexpr std::array kOutputs{Output{.name = "w", .text = "R at the true distance over the density that r was drawn with"}};
  static constexpr std::size_t kFeatures = 4;
  struct Form {
    static constexpr std::array kInputs{
        diffusion_rows::kRadius,
        Parameter{.name = "depth", .initial = 0, .range = {-1e9, 1e9}, .typical = {-3, 3}, .unit = "length", .role = Role::kCoordinate,
                  .text = "of the sample's surface, less that of the disk"},
        diffusion_rows::kShape,
        Parameter{.name = "s_drawn", .initial = 1, .range = {1e-6, 1e6}, .typical = {0.1, 10}, .unit = "1/length", .logarithmic = true,
                  .text = "the shape that r was drawn for: the least of the channels'"}};
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const auto w = BilateralWeight<S>::at(in[0], in[1], in[2], in[3]);
      features[0] = w.excess;
      features[1] = w.scale;
      features[2] = w.x;
      features[3] = w.x_drawn;
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) { out[0] = BilateralWeight<S>{f[0], f[1], f[2], f[3]}.value(); }
};
// clang-format on

}  // namespace likeness::brdf
