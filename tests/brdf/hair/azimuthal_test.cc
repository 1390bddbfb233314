#include "brdf/hair/azimuthal.h"

#include "brdf/hair/evaluators.h"
#include "brdf/jet.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/hair/fibre_quadrature.h"

// The logistic, what happens inside a fibre, and the near field.
namespace likeness::brdf {
namespace {

template <class S>
class HairAzimuth : public ::testing::Test {};
TYPED_TEST_SUITE(HairAzimuth, Kinds, KindNames);

TEST(TrimmedLogistic, IntegratesToOneForEveryWidth) {
  for (double s = 1e-4; s < 20; s *= 1.7) {
    std::vector<double> ends{0, std::numbers::pi};
    for (double d = 2 * s; d < std::numbers::pi; d *= 2) ends.push_back(d);
    const Nodes nodes(ends);
    double sum = 0;
    for (std::size_t i = 0; i < nodes.at.size(); ++i) sum += 2 * nodes.weight[i] * trimmed_logistic(nodes.at[i], s);
    EXPECT_NEAR(sum, 1, 1e-12) << s;  // 2e-15 measured
  }
}

TYPED_TEST(HairAzimuth, TheLogisticIsSoundAtItsPeakAndFarFromIt) {
  using S = TypeParam;
  for (const double s : {1e-4, 1e-3, 0.1, 4.3, 100.0})
    for (const double x : {0.0, 1e-7, 1e-3, 1.0, std::numbers::pi}) {
      const double d = first(trimmed_logistic(constant<S>(x), constant<S>(s)));
      EXPECT_TRUE(std::isfinite(d) && d >= 0) << s << " " << x;
      if (x == 0) {
        EXPECT_NEAR(d * 4 * s * std::tanh(std::numbers::pi / (2 * s)), 1, kIsFloat<S> ? 1e-6 : 1e-14);
      }
    }
}

TYPED_TEST(HairAzimuth, LogisticSamplesAreTheInverseOfItsIntegral) {
  using S = TypeParam;
  for (const double s : {1e-3, 0.05, 0.4, 4.0, 100.0}) {
    double before = -4;
    for (const double u : {0.0, 1e-7, 0.01, 0.3, 0.5, 0.8, 0.99, 1 - 0x1p-24}) {
      const double x = first(sample_trimmed_logistic(constant<S>(s), constant<S>(u)));
      EXPECT_LE(std::abs(x), std::numbers::pi * (1 + 1e-7));
      EXPECT_GE(x, before) << s << " " << u;
      before = x;
      const double integral = 0.5 + 0.5 * std::tanh(x / (2 * s)) / std::tanh(std::numbers::pi / (2 * s));
      EXPECT_NEAR(integral, u, kIsFloat<S> ? 2e-6 : 1e-14) << s << " " << u;
    }
  }
}

// ---- inside the fibre

TYPED_TEST(HairAzimuth, WhatIsReflectedAndWhatEntersAddUpToOne) {
  using S = TypeParam;
  for (const double eta : {1.0, 1 + 1e-7, 1.0001, 1.3, 1.55, 3.0})
    for (const double cos_theta : {0.0, 1e-7, 1e-3, 0.5, 1.0})
      for (const double h : {-1.0, -0.999999, -0.3, 0.0, 0.7, 1.0}) {
        const auto path = fibre_path(constant<S>(h), constant<S>(cos_theta), constant<S>(eta));
        const double f = first(path.reflected), g = first(path.transmitted), chord = first(path.chord);
        EXPECT_NEAR(f + g, 1, kIsFloat<S> ? 1e-6 : 4e-15) << eta << " " << cos_theta << " " << h;
        EXPECT_TRUE(f >= 0 && g >= 0);
        EXPECT_TRUE(std::isfinite(chord) && chord >= 0) << eta << " " << cos_theta << " " << h;
        EXPECT_LE(std::abs(first(path.gamma_t)), std::abs(first(path.gamma_i)) * (1 + 1e-6));  // towards the axis
      }
}

// eta 1: the light goes straight on, whatever the inclination.
TYPED_TEST(HairAzimuth, AFibreOfAirIsNotThere) {
  using S = TypeParam;
  for (const double cos_theta : {0.0, 1e-6, 0.5, 1.0})
    for (const double h : {-1.0, 0.0, 0.6}) {
      const auto path = fibre_path(constant<S>(h), constant<S>(cos_theta), S(1));
      EXPECT_EQ(first(path.reflected), 0);
      EXPECT_NEAR(first(path.gamma_t), first(path.gamma_i), 1e-6);
      const auto a = hair_attenuations(path.reflected, path.transmitted, S(0));
      EXPECT_NEAR(first(a[1]), 1, 1e-6);
    }
}

TYPED_TEST(HairAzimuth, WithoutAbsorptionTheLobesShareAllLight) {
  using S = TypeParam;
  for (const double f : {0.0, 1e-12, 0.04, 0.5, 1 - 1e-7, 1.0}) {
    const auto a = hair_attenuations(constant<S>(f), constant<S>(1 - f), S(0));
    EXPECT_NEAR(first(a[0]) + first(a[1]) + first(a[2]) + first(a[3]), 1, kIsFloat<S> ? 2e-7 : 4e-16) << f;
    EXPECT_TRUE(std::isfinite(first(a[3])) && first(a[3]) >= 0);
  }
}

TYPED_TEST(HairAzimuth, TheLongerPathsAreTheSumOfTheirSeries) {
  using S = TypeParam;
  for (const double f : {0.0, 0.04, 0.5, 0.9})
    for (const double depth : {0.0, 1e-3, 0.4, 5.0}) {
      const double t = std::exp(-depth);
      double sum = 0;
      for (int p = 3; p < 2000; ++p) sum += (1 - f) * (1 - f) * std::pow(f, p - 1) * std::pow(t, p);
      const auto a = hair_attenuations(constant<S>(f), constant<S>(1 - f), constant<S>(depth));
      EXPECT_LE(relative_difference(first(a[3]), sum, 1e-300), kIsFloat<S> ? 2e-6 : 1e-13) << f << " " << depth;
    }
}

TYPED_TEST(HairAzimuth, AbsorptionLeavesOnlyTheReflection) {
  using S = TypeParam;
  for (const double f : {0.0, 0.04, 1.0}) {
    const auto a = hair_attenuations(constant<S>(f), constant<S>(1 - f), constant<S>(1e6));
    EXPECT_EQ(first(a[0]), first(constant<S>(f)));
    for (int p = 1; p < kHairLobes; ++p) EXPECT_EQ(first(a[std::size_t(p)]), 0);
  }
}

// ---- the near field

std::vector<double> near_row(double p, double phi, double h, double s, double sigma_a, double eta, double theta) {
  return {p, phi, h, s, sigma_a, eta, theta};
}

TYPED_TEST(HairAzimuth, TheNearFieldIsSoundWhereverItsInputsAreAllowed) {
  using S = TypeParam;
  for (const double p : {0.0, 1.0, 2.0, 3.0})
    for (const double h : {-1.0, -1 + 1e-7, 0.0, 1e-9, 0.5, 1.0})
      for (const double theta : {-std::numbers::pi / 2, -1.5, 0.0, std::numbers::pi / 2 - 1e-7, std::numbers::pi / 2})
        for (const double sigma_a : {0.0, 0.3, 1e6})
          for (const double eta : {1.0, 1.0001, 1.55})
            for (const double s : {1e-3, 0.2, 4.3})
              for (const double phi : {-2 * std::numbers::pi, -std::numbers::pi, 0.0, 1.0, std::numbers::pi}) {
                const auto n = evaluate_row<HairNear, S>(near_row(p, phi, h, s, sigma_a, eta, theta));
                ASSERT_TRUE(std::isfinite(n[0]) && n[0] >= 0)
                    << p << " " << phi << " " << h << " " << s << " " << sigma_a << " " << eta << " " << theta;
                // In the lanes' own precision from the start, as an engine runs it.
                S in[7], features[HairNear::kFeatures], out[1];
                const auto row = near_row(p, phi, h, s, sigma_a, eta, theta);
                for (std::size_t i = 0; i < 7; ++i) in[i] = constant<S>(row[i]);
                HairNear::Form::prepare(in, features);
                HairNear::evaluate(features, out);
                ASSERT_TRUE(std::isfinite(first(out[0])) && first(out[0]) >= 0)
                    << p << " " << phi << " " << h << " " << s << " " << sigma_a << " " << eta << " " << theta;
              }
}

double near_field(double p, double phi, double h, double s, double theta) {
  return evaluate_row<HairNear, double>(near_row(p, phi, h, s, 0.2, 1.55, theta))[0];
}

TEST(HairNearField, IsTheSameAfterAWholeTurnAndMirrored) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const double p = double(random.index(4)), phi = random.uniform(-std::numbers::pi, std::numbers::pi),
                 h = random.uniform(-1, 1), s = random.uniform(0.05, 1), theta = random.uniform(-1.5, 1.5);
    const double n = near_field(p, phi, h, s, theta);
    EXPECT_LE(relative_difference(n, near_field(p, phi + 2 * std::numbers::pi, h, s, theta)), 1e-12);
    EXPECT_LE(relative_difference(n, near_field(p, phi - 2 * std::numbers::pi, h, s, theta)), 1e-12);
    EXPECT_LE(relative_difference(n, near_field(p, -phi, -h, s, theta)), 1e-12);
    EXPECT_LE(relative_difference(n, near_field(p, phi, h, s, -theta)), 1e-12);
  }
}

// Half a turn from the peak the distance turns back, and near grazing the reflectance rises to 1: nothing jumps.
TEST(HairNearField, DoesNotJumpInAzimuthOrOffset) {
  for (const double p : {0.0, 1.0, 2.0, 3.0})
    for (const double s : {0.1, 0.5}) {
      double before = near_field(p, -2 * std::numbers::pi, 0.3, s, 0.4);
      for (double phi = -2 * std::numbers::pi; phi < 2 * std::numbers::pi; phi += 1e-3) {
        const double here = near_field(p, phi, 0.3, s, 0.4);
        EXPECT_LE(relative_difference(here, before), 1.01e-3 / s);  // |D'| <= D / s
        before = here;
      }
      before = near_field(p, 1, -1, s, 0.4);
      for (double gamma = -std::numbers::pi / 2; gamma < std::numbers::pi / 2; gamma += 1e-4) {
        const double here = near_field(p, 1, std::sin(gamma), s, 0.4);
        EXPECT_LE(std::abs(here - before), 2e-4 / (s * s)) << p << " " << gamma;
        before = here;
      }
    }
}

TEST(HairNearDerivatives, AreFiniteAndThoseOfADifference) {
  using Jet = ceres::Jet<double, 3>;  // by s, sigma_a and eta
  const auto jet_of = [](const std::vector<double>& row) {
    Jet in[7], features[HairNear::kFeatures], out[1];
    for (std::size_t i = 0; i < 7; ++i) in[i] = Jet(row[i]);
    for (int i = 0; i < 3; ++i) in[3 + i].v[i] = 1;
    HairNear::Form::prepare(in, features);
    HairNear::evaluate(features, out);
    return out[0];
  };
  Random random(4);
  for (int i = 0; i < 3000; ++i) {
    auto row = near_row(double(random.index(4)), random.uniform(-std::numbers::pi, std::numbers::pi),
                        random.uniform(-0.99, 0.99), random.uniform(0.1, 1), random.uniform(0.01, 2),
                        random.uniform(1.2, 1.8), random.uniform(-1.4, 1.4));
    const Jet n = jet_of(row);
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = row[3 + k], step = 1e-5;
      const auto at = [&](double there) {
        row[3 + k] = there;
        return evaluate_row<HairNear, double>(row)[0];
      };
      const double slope = (at(x + step) - at(x - step)) / (2 * step);
      row[3 + k] = x;
      const auto path = fibre_path(row[2], std::cos(row[6]), row[5]);
      const double distance = azimuth_distance(row[0], row[1], path.gamma_i, path.gamma_t);
      if (distance < 1e-3 || distance > std::numbers::pi - 1e-3) continue;  // |x| has a kink at the peak and at the cut
      EXPECT_NEAR(n.v[int(k)], slope, 1e-5 * (std::abs(slope) + n.a)) << i << " by " << k;
    }
  }
  for (const double p : {0.0, 1.0, 2.0, 3.0})
    for (const double h : {-1.0, 0.0, 1.0})
      for (const double theta : {0.0, std::numbers::pi / 2})
        for (const double sigma_a : {0.0, 1e6})
          for (const double eta : {1.0, 1.55}) {
            const Jet n = jet_of(near_row(p, 0.5, h, 0.2, sigma_a, eta, theta));
            for (int k = 0; k < 3; ++k)
              EXPECT_TRUE(std::isfinite(n.v[k]))
                  << p << " " << h << " " << theta << " " << sigma_a << " " << eta << " by " << k;
          }
}

}  // namespace
}  // namespace likeness::brdf
