#include "tests/brdf/chi_square.h"
#include "tests/brdf/kinds.h"
#include "tests/brdf/sampled_cases.h"

// The samples of every model are distributed as its pdf says, lose below the horizon what the pdf says, and average to
// the albedo that a quadrature finds. A wrong lobe that sample() and pdf() share passes the weights of sampling_test; it
// does not pass here, where the pdf is integrated.
//
// Chi-square in half-vector coordinates (half_vector_map.h), which resolve the narrowest lobe: in 2-D and, because 2-D
// alone misses errors of a few percent, over the polar angle and over the azimuth. The directions that are lost have a
// bin of their own in each.
namespace likeness::brdf {
namespace {

constexpr std::uint64_t kSeed = 20250811;
constexpr int kSamples = 100000;
constexpr std::size_t kFine = 64, kCoarse = 16;  // bins a side: of the marginals, and in 2-D

// The suite: every model and parameter set (two more for the clearcoat), every view, double and float, in three tests
// each; together they fail by chance once in 100.
constexpr std::size_t kTests = (std::variant_size_v<AnyBrdf> * kParameterSets + 2) * kViewHeights.size() * 2 * 3;
const double kLeastP = sidak(0.01, kTests);
// The means, two-sided: erfc(4.5 / sqrt(2)) is 7e-6, so all of them together fail by chance once in 400.
constexpr double kSigmas = 4.5;

// What the pdf of a model expects.
struct Expected {
  std::vector<double> fine = std::vector<double>(kFine * kFine);  // probability of each cell
  double kept = 0;                                                // integral of the pdf
};
template <class M>
Expected expected_of(const M& model, const Vec3<double>& view, const HalfVectorMap& map) {
  Expected expected;
  const GaussLegendre rule(4);
  for (std::size_t cell = 0; cell < kFine * kFine; ++cell) {
    for (std::size_t i = 0; i < rule.node.size(); ++i)
      for (std::size_t k = 0; k < rule.node.size(); ++k) {
        const auto point = map.at((double(cell % kFine) + rule.node[i]) / double(kFine),
                                  (double(cell / kFine) + rule.node[k]) / double(kFine));
        expected.fine[cell] +=
            rule.weight[i] * rule.weight[k] * point.area * model.pdf(point.to_light, view) / double(kFine * kFine);
      }
    expected.kept += expected.fine[cell];
  }
  return expected;
}

// Samples of one lane of S, from random numbers that S can hold.
struct Counts {
  std::vector<double> fine = std::vector<double>(kFine * kFine);
  double lost = 0, sum = 0, sum_of_squares = 0;  // of the red weight
};
template <Scalar S, template <class> class M>
Counts counts_of(const M<double>& in_double, const Vec3<double>& view, const HalfVectorMap& map) {
  const M<S> model = model_in<S>(in_double);
  const Vec3<S> to_view = vector_in<S>(view);
  Random random(kSeed);
  Counts counts;
  const auto number = [&] {  // 24 bits in a float, the highest of which is below 1
    const double x = random.uniform();
    return kIsFloat<S> ? constant<S>(std::floor(x * 0x1p24) * 0x1p-24) : constant<S>(x);
  };
  for (int i = 0; i < kSamples; ++i) {
    const S choice = number(), u = number(), v = number();
    const Sample<S> sample = model.sample(to_view, choice, u, v);
    const double weight = first(sample.weight.r);
    counts.sum += weight;
    counts.sum_of_squares += weight * weight;
    if (first(sample.pdf) == 0) {
      ++counts.lost;
      continue;
    }
    const auto place = map.place_of({first(sample.to_light.x), first(sample.to_light.y), first(sample.to_light.z)});
    const auto bin = [](double x) { return std::min(std::size_t(std::max(x, 0.0) * double(kFine)), kFine - 1); };
    ++counts.fine[bin(place.y) * kFine + bin(place.x)];
  }
  return counts;
}

// Cells gathered by `bin_of(column, row)`, with the lost ones in a bin at the end.
template <class F>
std::vector<double> gathered(const std::vector<double>& fine, std::size_t bins, double lost, F&& bin_of) {
  std::vector<double> out(bins + 1);
  for (std::size_t cell = 0; cell < fine.size(); ++cell) out[bin_of(cell % kFine, cell / kFine)] += fine[cell];
  out[bins] = lost;
  return out;
}

template <class M>
class EveryModelsSamples : public ::testing::Test {};
TYPED_TEST_SUITE(EveryModelsSamples, TypesOf<AnyBrdf>::Type, ModelNames);

template <std::size_t kSets, class M, class F>
void for_each_case(const std::array<M, kSets>& sets, F&& visit) {
  for (std::size_t set = 0; set < sets.size(); ++set)
    for (const double height : kViewHeights) {
      const Vec3<double> view = view_at(height);
      SCOPED_TRACE("parameter set " + std::to_string(set) + ", view at height " + std::to_string(height) + ", seed " +
                   std::to_string(kSeed));
      visit(sets[set], view, HalfVectorMap(view, sharpest(sets[set])));
    }
}

template <class S, class M>
void expect_distribution(const M& model, const Vec3<double>& view, const HalfVectorMap& map, const Expected& expected,
                         double albedo) {
  const Counts counts = counts_of<S>(model, view, map);
  std::vector<double> cells = expected.fine;
  for (double& x : cells) x *= kSamples;
  const double lost = std::max(0.0, kSamples * (1 - expected.kept));
  const auto test = [&](const char* what, std::size_t bins, auto&& bin_of) {
    const ChiSquare result =
        chi_square(gathered(counts.fine, bins, counts.lost, bin_of), gathered(cells, bins, lost, bin_of));
    EXPECT_GE(result.p, kLeastP) << what << ": chi-square " << result.statistic << " of " << result.freedom
                                 << " degrees of freedom, " << counts.lost << " lost of " << lost << " expected";
  };
  constexpr std::size_t kBlock = kFine / kCoarse;
  test("2-D", kCoarse * kCoarse, [](std::size_t x, std::size_t y) { return y / kBlock * kCoarse + x / kBlock; });
  test("polar angle", kFine, [](std::size_t x, std::size_t) { return x; });
  test("azimuth", kFine, [](std::size_t, std::size_t y) { return y; });

  const double mean = counts.sum / kSamples, variance = counts.sum_of_squares / kSamples - mean * mean;
  const double sigma = std::sqrt(std::max(variance, 0.0) / kSamples);
  EXPECT_NEAR(mean, albedo, kSigmas * sigma + 1e-5 * albedo)  // and the error of the quadrature
      << "in sigmas: " << (mean - albedo) / sigma;
}

template <std::size_t kSets, class M>
void expect_samples_of(const std::array<M, kSets>& sets) {
  for_each_case(sets, [](const M& model, const Vec3<double>& view, const HalfVectorMap& map) {
    const Expected expected = expected_of(model, view, map);
    const double kept = over_lights(model, view, [&](const Vec3<double>& l) { return model.pdf(l, view); });
    EXPECT_NEAR(kept, expected.kept, 1e-7);  // another quadrature: what the bins hold together
    EXPECT_LE(kept, 1 + 1e-9);               // 1, less what falls below the horizon
    const double value = albedo(model, view);
    expect_distribution<double>(model, view, map, expected, value);
    expect_distribution<float>(model, view, map, expected, value);
  });
}

TYPED_TEST(EveryModelsSamples, AreDistributedAsThePdfSaysAndAverageToTheAlbedo) {
  expect_samples_of(parameter_sets<TypeParam>());
}

// Among other lobes the clearcoat has too few samples to be seen: here it has nearly all.
TEST(Disney2012Samples, OfTheClearcoatAloneAreDistributedAsThePdfSays) {
  const Disney2012<double> satin{
      .base_color = Rgb<double>(0), .specular = 0, .sheen = 0, .clearcoat = 4, .clearcoat_gloss = 0};
  Disney2012<double> gloss = satin;
  gloss.clearcoat_gloss = 1;
  expect_samples_of(std::array{satin, gloss});
}

// How unevenly samples weigh: the relative variance of one sample's mean over the channels, by quadrature, worst over
// parameters drawn from the usual ranges. A weight for the wrong lobe is right on average and shows here alone.
TYPED_TEST(EveryModelsSamples, AreAsNoisyAsMeasured) {
  Random random(22);
  double worst = 0;
  for (int i = 0; i < 30; ++i) {
    const auto model = random_model<TypeParam>(random, [](const Parameter& row) { return row.typical; });
    for (const double height : kViewHeights) {
      const Vec3<double> view = view_at(height);
      double sum = 0, squares = 0;
      for_each_light(view, sharpest(model), 48, 24, [&](const Vec3<double>& l, double area) {
        const double f_cos = mean(model.eval(l, view)) * l.z;
        sum += area * f_cos;
        squares += area * f_cos * f_cos / model.pdf(l, view);
      });
      worst = std::max(worst, squares / (sum * sum) - 1);
    }
  }
  this->RecordProperty("worst_relative_variance", std::to_string(worst));
  EXPECT_LE(worst, 1.0);  // 0.8 for the glossy models, of which a rough one loses half; 0.08 for Burley, 0 for Lambert
}

}  // namespace
}  // namespace likeness::brdf
