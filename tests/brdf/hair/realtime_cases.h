#pragma once

#include <string_view>
#include <vector>

#include "brdf/hair/evaluators.h"
#include "tests/brdf/hair/fibre_quadrature.h"

// The run-time forms of hair side by side: one fibre in each form's own parameters, values and energies.
namespace likeness::brdf {

inline constexpr double kHairDegree = std::numbers::pi / 180;

struct RealtimeFibre {
  double beta_m = 0.3, beta_n = 0.3, sigma_a = 0, tilt_deg = 2;

  HairFibre<double> exact() const {
    HairFibre<double> fibre;
    fibre.sigma_a = Rgb<double>(sigma_a);
    fibre.beta_m = beta_m;
    fibre.beta_n = beta_n;
    fibre.tilt_deg = tilt_deg;
    return fibre;
  }
};

// S cos(theta_i) of a form, one channel.
struct RealtimeForm {
  std::string_view name;
  double (*eval_cos)(const RealtimeFibre&, double theta_i, double theta_o, double phi);
};

// The first channel of f_cos of a row from its inputs.
template <class E, std::size_t N>
double f_cos_of(const double (&in)[N]) {
  using Form = std::tuple_element_t<0, typename E::Forms>;
  static_assert(input_count<Form>() == N);
  double features[feature_count<E>()], out[output_count<E>()];
  Form::prepare(in, features);
  if constexpr (HasTables<E>) E::evaluate(E::tables(), features, out);
  else E::evaluate(features, out);
  return out[3];
}
template <class E>
double far_row(const RealtimeFibre& a, double theta_i, double theta_o, double phi) {
  return f_cos_of<E>({theta_i, theta_o, phi, a.sigma_a, a.sigma_a, a.sigma_a, a.beta_m, a.beta_n, a.tilt_deg});
}
// In file 002's parameters: B_R = roughness^2 is the standard deviation of M_R, base color exp(-4 sigma_a).
inline double karis_row(const RealtimeFibre& a, double theta_i, double theta_o, double phi) {
  const double color = std::exp(-4 * a.sigma_a), roughness = std::min(1.0, std::pow(hair_variance(a.beta_m), 0.25));
  return f_cos_of<HairKarisRow>(
      {theta_i, theta_o, phi, color, color, color, 0.5, roughness, 1, a.tilt_deg * kHairDegree});
}

// Energies of R, TT, TRT and longer paths of a smooth or rough fibre: 1/2 integral of A_p over h.
inline std::array<double, kHairLobes> lobe_energies(double sigma_a, double cos_theta, double eta = 1.55) {
  const Nodes gammas({0, 0.8, 1.2, 1.4, 1.5, std::numbers::pi / 2});
  std::array<double, kHairLobes> sum{};
  for (std::size_t i = 0; i < gammas.at.size(); ++i) {
    const double cos_h = std::cos(gammas.at[i]);
    const FibrePath<double> path(gammas.at[i], std::sin(gammas.at[i]), cos_h, cos_theta, eta);
    const auto a = hair_attenuations(path.reflected, path.transmitted, 2 * sigma_a * path.chord);
    for (std::size_t p = 0; p < kHairLobes; ++p) sum[p] += a[p] * cos_h * gammas.weight[i];
  }
  return sum;
}

// Kajiya-Kay with the reference's energies across the fibre as weights, and exponents 1 / variance.
inline double kajiya_kay_row(const RealtimeFibre& a, double theta_i, double theta_o, double phi) {
  const auto e = lobe_energies(a.sigma_a, 1);
  const double n = 1 / hair_variance(a.beta_m);
  return f_cos_of<KajiyaKayRow>({theta_i,
                                 theta_o,
                                 phi,
                                 e[3],
                                 e[3],
                                 e[3],
                                 e[0],
                                 e[0],
                                 e[0],
                                 e[2],
                                 e[2],
                                 e[2],
                                 e[1],
                                 e[1],
                                 e[1],
                                 n,
                                 n / 4,
                                 n * 4,
                                 -2 * a.tilt_deg,
                                 4 * a.tilt_deg});
}

inline constexpr RealtimeForm kRealtimeForms[]{
    {"kajiya_kay", &kajiya_kay_row},
    {"hair_karis", &karis_row},
    {"hair_lut_talk", &far_row<HairTalkLutRow>},
    {"hair_closed", &far_row<HairClosedRow>},
    {"hair_lut_gauss", &far_row<HairLutGaussRow>},
    {"hair_lut", &far_row<HairLutRow>},
};

// The reference: hair_fibre_far by quadrature.
inline double exact_f_cos(const RealtimeFibre& a, double theta_i, double theta_o, double phi, double tolerance = 1e-6) {
  return hair_far_terms(a.exact(), inclination_at(theta_i), inclination_at(theta_o), phi).eval_cos(tolerance).r;
}

// The integral over the inclination of the light, for one azimuth, of a form: its azimuthal scattering.
template <class F>
double over_inclinations(const F& eval_cos, const RealtimeFibre& fibre, double theta_o, double phi, double step = 1.5) {
  const auto view = fibre.exact().view(inclination_at(theta_o), 0.0, 0.0);
  const Nodes inclinations = inclination_nodes(view, step);
  double sum = 0;
  for (std::size_t i = 0; i < inclinations.at.size(); ++i)
    sum += inclinations.weight[i] * std::cos(inclinations.at[i]) * eval_cos(fibre, inclinations.at[i], theta_o, phi);
  return sum;
}
// And over the azimuth: all light that a fibre scatters under light from everywhere.
template <class F>
double energy_of(const F& eval_cos, const RealtimeFibre& fibre, double theta_o, int panels = 12) {
  std::vector<double> ends;
  for (int i = 0; i <= panels; ++i) ends.push_back(std::numbers::pi * i / panels);
  const Nodes azimuths(ends);
  double sum = 0;
  for (std::size_t i = 0; i < azimuths.at.size(); ++i)
    sum += 2 * azimuths.weight[i] * over_inclinations(eval_cos, fibre, theta_o, azimuths.at[i], 3);
  return sum;
}

}  // namespace likeness::brdf
