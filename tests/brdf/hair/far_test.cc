#include "brdf/hair/far.h"

#include "brdf/hair/evaluators.h"
#include "brdf/jet.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/hair/fibre_quadrature.h"

// The far field by adaptive quadrature, against the near field summed by brute force.
namespace likeness::brdf {
namespace {

struct Far {
  int p;
  double phi, s, sigma_a, eta, theta;
  double at(double tolerance = 1e-9) const { return hair_far(p, phi, s, sigma_a, eta, std::cos(theta), tolerance); }
  // The midpoint rule over gamma, h = sin gamma.
  double by_brute_force(int steps) const {
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double gamma = std::numbers::pi * ((i + 0.5) / steps - 0.5);
      const double row[]{double(p), phi, std::sin(gamma), s, sigma_a, eta, theta};
      double features[HairNear::kFeatures], out[1];
      HairNear::Form::prepare(row, features);
      HairNear::evaluate(features, out);
      sum += out[0] * std::cos(gamma);
    }
    return 0.5 * sum * std::numbers::pi / steps;
  }
};
std::ostream& operator<<(std::ostream& out, const Far& f) {
  return out << "p " << f.p << ", phi " << f.phi << ", s " << f.s << ", sigma_a " << f.sigma_a << ", eta " << f.eta
             << ", theta " << f.theta;
}

TEST(HairFar, IsTheMeanOfTheNearFieldOverTheWidth) {
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    const Far far{int(random.index(4)),     random.uniform(-std::numbers::pi, std::numbers::pi),
                  random.uniform(0.02, 1),  random.uniform(0, 2),
                  random.uniform(1.1, 2.5), random.uniform(-1.5, 1.5)};
    // The midpoint rule does not see the cut: 3e-7 of the peak at 40000 steps.
    EXPECT_NEAR(far.at(), far.by_brute_force(40000), 1e-6 * (far.at() + 0.01)) << far;
  }
}

// At every tolerance the error is within it. What is held to be true is the same quadrature at 1e-13, which 40 digits
// confirm to 1e-15 on the rows of hair_far.csv.
TEST(HairFar, IsAsExactAsItIsAskedToBe) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    const Far far{int(random.index(3)),
                  random.uniform(-std::numbers::pi, std::numbers::pi),
                  std::pow(10, random.uniform(-3, 0.3)),
                  random.uniform() < 0.3 ? 0 : std::pow(10, random.uniform(-2, 2)),
                  random.uniform(1.05, 2.2),
                  random.uniform(-1.5, 1.5)};
    const double want = far.at(1e-13);
    for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-11})
      EXPECT_LE(relative_difference(far.at(tolerance), want, 1e-290), tolerance) << far;
  }
}

// phi at, just inside and just outside of the caustic of TRT, where Phi turns back.
TEST(HairFar, HoldsAtTheCausticOfTrt) {
  for (const double theta : {0.0, 0.7}) {
    const double eta = 1.55, ratio = std::cos(theta) / std::sqrt(eta * eta - std::pow(std::sin(theta), 2));
    const double h = std::sqrt((4 - 1 / (ratio * ratio)) / 3);
    const double caustic = 4 * std::asin(h * ratio) - 2 * std::asin(h) + 2 * std::numbers::pi;
    for (const double s : {1e-3, 0.01, 0.1})
      for (const double off : {-0.1, -1e-4, 0.0, 1e-9, 1e-4, 0.1}) {
        const Far far{2, caustic + off, s, 0.1, eta, theta};
        EXPECT_LE(relative_difference(far.at(), far.at(1e-13), 1e-290), 1e-9) << far;
        EXPECT_LE(relative_difference(far.at(), far.by_brute_force(200000), 1e-290), 1e-5) << far;
      }
  }
}

TEST(HairFar, WithoutAbsorptionAllLobesTogetherSendOutAllLight) {
  for (const double eta : {1.0, 1.3, 1.55, 2.4})
    for (const double theta : {0.0, 1.0, 1.5})
      for (const double s : {0.05, 0.4}) {
        // Even panels over phi, fine enough for the peaks; the far field is as smooth as its logistic.
        std::vector<double> ends;
        for (int i = 0; i <= 60; ++i) ends.push_back(-std::numbers::pi + i * std::numbers::pi / 30);
        const Nodes nodes(ends);
        double sum = 0;
        for (std::size_t i = 0; i < nodes.at.size(); ++i)
          for (int p = 0; p < kHairLobes; ++p) sum += nodes.weight[i] * Far{p, nodes.at[i], s, 0, eta, theta}.at(1e-8);
        EXPECT_NEAR(sum, 1, 1e-6) << eta << " " << theta << " " << s;  // 60 panels at s = 0.05, eta = 1
      }
}

TEST(HairFar, IsSoundWhereverItsInputsAreAllowed) {
  for (int p = 0; p < kHairLobes; ++p)
    for (const double phi : {-2 * std::numbers::pi, -std::numbers::pi, 0.0, 1e-9, 1.0, std::numbers::pi})
      for (const double s : {1e-3, 0.2, 10.0})
        for (const double sigma_a : {0.0, 1e-3, 100.0, 1e6})
          for (const double eta : {1.0, 1.0001, 1.55, 2.0, 3.0})
            for (const double theta : {0.0, 1.5, std::numbers::pi / 2 - 1e-7, std::numbers::pi / 2}) {
              const Far far{p, phi, s, sigma_a, eta, theta};
              const double n = far.at(1e-6);
              ASSERT_TRUE(std::isfinite(n) && n >= 0) << far;
              const auto in_float = evaluate_row<HairFar, float>({double(p), phi, s, sigma_a, eta, theta, 1e-6});
              ASSERT_TRUE(std::isfinite(in_float[0]) && in_float[0] >= 0) << far;
              ASSERT_TRUE(p == 0 || eta == 1 || sigma_a < 1e6 || n == 0) << far;  // eta 1: the chord is 0 at h = +-1
            }
}

// Inputs that mean nothing end as quickly as others do.
TEST(HairFar, EndsForEveryInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (int p = 0; p < kHairLobes; ++p)
    for (const double bad : {nan, inf, -inf, 0.0, -1.0, 1e300}) {
      (void)Far{p, bad, 0.2, 0.2, 1.55, 0.1}.at();
      (void)Far{p, 0.5, bad, 0.2, 1.55, 0.1}.at();
      (void)Far{p, 0.5, 0.2, bad, 1.55, 0.1}.at();
      (void)Far{p, 0.5, 0.2, 0.2, bad, 0.1}.at();
      (void)hair_far(p, 0.5, 0.2, 0.2, 1.55, bad);
      (void)Far{p, 0.5, 0.2, 0.2, 1.55, 0.1}.at(bad);
    }
}

TEST(HairFar, IsTheSameAfterAWholeTurnAndMirrored) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    Far far{int(random.index(3)),
            random.uniform(-std::numbers::pi, std::numbers::pi),
            random.uniform(0.05, 1),
            0.3,
            1.55,
            0.4};
    const double n = far.at();
    far.phi += 2 * std::numbers::pi;
    EXPECT_LE(relative_difference(n, far.at()), 2e-9);
    far.phi = 2 * std::numbers::pi - far.phi;
    EXPECT_LE(relative_difference(n, far.at()), 2e-9);
  }
}

TEST(HairFarDerivatives, AreThoseOfADifference) {
  using Jet = ceres::Jet<double, 3>;
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const int p = int(random.index(4));
    const double phi = random.uniform(-std::numbers::pi, std::numbers::pi), cos_theta = random.uniform(0.1, 1);
    std::array<double, 3> x{random.uniform(0.1, 0.8), random.uniform(0.01, 2), random.uniform(1.2, 1.8)};
    const Jet n = hair_far(p, Jet(phi), Jet(x[0], 0), Jet(x[1], 1), Jet(x[2], 2), Jet(cos_theta), 1e-12);
    for (std::size_t k = 0; k < 3; ++k) {
      const double middle = x[k], step = 1e-5;
      const auto at = [&](double there) {
        x[k] = there;
        return hair_far(p, phi, x[0], x[1], x[2], cos_theta, 1e-13);
      };
      const double slope = (at(middle + step) - at(middle - step)) / (2 * step);
      x[k] = middle;
      EXPECT_NEAR(n.v[int(k)], slope, 3e-6 * (std::abs(slope) + n.a)) << p << " " << phi << " by " << k;
    }
  }
  for (int p = 0; p < kHairLobes; ++p)
    for (const double sigma_a : {0.0, 1e6})
      for (const double eta : {1.0, 1.55})
        for (const double cos_theta : {0.0, 1.0}) {
          const Jet n = hair_far(p, Jet(0.5), Jet(0.2, 0), Jet(sigma_a, 1), Jet(eta, 2), Jet(cos_theta), 1e-6);
          for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(n.v[k])) << p << " " << sigma_a << " " << eta;
        }
}

}  // namespace
}  // namespace likeness::brdf
