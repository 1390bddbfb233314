#include "brdf/jet.h"

#include "tests/brdf/hard_cases.h"
#include "tests/brdf/kinds.h"

// Automatic derivatives: equal to a central difference in long double inside the range, finite at its edges.
namespace likeness::brdf {

template <class T, int N>
struct First<ceres::Jet<T, N>> {
  static double of(const ceres::Jet<T, N>& x) { return first(x.a); }
};

namespace {

template <class T>
using Dual = ceres::Jet<T, 1>;

// f and its derivative by channel `k` of the parameters, in T.
struct Slope {
  Channels value, slope;
};
template <class T, template <class> class M>
Slope slope_in(const M<double>& model, const Geometry<double>& g, std::size_t k) {
  auto values = channels_of(model_in<Dual<T>>(model));
  values[k].v[0] = T(1);
  const Rgb<Dual<T>> f = model_from_channels<M, Dual<T>>(values.data()).eval(geometry_in<T>(g));
  return {channels(f), {first(f.r.v[0]), first(f.g.v[0]), first(f.b.v[0])}};
}
// The same in float, with directions rounded to float first.
template <class T, template <class> class M>
Slope slope_in(const M<double>& model, const Pair& pair, std::size_t k) {
  auto values = channels_of(model_in<Dual<T>>(model));
  values[k].v[0] = T(1);
  const Geometry<T> g(vector_in<T>(pair.to_light), vector_in<T>(pair.to_view));
  const Rgb<Dual<T>> f = model_from_channels<M, Dual<T>>(values.data()).eval(g);
  return {channels(f), {first(f.r.v[0]), first(f.g.v[0]), first(f.b.v[0])}};
}

using Precise = std::array<long double, 3>;
template <template <class> class M>
Precise precise(const M<double>& model, const Geometry<double>& g, std::size_t k, long double step) {
  auto values = channels_of(model_in<long double>(model));
  values[k] += step;
  const auto f = model_from_channels<M, long double>(values.data()).eval(Geometry<long double>(g));
  return {f.r, f.g, f.b};
}

// Where a formula changes its branch the derivative has two values; a difference across it is neither.
template <std::derived_from<Callisto<double>> M>
bool near_a_kink(const M& m, const Geometry<double>& g) {
  const double cube_d = g.versine_d * g.versine_d * g.versine_d, cube_h = g.versine_h * g.versine_h * g.versine_h;
  const double end = m.smooth_terminator_length * (1 - cube_d) * (1 - cube_h);
  return std::abs(m.roughness * m.dual_specular_roughness_scale - 1) < 1e-4 ||
         std::abs(m.specular_fresnel_falloff - 0.5) < 1e-4 || std::abs(end - g.cos_i) < 1e-4;
}
bool near_a_kink(const auto& m, const Geometry<double>& g) {
  constexpr bool kHasSigma = requires { m.sigma; };  // Oren and Nayar: the sign of s, and which cosine is the larger
  return kHasSigma && (std::abs(g.cos_vl - g.cos_i * g.cos_o) < 1e-4 || std::abs(g.cos_i - g.cos_o) < 1e-4);
}

// Scales, tints and mixes enter as polynomials: their ends are ordinary points. Shapes, and the color that a hue is
// taken from, stay inside; roughness above 0.15, where D's third derivative is small against the step.
Interval smooth_part(Random& random, const Parameter& row) {
  const double width = row.range.high - row.range.low;
  if (row.role == Role::kShape || row.name == "base_color")
    return {row.range.low + (row.name == "roughness" ? 0.15 : 0.02) * width, row.range.high - 0.02 * width};
  switch (random.index(4)) {
    case 0:
      return {row.range.low, row.range.low};
    case 1:
      return {row.range.high, row.range.high};
    default:
      return row.range;
  }
}

template <class M>
class DerivativeOf : public ::testing::Test {};
TYPED_TEST_SUITE(DerivativeOf, TypesOf<AnyBrdf>::Type, ModelNames);

TYPED_TEST(DerivativeOf, EveryParameterEqualsTheCentralDifference) {
  Random random(8);
  for (int i = 0; i < 1000; ++i) {
    const auto model = random_model<TypeParam>(random, [&](const Parameter& row) { return smooth_part(random, row); });
    const Geometry<double> g(random.direction(0.01), random.direction(0.01));
    if (near_a_kink(model, g)) continue;
    const Channels value = channels(model.eval(g));
    for (std::size_t k = 0; k < channels_of(model).size(); ++k) {
      const Slope got = slope_in<double>(model, g, k);
      const Slope lane = slope_in<xsimd::batch<double>>(model, g, k);
      const long double step = 1e-6L;  // truncation: step^2 f''' / 6, about 1e-9 f; rounding: 1e-19 / step = 1e-13 f
      const Precise up = precise(model, g, k, step), down = precise(model, g, k, -step);
      for (int c = 0; c < 3; ++c) {
        const double want = double((up[c] - down[c]) / (2 * step)), scale = std::abs(want) + value[c] + 1e-12;
        ASSERT_NEAR(got.slope[c], want, 1e-8 * scale) << "case " << i << ", channel " << k;
        ASSERT_NEAR(lane.slope[c], got.slope[c], 1e-11 * scale)
            << "case " << i << ", channel " << k;                                       // batch pow: 1e-14
        ASSERT_LE(relative_difference(got.value[c], value[c]), 1e-14) << "case " << i;  // the same operations
      }
    }
  }
}

TYPED_TEST(DerivativeOf, DirectionsEqualTheCentralDifference) {
  using S = ceres::Jet<double, 2>;
  Random random(9);
  for (int i = 0; i < 1000; ++i) {
    const auto model = random_model<TypeParam>(random, [&](const Parameter& row) { return smooth_part(random, row); });
    const double theta_h = random.uniform(0.05, 0.7), theta_d = random.uniform(0.05, 0.7), phi_d = random.uniform(0, 3);
    if (near_a_kink(model, geometry_at(theta_h, theta_d, phi_d))) continue;
    const Rgb<S> f = model_in<S>(model).eval(geometry_at(S(theta_h, 0), S(theta_d, 1), S(phi_d)));
    const auto at = [&](long double h, long double d) {
      const auto v = model_in<long double>(model).eval(geometry_at<long double>(theta_h + h, theta_d + d, phi_d));
      return v.g;
    };
    const long double step = 1e-6L;  // as above
    const double by_h = double((at(step, 0) - at(-step, 0)) / (2 * step)),
                 by_d = double((at(0, step) - at(0, -step)) / (2 * step));
    ASSERT_NEAR(f.g.v[0], by_h, 1e-8 * (std::abs(by_h) + f.g.a)) << i;
    ASSERT_NEAR(f.g.v[1], by_d, 1e-8 * (std::abs(by_d) + f.g.a)) << i;
  }
}

// ---- finite at every edge: one infinite slope poisons a whole row of a fit's Jacobian.

template <class T, template <class> class M>
void expect_finite(const M<double>& model, const Pair& pair) {
  for (std::size_t k = 0; k < channels_of(model).size(); ++k) {
    const Slope s = slope_in<T>(model, pair, k);
    for (int c = 0; c < 3; ++c) {
      EXPECT_TRUE(std::isfinite(s.slope[c])) << M<double>::kName << ", " << pair.name << ", channel " << k;
      EXPECT_TRUE(std::isfinite(s.value[c])) << M<double>::kName << ", " << pair.name;
    }
  }
}

TYPED_TEST(DerivativeOf, EdgesAreFiniteInEveryScalar) {
  Random random(10);
  auto pairs = hard_pairs();
  for (const Pair& pair : dark_pairs()) pairs.push_back(pair);
  for (int i = 0; i < 120; ++i) {
    const auto model = random_model<TypeParam>(random, [&](const Parameter& row) -> Interval {
      const double ends[]{row.range.low, row.range.high, row.initial};
      const double x = ends[random.index(3)];
      return {x, x};
    });
    for (const Pair& pair : pairs) {
      expect_finite<double>(model, pair);
      expect_finite<float>(model, pair);
      expect_finite<xsimd::batch<double>>(model, pair);
      expect_finite<xsimd::batch<float>>(model, pair);
    }
  }
}

// The value falls to 0 with an infinite slope where an exponent passes through 0 at cosine 0; taken as 0.
TEST(Power, ZeroToAPowerHasNoSlope) {
  using S = Dual<double>;
  for (const double e : {0.0, 1e-3, 0.5, 1.0, 5.0}) {
    const S f = power(S(0.0, 0), S(e));
    EXPECT_EQ(f.a, e > 0 ? 0 : 1);
    EXPECT_EQ(f.v[0], 0) << e;
    EXPECT_EQ(power(0.0, S(e, 0)).v[0], 0) << e;
  }
  EXPECT_EQ(safe_sqrt(S(0.0, 0)).v[0], 0);
  EXPECT_EQ(safe_sqrt(S(4.0, 0)).v[0], 0.25);
}

// Where a value is held by a clamp, its parameter has no slope, and gets it back on the other side.
TEST(DerivativeOf, AClampedRoughnessHasNoSlope) {
  const auto g = geometry_at(1e-3, 0.4, 0.3);
  Ggx<double> model{.roughness = 0.009};
  EXPECT_EQ(slope_in<double>(model, g, 3).slope[0], 0);
  model.roughness = 0.011;
  EXPECT_NE(slope_in<double>(model, g, 3).slope[0], 0);
}

}  // namespace
}  // namespace likeness::brdf
