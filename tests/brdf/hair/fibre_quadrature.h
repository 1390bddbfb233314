#pragma once

#include <algorithm>
#include <numbers>
#include <vector>

#include "brdf/hair/fibre.h"

// Integrals over all directions of the light, for what a fibre scatters: products of Gauss-Legendre panels whose ends
// are the lobes' own scales.
namespace likeness::brdf {

struct Nodes {
  std::vector<double> at, weight;

  // Ten nodes on each interval between two of `ends`.
  explicit Nodes(std::vector<double> ends) {
    constexpr double kAt[]{0.97390652851717172, 0.86506336668898451, 0.67940956829902441, 0.43339539412924719,
                           0.14887433898163122};
    constexpr double kWeight[]{0.06667134430868814, 0.14945134915058059, 0.21908636251598204, 0.26926671930999636,
                               0.29552422471475287};
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 1; i < ends.size(); ++i) {
      const double half = 0.5 * (ends[i] - ends[i - 1]), middle = 0.5 * (ends[i] + ends[i - 1]);
      if (half < 1e-13) continue;
      for (int k = 0; k < 5; ++k)
        for (const double side : {-1.0, 1.0}) {
          at.push_back(middle + side * half * kAt[k]);
          weight.push_back(half * kWeight[k]);
        }
    }
  }
};

// Inclinations: panels of `step` standard deviations about the mirror direction of each lobe.
inline Nodes inclination_nodes(const HairFibre<double>::View& view, double step = 1.5) {
  const double pole = std::numbers::pi / 2;
  std::vector<double> ends{-pole, pole};
  for (std::size_t p = 0; p < kHairLobes; ++p) {
    const double centre = -std::asin(view.o[p].sine), deviation = std::sqrt(view.v[std::min<std::size_t>(p, 2)]);
    for (double d = 0; d < 13; d += step)
      for (const double t : {centre - d * deviation, centre + d * deviation})
        if (std::abs(t) < pole) ends.push_back(t);
  }
  return Nodes(ends);
}
// Azimuths from that of the viewer: panels that grow from each peak to the cut half a turn from it.
inline Nodes azimuth_nodes(const HairFibre<double>::View& view, double growth = 2) {
  constexpr double kPi = std::numbers::pi;
  const auto wrapped = [](double x) { return x - 2 * kPi * std::floor((x + kPi) / (2 * kPi)); };
  std::vector<double> ends{-kPi, kPi};
  for (int p = 0; p < 3; ++p) {
    const double centre = 2 * (p * view.gamma_t - view.gamma_i) + p * kPi;
    ends.push_back(wrapped(centre));
    ends.push_back(wrapped(centre + kPi));
    for (double d = 2 * view.s; d < kPi; d *= growth) {
      ends.push_back(wrapped(centre - d));
      ends.push_back(wrapped(centre + d));
    }
  }
  return Nodes(ends);
}

// Integrals over the sphere of S cos(theta_i), by channel, and of the pdf.
struct FibreIntegrals {
  Rgb<double> energy;
  double pdf = 0;
};
inline FibreIntegrals integrate(const HairFibre<double>& fibre, double theta_o, double h) {
  const auto view = fibre.view(Inclination<double>{std::sin(theta_o), std::cos(theta_o)}, 0.0, h);
  const Nodes inclinations = inclination_nodes(view), azimuths = azimuth_nodes(view);
  FibreIntegrals all;
  for (std::size_t i = 0; i < inclinations.at.size(); ++i) {
    const Inclination<double> light{std::sin(inclinations.at[i]), std::cos(inclinations.at[i])};
    FibreIntegrals row;
    for (std::size_t k = 0; k < azimuths.at.size(); ++k) {
      const HairTerms<double> terms = view.terms(light, azimuths.at[k]);
      row.energy = row.energy + terms.eval_cos() * azimuths.weight[k];
      row.pdf += terms.pdf() * azimuths.weight[k];
    }
    const double area = inclinations.weight[i] * light.cosine;  // d omega = cos(theta) d theta d phi
    all.energy = all.energy + row.energy * area;
    all.pdf += row.pdf * area;
  }
  return all;
}

}  // namespace likeness::brdf
