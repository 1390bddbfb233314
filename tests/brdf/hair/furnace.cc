#include <cstdio>

#include "tests/brdf/hair/fibre_quadrature.h"

// The white furnace of a fibre over a grid that is too large for a test: prints the worst energy and the worst integral
// of the pdf, each with where it is. Some minutes.
//
//     ninja hair_furnace && tests/brdf/hair/hair_furnace
int main() {
  using namespace likeness::brdf;
  struct Worst {
    double error = 0, beta_m = 0, beta_n = 0, h = 0, theta_deg = 0, tilt_deg = 0;
  } energy, pdf;
  int cases = 0;
  for (const double beta_m : {0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.8, 1.0})
    for (const double beta_n : {0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.0})
      for (const double h : {-1.0, -0.99, -0.7, 0.0, 0.4, 0.9, 0.9999, 1.0})
        for (const double theta_deg : {-85.0, -45.0, 0.0, 20.0, 60.0, 80.0, 85.0})
          for (const double tilt_deg : {0.0, 4.0}) {
            HairFibre<double> fibre;
            fibre.sigma_a = Rgb<double>(0.0);
            fibre.beta_m = beta_m;
            fibre.beta_n = beta_n;
            fibre.tilt_deg = tilt_deg;
            const FibreIntegrals sum = integrate(fibre, theta_deg * std::numbers::pi / 180, h);
            const auto keep = [&](double error, Worst& worst) {
              if (!(error <= worst.error)) worst = {error, beta_m, beta_n, h, theta_deg, tilt_deg};
            };
            keep(std::abs(sum.energy.g - 1), energy);
            keep(std::abs(sum.pdf - 1), pdf);
            ++cases;
          }
  std::printf("%d cases\n", cases);
  for (const auto& [name, worst] : {std::pair{"energy", energy}, {"pdf", pdf}})
    std::printf("%s: off by %.2g at beta_m %g, beta_n %g, h %g, theta_o %g deg, tilt %g deg\n", name, worst.error,
                worst.beta_m, worst.beta_n, worst.h, worst.theta_deg, worst.tilt_deg);
  return energy.error <= 1e-5 && pdf.error <= 1e-5 ? 0 : 1;
}
