#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/hair/realtime_cases.h"

// File 002's closed forms: against its printed code, written out here in angles, and against what they approximate.
namespace likeness::brdf {
namespace {

struct Printed {
  double r, tt, trt;
};
// The code of file 002, line by line, for light and viewer at theta and azimuth phi apart.
Printed printed(double theta_l, double theta_v, double phi, double color, double specular, double roughness,
                double backlit, double shift) {
  const double pi = std::numbers::pi;
  const auto g = [&](double b, double x) { return std::exp(-0.5 * x * x / (b * b)) / (std::sqrt(2 * pi) * b); };
  const double f0 = std::pow((1 - 1.55) / (1 + 1.55), 2);
  const auto fresnel = [&](double x) { return f0 + (1 - f0) * std::pow(1 - x, 5); };
  const double sum = std::sin(theta_l) + std::sin(theta_v), cos_phi = std::cos(phi),
               cos_half = std::abs(std::cos(phi / 2));
  const double v_dot_l = std::sin(theta_l) * std::sin(theta_v) + std::cos(theta_l) * std::cos(theta_v) * cos_phi;
  const double cos_d = std::cos(0.5 * std::abs(theta_v - theta_l));
  const double a = 1 / (1.19 / cos_d + 0.36 * cos_d);
  const double r2 = roughness * roughness;
  Printed out;
  out.r = g(r2, sum + 2 * shift) * 0.25 * cos_half * fresnel(std::sqrt(std::clamp(0.5 + 0.5 * v_dot_l, 0.0, 1.0))) *
          (specular * 2) * (1 + (backlit - 1) * std::clamp(-v_dot_l, 0.0, 1.0));
  const double h = cos_half * (1 + a * (0.6 - 0.8 * cos_phi));
  const double f = fresnel(cos_d * std::sqrt(std::clamp(1 - h * h, 0.0, 1.0)));
  out.tt = g(0.5 * r2, sum - shift) * std::exp(-3.65 * cos_phi - 3.98) * (1 - f) * (1 - f) *
           std::pow(color, std::sqrt(1 - h * h * a * a) / (2 * cos_d)) * backlit;
  const double ft = fresnel(cos_d * 0.5);
  out.trt = g(2 * r2, sum - 4 * shift) * std::exp(17 * cos_phi - 16.78) * (1 - ft) * (1 - ft) * ft *
            std::pow(color, 0.8 / cos_d);
  return out;
}

TEST(HairKaris, IsThePrintedCode) {
  Random random(1);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const double theta_i = random.uniform(-1.5, 1.5), theta_o = random.uniform(-1.5, 1.5), phi = random.uniform(-4, 4);
    const double color = random.uniform(0.01, 1), specular = random.uniform(), roughness = random.uniform(0.1, 1);
    const double backlit = random.uniform(), shift = random.uniform(-0.1, 0.1);
    const auto out = evaluate_row<HairKarisRow, double>(
        {theta_i, theta_o, phi, color, color, color, specular, roughness, backlit, shift});
    const Printed want = printed(theta_i, theta_o, phi, color, specular, roughness, backlit, shift);
    const double wants[]{want.r, want.tt, want.trt}, gots[]{out[6], out[8], out[11]};
    for (int p = 0; p < 3; ++p) worst = std::max(worst, relative_difference(gots[p], wants[p], 1e-290));
    EXPECT_NEAR(out[3], want.r + want.tt + want.trt, 1e-12 * out[3] + 1e-290);
    EXPECT_NEAR(out[0] * std::cos(theta_i), out[3], 1e-12 * out[3] + 1e-290);
  }
  EXPECT_LE(worst, 1e-11);  // exponents of up to 400; 2e-12 measured
}

TEST(HairKaris, PeaksAreWhereTheShiftSays) {
  // R at -2, TT at +1, TRT at +4 times the shift, in sines.
  for (const auto& [output, times] : {std::pair{6, -2}, {8, 1}, {11, 4}}) {
    double best = -1, at = 0;
    for (int i = -400; i <= 400; ++i) {
      const double sine = i / 1000.0, phi = output == 8 ? std::numbers::pi : 0;
      const auto out = evaluate_row<HairKarisRow, double>({std::asin(sine), 0, phi, 1, 1, 1, 0.5, 0.2, 1, 0.05});
      const double value = out[std::size_t(output)];
      if (value > best) {
        best = value;
        at = sine;
      }
    }
    EXPECT_NEAR(at, times * 0.05, 0.002) << output;  // F changes little over the lobe
  }
}

TEST(HairKaris, ColorsAndScalesAreNeutralWhereTheyShouldBe) {
  const auto at = [](double color, double specular, double backlit) {
    return evaluate_row<HairKarisRow, double>({0.2, -0.1, 2.5, color, color, color, specular, 0.4, backlit, 0.03});
  };
  const auto white = at(1, 0.5, 1);
  EXPECT_DOUBLE_EQ(at(1, 1, 1)[6], 2 * white[6]);
  EXPECT_DOUBLE_EQ(at(1, 0.5, 0.25)[8], 0.25 * white[8]);
  EXPECT_EQ(at(1, 0.5, 0.25)[11], white[11]);
  EXPECT_LT(at(1, 0.5, 0)[6], white[6]);  // light from behind: wi.wo < 0
  EXPECT_EQ(at(0, 0.5, 1)[8], 0);
  EXPECT_EQ(at(0, 0.5, 1)[6], white[6]);
}

TEST(EtaPrime, ExactIsSnellsLawInTheSectionAndTheFitIsWithinItsBound) {
  double worst = 0;
  for (double theta = 0; theta < 1.5708; theta += 0.001) {
    const auto out = evaluate_row<EtaPrimeRow, double>({1.55, theta});
    const double want = std::sqrt(1.55 * 1.55 - std::sin(theta) * std::sin(theta)) / std::cos(theta);
    EXPECT_NEAR(out[0] * want, 1, 1e-13);
    worst = std::max(worst, std::abs(out[0] / out[1] - 1));
  }
  EXPECT_LE(worst, 0.0068);  // file 002 says 0.68 %; 0.67 % measured
}

TEST(EtaPrime, StaysFiniteAtNinetyDegrees) {
  for (const double theta : {std::numbers::pi / 2, -std::numbers::pi / 2, 1.5707963}) {
    const auto out = evaluate_row<EtaPrimeRow, double>({1.55, theta});
    EXPECT_GE(out[0], 0);
    EXPECT_LT(out[0], 1e-7);
    EXPECT_NEAR(out[1], out[0], 0.007 * out[0]);
  }
  // eta = 1: no refraction, whatever the inclination.
  for (const double theta : {0.0, 1.0, 1.57}) EXPECT_NEAR((evaluate_row<EtaPrimeRow, double>({1, theta})[0]), 1, 1e-12);
}

TEST(OffsetTt, SolvesTheDeflectionOfTt) {
  Random random(2);
  for (int i = 0; i < 5000; ++i) {
    const double eta = random.uniform(1.05, 2), theta = random.uniform(-1.4, 1.4);
    const double a = inverse_eta_prime(eta, std::cos(theta)), least = 2 * std::asin(a);
    const double phi = random.uniform(least, std::numbers::pi) * (random.uniform() < 0.5 ? -1 : 1);
    const double h = evaluate_row<OffsetTtRow, double>({phi, eta, theta})[0];
    const double deflection =
        2 * std::asin(a * h) - 2 * std::asin(h) + std::numbers::pi;  // Phi(1, h), in [least, 2 pi - least]
    EXPECT_NEAR(std::remainder(deflection - phi, 2 * std::numbers::pi), 0, 2e-7)
        << phi << " " << eta;  // asin near h = 1
    EXPECT_EQ(h > 0, phi > 0);
  }
}

TEST(OffsetTt, VanishesOppositeAndChangesItsSignAtZeroAlone) {
  const auto h = [](double phi) { return evaluate_row<OffsetTtRow, double>({phi, 1.55, 0.3})[0]; };
  EXPECT_NEAR(h(std::numbers::pi), 0, 1e-15);
  EXPECT_NEAR(h(-std::numbers::pi), 0, 1e-15);
  EXPECT_NEAR(h(std::numbers::pi - 1e-9), -h(std::numbers::pi + 1e-9), 1e-15);
  EXPECT_NEAR(h(1e-12), -h(-1e-12), 1e-12);
  EXPECT_GT(h(0), 0.8);  // 1 / sqrt(1 + a^2)
  // eta = 1: the light goes straight on, phi = pi from every offset.
  EXPECT_TRUE(std::isfinite(evaluate_row<OffsetTtRow, double>({std::numbers::pi, 1, 0.3})[0]));
}

TEST(OffsetTt, TheFitOfFile002IsAsFarOffAsItsPageSays) {
  double worst = 0;
  for (const double theta : {0.0, 0.4, 0.8, 1.2}) {
    const double least = 2 * std::asin(inverse_eta_prime(1.55, std::cos(theta)));
    for (double phi = least; phi < std::numbers::pi; phi += 0.01) {
      const auto out = evaluate_row<OffsetTtRow, double>({phi, 1.55, theta});
      worst = std::max(worst, std::abs(out[0] - out[1]));
    }
  }
  EXPECT_NEAR(worst, 0.154, 6e-4);  // across the fibre, theta_d = 0
}

// The numbers of docs/models/hair_karis.md, to their last digit: the form loses light with roughness and inclination.
TEST(HairKaris, ItsEnergyIsWhatItsPageSays) {
  struct {
    double roughness, beta_m, theta_o, energy;  // beta_m of about the same width, for the panels of the quadrature
  } constexpr kCases[]{{0.2, 0.052, 50, 1.065}, {0.2, 0.052, 70, 0.940}, {0.7, 0.45, 0, 0.976}, {0.7, 0.45, 70, 0.603}};
  for (const auto& c : kCases) {
    const auto row = [&](const RealtimeFibre&, double theta_i, double theta_o, double phi) {
      return f_cos_of<HairKarisRow>({theta_i, theta_o, phi, 1, 1, 1, 0.5, c.roughness, 1, 0.035});
    };
    const RealtimeFibre panels{.beta_m = c.beta_m, .beta_n = 0.3};
    EXPECT_NEAR(energy_of(row, panels, c.theta_o * kHairDegree), c.energy, 6e-4) << c.roughness << " " << c.theta_o;
  }
}

}  // namespace
}  // namespace likeness::brdf
