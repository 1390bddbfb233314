#include "brdf/jet.h"

#include "brdf/subsurface/evaluators.h"
#include "tests/brdf/evaluator_row.h"

// Automatic derivatives of what is fitted: by every input of a row, equal to a central difference, finite at the edges.
namespace likeness::brdf {

template <class T, int N>
struct First<ceres::Jet<T, N>> {
  static double of(const ceres::Jet<T, N>& x) { return first(x.a); }
};

namespace {

template <class E, class S>
std::vector<S> row_in(const std::vector<S>& in) {
  S features[feature_count<E>()];
  std::vector<S> out(output_count<E>());
  std::tuple_element_t<0, typename E::Forms>::prepare(in.data(), features);
  E::evaluate(features, out.data());
  return out;
}

template <class E, class T>
std::vector<ceres::Jet<T, 1>> slopes(const std::vector<double>& in, std::size_t by) {
  std::vector<ceres::Jet<T, 1>> dual;
  dual.reserve(in.size());
  for (const double x : in) dual.emplace_back(constant<T>(x));
  dual[by].v[0] = T(1);
  return row_in<E>(dual);
}

// By every input in `by`, against the central difference in long double with a step of 1e-6 of the input.
template <class E>
void expect_slopes(const std::vector<double>& in, const std::vector<std::size_t>& by) {
  for (const std::size_t k : by) {
    // The inverse bends as the logarithm of what is left to 1.
    const double far = E::kOutputs[0].name == "r" && k == 0 ? 1 - in[0] : 1e300;
    const long double step = 1e-6L * std::min(std::abs(in[k]), far);
    std::vector<long double> low(in.begin(), in.end()), high = low;
    low[k] -= step;
    high[k] += step;
    const auto below = row_in<E>(low), above = row_in<E>(high);
    const auto got = slopes<E, double>(in, k);
    const auto lane = slopes<E, xsimd::batch<double>>(in, k);
    for (std::size_t i = 0; i < got.size(); ++i) {
      const double want = double((above[i] - below[i]) / (2 * step));
      // Truncation: (1e-6 x)^2 / 6 of the third derivative; the value over its input is the scale where a slope vanishes.
      const double scale = std::abs(want) + std::abs(got[i].a / in[k]);
      ASSERT_NEAR(got[i].v[0], want, 1e-8 * scale) << E::kName << ", output " << i << " by input " << k;
      ASSERT_NEAR(lane[i].v[0].get(0), got[i].v[0], 1e-11 * scale) << E::kName;  // exp of a batch
    }
  }
}

double spread(Random& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

TEST(SubsurfaceDerivatives, EqualTheCentralDifference) {
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const double s = spread(random, 1e-3, 1e3), x = spread(random, 1e-4, 30), a = random.uniform(0.05, 1), r = x / s;
    expect_slopes<BurleyProfile>({r, s, a}, {0, 1, 2});
    expect_slopes<BurleyCdf>({r, s}, {0, 1});
    expect_slopes<SlabTransmission>({r, s}, {0, 1});
    expect_slopes<GaussianProfileOf<1>>({std::min(r, 9 / s), s, a}, {0, 1, 2});
    expect_slopes<GaussianProfileOf<2>>({std::min(r, 12 / s), s, a}, {0, 1, 2});
    expect_slopes<GaussianProfileOf<4>>({std::min(r, 15 / s), s, a}, {0, 1, 2});
    expect_slopes<BilateralWeightRow>({r, random.uniform(-3, 3) / s, s, s * random.uniform(0.2, 1)}, {0, 1, 2, 3});
    const double u = i % 2 ? spread(random, 1e-6, 0.5) : 1 - spread(random, 1e-4, 0.5);
    expect_slopes<BurleyIcdf>({u, s}, {0, 1});
    expect_slopes<BurleyIcdfHalleySteps<2>>({u, s}, {0, 1});
    expect_slopes<ThickTranslucency>({a, a, a, s, 2 * s, 3 * s, r, 0, random.uniform(-1, -0.1), random.uniform(0.1, 1)},
                                     {0, 1, 2, 3, 4, 5, 6, 8, 9});
    // Away from 0.8, where the absolute value of eq. 5 has its third derivative's jump.
    expect_slopes<BurleyShape>({random.uniform(0.01, 0.79)}, {0});
    expect_slopes<BurleyShape>({random.uniform(0.81, 0.99)}, {0});
  }
}

template <class E, class T>
void expect_finite(const std::vector<double>& in) {
  for (std::size_t k = 0; k < in.size(); ++k)
    for (const auto& out : slopes<E, T>(in, k)) {
      ASSERT_TRUE(std::isfinite(first(out.a))) << E::kName << " by " << k;
      ASSERT_TRUE(std::isfinite(first(out.v[0]))) << E::kName << " by " << k;
    }
}
template <class E>
void expect_finite_in_all(const std::vector<double>& in) {
  expect_finite<E, double>(in);
  expect_finite<E, float>(in);
  expect_finite<E, xsimd::batch<double>>(in);
  expect_finite<E, xsimd::batch<float>>(in);
}

TEST(SubsurfaceDerivatives, AreFiniteAtTheEdges) {
  for (const double s : {1e-6, 1.0, 1e6}) {
    for (const double r : {0.0, 1e-20, 1e-6, 1.0, 1e6}) {
      expect_finite_in_all<BurleyProfile>({r, s, 0.5});
      expect_finite_in_all<BurleyCdf>({r, s});
      expect_finite_in_all<GaussianProfile>({4, r, s, 0.5});
      expect_finite_in_all<SlabTransmission>({r, s});
      for (const double depth : {0.0, 1e-6, 1e6}) expect_finite_in_all<BilateralWeightRow>({r, depth, s, s});
      expect_finite_in_all<ThinTranslucency>({0, 0.5, 1, s, s, s, r, 0, 1});
      expect_finite_in_all<ThickTranslucency>({0, 0.5, 1, s, s, s, r, r, 0, 0});
    }
    for (const double u : {0.0, 1e-20, 0.5, 1 - 0x1p-24, 1.0}) {
      expect_finite_in_all<BurleyIcdf>({u, s});
      expect_finite_in_all<BurleyIcdfHalley>({u, s, 4});
    }
  }
  for (const double a : {0.0, 0.8, 1.0}) expect_finite_in_all<BurleyShape>({a});
}

// At the origin the slopes are those of the limits: r of u is 2 u / s, and P of r is s r / 2.
TEST(SubsurfaceDerivatives, HaveTheirLimitsAtTheOrigin) {
  EXPECT_NEAR((slopes<BurleyIcdf, double>({0, 4}, 0)[0].v[0]), 0.5, 1e-15);  // rounding
  EXPECT_NEAR((slopes<BurleyCdf, double>({0, 4}, 0)[0].v[0]), 2, 1e-15);
  EXPECT_EQ((slopes<BurleyIcdf, double>({0, 4}, 1)[0].v[0]), 0);
}

}  // namespace
}  // namespace likeness::brdf
