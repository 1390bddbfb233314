#include "brdf/hair/dual_scattering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "brdf/hair/far.h"
#include "brdf/hair/fibre.h"
#include "brdf/hair/strand_count.h"
#include "tests/brdf/kinds.h"

// Dual scattering against walks along rows of strands, and its table against the quadrature it is made from.
namespace likeness::brdf {
namespace {

// ---- a row of equal strands: each sends a share on, a share back, and turns the inclination by a normal deviate.

struct Strand {
  MeanScatter<double> forward, backward;
};

// The same deviates on every machine and standard library: Box and Muller.
double normal_deviate(Random& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));
  return radius * std::cos(2 * std::numbers::pi * random.uniform());
}

struct Walks {
  double count = 0, once = 0, thrice = 0, back = 0;  // paths that come back, without the first strand's own
  std::vector<double> turned;                        // the inclination of those that turn once or thrice
};

Walks walk(const Strand& strand, int count, std::uint64_t seed) {
  Random random(seed);
  Walks walks;
  walks.count = count;
  for (int i = 0; i < count; ++i) {
    int position = 1, direction = 1, turns = 0, passes = 0;
    double turned = 0;
    while (position > 0 && position < 4000) {  // of white strands one in 4000 comes this far
      const double u = random.uniform();
      const bool on = u < strand.forward.energy;
      if (!on && u >= strand.forward.energy + strand.backward.energy) break;
      const MeanScatter<double>& scatter = on ? strand.forward : strand.backward;
      turned += scatter.shift + std::sqrt(scatter.variance) * normal_deviate(random);
      direction = on ? direction : -direction;
      ++(on ? passes : turns);
      position += direction;
    }
    if (position != 0 || passes == 0) continue;
    walks.back += 1;
    walks.once += turns == 1;
    walks.thrice += turns == 3;
    if (turns <= 3) walks.turned.push_back(turned);
  }
  return walks;
}

// 5 sigma: all 24 comparisons below together fail by chance once in 70 000 seeds (two-sided normal, Sidak).
constexpr double kSigmas = 5;

void expect_share(double counted, double all, double share, const char* what) {
  const double sigma = std::sqrt(share * (1 - share) / all);
  EXPECT_NEAR(counted / all, share, kSigmas * sigma) << what;
}

class RowOfStrands : public ::testing::TestWithParam<Strand> {};

// Nothing but the definition of the row is shared with the formulas.
TEST_P(RowOfStrands, SendsBackWhatTheFormulasSay) {
  const Strand strand = GetParam();
  const Walks walks = walk(strand, 500000, 17);
  const auto row = row_backscatter(strand.forward, strand.backward);
  const double b = strand.backward.energy, square = strand.forward.energy * strand.forward.energy;
  const double once = b * square / (1 - square), thrice = once * b * b / ((1 - square) * (1 - square));
  EXPECT_NEAR(row.energy, once + thrice, 1e-14);  // sums in another order
  expect_share(walks.once, walks.count, once, "paths that turn once");
  expect_share(walks.thrice, walks.count, thrice, "paths that turn three times");
  expect_share(walks.back, walks.count, row.energy_of_all, "all that come back");

  double mean = 0, variance = 0, fourth = 0;
  const double n = double(walks.turned.size());
  for (const double x : walks.turned) mean += x / n;
  for (const double x : walks.turned) {
    variance += (x - mean) * (x - mean) / n;
    fourth += (x - mean) * (x - mean) * (x - mean) * (x - mean) / n;
  }
  EXPECT_NEAR(mean, row.shift, kSigmas * std::sqrt(variance / n));
  EXPECT_NEAR(variance, row.variance, kSigmas * std::sqrt((fourth - variance * variance) / n));
}

INSTANTIATE_TEST_SUITE_P(OfManyKinds, RowOfStrands,
                         ::testing::Values(Strand{{0.6, 0.03, 0.01}, {0.2, -0.05, 0.04}},
                                           Strand{{0.85, 0.02, 0.005}, {0.1, -0.1, 0.02}},
                                           Strand{{0.3, -0.04, 0.01}, {0.6, 0.06, 0.01}},
                                           Strand{{0.3, 0.2, 0}, {0.3, -0.3, 0}}));

// The limit of white hair: all light comes back, of which the paths of one and three turns carry 5/8.
TEST(RowBackscatter, OfWhiteStrandsIsAllTheLight) {
  for (const double b : {0.5, 0.1, 1e-3, 1e-6}) {
    const auto row = row_backscatter<double>({1 - b, 0, 0}, {b, 0, 0});
    EXPECT_NEAR(row.energy_of_all, 1 - b, 1e-9) << b;  // 1 - f loses what b has less than 1e-16
    // With f = 1 - b: b F / (1 - F) = F / (2 - b), w = 1 / (2 - b)^2.
    const double energy = (1 - b) * (1 - b) / (2 - b) * (1 + 1 / ((2 - b) * (2 - b)));
    EXPECT_NEAR(row.energy, energy, 1e-9) << b;  // the same
  }
}

TEST(RowBackscatter, IsThePapersToFirstOrder) {
  const double f = 0.5, b = 0.01, w = b * b / ((1 - f * f) * (1 - f * f));
  const auto row = row_backscatter<double>({f, 0.02, 0}, {b, 0.1, 0});
  const double paper_alpha_f = (2 * (1 - f * f) * (1 - f * f) + 4 * f * f * b * b) / std::pow(1 - f * f, 3);
  EXPECT_NEAR(row.shift, 0.1 * (1 + 2 * w) + 0.02 * paper_alpha_f, 1e-7);  // second order: w^2 = 3e-8
}

template <class S>
class DualKinds : public ::testing::Test {};
TYPED_TEST_SUITE(DualKinds, Kinds, KindNames);

template <class S>
bool usable(const S& x) {
  return std::isfinite(first(x)) && first(x) >= 0;
}

// Mean attenuations to 0, to 1, and together above 1, as rounded tables may have them.
TYPED_TEST(DualKinds, ARowIsFiniteForEveryAttenuation) {
  using S = TypeParam;
  for (const double f : {0.0, 1e-30, 0.5, 1 - 1e-6, 1.0, 1.1})
    for (const double b : {0.0, 1e-30, 1e-6, 0.5, 1.0, 1.1}) {
      const auto row = row_backscatter<S>({constant<S>(f), constant<S>(0.05), constant<S>(0.1)},
                                          {constant<S>(b), constant<S>(-0.1), constant<S>(0.1)});
      EXPECT_TRUE(usable(row.energy) && usable(row.energy_of_all) && usable(row.variance)) << f << " " << b;
      EXPECT_TRUE(std::isfinite(first(row.shift))) << f << " " << b;
      EXPECT_LE(first(row.energy_of_all), 1 + 1e-6) << f << " " << b;  // float
    }
}

TYPED_TEST(DualKinds, ManyStrandsOrNoneAreOrdinary) {
  using S = TypeParam;
  for (const double f : {0.0, 0.9, 1.0})
    for (const double n : {-1.0, 0.0, 1e-7, 1 - 1e-7, 1.0, 1 + 1e-7, 1e6}) {
      const auto through =
          transmitted_through<S>(constant<S>(n), {constant<S>(f), constant<S>(0.05), constant<S>(0.1)});
      EXPECT_TRUE(usable(through.direct) && usable(through.scattered) && usable(through.variance)) << f << " " << n;
      EXPECT_LE(first(through.direct) + first(through.scattered), 1 + 1e-6) << f << " " << n;
    }
}

// The strand counts 1 - e, 1 and 1 + e give the same to e.
TEST(Transmitted, HasNoJumpAtOneStrand) {
  const MeanScatter<double> forward{0.8, 0.01, 0.02};
  const auto before = transmitted_through(1 - 1e-9, forward), after = transmitted_through(1 + 1e-9, forward);
  EXPECT_NEAR(before.direct, after.direct, 2e-9);
  EXPECT_NEAR(before.scattered, after.scattered, 2e-9);
  EXPECT_NEAR(before.variance, after.variance, 2e-9);
}

// ---- means over the width of a fibre.

TEST(MeanScattering, ConservesEnergyWithoutAbsorption) {
  for (const double cosine : {1.0, 0.5, 0.1, 0.0}) {
    double out[kMeanValues], sum = 0;
    mean_scattering(cosine, 1.55, LogisticWidth(0.2), 0, 96, out);
    for (int p = 0; p < kHairLobes; ++p) sum += out[4 * p] + out[4 * p + 1];
    EXPECT_NEAR(sum, 1, 2e-5) << cosine;  // midpoint rule with 96 points on cos: 1.1e-5
  }
}

// Against the far field itself, integrated over phi.
TEST(MeanScattering, IsTheIntegralOfTheFarField) {
  const double s = 0.25, sigma_a = 0.3, cosine = 0.8;
  double out[kMeanValues];
  mean_scattering(cosine, 1.55, LogisticWidth(s), sigma_a, 96, out);
  for (int p = 0; p < 3; ++p) {
    const int steps = 400;  // even in phi
    double sums[4]{};
    for (int i = 0; i < steps; ++i) {
      const double phi = (i + 0.5) / steps * std::numbers::pi;
      const double n = 2 * std::numbers::pi / steps * hair_far(p, phi, s, sigma_a, 1.55, cosine, 1e-7);
      sums[0] += n * phi / std::numbers::pi;
      sums[1] += n * (1 - phi / std::numbers::pi);
      sums[2] += n * std::cos(phi);
      sums[3] += n * std::cos(3 * phi);
    }
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(out[4 * p + k], sums[k], 3e-5) << p << " " << k;  // both rules' 1e-5
  }
}

// The numbers of docs/models/dual_scattering.md.
TEST(MeanScatteringTable, IsWithinTheErrorItStates) {
  const auto table = std::make_unique<MeanScatteringTable>();
  Random random(3);
  double worst_forward = 0, worst_backward = 0;
  for (int i = 0; i < 2000; ++i) {
    const double cosine = random.uniform(), s = random.uniform(0.05, 4.5);
    const double sigma_a = i % 5 == 0 ? 0 : std::pow(10.0, random.uniform(-2, 1));
    double out[kMeanValues];
    mean_scattering(cosine, 1.55, LogisticWidth(s), sigma_a, 96, out);
    const auto lobes = table->lookup(cosine, s, sigma_a);
    double forward = 0, backward = 0;
    for (int p = 0; p < kHairLobes; ++p) {
      forward += lobes[std::size_t(p)].forward - out[4 * p];
      backward += lobes[std::size_t(p)].backward - out[4 * p + 1];
    }
    worst_forward = std::max(worst_forward, std::abs(forward));
    worst_backward = std::max(worst_backward, std::abs(backward));
  }
  EXPECT_LE(worst_forward, 0.004);   // 0.0028 measured
  EXPECT_LE(worst_backward, 0.004);  // 0.0023 measured
  RecordProperty("worst_forward", std::to_string(worst_forward));
  RecordProperty("worst_backward", std::to_string(worst_backward));
}

TEST(MeanScatter, OfNothingIsNothing) {
  const auto mean = mean_of_lobes<double>({0, 0, 0, 0}, {1, 2, 3, 4}, {1, 2, 3, 4});
  EXPECT_EQ(mean.energy, 0);
  EXPECT_EQ(mean.shift, 0);
  EXPECT_EQ(mean.variance, 0);
}

TEST(MeanScatter, AddsTheSpreadOfTheShifts) {
  const auto mean = mean_of_lobes<double>({0.25, 0.25, 0, 0}, {0.1, 0.3, 0, 0}, {0.04, 0.04, 0, 0});
  EXPECT_NEAR(mean.energy, 0.5, 1e-15);
  EXPECT_NEAR(mean.shift, 0.2, 1e-15);
  EXPECT_NEAR(mean.variance, 0.04 + 0.01, 1e-15);
}

// Against the far field, averaged over light from a whole half circle of azimuths.
TEST(MeanScattering, OfScatteredLightIsTheFarFieldAveragedOverHalfACircle) {
  const double s = 0.3, sigma_a = 0.2, cosine = 0.9;
  double out[kMeanValues];
  mean_scattering(cosine, 1.55, LogisticWidth(s), sigma_a, 96, out);
  for (const int p : {0, 1, 2}) {
    const LobeScattering<double> lobe{out[4 * p], out[4 * p + 1], out[4 * p + 2], out[4 * p + 3]};
    for (const double phi : {0.0, 0.8, 1.6, 2.4, 3.1}) {
      const int steps = 200;
      double mean = 0;
      for (int i = 0; i < steps; ++i) {
        const double from = ((i + 0.5) / steps - 0.5) * std::numbers::pi;
        mean += hair_far(p, phi - from, s, sigma_a, 1.55, cosine, 1e-6) / steps;
      }
      const double energy = lobe.forward + lobe.backward;
      EXPECT_NEAR(scattered_azimuthal(lobe, std::cos(phi)), mean, 0.01 * energy) << p << " " << phi;  // 5th coefficient
    }
  }
}

// ---- the whole.

DualFibre<double> fibre_of(double cosine, double sigma_a) {
  double out[kMeanValues];
  mean_scattering(cosine, 1.55, LogisticWidth(0.3), sigma_a, 96, out);
  DualFibre<double> fibre{{}, {-0.07, 0.035, 0.14, 0}, {0.04, 0.01, 0.16, 0.16}};
  for (std::size_t p = 0; p < kHairLobes; ++p)
    fibre.lobes[p] = {out[4 * p], out[4 * p + 1], out[4 * p + 2], out[4 * p + 3]};
  return fibre;
}

Inclination<double> inclination(double theta) { return {std::sin(theta), std::cos(theta)}; }

// Integrated over all directions, each part is the energy that the row's bookkeeping gives it.
TEST(DualScattering, EachPartHasItsEnergy) {
  const double theta_i = 0.3, strands = 3, density = 0.7;
  const DualFibre<double> fibre = fibre_of(std::cos(theta_i), 0.1);
  double local = 0, global = 0, global_local = 0;
  const int steps = 300;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) {
      const double theta = (i + 0.5) / steps * std::numbers::pi - std::numbers::pi / 2;
      const double phi = (k + 0.5) / steps * 2 * std::numbers::pi;
      const double weight = std::cos(theta) * 2 * std::numbers::pi * std::numbers::pi / (steps * steps);
      const auto at = [&](double n) {
        return dual_scattering(fibre, n, density, inclination(theta_i), inclination(theta), std::cos(phi));
      };
      local += weight * at(0).local;
      global += weight * at(strands).global;
      global_local += weight * at(strands).global_local;
    }
  const auto row = row_backscatter(fibre.forward(), fibre.backward());
  const double through = std::pow(fibre.forward().energy, strands);
  const double whole = fibre.forward().energy + fibre.backward().energy;
  EXPECT_NEAR(local, density * row.energy, 1e-4);        // midpoint rule: 1e-5 measured
  EXPECT_NEAR(global, density * through * whole, 1e-4);  // the same
  EXPECT_NEAR(global_local, density * density * through * row.energy, 1e-4);
}

TEST(DualScattering, HasNoJumpInAzimuthNorInStrands) {
  const DualFibre<double> fibre = fibre_of(0.9, 0.2);
  const auto at = [&](double n, double phi) {
    const auto f = dual_scattering(fibre, n, 0.7, inclination(0.2), inclination(-0.1), std::cos(phi));
    return f.sum();
  };
  for (const double n : {0.0, 0.5, 1.0, 4.0})
    for (double phi = 0; phi < 2 * std::numbers::pi; phi += 0.01) {
      EXPECT_NEAR(at(n, phi), at(n, phi + 1e-9), 1e-8) << n << " " << phi;  // slope below 10
      EXPECT_NEAR(at(n, phi), at(n + 1e-9, phi), 1e-8) << n << " " << phi;
    }
}

TYPED_TEST(DualKinds, TheWholeIsFiniteInHardCases) {
  using S = TypeParam;
  static const auto table = std::make_unique<MeanScatteringTable>();
  const auto as = [](double x) { return constant<S>(x); };
  for (const double theta : {0.0, 1.5, 1.5707963267948966, -1.5707963267948966})
    for (const double sigma_a : {0.0, 0.5, 1e6})
      for (const double v : {1e-9, 0.1, 1e3})
        for (const double n : {0.0, 0.5, 20.0})
          for (const double cos_phi : {-1.0, 0.0, 1e-7, 1.0}) {
            const DualFibre<S> fibre{table->lookup<S>(as(std::cos(theta)), as(0.3), as(sigma_a)),
                                     {as(-0.1), as(0.05), as(0.2), as(0)},
                                     {as(v), as(v), as(v), as(v)}};
            const Inclination<S> i{as(std::sin(theta)), as(std::max(0.0, std::cos(theta)))}, o{as(0.6), as(0.8)};
            const auto f = dual_scattering<S>(fibre, as(n), as(0.7), i, o, as(cos_phi));
            EXPECT_TRUE(usable(f.local) && usable(f.global) && usable(f.global_local) && usable(f.direct))
                << theta << " " << sigma_a << " " << v << " " << n << " " << cos_phi;
          }
}

// ---- a slab of parallel fibres: every hit is a sample of the reference model at a random offset.

struct Slab {
  double first_on = 0, first_back = 0, squares_on = 0;  // of the first fibre
  double back = 0;                                      // without the first fibre's own, of one or three turns
  double through_three = 0;                             // without a turn
};

Slab walk_slab(const HairFibre<double>& fibre, double theta, int count) {
  Random random(23);
  Slab slab;
  for (int i = 0; i < count; ++i) {
    const double phi = (random.uniform() - 0.5) * std::numbers::pi;
    Vec3<double> to_view{std::sin(theta), std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi)};
    double weight = 1.0 / count;
    int position = 1, direction = 1, turns = 0, passes = 0;
    while (position > 0 && weight * count > 1e-4) {
      const double h = 2 * random.uniform() - 1, choice = random.uniform(), u = random.uniform(), w = random.uniform();
      const auto sample = fibre.sample(to_view, h, choice, u, w, random.uniform());
      weight *= sample.weight.r;
      const bool on = (sample.to_light.y > 0) != (to_view.y > 0);
      if (turns + passes == 0) {
        (on ? slab.first_on : slab.first_back) += weight;
        slab.squares_on += on ? weight * weight : 0;
      }
      ++(on ? passes : turns);
      direction = on ? direction : -direction;
      position += direction;
      if (turns == 0 && passes == 3) slab.through_three += weight;
      to_view = sample.to_light * -1.0;
    }
    if (position == 0 && passes > 0 && turns <= 3) slab.back += weight;
  }
  return slab;
}

// The means are exact; what is made of them takes inclination and azimuth as forgotten at each hit, and differs.
TEST(DualScattering, IsNearASlabOfFibres) {
  for (const double sigma_a : {0.1, 0.5})
    for (const double theta : {0.0, 0.6}) {
      HairFibre<double> fibre;
      fibre.sigma_a = Rgb<double>(sigma_a);
      const int count = 20000;
      const Slab slab = walk_slab(fibre, theta, count);
      double out[kMeanValues];
      mean_scattering(std::cos(theta), fibre.eta, LogisticWidth(hair_width(fibre.beta_n)), sigma_a, 96, out);
      double on = 0, back = 0;
      for (int p = 0; p < kHairLobes; ++p) on += out[4 * p], back += out[4 * p + 1];
      const double sigma = std::sqrt((slab.squares_on - on * on / count));
      EXPECT_NEAR(slab.first_on, on, kSigmas * sigma) << sigma_a << " " << theta;
      EXPECT_NEAR(slab.first_back, back, kSigmas * sigma) << sigma_a << " " << theta;  // the variances are alike
      const auto row = row_backscatter<double>({on, 0, 0}, {back, 0, 0});
      EXPECT_NEAR(row.energy / slab.back, 1, 0.35) << sigma_a << " " << theta;             // 5 to 24 % measured
      EXPECT_NEAR(on * on * on / slab.through_three, 1, 0.15) << sigma_a << " " << theta;  // 2 to 8 % measured
    }
}

// ---- strand counts.

TEST(StrandCount, OfAPlaneOfHairIsItsBestLinearFunction) {
  // 10 strands above, none below: mean 5, gradient 3 x the mean of n(w) w, which is 3 x 10 / 4.
  StrandCount<double> count;
  const int directions = 20000;
  for (int i = 0; i < directions; ++i) {
    const double z = 1 - (2 * i + 1.0) / directions, phi = i * std::numbers::pi * (3 - std::sqrt(5.0));
    count.add(Random::direction_at(z, phi), z > 0 ? 10 : 0, directions);
  }
  EXPECT_NEAR(count.mean, 5, 1e-12);
  EXPECT_NEAR(count.gradient.z, 7.5, 1e-3);  // the spiral is even to 1e-4
  EXPECT_NEAR(count.gradient.x, 0, 1e-2);
  const auto kept = count.kept_positive();
  EXPECT_NEAR(kept.mean, 5, 1e-12);
  EXPECT_NEAR(kept.eval({0, 0, 1}), 10, 1e-2);
  EXPECT_NEAR(kept.eval({0, 0, -1}), 0, 1e-2);
}

TEST(StrandCount, KeptPositiveKeepsItsMeanOverTheSphere) {
  const auto kept = StrandCount<double>{2, {3, -4, 1}}.kept_positive();
  double sum = 0;
  const int directions = 20000;
  for (int i = 0; i < directions; ++i) {
    const double z = 1 - (2 * i + 1.0) / directions;
    sum += kept.eval(Random::direction_at(z, i * std::numbers::pi * (3 - std::sqrt(5.0))));
  }
  EXPECT_NEAR(sum / directions, 2, 1e-3);  // evenness of the spiral
}

}  // namespace
}  // namespace likeness::brdf
