#include "brdf/jet.h"

#include "tests/brdf/diffuse/forms.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/hard_cases.h"

// The integral over microfacets: against other quadratures, against what holds for it, and where it could break.
namespace likeness::brdf {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

template <class S>
class MicrofacetIntegral : public ::testing::Test {};
TYPED_TEST_SUITE(MicrofacetIntegral, Kinds, KindNames);

TYPED_TEST(MicrofacetIntegral, MeetsItsFile) {
  if (read_reference("microfacet_diffuse.csv").empty())
    GTEST_SKIP() << "no " LIKENESS_SHARED_DIR "/reference/microfacet_diffuse.csv";
  // 5e-14 measured in double, 3e-7 in float
  const double worst =
      worst_against_file<MicrofacetDiffuseRow, TypeParam>("microfacet_diffuse.csv", {.in_double = 1e-10});
  this->RecordProperty("worst", std::to_string(worst));
}

// 160 points by another quadrature with 25 digits (microfacet_diffuse_reference.py), many at 89.9 degrees, alpha 1e-4.
TYPED_TEST(MicrofacetIntegral, MeetsAnotherQuadratureAtTheEndsOfItsRange) {
  const auto rows = read_rows(LIKENESS_SOURCE_DIR "/tests/brdf/diffuse/microfacet_diffuse.csv");
  ASSERT_EQ(rows.size(), 160u);
  for (const Row& row : rows) {
    std::size_t used = 0;
    const auto in = inputs_of<AlphaAndAngles>(row, used);
    const auto got = evaluate_row<MicrofacetDiffuseRow, TypeParam>(in);
    const double want = row.at("ref_f_over_base");
    // the rule with 14 nodes: 1e-8 measured; with 10, and rounding: 3.5e-6 measured
    const double tolerance = kIsFloat<TypeParam> ? 1e-5 : 3e-8;
    EXPECT_LE(relative_difference(got[0], want), tolerance)
        << "alpha " << in[0] << ", angles " << in[1] << " " << in[2];
    EXPECT_LE(relative_difference(got[1], want * std::cos(in[2])), tolerance) << "alpha " << in[0];
  }
}

TYPED_TEST(MicrofacetIntegral, IsLambertToTheLastBitAtAlphaZero) {
  using S = TypeParam;
  for (const double theta : {0.0, 0.5, 1.5, 89.9 * kDegree}) {
    const auto got = evaluate_row<MicrofacetDiffuseRow, S>({0, theta, 0.3, 1.0});
    EXPECT_EQ(got[0], first(constant<S>(std::numbers::inv_pi)));
    EXPECT_NEAR(got[1], std::cos(0.3) / std::numbers::pi, kIsFloat<S> ? 1e-7 : 1e-16);  // a product
    // and nearly so at its next alphas: no jump
    for (const double alpha : {1e-30, 1e-17, 1e-12, 1e-6})
      EXPECT_NEAR(
          (evaluate_row<MicrofacetDiffuseRow, S>({alpha, theta, 0.3, 1.0})[0] * std::numbers::pi), 1,
          kIsFloat<S> ? 5e-6 : 3e-8 + 10 * alpha * std::tan(theta));  // 14 nodes at 89.9 degrees: 1.4e-8 measured
  }
}

TYPED_TEST(MicrofacetIntegral, IsFiniteInEveryHardCase) {
  using S = TypeParam;
  for (const double alpha : {0.0, 1e-30, 1e-19, 1e-10, 1e-4, 0.03, 0.5, 0.999999, 1.0}) {
    for (const Pair& pair : hard_pairs()) {
      const auto got = evaluate_row<MicrofacetDiffuseRow, S, AlphaAndVectors>(
          {pair.to_light.x, pair.to_light.y, pair.to_light.z, pair.to_view.x, pair.to_view.y, pair.to_view.z, alpha});
      for (const double f : got)
        EXPECT_TRUE(std::isfinite(f) && f >= 0) << pair.name << ", alpha " << alpha << ": " << f;
    }
    for (const Pair& pair : dark_pairs()) {
      const auto got = evaluate_row<MicrofacetDiffuseRow, S, AlphaAndVectors>(
          {pair.to_light.x, pair.to_light.y, pair.to_light.z, pair.to_view.x, pair.to_view.y, pair.to_view.z, alpha});
      for (const double f : got) EXPECT_EQ(f, 0) << pair.name << ", alpha " << alpha;
    }
  }
}

// In the kind's own precision from the start, as an engine has it.
TYPED_TEST(MicrofacetIntegral, IsFiniteFromInputsInItsOwnPrecision) {
  using S = TypeParam;
  Random random(8);
  const double kAngles[]{0, 1e-30, 1e-8, 1e-3, 0.7, 1.5707, 89.9 * kDegree, kHalfPi};
  const double kAzimuths[]{0, 1e-30, 1e-7, 1, kHalfPi, 3.1415, std::numbers::pi, 4, 2 * std::numbers::pi};
  const double kAlphas[]{0, 1e-30, 1e-4, 0.01, 0.5, 1};
  for (int i = 0; i < 5000; ++i) {
    const S in[]{constant<S>(kAlphas[random.index(6)]), constant<S>(kAngles[random.index(8)]),
                 constant<S>(kAngles[random.index(8)]), constant<S>(kAzimuths[random.index(9)])};
    S out[2];
    evaluate_inputs<MicrofacetDiffuseRow, AlphaAndAngles>(nullptr, in, out);
    for (const S& f : out)
      ASSERT_TRUE(std::isfinite(first(f)) && first(f) >= 0)
          << first(in[0]) << " " << first(in[1]) << " " << first(in[2]) << " " << first(in[3]);
  }
}

double f_at(double alpha, double theta_o, double theta_i, double phi) {
  return microfacet_diffuse(alpha, PolarPair<double>::at(theta_o, theta_i, phi)).f;
}

TEST(MicrofacetDiffuse, IsReciprocalAndEvenInTheAzimuth) {
  for (int n = 0; n < 5000; ++n) {
    const Draw at = draw(n, Directions::kUniform);
    const double o = std::acos(at.cos_o), i = std::acos(at.cos_i), f = f_at(at.alpha, o, i, at.phi);
    EXPECT_LE(relative_difference(f, f_at(at.alpha, i, o, at.phi)), 1e-14);  // the arcs change places: 6e-16 measured
    EXPECT_LE(relative_difference(f, f_at(at.alpha, o, i, -at.phi)), 1e-14);
    EXPECT_LE(relative_difference(f, f_at(at.alpha, o, i, 2 * std::numbers::pi - at.phi)),
              1e-13);  // an azimuth rounded anew: 2e-15 measured
  }
}

// What a viewer gets from light all around follows from what one facet gets of it, without the second direction.
TEST(MicrofacetDiffuse, SendsWhatItsFacetsReceive) {
  for (const double alpha : {0.1, 0.3, 1.0})
    for (const double degrees : {0, 30, 60, 80}) {
      const double theta = degrees * kDegree;
      double sum = 0;
      const int steps = 60;
      for (int a = 0; a < steps; ++a)
        for (int b = 0; b < steps; ++b) {
          const double root = (a + 0.5) / steps,
                       phi = std::numbers::pi * (b + 0.5) / steps;  // midpoints in sqrt(cos_i)
          sum += microfacet_diffuse(alpha, PolarPair<double>::at(theta, std::acos(root * root), phi)).f_cos * 4 * root;
        }
      const double albedo = std::numbers::pi * sum / (steps * steps);
      // the midpoint rule: 1.5e-4 measured at alpha 0.1 and 80 degrees
      EXPECT_NEAR(albedo, microfacet_diffuse_albedo(alpha, std::cos(theta), std::sin(theta)), 5e-4) << alpha << degrees;
    }
  // Views along the normal of a hemisphere: half of 1 and of the mean squared cosine, with alpha = 1 where D = 1 / pi.
  EXPECT_NEAR(microfacet_diffuse_albedo(1.0, 1.0, 0.0), (1 + 2.0 / 3) / 2, 1e-12);
  EXPECT_DOUBLE_EQ(microfacet_diffuse_albedo(0.0, 0.3, std::sqrt(0.91)), 1);
}

// alpha = 1 is the hemisphere, D = 1 / pi. Seen from above it is a half moon integrated: elementary.
TEST(MicrofacetDiffuse, IsElementaryForAHemisphereSeenFromAbove) {
  for (const double theta : {0.0, 1e-7, 0.4, 1.0, 1.4, 89.9 * kDegree})
    EXPECT_NEAR(f_at(1, 0, theta, 0) * std::cos(theta) * std::numbers::pi,
                2 / (3 * std::numbers::pi) * ((std::numbers::pi - theta) * std::cos(theta) + std::sin(theta)),
                1e-14);  // rounding: 2e-16 measured
}

// Where the formulas change: azimuths of 0, 1 (of the gap), 90 and 180 degrees, equal angles, alpha 1 and at the floor.
TEST(MicrofacetDiffuse, HasNoJumpWhereItsFormulasChange) {
  const auto expect_near = [](double a, double b, double tolerance, const char* what) {
    EXPECT_LE(relative_difference(a, b), tolerance) << what;
  };
  const double h = 1e-10;
  for (const double alpha : {1e-3, 0.05, 0.4, 1.0})
    for (const double o : {0.2, 1.0, 1.5})
      for (const double i : {0.2, 0.9, 1.5}) {
        // 2.7e-9 measured: the slope of f by an azimuth is up to 14 times f
        for (const double phi : {std::numbers::pi - 1, std::numbers::pi / 2, 0.0, std::numbers::pi})
          expect_near(f_at(alpha, o, i, phi - h), f_at(alpha, o, i, phi + h), 1e-8, "azimuth");
        expect_near(f_at(alpha, o, i, 1e-14), f_at(alpha, o, i, 0), 1e-10, "azimuth of nearly 0");
        expect_near(f_at(alpha, o, o - h, 0), f_at(alpha, o, o + h, 0), 2e-8, "equal angles");
        expect_near(f_at(alpha, o, o + h, 1e-9), f_at(alpha, o, o, 0), 2e-8, "nearly equal directions");
        expect_near(f_at(1 - h, o, i, 1), f_at(1, o, i, 1), 1e-8, "alpha of nearly 1");
        expect_near(f_at(alpha, 0, i, 1), f_at(alpha, 3e-15, i, 1), 1e-12, "upright view");
        expect_near(f_at(alpha, 0, 0, 1), f_at(alpha, 3e-15, 2e-15, 1), 1e-12, "both upright");
      }
}

// Series take over from closed forms at a bound that each node of the rule crosses somewhere: neighbours stay
// neighbours.
TEST(MicrofacetDiffuse, IsSmoothAlongEveryInput) {
  const auto expect_smooth = [](auto&& f, double low, double high) {
    const int steps = 4000;
    const double h = (high - low) / steps;
    double worst = 0;
    for (int k = 2; k < steps - 1; ++k) {  // fourth differences see a jump that is 1 / 16 of themselves
      const double x = low + k * h;
      const double fourth = f(x - 2 * h) - 4 * f(x - h) + 6 * f(x) - 4 * f(x + h) + f(x + 2 * h);
      worst = std::max(worst, std::abs(fourth) / f(x));
    }
    EXPECT_LE(worst, 3e-8);  // the fourth derivative near 1.5 itself: 1.3e-8 measured
  };
  for (const double phi : {0.0, 1.0, 2.9, std::numbers::pi}) {
    expect_smooth([&](double x) { return f_at(x, 1.2, 0.9, phi); }, 0.05, 1);
    expect_smooth([&](double x) { return f_at(0.3, x, 0.9, phi); }, 0.05, 1.5);
    expect_smooth([&](double x) { return f_at(0.05, 0.5, x, phi); }, 0.05, 1.5);
  }
  expect_smooth([&](double x) { return f_at(0.3, 1.2, 0.9, x); }, 0, std::numbers::pi);
  expect_smooth([&](double x) { return f_at(0.05, 1.5, 1.5, x); }, 0.05, 3.1);
}

TEST(MicrofacetDiffuse, IsTheSameFromAnglesAndFromVectors) {
  Random random(12);
  double worst = 0, worst_in_float = 0;
  for (int n = 0; n < 20000; ++n) {
    const double alpha = random.uniform(), o = random.uniform(0, 1.55), phi = random.uniform(0, 2 * std::numbers::pi);
    const double i = n % 3 == 0 ? o + random.uniform(-1e-6, 1e-6) : random.uniform(0, 1.55);
    const double azimuth = n % 3 == 0 ? random.uniform(-1e-6, 1e-6) : phi;
    const Vec3<double> l(std::sin(i) * std::cos(0.7), std::sin(i) * std::sin(0.7), std::cos(i));
    const Vec3<double> v(std::sin(o) * std::cos(0.7 + azimuth), std::sin(o) * std::sin(0.7 + azimuth), std::cos(o));
    const double want = f_at(alpha, o, i, azimuth);
    worst = std::max(worst, relative_difference(microfacet_diffuse(alpha, PolarPair<double>::of(l, v)).f, want));
    // Everything in float: what a cosine of 0.02 has lost by then, 3e-6, is not the integral's to mend.
    const Vec3<float> lf(l), vf(v);
    const double float_want =
        microfacet_diffuse(double(float(alpha)), PolarPair<double>::of(Vec3<double>(lf), Vec3<double>(vf))).f;
    worst_in_float =
        std::max(worst_in_float,
                 relative_difference(microfacet_diffuse(float(alpha), PolarPair<float>::of(lf, vf)).f, float_want));
  }
  EXPECT_LE(worst, 1e-13);          // 1.2e-15 measured
  EXPECT_LE(worst_in_float, 5e-6);  // 8e-7 measured with ten times the draws
}

template <class S>
double worst_lane() {
  using Number = typename S::value_type;
  Random random(3);
  double worst = 0;
  for (int n = 0; n < 500; ++n) {
    alignas(64) std::array<std::array<Number, S::size>, kAlphaFeatures> features;
    std::array<double, S::size> want;
    for (std::size_t lane = 0; lane < S::size; ++lane) {
      const double in[]{random.index(4) ? random.uniform() : 0, random.uniform(0, 1.57), random.uniform(0, 1.57),
                        random.uniform(0, std::numbers::pi)};
      double row[kAlphaFeatures];
      AlphaAndAngles::prepare(in, row);
      Number rounded[kAlphaFeatures], out[2];
      for (std::size_t k = 0; k < kAlphaFeatures; ++k) rounded[k] = features[k][lane] = Number(row[k]);
      MicrofacetDiffuseRow::evaluate(rounded, out);
      want[lane] = double(out[0]);
    }
    S together[kAlphaFeatures], out[2];
    for (std::size_t k = 0; k < kAlphaFeatures; ++k) together[k] = S::load_aligned(features[k].data());
    MicrofacetDiffuseRow::evaluate(together, out);
    for (std::size_t lane = 0; lane < S::size; ++lane)
      worst = std::max(worst, relative_difference(double(out[0].get(lane)), want[lane]));
  }
  return worst;
}
TEST(MicrofacetDiffuse, GivesEachLaneOfABatchItsOwn) {
  EXPECT_LE(worst_lane<xsimd::batch<double>>(), 1e-13);  // exp, log and atan of another library: 1.4e-15 measured
  EXPECT_LE(worst_lane<xsimd::batch<float>>(), 3e-6);    // 4.2e-7 measured
}

// By alpha and by both angles, as a fit of it would need.
TEST(MicrofacetDiffuse, HasTheDerivativeOfItsDifferences) {
  using Dual = ceres::Jet<double, 3>;
  for (int n = 0; n < 300; ++n) {
    const Draw at = draw(n, Directions::kByCosine);
    const double x[]{std::max(at.alpha, 0.01), std::acos(std::max(at.cos_o, 0.05)),
                     std::acos(std::max(at.cos_i, 0.05))};
    const auto pair = PolarPair<Dual>::at(Dual(x[1], 1), Dual(x[2], 2), Dual(at.phi));
    const Dual f = microfacet_diffuse(Dual(x[0], 0), pair).f;
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-5;
      double up[]{x[0], x[1], x[2]}, down[]{x[0], x[1], x[2]};
      up[k] += h;
      down[k] -= h;
      if (up[0] > 1) continue;
      const double slope = (f_at(up[0], up[1], up[2], at.phi) - f_at(down[0], down[1], down[2], at.phi)) / (2 * h);
      // third derivatives times h^2 / 6 at cosines of 0.05 and alpha of 0.01: 3e-7 measured
      EXPECT_NEAR(f.v[k], slope, 2e-6 * (1 + std::abs(slope))) << n << " by input " << k;
    }
  }
}
TEST(MicrofacetDiffuse, HasFiniteDerivativesInHardCases) {
  using Dual = ceres::Jet<double, 1>;
  for (const double alpha : {0.0, 1e-10, 1e-4, 0.5, 1.0})
    for (const Pair& pair : hard_pairs()) {
      const auto p = PolarPair<Dual>::of(vector_in<Dual>(pair.to_light), vector_in<Dual>(pair.to_view));
      const auto value = microfacet_diffuse(Dual(alpha, 0), p);
      EXPECT_TRUE(std::isfinite(value.f.v[0]) && std::isfinite(value.f_cos.v[0])) << pair.name << ", alpha " << alpha;
    }
}

// The rule on each arc is Gauss's: exact for polynomials up to twice its nodes.
TEST(MicrofacetDiffuse, TakesArcsByGaussRules) {
  const auto expect_exact = [](const auto& nodes, const auto& weights) {
    for (std::size_t degree = 0; degree < 2 * nodes.size(); ++degree) {
      double sum = 0;
      for (std::size_t k = 0; k < nodes.size(); ++k) sum += weights[k] * std::pow(nodes[k], double(degree));
      EXPECT_NEAR(sum, 1 / double(degree + 1), 1e-15) << degree;
    }
  };
  expect_exact(ArcRule<double>::kNode, ArcRule<double>::kWeight);
  expect_exact(ArcRule<float>::kNode, ArcRule<float>::kWeight);
}

}  // namespace
}  // namespace likeness::brdf
