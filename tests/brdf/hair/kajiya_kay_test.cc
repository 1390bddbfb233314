#include "brdf/hair/kajiya_kay.h"

#include "brdf/hair/evaluators.h"
#include "brdf/jet.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/hair/fibre_quadrature.h"

namespace likeness::brdf {
namespace {

std::vector<double> row_of(double theta_i, double theta_o, double phi, const KajiyaKay<double>& model) {
  std::vector<double> in{theta_i, theta_o, phi};
  for (const double x : channels_of(model)) in.push_back(x);
  return in;
}
// f (3) and f_cos (3).
template <class S>
std::vector<double> values(double theta_i, double theta_o, double phi, const KajiyaKay<double>& model) {
  return evaluate_row<KajiyaKayRow, S>(row_of(theta_i, theta_o, phi, model));
}

template <class S>
class KajiyaKayKinds : public ::testing::Test {};
TYPED_TEST_SUITE(KajiyaKayKinds, Kinds, KindNames);

TYPED_TEST(KajiyaKayKinds, IsSoundInEveryHardCase) {
  using S = TypeParam;
  for (const double exponent : {0.0, 1.0, 1e5})
    for (const double shift : {-40.0, 0.0, 40.0}) {
      KajiyaKay<double> model;
      model.primary_exponent = model.secondary_exponent = model.transmission_exponent = exponent;
      model.primary_shift_deg = model.secondary_shift_deg = shift;
      for (const double a : {-std::numbers::pi / 2, -1.0, 0.0, 1e-7, std::numbers::pi / 2 - 1e-7, std::numbers::pi / 2})
        for (const double b : {-std::numbers::pi / 2, 0.0, 1.0, std::numbers::pi / 2})
          for (const double phi : {0.0, 1.0, std::numbers::pi, 2 * std::numbers::pi})
            for (const double x : values<S>(a, b, phi, model))
              ASSERT_TRUE(std::isfinite(x) && x >= 0) << exponent << " " << shift << " " << a << " " << b << " " << phi;
    }
}

TYPED_TEST(KajiyaKayKinds, AgreesWithDouble) {
  using S = TypeParam;
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const auto model = random_model<KajiyaKay<double>>(random, [](const Parameter& row) { return row.typical; });
    const double a = random.uniform(-1.5, 1.5), b = random.uniform(-1.5, 1.5),
                 phi = random.uniform(-std::numbers::pi, std::numbers::pi);
    const auto want = values<double>(a, b, phi, model), got = values<S>(a, b, phi, model);
    for (std::size_t k = 0; k < want.size(); ++k)
      ASSERT_LE(relative_difference(got[k], want[k], 1e-33), kIsFloat<S> ? 2e-5 : 1e-12) << i;
  }
}

// Each weight is the energy of its term, seen across the fibre.
TEST(KajiyaKay, WeightsAreEnergies) {
  std::vector<double> ends;
  for (int i = 0; i <= 12; ++i) ends.push_back(std::numbers::pi * (i / 12.0 - 0.5));
  const Nodes theta(ends), phi(ends);  // phi over half a turn, twice
  for (int term = 0; term < 4; ++term)
    for (const double exponent : {0.0, 1.0, 10.0, 200.0}) {
      KajiyaKay<double> model;
      model.diffuse = model.primary = model.secondary = model.transmission = Rgb<double>(0.0);
      (term == 0   ? model.diffuse
       : term == 1 ? model.primary
       : term == 2 ? model.secondary
                   : model.transmission) = Rgb<double>(1);
      model.primary_exponent = model.secondary_exponent = model.transmission_exponent = exponent;
      model.primary_shift_deg = model.secondary_shift_deg = 0;
      double sum = 0;
      for (std::size_t i = 0; i < theta.at.size(); ++i)
        for (std::size_t k = 0; k < phi.at.size(); ++k)
          for (const double half : {0.0, std::numbers::pi})
            sum += theta.weight[i] * phi.weight[k] * std::cos(theta.at[i]) *
                   values<double>(theta.at[i], 0, phi.at[k] + half, model)[3];
      EXPECT_NEAR(sum, 1,
                  term == 0       ? 1e-9
                  : exponent < 1  ? 0.024
                  : exponent < 10 ? 0.0095
                                  : 0.001)
          << term << " " << exponent;
    }
}

TEST(KajiyaKay, IsTheFormulaOfTheSlide) {
  // S = k_d + k_s cos^n(theta_r + theta_i) / cos(theta_i), with one highlight and no transmission.
  KajiyaKay<double> model;
  model.secondary = model.transmission = Rgb<double>(0.0);
  model.primary_shift_deg = 0;
  const double n = model.primary_exponent, a = 0.3, b = -0.45;
  const double k_s = 0.1 * std::sqrt(n + 1.5) / std::pow(2 * std::numbers::pi, 1.5),
               k_d = 0.2 / (std::numbers::pi * std::numbers::pi);
  EXPECT_NEAR(values<double>(a, b, 1, model)[0], k_d + k_s * std::pow(std::cos(a + b), n) / std::cos(a), 1e-15);
  // Where the mirror direction is more than a quarter turn away there is no highlight.
  EXPECT_NEAR(values<double>(0.9, 0.8, 1, model)[0], k_d, 1e-16);
}

TEST(KajiyaKay, LightFromBehindComesThroughOnlyFromBehind) {
  KajiyaKay<double> model;
  model.diffuse = model.primary = model.secondary = Rgb<double>(0.0);
  EXPECT_EQ(values<double>(0, 0, 0, model)[0], 0);
  EXPECT_GT(values<double>(0, 0, std::numbers::pi, model)[0],
            100 * values<double>(0, 0, std::numbers::pi / 2, model)[0]);
}

TEST(KajiyaKayDerivatives, AreFiniteAndThoseOfADifference) {
  using Jet = ceres::Jet<double, 17>;
  const auto jets = [](const std::vector<double>& row) {
    Jet in[20], features[KajiyaKayRow::kFeatures];
    for (std::size_t i = 0; i < 20; ++i) in[i] = Jet(row[i]);
    for (int k = 0; k < 17; ++k) in[3 + k].v[k] = 1;
    KajiyaKayRow::Form::prepare(in, features);
    std::array<Jet, 6> out;
    KajiyaKayRow::evaluate(features, out.data());
    return out;
  };
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    const auto model = random_model<KajiyaKay<double>>(random, [](const Parameter& row) { return row.typical; });
    auto row = row_of(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7),
                      random.uniform(-std::numbers::pi, std::numbers::pi), model);
    const auto out = jets(row);
    for (std::size_t k = 0; k < 17; ++k) {
      const double x = row[3 + k], step = 1e-4;
      row[3 + k] = x + step;
      const auto up = evaluate_row<KajiyaKayRow, double>(row);
      row[3 + k] = x - step;
      const auto down = evaluate_row<KajiyaKayRow, double>(row);
      row[3 + k] = x;
      for (std::size_t o = 0; o < 6; ++o) {
        const double slope = (up[o] - down[o]) / (2 * step);
        ASSERT_NEAR(out[o].v[int(k)], slope, 1e-6 * (std::abs(slope) + out[o].a)) << i << " by " << k;
      }
    }
  }
  for (const double theta : {-std::numbers::pi / 2, 0.0, std::numbers::pi / 2})
    for (const Jet& x : jets(row_of(theta, std::numbers::pi / 2, std::numbers::pi, {})))
      for (int k = 0; k < 17; ++k) EXPECT_TRUE(std::isfinite(x.v[k]));
}

}  // namespace
}  // namespace likeness::brdf
