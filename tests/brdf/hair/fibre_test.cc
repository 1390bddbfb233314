#include "brdf/hair/fibre.h"

#include "brdf/hair/evaluators.h"
#include "brdf/jet.h"
#include "tests/brdf/evaluator_row.h"

// The whole fibre: hard cases in every scalar, derivatives, tilt, and that its forms agree.
namespace likeness::brdf {
namespace {

struct Place {
  double theta_i, theta_o, phi, h;
};
template <class Form = HairFibreRow::Angles>
std::vector<double> row_of(const Place& at, const HairFibre<double>& fibre) {
  std::vector<double> in{at.theta_i, at.theta_o, at.phi, at.h};
  for (const double x : channels_of(fibre)) in.push_back(x);
  return in;
}
template <class S>
std::vector<double> values(const Place& at, const HairFibre<double>& fibre) {
  return evaluate_row<HairFibreRow, S>(row_of(at, fibre));
}

template <class S>
class HairFibreKinds : public ::testing::Test {};
TYPED_TEST_SUITE(HairFibreKinds, Kinds, KindNames);

TYPED_TEST(HairFibreKinds, IsSoundInEveryHardCase) {
  using S = TypeParam;
  const double pole = std::numbers::pi / 2;
  for (const double beta_m : {0.0, 0.05, 1.0})
    for (const double beta_n : {0.0, 0.3, 1.0})
      for (const double sigma_a : {0.0, 1e6})
        for (const double eta : {1.0, 1.55})
          for (const double tilt : {-20.0, 0.0, 3.0}) {
            HairFibre<double> fibre;
            fibre.beta_m = beta_m;
            fibre.beta_n = beta_n;
            fibre.sigma_a = Rgb<double>(sigma_a);
            fibre.eta = eta;
            fibre.tilt_deg = tilt;
            for (const double a : {-pole, -0.5, 0.0, pole - 1e-7, pole})
              for (const double b : {-pole, 0.0, 0.5, pole - 1e-7, pole})
                for (const double h : {-1.0, 0.0, 1.0})
                  for (const double phi : {0.0, 1.0, std::numbers::pi}) {
                    for (const double x : values<S>({a, b, phi, h}, fibre))
                      ASSERT_TRUE(std::isfinite(x) && x >= 0)
                          << x << " at " << beta_m << " " << beta_n << " " << sigma_a << " " << eta << " " << tilt
                          << ": " << a << " " << b << " " << h << " " << phi;
                    // With everything rounded before it starts, as an engine has it.
                    const auto row = row_of({a, b, phi, h}, fibre);
                    S in[11], features[HairFibreRow::kFeatures], out[7];
                    for (std::size_t i = 0; i < 11; ++i) in[i] = constant<S>(row[i]);
                    HairFibreRow::Angles::prepare(in, features);
                    HairFibreRow::evaluate(features, out);
                    for (const S& x : out) ASSERT_TRUE(std::isfinite(first(x)) && first(x) >= 0);
                  }
          }
}

TYPED_TEST(HairFibreKinds, AgreesWithDouble) {
  using S = TypeParam;
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const auto fibre = random_model<HairFibre<double>>(random, [](const Parameter& row) { return row.typical; });
    const Place at{random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5),
                   random.uniform(-std::numbers::pi, std::numbers::pi), random.uniform(-1, 1)};
    const auto want = values<double>(at, fibre), got = values<S>(at, fibre);
    for (std::size_t k = 0; k < want.size(); ++k)
      ASSERT_LE(relative_difference(got[k], want[k], 1e-33), kIsFloat<S> ? 2e-5 : 1e-12) << i << " output " << k;
  }
}

TEST(HairFibreForms, AreOneAnother) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const auto fibre = random_model<HairFibre<double>>(random, [](const Parameter& row) { return row.typical; });
    const Place at{random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5),
                   random.uniform(-std::numbers::pi, std::numbers::pi), random.uniform(-1, 1)};
    const auto direction = [](double theta, double phi) {
      return Vec3<double>{std::sin(theta), std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi)};
    };
    const double turned =
        random.uniform(-std::numbers::pi, std::numbers::pi);  // only the difference of azimuths matters
    const Vec3<double> light = direction(at.theta_i, at.phi + turned), view = direction(at.theta_o, turned);
    std::vector<double> axes{light.x, light.y, light.z, view.x, view.y, view.z, at.h};
    for (const double x : channels_of(fibre)) axes.push_back(x);
    const auto want = values<double>(at, fibre), got = evaluate_row<HairFibreRow, double, HairFibreRow::Axes>(axes);
    for (std::size_t k = 0; k < want.size(); ++k) ASSERT_LE(relative_difference(got[k], want[k], 1e-100), 1e-9) << i;
    const Rgb<double> f = fibre.eval(light, view, at.h);
    EXPECT_LE(relative_difference(f.g, want[1], 1e-100), 1e-9);
    EXPECT_LE(relative_difference(f.g * std::cos(at.theta_i), want[4], 1e-100), 1e-9);
    EXPECT_LE(relative_difference(fibre.pdf(light, view, at.h), want[6], 1e-100), 1e-9);
  }
}

TEST(HairFibreForms, HaveASumOfTheirLobesAsTheirValue) {
  HairFibre<double> fibre;
  fibre.tilt_deg = 0;
  const Place at{0.3, -0.5, 2.0, 0.4};
  double sum = 0;
  const double v = hair_variance(0.3);
  for (int p = 0; p < kHairLobes; ++p) {
    const double m = evaluate_row<HairMp, double>({p == 0 ? v : p == 1 ? v / 4 : 4 * v, at.theta_i, at.theta_o})[0];
    sum += m * evaluate_row<HairNear, double>({double(p), at.phi, at.h, hair_width(0.3), 0.2, 1.55, at.theta_o})[0];
  }
  EXPECT_LE(relative_difference(values<double>(at, fibre)[3], sum), 1e-14);
}

// R alone (everything else absorbed), seen as light moves along the fibre: its peak lies where the page says.
TEST(HairTilt, MovesRTowardsTheRootByTwiceItsAngle) {
  for (const double tilt : {0.0, 2.0, 5.0}) {
    HairFibre<double> fibre;
    fibre.sigma_a = Rgb<double>(1e6);
    fibre.beta_m = 0.1;
    fibre.tilt_deg = tilt;
    double best = 0, where = 0;
    for (double theta_i = -0.6; theta_i < 0.4; theta_i += 1e-4) {
      const double f = values<double>({theta_i, 0.1, 0, 0}, fibre)[3];
      if (f > best) {
        best = f;
        where = theta_i;
      }
    }
    EXPECT_NEAR(where + 0.1, -2 * tilt * std::numbers::pi / 180, 1.5e-3) << tilt;  // the cosines skew M: 1e-3 measured
  }
}
TEST(HairTilt, MovesTtAndTrtTowardsTheTip) {
  HairFibre<double> fibre;
  fibre.sigma_a = Rgb<double>(0.0);
  fibre.beta_m = 0.1;
  fibre.tilt_deg = 2;
  // TT straight behind (phi = pi); TRT at h = 0.9, at the azimuth it leaves by.
  const FibrePath<double> path = fibre_path(0.9, 1.0, 1.55);
  const double trt = 4 * path.gamma_t - 2 * path.gamma_i + 2 * std::numbers::pi;
  for (const auto& [phi, h, shift] : {std::tuple{std::numbers::pi, 0.0, 1.0}, {trt, 0.9, 4.0}}) {
    double best = 0, where = 0;
    for (double theta_i = -0.4; theta_i < 0.4; theta_i += 1e-4) {
      const double f = values<double>({theta_i, 0, phi, h}, fibre)[3];
      if (f > best) {
        best = f;
        where = theta_i;
      }
    }
    EXPECT_NEAR(where, shift * 2 * std::numbers::pi / 180, 0.01)
        << shift;  // a little of the other lobes is below the peak
  }
}

TEST(HairRoughness, IsHeldAtItsFloorAndGrowsAboveIt) {
  EXPECT_EQ(hair_variance(0.0), hair_variance(0.01));
  EXPECT_EQ(hair_width(0.0), hair_width(0.01));
  EXPECT_NEAR(hair_variance(1.0), std::pow(0.726 + 0.812 + 3.7, 2), 1e-12);
  EXPECT_NEAR(hair_width(1.0), std::sqrt(std::numbers::pi / 8) * (0.265 + 1.194 + 5.372), 1e-12);
  EXPECT_NEAR(hair_variance(0.5), std::pow(0.726 * 0.5 + 0.812 * 0.25 + 3.7 * std::pow(0.5, 20), 2), 1e-15);
  EXPECT_NEAR(hair_width(0.5),
              std::sqrt(std::numbers::pi / 8) * (0.265 * 0.5 + 1.194 * 0.25 + 5.372 * std::pow(0.5, 22)), 1e-15);
  for (double b = 0.01; b < 1; b += 0.01) {
    EXPECT_GT(hair_variance(b + 0.01), hair_variance(b));
    EXPECT_GT(hair_width(b + 0.01), hair_width(b));
  }
}

// ---- derivatives by every parameter: sigma_a (3), eta, beta_m, beta_n, tilt_deg

using FibreJet = ceres::Jet<double, 7>;
std::array<FibreJet, 7> jets(const Place& at, const HairFibre<double>& fibre) {
  const auto row = row_of(at, fibre);
  FibreJet in[11], features[HairFibreRow::kFeatures];
  for (std::size_t i = 0; i < 11; ++i) in[i] = FibreJet(row[i]);
  for (int k = 0; k < 7; ++k) in[4 + k].v[k] = 1;
  HairFibreRow::Angles::prepare(in, features);
  std::array<FibreJet, 7> out;
  HairFibreRow::evaluate(features, out.data());
  return out;
}

TEST(HairFibreDerivatives, AreThoseOfADifference) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    auto fibre = random_model<HairFibre<double>>(random, [](const Parameter& row) -> Interval {
      if (row.name == "sigma_a") return {0.05, 2};
      if (row.name == "beta_m" || row.name == "beta_n") return {0.2, 0.8};
      return row.typical;
    });
    const Place at{random.uniform(-1.3, 1.3), random.uniform(-1.3, 1.3),
                   random.uniform(-std::numbers::pi, std::numbers::pi), random.uniform(-0.98, 0.98)};
    const auto out = jets(at, fibre);
    for (std::size_t k = 0; k < 7; ++k) {
      const double step = k == 6 ? 1e-3 : 1e-5;
      const auto shifted = [&](double by) {
        auto row = row_of(at, fibre);
        row[4 + k] += by;
        return evaluate_row<HairFibreRow, double>(row);
      };
      const auto up = shifted(step), down = shifted(-step);
      for (std::size_t o = 0; o < 7; ++o) {
        const double slope = (up[o] - down[o]) / (2 * step);
        // The cut half a turn from a peak is a kink in eta; its slope there is exp(-pi / s) / s^2 of the lobe.
        ASSERT_NEAR(out[o].v[int(k)], slope, 2e-4 * (std::abs(slope) + out[o].a)) << i << " by " << k << " of " << o;
      }
    }
  }
}

TEST(HairFibreDerivatives, AreFiniteInTheHardCases) {
  for (const double beta : {0.0, 0.3, 1.0})
    for (const double sigma_a : {0.0, 1e6})
      for (const double eta : {1.0, 1.55})
        for (const double theta_i : {-std::numbers::pi / 2, 0.0, 1.2})
          for (const double theta_o : {-1.2, 0.0, std::numbers::pi / 2 - 1e-7, std::numbers::pi / 2})
            for (const double h : {-1.0, 0.0, 1.0}) {
              HairFibre<double> fibre;
              fibre.beta_m = fibre.beta_n = beta;
              fibre.sigma_a = Rgb<double>(sigma_a);
              fibre.eta = eta;
              for (const FibreJet& x : jets({theta_i, theta_o, 0.5, h}, fibre))
                for (int k = 0; k < 7; ++k)
                  ASSERT_TRUE(std::isfinite(x.v[k])) << beta << " " << sigma_a << " " << eta << " " << theta_i << " "
                                                     << theta_o << " " << h << " by " << k;
            }
}

}  // namespace
}  // namespace likeness::brdf
