#pragma once

#include "brdf/hair/closed.h"
#include "brdf/hair/fibre_evaluators.h"
#include "brdf/hair/karis.h"
#include "brdf/hair/lut_bake.h"

// Parts of the run-time forms of hair as rows of `likeness eval`: azimuthal scattering alone, to be held against
// hair_far, and what file 002 approximates.
namespace likeness::brdf {

// The tables of eta = 1.55, made at the first call.
inline const HairLut& hair_lut_at_155() {
  static const HairLut lut = bake_hair_lut();
  return lut;
}
inline const HairTalkLut& hair_talk_lut_at_155() {
  static const HairTalkLut lut = bake_hair_talk_lut();
  return lut;
}

inline constexpr std::array kHairLobeOutputs{
    Output{.name = "r", .unit = "1/rad", .text = "N of R"}, Output{.name = "tt", .unit = "1/rad", .text = "N of TT"},
    Output{.name = "trt", .unit = "1/rad", .text = "N of TRT"},
    Output{.name = "longer", .unit = "1/rad", .text = "N of all longer paths together"}};
inline constexpr std::array kHairFarInputs{kHairAzimuth, kHairWidth, kHairAbsorption, kHairDifference};

struct HairLutAzimuthRow {
  static constexpr std::string_view kName = "hair_lut_azimuth";
  static constexpr std::string_view kText = "N of hair_lut: hair_far at eta 1.55 from tables";
  static constexpr auto kOutputs = kHairLobeOutputs;
  static constexpr std::size_t kFeatures = 4;
  using Tables = HairLut;
  static const Tables& tables() { return hair_lut_at_155(); }
  struct Form {
    static constexpr auto kInputs = kHairFarInputs;
    template <Scalar S>
    static void prepare(const S* in, S* f) {
      f[0] = azimuth_distance(S(0), in[0], S(0), S(0));
      f[1] = hair_lut_width(in[1]);
      f[2] = in[2];
      f[3] = positive(S(cos(in[3])));
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const Tables& lut, const S* f, S* out) {
    const HairFarLobes<S> n = lut.read(f[0], f[3], f[1], Rgb<S>(f[2]));
    for (const S& x : {n.r, n.tt.r, n.trt.r, n.longer.r}) *out++ = x;
  }
};

struct HairClosedAzimuthRow {
  static constexpr std::string_view kName = "hair_closed_azimuth";
  static constexpr std::string_view kText = "N of hair_closed: hair_far at eta 1.55 in closed form";
  static constexpr auto kOutputs = kHairLobeOutputs;
  static constexpr std::size_t kFeatures = 5;
  struct Form {
    static constexpr auto kInputs = kHairFarInputs;
    template <Scalar S>
    static void prepare(const S* in, S* f) {
      const S half = in[0] * S(0.5);
      f[0] = squared(S(sin(half)));
      f[1] = squared(S(cos(half)));
      f[2] = in[1];
      f[3] = in[2];
      f[4] = positive(S(cos(in[3])));
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const HairFarLobes<S> n = HairClosed<S>(f[2]).read(f[0], f[1], f[4], Rgb<S>(f[3]));
    for (const S& x : {n.r, n.tt.r, n.trt.r, n.longer.r}) *out++ = x;
  }
};

struct HairTalkDistributionRow {
  static constexpr std::string_view kName = "hair_talk_distribution";
  static constexpr std::string_view kText = "the table of the Enemies talk: 1/2 integral of D_p(phi - Phi(p, h)) dh";
  static constexpr std::array kOutputs{Output{.name = "d_r", .unit = "1/rad", .text = "of R"},
                                       Output{.name = "d_tt", .unit = "1/rad", .text = "of TT"},
                                       Output{.name = "d_trt", .unit = "1/rad", .text = "of TRT"}};
  static constexpr std::size_t kFeatures = 3;
  using Tables = HairTalkLut;
  static const Tables& tables() { return hair_talk_lut_at_155(); }
  struct Form {
    static constexpr std::array kInputs{kHairAzimuth, HairFibre<double>::kParameters[3], kHairDifference};
    template <Scalar S>
    static void prepare(const S* in, S* f) {
      f[0] = azimuth_distance(S(0), in[0], S(0), S(0));
      f[1] = in[1];
      f[2] = positive(S(cos(in[2])));
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const Tables& lut, const S* f, S* out) {
    lut.read(f[0], f[2], f[1], out);
  }
};

struct EtaPrimeRow {
  static constexpr std::string_view kName = "hair_eta_prime";
  static constexpr std::string_view kText = "1 / eta' of a fibre at an inclination, exact and as file 002 fits it";
  static constexpr std::array kOutputs{
      Output{.name = "inverse", .text = "1 / eta', exact"},
      Output{.name = "inverse_fit", .text = "of eta' = 1.19 / cos + 0.36 cos, which is for eta = 1.55"}};
  static constexpr std::size_t kFeatures = 2;
  struct Form {
    static constexpr std::array kInputs{kHairEta, kHairDifference};
    template <Scalar S>
    static void prepare(const S* in, S* f) {
      f[0] = in[0];
      f[1] = positive(S(cos(in[1])));
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = inverse_eta_prime(f[0], f[1]);
    out[1] = inverse_eta_prime_fit(f[1]);
  }
};

struct OffsetTtRow {
  static constexpr std::string_view kName = "hair_h_tt";
  static constexpr std::string_view kText =
      "offset of the light that TT sends to an azimuth, exact and as file 002 fits it";
  static constexpr std::array kOutputs{
      Output{.name = "h", .unit = "radius", .may_be_negative = true, .text = "exact; odd in phi"},
      Output{.name = "h_fit", .unit = "radius", .text = "its size as fitted, for eta = 1.55"}};
  static constexpr std::size_t kFeatures = 7;
  struct Form {
    static constexpr std::array kInputs{kHairAzimuth, kHairEta, kHairDifference};
    template <Scalar S>
    static void prepare(const S* in, S* f) {
      const S cos_d = positive(S(cos(in[2]))), a = inverse_eta_prime(in[1], cos_d), q = (in[1] - S(1)) * (in[1] + S(1));
      const S half = in[0] * S(0.5), distance = azimuth_distance(S(0), in[0], S(0), S(0));
      f[0] = a;
      f[1] = q / (larger(S(q + cos_d * cos_d), constant<S>(kTiny<S>)) * (S(1) + a));  // 1 - a = (1 - a^2) / (1 + a)
      f[2] = (constant<S>(std::numbers::pi) - distance) * S(0.25);
      f[3] = pick(greater(S(0), S(sin(in[0]))), S(-1), S(1));
      f[4] = inverse_eta_prime_fit(cos_d);
      f[5] = S(abs(S(cos(half))));
      f[6] = cos(in[0]);
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = h_tt(f[0], f[1], f[2], f[3]);
    out[1] = h_tt_fit(f[4], f[5], f[6]);
  }
};

}  // namespace likeness::brdf
