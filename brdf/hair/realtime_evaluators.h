#pragma once

#include "brdf/hair/directions.h"
#include "brdf/hair/realtime_parts.h"

// The run-time forms of hair as rows of `likeness eval`: one fibre, far field.
namespace likeness::brdf {

// The parameters of HairFibre, without the index: these forms are made for 1.55.
inline constexpr std::array kHairFarParameters{HairFibre<double>::kParameters[0], HairFibre<double>::kParameters[2],
                                               HairFibre<double>::kParameters[3], HairFibre<double>::kParameters[4]};

// What the rows with energy-conserving M_p read: its scale for R, TT and TRT, (1 - cos(theta_i + theta_o)) / v and
// cos cos / v of each lobe with its tilt, the cosines of the inclinations, absorption.
template <Scalar S>
struct HairLobesRow {
  static constexpr std::size_t kFeatures = 16;

  static void store(const HairPair<S>& at, const S* in, S* f) {
    const S v = hair_variance(in[3]), alpha = in[5] * constant<S>(std::numbers::pi / 180);
    const S variances[]{v, S(v * S(0.25)), S(v * S(4)), S(v * S(4))};
    const Inclination<S> o[]{HairFibre<S>::turned(at.o, S(S(2) * alpha)), HairFibre<S>::turned(at.o, S(-alpha)),
                             HairFibre<S>::turned(at.o, S(S(-4) * alpha)), at.o};
    for (std::size_t p = 0; p < 3; ++p) f[p] = hair_mp_scale(variances[p]);
    for (std::size_t p = 0; p < 4; ++p) {
      f[3 + p] = versine_of_sum(at.i, o[p]) / variances[p];
      f[7 + p] = at.i.cosine * o[p].cosine / variances[p];
    }
    f += 11;
    for (const S& x : {at.i.cosine, at.o.cosine, in[0], in[1], in[2]}) *f++ = x;
  }
  static const S& cos_o(const S* f) { return f[12]; }
  static Rgb<S> sigma_a(const S* f) { return {f[13], f[14], f[15]}; }
  // The exponentials of M_p, as logarithms.
  static HairLogFactors<S> exponents(const S* f) { return {S(-f[3]), S(-f[4]), S(-f[5]), S(-f[6])}; }
  // f and f_cos from the features and N_p times those exponentials.
  static void write(const S* f, const HairFarLobes<S>& n, S* out) {
    const auto m = [&](std::size_t p) { return bessel_i0_scaled(f[7 + p]) * f[p < 3 ? p : 2]; };
    write_scattering(Rgb<S>(S(n.r * m(0))) + n.tt * m(1) + n.trt * m(2) + n.longer * m(3), f[11], out);
  }
};

struct HairLutRow : HairForms<HairLutRow> {
  static constexpr std::string_view kName = "hair_lut";
  static constexpr std::string_view kText = "a fibre of hair, far field from tables, energy-conserving";
  static constexpr auto kParameters = kHairFarParameters;
  static constexpr std::size_t kFeatures = 18;  // those of HairLobesRow, |phi|, the place of the width in the tables
  using Tables = HairLut;
  static const Tables& tables() { return hair_lut_at_155(); }

  template <Scalar S>
  static void store(const HairPair<S>& at, const S* in, S* f) {
    HairLobesRow<S>::store(at, in, f);
    f[16] = at.distance;
    f[17] = hair_lut_width(hair_width(in[4]));
  }
  template <Scalar S>
  static void evaluate(const Tables& lut, const S* f, S* out) {
    using Lobes = HairLobesRow<S>;
    Lobes::write(f, lut.read(f[16], Lobes::cos_o(f), f[17], Lobes::sigma_a(f), Lobes::exponents(f)), out);
  }
};

struct HairClosedRow : HairForms<HairClosedRow> {
  static constexpr std::string_view kName = "hair_closed";
  static constexpr std::string_view kText = "a fibre of hair, far field in closed form";
  static constexpr auto kParameters = kHairFarParameters;
  static constexpr std::size_t kFeatures = 19;  // those of HairLobesRow, sin^2 and cos^2 of phi / 2, the width

  template <Scalar S>
  static void store(const HairPair<S>& at, const S* in, S* f) {
    HairLobesRow<S>::store(at, in, f);
    f[16] = at.sin2_half;
    f[17] = at.cos2_half;
    f[18] = hair_width(in[4]);
  }
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    using Lobes = HairLobesRow<S>;
    Lobes::write(f, HairClosed<S>(f[18]).read(f[16], f[17], Lobes::cos_o(f), Lobes::sigma_a(f), Lobes::exponents(f)),
                 out);
  }
};

// Marschner's factorisation: a Gaussian of theta_i + theta_o for each lobe, S = sum of g N / cos^2(theta_d).
template <Scalar S>
struct HairGaussians {
  static constexpr std::size_t kFeatures = 9;

  static void store(const HairPair<S>& at, const S& beta_m, const S& tilt_deg, S* f) {
    const S width = sqrt(hair_variance(beta_m)), alpha = tilt_deg * constant<S>(std::numbers::pi / 180);
    constexpr double kWidths[]{1, 0.5, 2, 2}, kShifts[]{-2, 1, 4, 0};
    f[0] = width;
    for (std::size_t p = 0; p < 4; ++p)
      f[1 + p] = (at.theta_sum - alpha * constant<S>(kShifts[p])) / S(width * constant<S>(kWidths[p]));
    const S cos2_d = S(0.25) * (squared(S(at.i.cosine + at.o.cosine)) + squared(S(at.i.sine + at.o.sine)));
    f[5] = at.i.cosine;
    f[6] = at.i.cosine / larger(cos2_d, constant<S>(kTiny<S>));
    f[7] = smaller(safe_sqrt(cos2_d), S(1));
    f[8] = at.o.cosine;
  }
  static void write(const S* f, const HairFarLobes<S>& n, S* out) {
    constexpr double kWidths[]{1, 0.5, 2, 2};
    const auto m = [&](std::size_t p) { return S(hair_gauss(S(f[0] * constant<S>(kWidths[p])), f[1 + p]) * f[6]); };
    write_scattering(Rgb<S>(S(n.r * m(0))) + n.tt * m(1) + n.trt * m(2) + n.longer * m(3), f[5], out);
  }
};

struct HairLutGaussRow : HairForms<HairLutGaussRow> {
  static constexpr std::string_view kName = "hair_lut_gauss";
  static constexpr std::string_view kText = "hair_lut with Marschner's Gaussians in place of M_p";
  static constexpr auto kParameters = kHairFarParameters;
  static constexpr std::size_t kFeatures = HairGaussians<double>::kFeatures + 5;
  using Tables = HairLut;
  static const Tables& tables() { return hair_lut_at_155(); }

  template <Scalar S>
  static void store(const HairPair<S>& at, const S* in, S* f) {
    HairGaussians<S>::store(at, in[3], in[5], f);
    f += HairGaussians<S>::kFeatures;
    for (const S& x : {in[0], in[1], in[2], at.distance, hair_lut_width(hair_width(in[4]))}) *f++ = x;
  }
  template <Scalar S>
  static void evaluate(const Tables& lut, const S* f, S* out) {
    const S* more = f + HairGaussians<S>::kFeatures;
    HairGaussians<S>::write(f, lut.read(more[3], f[8], more[4], Rgb<S>{more[0], more[1], more[2]}), out);
  }
};

// The Enemies talk's form: S cos(theta_i) = cos(theta_i) / cos^2(theta_d) sum of g(theta_i + theta_o - alpha_p) A_p D_p,
// A_p at a dominant offset, D_p from a table. Longer paths are left out.
struct HairTalkLutRow : HairForms<HairTalkLutRow> {
  static constexpr std::string_view kName = "hair_lut_talk";
  static constexpr std::string_view kText = "the Enemies talk's table of distributions, Gaussians, dominant offsets";
  static constexpr auto kParameters = kHairFarParameters;
  static constexpr std::size_t kFeatures = HairGaussians<double>::kFeatures + 6;
  using Tables = HairTalkLut;
  static const Tables& tables() { return hair_talk_lut_at_155(); }

  template <Scalar S>
  static void store(const HairPair<S>& at, const S* in, S* f) {
    HairGaussians<S>::store(at, in[3], in[5], f);
    f += HairGaussians<S>::kFeatures;
    const S cos2_d = S(0.25) * (squared(S(at.i.cosine + at.o.cosine)) + squared(S(at.i.sine + at.o.sine)));
    const S half = at.cos2_half * cos2_d + at.sin2_half * S(0.5) * versine_of_sum(at.i, at.o);
    for (const S& x : {in[0], in[1], in[2], at.distance, in[4], smaller(safe_sqrt(half), S(1))}) *f++ = x;
  }
  template <Scalar S>
  static void evaluate(const Tables& lut, const S* f, S* out) {
    const S* more = f + HairGaussians<S>::kFeatures;
    S d[3];
    lut.read(more[3], f[7], more[4], d);
    HairFarLobes<S> n = hair_talk_attenuations(more[5], f[7], constant<S>(lut.eta), Rgb<S>{more[0], more[1], more[2]});
    n.r = n.r * d[0];
    n.tt = n.tt * d[1];
    n.trt = n.trt * d[2];
    HairGaussians<S>::write(f, n, out);
  }
};

struct HairKarisRow {
  using Model = HairKaris<double>;
  using Forms = std::tuple<HairForm<HairAngles, HairKarisRow>, HairForm<HairAxes, HairKarisRow>>;
  static constexpr std::string_view kName = Model::kName;
  static constexpr std::string_view kText = Model::kText;
  static constexpr auto kParameters = Model::kParameters;
  static constexpr std::array kOutputs{
      HairFibreRow::kOutputs[0], HairFibreRow::kOutputs[1],
      Output{.name = "r", .unit = "1/sr", .text = "R's part of f_cos"},
      Output{.name = "tt", .unit = "1/sr", .channels = 3, .text = "TT's part of f_cos, linear RGB"},
      Output{.name = "trt", .unit = "1/sr", .channels = 3, .text = "TRT's part of f_cos, linear RGB"}};
  static constexpr std::size_t kFeatures = 16;  // HairKaris::Terms, cos(theta_i), base_color, specular, backlit

  template <Scalar S>
  static void store(const HairPair<S>& at, const S* in, S* f) {
    const auto t = model_from_channels<HairKaris, S>(in).terms(at.i, at.o, at.sin2_half, at.cos2_half);
    for (const S& x : t.beta) *f++ = x;
    for (const S& x : t.offset) *f++ = x;
    for (const S& x : {t.cos_half, t.cos_phi, t.cos_d, t.half_cosine, at.i.cosine, in[0], in[1], in[2], in[3], in[5]})
      *f++ = x;
  }
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const HairKaris<S> model{
        .base_color = {f[11], f[12], f[13]}, .specular = f[14], .roughness = S(0), .backlit = f[15], .shift = S(0)};
    const KarisLobes<S> lobes = model.eval_cos({.beta = {f[0], f[1], f[2]},
                                                .offset = {f[3], f[4], f[5]},
                                                .cos_half = f[6],
                                                .cos_phi = f[7],
                                                .cos_d = f[8],
                                                .half_cosine = f[9]});
    write_scattering(lobes.sum(), f[10], out);
    out += 6;
    for (const S& x : {lobes.r, lobes.tt.r, lobes.tt.g, lobes.tt.b, lobes.trt.r, lobes.trt.g, lobes.trt.b}) *out++ = x;
  }
};

using HairRealtimeEvaluators =
    std::tuple<HairKarisRow, HairClosedRow, HairLutRow, HairLutGaussRow, HairTalkLutRow, HairClosedAzimuthRow,
               HairLutAzimuthRow, HairTalkDistributionRow, EtaPrimeRow, OffsetTtRow>;

}  // namespace likeness::brdf
