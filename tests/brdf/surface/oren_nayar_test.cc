#include "brdf/oren_nayar.h"

#include "brdf/surface_evaluators.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/hard_cases.h"
#include "tests/brdf/surface/albedo.h"

// Both forms of Oren and Nayar against the angles of their sources, at grazing angles and along the normal.
namespace likeness::brdf {
namespace {

using Long = long double;

struct Angles {
  Long theta_i, theta_o, phi;
};
Long by_angles(const OrenNayar<double>& m, const Angles& a) {
  const Long ci = std::cos(a.theta_i), co = std::cos(a.theta_o);
  const Long s = std::sin(a.theta_i) * std::sin(a.theta_o) * std::cos(a.phi), t = s > 0 ? std::max(ci, co) : 1;
  return m.base_color.g * (1 + m.sigma * s / t) /
         (std::numbers::pi_v<Long> + (std::numbers::pi_v<Long> / 2 - 2 / Long(3)) * m.sigma);
}
Long by_angles(const OrenNayar1994<double>& m, const Angles& a) {
  const Long v = Long(m.sigma) * m.sigma, big = 1 - v / (2 * (v + 0.33L)), small = 0.45L * v / (v + 0.09L);
  const Long alpha = std::max(a.theta_i, a.theta_o), beta = std::min(a.theta_i, a.theta_o);
  return m.base_color.g * (big + small * std::max(Long(0), std::cos(a.phi)) * std::sin(alpha) * std::tan(beta)) /
         std::numbers::pi_v<Long>;
}

template <class S>
class OrenNayarIn : public ::testing::Test {
 protected:
  // Through the row that takes angles, whose cosines are not rounded before they are multiplied.
  template <template <class> class M>
  double off(M<double> model, const Angles& a) {
    using Row = Surface<M>;
    model = {Rgb<double>(first(constant<S>(model.base_color.g))),
             first(constant<S>(model.sigma))};  // what S has of them
    const std::vector<double> in{double(a.theta_i),  double(a.theta_o),  double(a.phi), model.base_color.r,
                                 model.base_color.g, model.base_color.b, model.sigma};
    const auto got = evaluate_row<Row, S, std::tuple_element_t<2, typename Row::Forms>>(in);
    return relative_difference(got[1], double(by_angles(model, a)));
  }
  static constexpr double kRelative = kIsFloat<S> ? 2e-5 : 1e-12;  // the demand
};
TYPED_TEST_SUITE(OrenNayarIn, Kinds, KindNames);

TYPED_TEST(OrenNayarIn, EqualsTheFormulaInAngles) {
  Random random(1994);
  for (int i = 0; i < 20000; ++i) {
    const Angles a{random.uniform(0, 1.57), random.uniform(0, 1.57), random.uniform(-4, 7)};
    const Rgb<double> rho(random.uniform());
    const double weight = random.uniform(), angle = random.uniform(0, 1.57);
    ASSERT_LE(this->off(OrenNayar<double>{rho, weight}, a), this->kRelative) << i;     // 3e-7 and 7e-16 measured
    ASSERT_LE(this->off(OrenNayar1994<double>{rho, angle}, a), this->kRelative) << i;  // 2e-7 and 6e-16
  }
}

// Where both directions graze, s / t is large on the light's side and 1 + s vanishes on the other.
TYPED_TEST(OrenNayarIn, KeepsItsDigitsWhereBothDirectionsGraze) {
  const Long right = std::numbers::pi_v<Long> / 2;
  for (const double i : {1e-2, 1e-3, 1e-4, 1e-7})
    for (const double o : {1e-2, 1e-3, 1e-4, 1e-7})
      for (const double phi :
           {0.0, 1e-4, 0.5, 1.57, 1.5707, double(right) - 1e-6, double(right), double(right) + 1e-3, 2.0, 3.1, 3.14,
            double(std::numbers::pi_v<Long>) - 1e-4, double(std::numbers::pi_v<Long>)})
        for (const double sigma : {0.0, 0.5, 1.0}) {
          const Angles a{Long(double(right) - i), Long(double(right) - o), phi};
          // In double half of the digits of 1 - sigma s go where f falls to 1e-14 of its size.
          const double zero = sigma == 1 && phi > 3 ? 1e-6 : 0;
          EXPECT_LE(this->off(OrenNayar<double>{Rgb<double>(1), sigma}, a), this->kRelative + zero)
              << i << " " << o << " " << phi << " " << sigma;
          EXPECT_LE(this->off(OrenNayar1994<double>{Rgb<double>(1), sigma}, a), this->kRelative)
              << i << " " << o << " " << phi << " " << sigma;
        }
}

TYPED_TEST(OrenNayarIn, AlongTheNormalTheAzimuthPlaysNoPart) {
  using S = TypeParam;
  for (const double z : {1.0, 0.9, 0.2, 1e-7})
    for (const double phi : {0.0, 1.0, 2.5}) {
      const OrenNayar<double> improved{Rgb<double>(1), 0.7};
      const double want = double(1 / (std::numbers::pi_v<Long> + (std::numbers::pi_v<Long> / 2 - 2 / Long(3)) * 0.7L));
      EXPECT_LE(relative_difference(eval_in<S>(improved, at_height(z, phi), {0, 0, 1})[0], want), 2e-7);  // 2 roundings
      EXPECT_LE(relative_difference(eval_in<S>(improved, {0, 0, 1}, at_height(z, phi))[0], want), 2e-7);
      const OrenNayar1994<double> old{Rgb<double>(1), 0.7};
      const double a = double((1 - 0.49L / (2 * 0.82L)) / std::numbers::pi_v<Long>);
      EXPECT_LE(relative_difference(eval_in<S>(old, at_height(z, phi), {0, 0, 1})[0], a), 2e-7);
      EXPECT_LE(relative_difference(eval_in<S>(old, {0, 0, 1}, at_height(z, phi))[0], a), 2e-7);
    }
}

TYPED_TEST(OrenNayarIn, IsLambertWhereNothingIsRough) {
  using S = TypeParam;
  for (const Pair& pair : hard_pairs()) {
    const Lambert<double> lambert{{0.2, 0.5, 0.9}};
    const Channels want = eval_in<S>(lambert, pair.to_light, pair.to_view);
    EXPECT_EQ(eval_in<S>(OrenNayar1994<double>{lambert.base_color, 0}, pair.to_light, pair.to_view), want) << pair.name;
    const Channels improved = eval_in<S>(OrenNayar<double>{lambert.base_color, 0}, pair.to_light, pair.to_view);
    for (int c = 0; c < 3; ++c)
      EXPECT_LE(relative_difference(improved[c], want[c]), 2e-7) << pair.name;  // 1 / pi twice
  }
}

TYPED_TEST(OrenNayarIn, EndsAreFiniteAndNotNegative) {
  using S = TypeParam;
  const auto sound = [](const auto& model) {
    for (const Pair& pair : hard_pairs())
      EXPECT_TRUE(finite_and_not_negative(eval_in<S>(model, pair.to_light, pair.to_view)))
          << model.kName << ", " << pair.name;
    for (const Pair& pair : dark_pairs())
      EXPECT_EQ(eval_in<S>(model, pair.to_light, pair.to_view), (Channels{0, 0, 0}))
          << model.kName << ", " << pair.name;
  };
  for_ends_of<OrenNayar<double>>({"base_color", "sigma"}, sound);
  for_ends_of<OrenNayar1994<double>>({"base_color", "sigma"}, sound);
}

// ---- no jump where s changes its sign and where the nearer of the two cosines changes.

template <class M>
void expect_no_step(const M& model, const char* what) {
  const auto close = [&](const Vec3<double>& l0, const Vec3<double>& l1, const Vec3<double>& v, double at) {
    const double a = channels(model.eval(l0, v))[0], b = channels(model.eval(l1, v))[0];
    EXPECT_LE(std::abs(a - b), 1e-7) << what << ", at " << at;  // the step is 2e-9, the slope at most 1 / t = 20
  };
  for (const double z : {0.05, 0.3, 0.9, 1.0})
    for (const double w : {0.05, 0.3, 0.9}) {
      const Vec3<double> v = at_height(w, 0);
      close(at_height(z, std::numbers::pi / 2 - 1e-9), at_height(z, std::numbers::pi / 2 + 1e-9), v, z);  // s = 0
      close(at_height(w - 1e-9, 0.4), at_height(w + 1e-9, 0.4), v, w);                                    // t changes
    }
}
TEST(OrenNayar, HasNoJump) {
  expect_no_step(OrenNayar<double>{Rgb<double>(1), 1}, "Fujii");
  expect_no_step(OrenNayar1994<double>{Rgb<double>(1), 1.2}, "1994");
}

// ---- energy: the numbers of docs/models/oren_nayar.md and oren_nayar_1994.md.

TEST(OrenNayar, ReflectsAtMostItsColorAndAllOfItAtGrazingView) {
  for (const double sigma : {0.1, 0.5, 1.0})
    for (const double z : {1e-4, 0.05, 0.3, 0.7, 1.0})
      EXPECT_LE(albedo(OrenNayar<double>{Rgb<double>(1), sigma}, z), 1 + 2e-5) << sigma << " " << z;  // the quadrature
  EXPECT_NEAR(albedo(OrenNayar<double>{Rgb<double>(1), 1}, 1e-4), 1, 1e-3);
  EXPECT_NEAR(albedo(OrenNayar<double>{Rgb<double>(1), 1}, 1), 0.777, 6e-4);
  EXPECT_NEAR(albedo(OrenNayar<double>{Rgb<double>(1), 0.5}, 1), 0.874, 6e-4);
}
TEST(OrenNayar1994, ReflectsAsItsPageSays) {
  const auto at = [](double sigma, double z) { return albedo(OrenNayar1994<double>{Rgb<double>(1), sigma}, z); };
  EXPECT_NEAR(at(0.2, 1e-5), 1.015, 6e-4);
  EXPECT_NEAR(at(0.3, 1), 0.893, 6e-4);
  EXPECT_NEAR(at(0.5, 1), 0.785, 6e-4);
  EXPECT_NEAR(at(1, 1), 0.624, 6e-4);
  EXPECT_NEAR(at(std::numbers::pi / 2, 1), 0.559, 6e-4);
}

}  // namespace
}  // namespace likeness::brdf
