#include "brdf/hair/fibre.h"
#include "tests/brdf/chi_square.h"
#include "tests/brdf/hair/fibre_quadrature.h"
#include "tests/brdf/kinds.h"

// What the fibre samples: distributed as its pdf says, and weighted by S cos(theta_i) / pdf.
namespace likeness::brdf {
namespace {

template <Scalar S>
HairFibre<S> fibre_in(const HairFibre<double>& fibre) {
  return model_in<S>(fibre);
}
HairFibre<double> fibre_of(double beta_m, double beta_n, Rgb<double> sigma_a) {
  HairFibre<double> fibre;
  fibre.beta_m = beta_m;
  fibre.beta_n = beta_n;
  fibre.sigma_a = sigma_a;
  return fibre;
}
Vec3<double> direction(double theta, double phi) {
  return {std::sin(theta), std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi)};
}

template <class S>
class HairSampling : public ::testing::Test {
 protected:
  static HairSample<S> draw(const HairFibre<double>& fibre, const Vec3<double>& view, double h, Random& random) {
    const auto number = [&] {  // 24 bits in a float, the highest of which is below 1
      const double x = random.uniform();
      return kIsFloat<S> ? constant<S>(std::floor(x * 0x1p24) * 0x1p-24) : constant<S>(x);
    };
    const S choice = number(), u = number(), w = number(), a = number();
    return fibre_in<S>(fibre).sample(vector_in<S>(view), constant<S>(h), choice, u, w, a);
  }
};
TYPED_TEST_SUITE(HairSampling, Kinds, KindNames);

TYPED_TEST(HairSampling, TheWeightIsScatteringOverPdfSampleBySample) {
  using S = TypeParam;
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto fibre = random_model<HairFibre<double>>(random, [](const Parameter& row) { return row.typical; });
    const Vec3<double> view = direction(random.uniform(-1.5, 1.5), random.uniform(-std::numbers::pi, std::numbers::pi));
    const double h = random.uniform(-1, 1);
    const HairSample<S> sample = this->draw(fibre, view, h, random);
    const auto model = fibre_in<S>(fibre);
    const Vec3<S> to_view = vector_in<S>(view);
    const double pdf = first(model.pdf(sample.to_light, to_view, constant<S>(h)));
    ASSERT_EQ(first(sample.pdf), pdf) << i;
    const Channels weight = channels(sample.weight),
                   f = channels(model.eval_cos(sample.to_light, to_view, constant<S>(h)));
    for (int c = 0; c < 3; ++c) {
      if (pdf > 0) {
        ASSERT_LE(relative_difference(weight[c], f[c] / pdf, 1e-30), kIsFloat<S> ? 1e-6 : 1e-14) << i;
      }
      // A lobe's weight is its attenuation over its chance, which is the mean of the channels' attenuations.
      ASSERT_TRUE(weight[c] >= 0 && weight[c] <= 3 * (1 + 1e-5)) << i << ": " << weight[c];
    }
    const double x = first(sample.to_light.x), y = first(sample.to_light.y), z = first(sample.to_light.z);
    ASSERT_NEAR(x * x + y * y + z * z, 1, kIsFloat<S> ? 1e-6 : 1e-14);
  }
}

TYPED_TEST(HairSampling, AGreyFibresWeightsAreAllItsEnergy) {
  using S = TypeParam;
  Random random(2);
  const auto white = fibre_of(0.2, 0.3, Rgb<double>(0.0)), grey = fibre_of(0.2, 0.3, Rgb<double>(0.5));
  const double energy = integrate(grey, 0.4, 0.3).energy.g;
  for (int i = 0; i < 5000; ++i) {
    EXPECT_NEAR(first(this->draw(white, direction(0.4, 1), 0.3, random).weight.g), 1, kIsFloat<S> ? 2e-6 : 1e-13);
    EXPECT_NEAR(first(this->draw(grey, direction(0.4, 1), 0.3, random).weight.g), energy, kIsFloat<S> ? 2e-6 : 1e-10);
  }
}

TYPED_TEST(HairSampling, IsSoundInEveryHardCase) {
  using S = TypeParam;
  Random random(3);
  for (const double beta_m : {0.0, 0.01, 0.3, 1.0})
    for (const double beta_n : {0.0, 0.3, 1.0})
      for (const double sigma_a : {0.0, 1e6})
        for (const double eta : {1.0, 1.55})
          for (const double theta :
               {-std::numbers::pi / 2, 0.0, 1.0, std::numbers::pi / 2 - 1e-7, std::numbers::pi / 2})
            for (const double h : {-1.0, 0.0, 0.5, 1.0})
              for (const double x : {0.0, 0.5, 1 - 0x1p-24}) {
                auto fibre = fibre_of(beta_m, beta_n, Rgb<double>(sigma_a));
                fibre.eta = eta;
                const S n = constant<S>(x);
                const Vec3<double> view =
                    theta > 1.57 ? Vec3<double>{1, theta < std::numbers::pi / 2 ? 1e-7 : 0, 0} : direction(theta, 0.7);
                const auto sample = fibre_in<S>(fibre).sample(vector_in<S>(view), constant<S>(h), n, n, n, n);
                for (const S& value :
                     {sample.pdf, sample.weight.r, sample.to_light.x, sample.to_light.y, sample.to_light.z})
                  ASSERT_TRUE(std::isfinite(first(value)));
                ASSERT_TRUE(first(sample.pdf) >= 0 && first(sample.weight.r) >= 0);
              }
}

// ---- chi-square against the pdf: in 2-D, and over the inclination and over the azimuth alone, because 2-D alone has too
// many bins to see an error of 2 % of a lobe.

constexpr std::size_t kInclinations = 48, kAzimuths = 96;

struct Case {
  double beta_m, beta_n, theta_o, h;
};
constexpr Case kCases[]{
    {0.1, 0.1, 0.0, 0.3},  {0.1, 0.3, 1.2, -0.9}, {0.3, 0.1, -0.6, 0.0}, {0.3, 0.3, 0.4, 0.6},   {0.3, 1.0, 1.4, 1.0},
    {0.6, 0.2, 0.9, -0.3}, {0.6, 0.6, 0.0, 0.95}, {1.0, 0.1, 0.5, 0.5},  {1.0, 1.0, -1.0, -1.0}, {0.2, 0.8, 1.55, 0.1},
};
const double kLeastP = sidak(0.01, std::size(kCases) * 2 * 3);  // cases, kinds, tests of each

// Bins of equal width in theta and phi, each integrated with 6 x 6 nodes.
std::vector<double> expected_of(const HairFibre<double>& fibre, const Case& c) {
  const auto view = fibre.view(direction(c.theta_o, 0), c.h);
  std::vector<double> ends;
  for (std::size_t i = 0; i <= kInclinations; ++i) ends.push_back(std::numbers::pi * (double(i) / kInclinations - 0.5));
  const Nodes theta(ends);
  ends.clear();
  for (std::size_t i = 0; i <= kAzimuths; ++i) ends.push_back(2 * std::numbers::pi * (double(i) / kAzimuths - 0.5));
  const Nodes phi(ends);
  std::vector<double> bins(kInclinations * kAzimuths);
  for (std::size_t i = 0; i < theta.at.size(); ++i)
    for (std::size_t k = 0; k < phi.at.size(); ++k) {
      const Inclination<double> light{std::sin(theta.at[i]), std::cos(theta.at[i])};
      bins[i / 10 * kAzimuths + k / 10] +=
          theta.weight[i] * phi.weight[k] * light.cosine * view.terms(light, phi.at[k]).pdf();
    }
  return bins;
}

template <class S, class Draw>
void compare(int samples, Draw&& draw) {
  for (std::size_t n = 0; n < std::size(kCases); ++n) {
    const Case& c = kCases[n];
    const auto fibre = fibre_of(c.beta_m, c.beta_n, Rgb<double>(0.05, 0.3, 1));
    std::vector<double> expected = expected_of(fibre, c), counts(expected.size());
    for (double& x : expected) x *= samples;
    Random random(100 + n);
    for (int i = 0; i < samples; ++i) {
      const auto sample = draw(fibre, direction(c.theta_o, 0), c.h, random);
      const double x = first(sample.to_light.x), y = first(sample.to_light.y), z = first(sample.to_light.z);
      const auto bin = [](double at, std::size_t bins) {
        return std::min(std::size_t(std::max(at, 0.0) * double(bins)), bins - 1);
      };
      counts[bin(std::atan2(x, std::hypot(y, z)) / std::numbers::pi + 0.5, kInclinations) * kAzimuths +
             bin(std::atan2(z, y) / (2 * std::numbers::pi) + 0.5, kAzimuths)]++;
    }
    const auto marginal = [](const std::vector<double>& cells, std::size_t bins, auto&& of) {
      std::vector<double> sums(bins);
      for (std::size_t i = 0; i < cells.size(); ++i) sums[of(i)] += cells[i];
      return sums;
    };
    const auto row = [](std::size_t i) { return i / kAzimuths; };
    const auto column = [](std::size_t i) { return i % kAzimuths; };
    const ChiSquare both_ways = chi_square(counts, expected);
    const ChiSquare along = chi_square(marginal(counts, kInclinations, row), marginal(expected, kInclinations, row));
    const ChiSquare around = chi_square(marginal(counts, kAzimuths, column), marginal(expected, kAzimuths, column));
    EXPECT_GE(both_ways.p, kLeastP) << "case " << n << ", 2-D: " << both_ways.statistic << " of " << both_ways.freedom;
    EXPECT_GE(along.p, kLeastP) << "case " << n << ", theta: " << along.statistic << " of " << along.freedom;
    EXPECT_GE(around.p, kLeastP) << "case " << n << ", phi: " << around.statistic << " of " << around.freedom;
  }
}

class HairDistribution : public HairSampling<double> {};
TEST_F(HairDistribution, IsThatOfThePdfInDouble) { compare<double>(200000, HairSampling<double>::draw); }
class HairDistributionInFloat : public HairSampling<float> {};
TEST_F(HairDistributionInFloat, IsThatOfThePdf) { compare<float>(200000, HairSampling<float>::draw); }

}  // namespace
}  // namespace likeness::brdf
