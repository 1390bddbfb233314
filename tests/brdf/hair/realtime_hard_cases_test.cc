#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/hair/realtime_cases.h"

// Every run-time form of hair at the edges of its inputs, in every kind of scalar: no NaN, no infinity, nothing
// negative, no jump.
namespace likeness::brdf {
namespace {

template <class S>
class HairRealtime : public ::testing::Test {};
TYPED_TEST_SUITE(HairRealtime, Kinds, KindNames);

template <class F>
void for_each_row(F&& f) {
  [&]<class... E>(std::type_identity<std::tuple<E...>>) {
    (f(std::type_identity<E>{}), ...);
  }(std::type_identity<HairRealtimeEvaluators>{});
}

// Inputs of a form with the ends of every range, 0, right angles and a hair's breadth beside them over-weighted.
template <class Form>
std::vector<double> draw_edges(Random& random) {
  constexpr double kAngles[]{
      0,     std::numbers::pi / 2,       -std::numbers::pi / 2, std::numbers::pi, -std::numbers::pi, 1e-9,
      -1e-9, std::numbers::pi / 2 - 1e-7};
  std::vector<double> in;
  for (const Parameter& p : Form::kInputs)
    for (int channel = 0; channel < p.channels; ++channel) {
      const double edges[]{p.range.low, p.range.high, p.initial, std::clamp(0.0, p.range.low, p.range.high),
                           std::clamp(kAngles[random.index(std::size(kAngles))], p.range.low, p.range.high)};
      in.push_back(random.uniform() < 0.7 ? edges[random.index(std::size(edges))]
                                          : random.uniform(p.typical.low, p.typical.high));
    }
  return in;
}

template <class E, class S>
void expect_sound(const std::vector<double>& out, const std::vector<double>& in) {
  std::size_t at = 0;
  for (const Output& output : E::kOutputs)
    for (int channel = 0; channel < output.channels; ++channel, ++at) {
      // f without the cosine may pass the largest float at a pole: the cosine is held above kTiny, 1e-18.
      if (std::isfinite(out[at]) && (out[at] >= 0 || output.may_be_negative)) continue;
      std::string inputs;
      for (const double x : in) inputs += std::to_string(x) + " ";
      ADD_FAILURE() << E::kName << " " << output.name << " is " << out[at] << " at " << inputs;
    }
}

TYPED_TEST(HairRealtime, EdgesGiveNoNaN) {
  using S = TypeParam;
  for_each_row([]<class E>(std::type_identity<E>) {
    using Form = std::tuple_element_t<0, typename E::Forms>;
    Random random(1);
    for (int i = 0; i < 4000 && !::testing::Test::HasFailure(); ++i) {
      const auto in = draw_edges<Form>(random);
      expect_sound<E, S>(evaluate_row<E, S>(in), in);
      // The whole of it in S, as an engine would.
      S narrow[input_count<Form>()], out[output_count<E>()];
      for (std::size_t k = 0; k < in.size(); ++k) narrow[k] = constant<S>(in[k]);
      const void* tables = nullptr;
      if constexpr (HasTables<E>) tables = &E::tables();
      evaluate_inputs<E, Form>(tables, narrow, out);
      std::vector<double> values;
      for (const S& x : out) values.push_back(first(x));
      expect_sound<E, S>(values, in);
    }
  });
}

TYPED_TEST(HairRealtime, NoJumpAtTheAzimuthsZeroAndPi) {
  using S = TypeParam;
  for (const RealtimeFibre& a : {RealtimeFibre{}, RealtimeFibre{.beta_m = 0.1, .beta_n = 0.1, .sigma_a = 1}})
    for (const double theta_o : {0.0, 1.2}) {
      const auto far = [&]<class E>(std::type_identity<E>, double phi) {
        return evaluate_row<E, S>(
            {-theta_o + 0.1, theta_o, phi, a.sigma_a, a.sigma_a, a.sigma_a, a.beta_m, a.beta_n, 2})[3];
      };
      const auto karis = [&](double phi) {
        return evaluate_row<HairKarisRow, S>({-theta_o + 0.1, theta_o, phi, 0.5, 0.5, 0.5, 0.5, 0.3, 1, 0.03})[3];
      };
      const auto check = [&](auto&& f) {
        const double step = 1e-5;
        for (const double centre : {0.0, std::numbers::pi, -std::numbers::pi, 2 * std::numbers::pi}) {
          const double here = f(centre), before = f(centre - step), after = f(centre + step);
          EXPECT_NEAR(before, after, (kIsFloat<S> ? 3e-5 : 1e-9) * here);  // even about both
          EXPECT_NEAR(before, here, 1e-3 * here);                          // slopes of up to 1 / 0.024
        }
        EXPECT_NEAR(f(std::numbers::pi), f(-std::numbers::pi), (kIsFloat<S> ? 1e-6 : 1e-12) * f(std::numbers::pi));
      };
      check([&](double phi) { return far(std::type_identity<HairLutRow>{}, phi); });
      check([&](double phi) { return far(std::type_identity<HairLutGaussRow>{}, phi); });
      check([&](double phi) { return far(std::type_identity<HairTalkLutRow>{}, phi); });
      check([&](double phi) { return far(std::type_identity<HairClosedRow>{}, phi); });
      check(karis);
    }
}

// Absorption 1e6 leaves R alone; 0 is the limit of little.
TYPED_TEST(HairRealtime, AbsorptionGoesFromNoneToAll) {
  using S = TypeParam;
  const auto both = [&]<class E>(std::type_identity<E>) {
    const auto at = [&](double sigma_a) { return evaluate_row<E, S>({2.5, 0.3, sigma_a, 0.4}); };
    const auto none = at(0), little = at(1e-7), all = at(1e6);
    for (std::size_t p = 0; p < 4; ++p) EXPECT_NEAR(little[p], none[p], 2e-6 * none[p]);
    EXPECT_EQ(all[0], none[0]);
    for (std::size_t p = 1; p < 4; ++p) EXPECT_EQ(all[p], 0);
    double last = none[1];
    for (double sigma_a = 0.01; sigma_a < 100; sigma_a *= 1.3) {
      const double tt = at(sigma_a)[1];
      EXPECT_LE(tt, last);
      last = tt;
    }
  };
  both(std::type_identity<HairLutAzimuthRow>{});
  both(std::type_identity<HairClosedAzimuthRow>{});
}

// theta_d = 90 degrees: light and viewer at opposite ends of the fibre. All is reflected there.
TYPED_TEST(HairRealtime, AtNinetyDegreesOnlyRIsLeft) {
  using S = TypeParam;
  const auto check = [&](const std::vector<double>& n) {
    EXPECT_NEAR(n[0], 0.25 * std::cos(0.5), 0.02);  // cos(phi / 2) / 4 with F = 1
    for (std::size_t p = 1; p < 4; ++p) EXPECT_NEAR(n[p], 0, 1e-7);
  };
  const double right = std::numbers::pi / 2;
  check(evaluate_row<HairLutAzimuthRow, S>({1, 0.1, 0, right}));
  check(evaluate_row<HairClosedAzimuthRow, S>({1, 0.1, 0, right}));
}

// Roughness 0 is held at 0.01 (longitudinal) and at the tables' least width, 1e-4 in file 002's widths.
TYPED_TEST(HairRealtime, RoughnessZeroIsHeldAtItsFloor) {
  using S = TypeParam;
  const auto lut = [](double beta) {
    return evaluate_row<HairLutRow, S>({-0.3, 0.3, 0.4, 0.1, 0.1, 0.1, beta, beta, 0});
  };
  EXPECT_EQ(lut(0), lut(kHairRoughnessFloor));
  const auto karis = [](double roughness) {
    return evaluate_row<HairKarisRow, S>({-0.3, 0.3, 0.4, 0.5, 0.5, 0.5, 0.5, roughness, 1, 0});
  };
  EXPECT_EQ(karis(0), karis(0.01));
  EXPECT_GT(karis(0)[6], 10);  // at the peak, 1 / (sqrt(2 pi) 1e-4) times 0.01
}

TYPED_TEST(HairRealtime, AnglesAndVectorsNameTheSamePair) {
  using S = TypeParam;
  const auto vector = [](double theta, double phi) {
    return std::array{std::sin(theta), std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi)};
  };
  const auto check = [&]<class E>(std::type_identity<E>) {
    if constexpr (std::tuple_size_v<typename E::Forms> == 2) {
      Random random(5);
      using Axes = std::tuple_element_t<1, typename E::Forms>;
      for (int i = 0; i < 300; ++i) {
        const double theta_i = random.uniform(-1.4, 1.4), theta_o = random.uniform(-1.4, 1.4);
        const double phi_i = random.uniform(-3, 3), phi_o = random.uniform(-3, 3);
        std::vector<double> angles{theta_i, theta_o, phi_i - phi_o}, axes;
        for (const auto& v : {vector(theta_i, phi_i), vector(theta_o, phi_o)})
          axes.insert(axes.end(), v.begin(), v.end());
        for (const Parameter& p : E::kParameters)
          for (int c = 0; c < p.channels; ++c) {
            const double x = random.uniform(p.typical.low, p.typical.high);
            angles.push_back(x);
            axes.push_back(x);
          }
        const auto a = evaluate_row<E, S>(angles), b = evaluate_row<E, S, Axes>(axes);
        for (std::size_t k = 0; k < a.size(); ++k)
          EXPECT_NEAR(a[k], b[k], (kIsFloat<S> ? 1e-4 : 1e-9) * a[k] + 1e-30) << E::kName;  // far down the tails
      }
    }
  };
  for_each_row(check);
}

// Features prepared in double, then rounded.
TYPED_TEST(HairRealtime, AgreesWithDoubleToRounding) {
  using S = TypeParam;
  for_each_row([]<class E>(std::type_identity<E>) {
    using Form = std::tuple_element_t<0, typename E::Forms>;
    Random random(6);
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
      std::vector<double> in;
      for (const Parameter& p : Form::kInputs)
        for (int c = 0; c < p.channels; ++c) in.push_back(random.uniform(p.typical.low, p.typical.high));
      const auto want = evaluate_row<E, double>(in), got = evaluate_row<E, S>(in);
      // Values that no picture shows are left out: there an error is an exponent's last digit times its size.
      for (std::size_t k = 0; k < want.size(); ++k)
        worst = std::max(worst, relative_difference(got[k], want[k], kIsFloat<S> ? 1e-12 : 1e-300));
    }
    EXPECT_LE(worst, kIsFloat<S> ? 2e-5 : 1e-12) << E::kName;  // the demand
  });
}

}  // namespace
}  // namespace likeness::brdf
