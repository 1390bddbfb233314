#include <chrono>

#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/hair/realtime_cases.h"

// The tables of hair_lut against the quadrature that they stand for, over the range that docs/models/hair_lut.md states:
// beta_n 0.1 to 1, inclinations to 80 degrees, absorption to 2 per radius.
namespace likeness::brdf {
namespace {

TEST(HairLutBake, SumsAreTheQuadrature) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const double cosine = random.uniform(0.02, 1), s = hair_width(random.uniform(0.1, 1));
    const double phi = random.uniform(0, std::numbers::pi);
    HairOffsets offsets(1.55, cosine);
    for (int p = 0; p < 3; ++p) {
      offsets.choose(std::size_t(p), s);
      const auto sums = offsets.sums(phi);
      const double want = hair_far(p, phi, s, 0.0, 1.55, cosine, 1e-9);
      if (want < 1e-10) continue;
      EXPECT_NEAR(sums.bare / want, 1, 1e-4) << p << " " << cosine << " " << s << " " << phi;  // 3e-5 at the cut of R
      EXPECT_EQ(offsets.bare(phi), sums.bare);
      EXPECT_NEAR(sums.absorbed / hair_far(p, phi, s, HairOffsets::kSigma, 1.55, cosine, 1e-9), 1, 1e-4);
      // The way travelled is minus the slope of ln N by sigma_a.
      const double step = 1e-4, more = hair_far(p, phi, s, step, 1.55, cosine, 1e-11);
      EXPECT_NEAR(sums.travelled / sums.bare, -std::log(more / want) / step, 2e-3 + 2e-3 * p);
    }
  }
}

TEST(HairLutBake, TakesLessThanASecondAndAboutAMegabyte) {
  const auto start = std::chrono::steady_clock::now();
  const HairLut lut = bake_hair_lut();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(lut.bytes(), 1137024u);  // as the page says
  // 0.15 s measured on an idle core; other builds and sanitizers are allowed for.
  EXPECT_LT(seconds, 10);
}

struct Drawn {
  double phi, s, sigma_a, theta;
};
Drawn draw_in_range(Random& random) {
  const double beta_n = random.uniform() < 0.5 ? random.uniform(0.1, 1) : random.uniform(0.1, 0.25);
  const double sigma_a = random.uniform() < 0.3 ? 0 : random.uniform(0, 2);
  return {random.uniform(0, std::numbers::pi), hair_width(beta_n), sigma_a, random.uniform(0, 80 * kHairDegree)};
}

TEST(HairLut, EveryLobeIsWithinFivePercentOfTheQuadrature) {
  Random random(2);
  std::array<double, 5> worst{};
  const auto lobes = [](const Drawn& at, double phi) {
    return evaluate_row<HairLutAzimuthRow, double>({phi, at.s, at.sigma_a, at.theta});
  };
  for (int i = 0; i < 4000; ++i) {
    const Drawn at = draw_in_range(random);
    const auto got = lobes(at, at.phi);
    std::array<double, 4> peak{};
    for (int k = 0; k <= 60; ++k) {
      const auto n = lobes(at, std::numbers::pi * k / 60);
      for (std::size_t p = 0; p < 4; ++p) peak[p] = std::max(peak[p], n[p]);
    }
    double sum = 0, want_sum = 0;
    for (std::size_t p = 0; p < 4; ++p) {
      const double want = hair_far(int(p), at.phi, at.s, at.sigma_a, 1.55, std::cos(at.theta), 1e-5);
      sum += got[p];
      want_sum += want;
      if (want > 0.05 * peak[p]) worst[p] = std::max(worst[p], std::abs(got[p] / want - 1));
    }
    worst[4] = std::max(worst[4], std::abs(sum / want_sum - 1));
  }
  EXPECT_LE(worst[0], 0.05);  // R: 2.7 % over 150000 points
  EXPECT_LE(worst[1], 0.05);  // TT: 3.5 %
  EXPECT_LE(worst[2], 0.05);  // TRT: 4.5 %
  EXPECT_LE(worst[3], 0.06);  // longer paths, at most 5 % of the energy: 5.1 %
  EXPECT_LE(worst[4], 0.05);  // all together, at every azimuth: 2.3 %
}

// The whole fibre, tilt and longitudinal terms included, wherever the light is; the closed forms at the same points.
TEST(HairLut, TheWholeFibreIsWithinFivePercentOfTheReference) {
  Random random(8);
  double worst = 0, off2 = 0, want2 = 0;
  for (int i = 0; i < 600; ++i) {
    const RealtimeFibre fibre{.beta_m = random.uniform(0.1, 1),
                              .beta_n = random.uniform(0.1, 1),
                              .sigma_a = random.uniform() < 0.3 ? 0 : random.uniform(0, 2),
                              .tilt_deg = random.uniform(-8, 8)};
    const double theta_o = random.uniform(-80, 80) * kHairDegree, phi = random.uniform(-7, 7);
    const double theta_i = std::clamp(-theta_o + random.uniform(-0.6, 0.6), -1.5, 1.5);
    const double want = exact_f_cos(fibre, theta_i, theta_o, phi, 1e-5);
    worst = std::max(worst, std::abs(far_row<HairLutRow>(fibre, theta_i, theta_o, phi) / want - 1));
    off2 += squared(far_row<HairClosedRow>(fibre, theta_i, theta_o, phi) - want);
    want2 += want * want;
  }
  EXPECT_LE(worst, 0.05);                    // the demand
  EXPECT_LE(std::sqrt(off2 / want2), 0.03);  // hair_closed: 1 to 1.7 % for each beta
}

TEST(HairLut, EnergyIsWithinTwoPercent) {
  double worst = 0;
  for (const double beta : {0.1, 0.35, 0.7, 1.0})
    for (const double theta_o : {0.0, -40.0, 80.0})
      for (const double sigma_a : {0.0, 0.3, 2.0}) {
        const RealtimeFibre fibre{.beta_m = beta, .beta_n = beta, .sigma_a = sigma_a};
        const auto lobes = lobe_energies(sigma_a, std::cos(theta_o * kHairDegree));
        const double want = lobes[0] + lobes[1] + lobes[2] + lobes[3];
        const double got = energy_of(&far_row<HairLutRow>, fibre, theta_o * kHairDegree);
        worst = std::max(worst, std::abs(got / want - 1));
        EXPECT_NEAR(got / want, 1, 0.02) << beta << " " << theta_o << " " << sigma_a;  // the demand
      }
  EXPECT_LE(worst, 0.005);  // 0.3 % measured
}

TEST(HairLut, EachLobeHasItsEnergy) {
  const auto energies = [](double s, double sigma_a, double theta) {
    std::vector<double> ends;
    for (int i = 0; i <= 60; ++i) ends.push_back(std::numbers::pi * i / 60);
    const Nodes azimuths(ends);
    std::array<double, 4> sum{};
    for (std::size_t i = 0; i < azimuths.at.size(); ++i) {
      const auto n = evaluate_row<HairLutAzimuthRow, double>({azimuths.at[i], s, sigma_a, theta});
      for (std::size_t p = 0; p < 4; ++p) sum[p] += 2 * azimuths.weight[i] * n[p];
    }
    return sum;
  };
  Random random(3);
  for (int i = 0; i < 400; ++i) {
    const Drawn at = draw_in_range(random);
    const auto got = energies(at.s, at.sigma_a, at.theta), want = lobe_energies(at.sigma_a, std::cos(at.theta));
    const double tolerance[]{0.005, 0.012, 0.02, 0.055};  // measured: 0.2 %, 0.9 %, 1.5 %, 5.1 %
    for (std::size_t p = 0; p < 4; ++p)
      EXPECT_NEAR(got[p] / want[p], 1, tolerance[p]) << p << " " << at.s << " " << at.sigma_a << " " << at.theta;
  }
}

TEST(HairLut, ValuesAreContinuousAcrossNodesAndHeldBeyondTheTables) {
  const HairLut& lut = hair_lut_at_155();
  const auto at = [&](double distance, double cosine, double width) {
    const auto n = lut.read(distance, cosine, width, Rgb<double>(0.3));
    return std::array{n.r, n.tt.g, n.trt.b, n.longer.r};
  };
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const HairGrid* grids[]{&lut.r, &lut.tt, &lut.trt, &lut.ways};
    const HairGrid& g = *grids[random.index(4)];
    const auto node = [&](int n) { return double(random.index(std::size_t(n))) / (n - 1); };
    const double t = node(g.phi), c = node(g.cosine), w = node(g.width), e = 1e-9;
    const double phi = &g == &lut.r     ? std::numbers::pi - unbent(lut.dense_r, t)
                       : &g == &lut.trt ? unbent(lut.dense_trt, t)
                                        : std::numbers::pi * t;
    const auto here = at(phi, c, w);
    for (const double side : {-e, e}) {
      const auto near = at(std::clamp(phi + side, 0.0, std::numbers::pi), std::clamp(c + side, 0.0, 1.0), w + side);
      for (std::size_t p = 0; p < 4; ++p)
        EXPECT_NEAR(near[p], here[p], 2e-6 * here[p] + 1e-9);  // 1e-9 on a slope of up to 1e3
    }
  }
  EXPECT_EQ(at(1, 0.5, -3), at(1, 0.5, 0));
  EXPECT_EQ(at(1, 0.5, 7), at(1, 0.5, 1));
  EXPECT_EQ(hair_lut_width(1e-3), 0);
  EXPECT_NEAR(hair_lut_width(100.0), 1, 1e-15);
}

TEST(HairLut, WithGaussiansItIsTheSameInANarrowLobeAcrossTheFibre) {
  const RealtimeFibre fibre{.beta_m = 0.05, .beta_n = 0.3, .sigma_a = 0.2};
  for (const double phi : {0.2, 1.5, 3.0})
    for (const double theta_i : {-0.07, 0.0, 0.035}) {
      const double m = far_row<HairLutRow>(fibre, theta_i, 0, phi),
                   g = far_row<HairLutGaussRow>(fibre, theta_i, 0, phi);
      EXPECT_NEAR(g / m, 1, 0.01) << theta_i;  // M_p differs by v / 8 and by the cosines; 0.5 % measured
    }
}

// ---- the talk's table

TEST(HairTalkLut, EachDistributionIntegratesToOne) {
  for (const double beta_n : {0.1, 0.2, 0.45, 1.0})
    for (const double theta_d : {0.0, 0.7, 1.3}) {
      double sum[3]{};
      const int steps = 4000;
      for (int i = 0; i < steps; ++i) {
        const auto d = evaluate_row<HairTalkDistributionRow, double>(
            {std::numbers::pi * (2 * (i + 0.5) / steps - 1), beta_n, theta_d});
        for (std::size_t p = 0; p < 3; ++p) sum[p] += d[p] * 2 * std::numbers::pi / steps;
      }
      for (const double whole : sum) EXPECT_NEAR(whole, 1, 0.02) << beta_n << " " << theta_d;  // 1.1 % measured
    }
}

TEST(HairTalkLut, ItsNodesAreTheIntegralOverOffsets) {
  // p = 0 is closed: h = sin(gamma) and phi = -2 gamma, so that the smooth limit is cos(phi / 2) / 4; at beta_n 0.1 the
  // logistic is 1.4 degrees wide and its blur is below 1e-3 away from phi = pi.
  for (const double k : {0.0, 10.0, 30.0, 50.0}) {
    const double phi = std::numbers::pi * k / 63;
    const auto d = evaluate_row<HairTalkDistributionRow, double>({phi, 0.1, 0.3});
    EXPECT_NEAR(d[0], 0.25 * std::cos(phi / 2), 1e-3 * d[0]);
  }
}

TEST(HairTalkLut, AttenuationIsThatOfTheDominantOffset) {
  const double cos_d = 0.8, sigma_a = 0.4;
  const auto a = hair_talk_attenuations(0.9, cos_d, 1.55, Rgb<double>(sigma_a));
  const auto at = [&](double h) { return fibre_path(h, cos_d, 1.55); };
  const auto tt = at(0), trt = at(std::sqrt(3) / 2);
  EXPECT_NEAR(a.tt.g, tt.transmitted * tt.transmitted * std::exp(-2 * sigma_a * tt.chord), 1e-15);
  EXPECT_NEAR(a.trt.b, trt.transmitted * trt.transmitted * trt.reflected * std::exp(-4 * sigma_a * trt.chord), 1e-15);
  EXPECT_NEAR(a.r, fibre_path(0.0, 0.9, 1.55).reflected, 1e-15);
}

}  // namespace
}  // namespace likeness::brdf
