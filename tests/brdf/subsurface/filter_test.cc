#include <numbers>

#include "brdf/subsurface/evaluators.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/subsurface/profile_errors.h"

// The disk that is sampled, the bilateral filter over it, and slabs.
namespace likeness::brdf {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

// ---- the disk.

// Skin-like: red scatters farthest.
const BurleyDisk<double> kSkin{{0.6, 1.7, 4.0}};

TEST(BurleyDisk, BothDensitiesIntegrateToOne) {
  double mixed = 0, widest = 0;
  for (const Node& node : radial_nodes()) {
    const double r = node.x / kSkin.widest(), area = node.weight / kSkin.widest() * kTwoPi * r;
    mixed += area * kSkin.pdf(r);
    widest += area * kSkin.pdf_widest(r);
  }
  EXPECT_NEAR(mixed, 1, 1e-12);  // the quadrature's end
  EXPECT_NEAR(widest, 1, 1e-12);
}

// 64 rings of equal probability and 16 sectors: chi-square with 1023 degrees of freedom, and of the rings alone with 63.
// Significance 1e-4 for each of the four tests.
template <class F, class P>
void expect_samples_follow(F&& sample, P&& cdf) {
  constexpr int kRings = 64, kSectors = 16, kSamples = 400000;
  std::vector<double> counts(kRings * kSectors), rings(kRings);
  Random random(7);
  for (int i = 0; i < kSamples; ++i) {
    const DiskSample<double> at = sample(random);
    ASSERT_NEAR(at.x * at.x + at.y * at.y, at.r * at.r, 1e-14 * at.r * at.r + 1e-300);  // rounding
    const int ring = std::min(kRings - 1, int(cdf(at.r) * kRings));
    const double turn = std::atan2(at.y, at.x) / kTwoPi;
    counts[ring * kSectors + std::min(kSectors - 1, int((turn < 0 ? turn + 1 : turn) * kSectors))] += 1;
    rings[ring] += 1;
  }
  const auto chi_square = [&](const std::vector<double>& bins) {
    double sum = 0;
    const double expected = double(kSamples) / double(bins.size());
    for (const double count : bins) sum += (count - expected) * (count - expected) / expected;
    return sum;
  };
  EXPECT_LE(chi_square(counts), 1199);  // the quantile 1 - 1e-4 at 1023 degrees of freedom is 1199.7
  EXPECT_LE(chi_square(rings), 111);    // at 63: 111.5
}
TEST(BurleyDisk, SamplesFollowTheMeanOfTheChannels) {
  expect_samples_follow(
      [](Random& random) { return kSkin.sample(random.uniform(), random.uniform(), random.uniform()); },
      [](double r) { return (burley_cdf(kSkin.s.r * r) + burley_cdf(kSkin.s.g * r) + burley_cdf(kSkin.s.b * r)) / 3; });
}
TEST(BurleyDisk, SamplesOfTheWidestFollowIt) {
  expect_samples_follow([](Random& random) { return kSkin.sample_widest(random.uniform(), random.uniform()); },
                        [](double r) { return burley_cdf(kSkin.s.r * r); });
}

TEST(BurleyDisk, WeightsAreProfileOverDensitySampleBySample) {
  Random random(8);
  for (int i = 0; i < 20000; ++i) {
    const double choice = random.uniform(), u = random.uniform(), v = random.uniform();
    const auto check = [&](const DiskSample<double>& at, double pdf, double bound) {
      ASSERT_EQ(at.pdf, pdf);
      for (const auto& [s, weight] :
           {std::pair(kSkin.s.r, at.weight.r), {kSkin.s.g, at.weight.g}, {kSkin.s.b, at.weight.b}}) {
        ASSERT_LE(relative_difference(weight * at.pdf, burley_density_over_area(at.r, s)), 1e-13);  // two exponentials
        ASSERT_LE(weight, bound);
      }
    };
    const auto mixed = kSkin.sample(choice, u, v), widest = kSkin.sample_widest(u, v);
    check(mixed, kSkin.pdf(mixed.r), 3);
    check(widest, kSkin.pdf_widest(widest.r), kSkin.s.b / kSkin.s.r * (1 + 1e-15));
  }
}

template <class S>
class Disk : public ::testing::Test {};
TYPED_TEST_SUITE(Disk, Kinds, KindNames);

TYPED_TEST(Disk, WeightsAreFiniteAtTheEndsOfTheSquareForEveryShape) {
  using S = TypeParam;
  const double ends[]{0, 1e-7, 0.4, 0.7, 1 - 0x1p-24, 1};
  for (const double red : {1e-6, 1.0, 1e6})
    for (const double blue : {1e-6, 1.0, 1e6}) {
      const BurleyDisk<S> disk{{constant<S>(red), constant<S>(2), constant<S>(blue)}};
      for (const double choice : {0.0, 0.5, 1.0})
        for (const double u : ends)
          for (const double v : ends) {
            const auto at = disk.sample(constant<S>(choice), constant<S>(u), constant<S>(v));
            const auto wide = disk.sample_widest(constant<S>(u), constant<S>(v));
            ASSERT_TRUE(finite_and_not_negative({first(at.weight.r), first(at.weight.g), first(at.weight.b)}));
            ASSERT_TRUE(finite_and_not_negative({first(wide.weight.r), first(wide.weight.g), first(wide.weight.b)}));
            ASSERT_TRUE(finite_and_not_negative({first(at.pdf), first(wide.pdf), first(at.r)}));
            ASSERT_TRUE(std::isfinite(first(at.x)) && std::isfinite(first(at.y)));
            ASSERT_NEAR(first(at.weight.r + at.weight.g + at.weight.b), 3, 1e-5);  // the balance heuristic; rounding
          }
    }
}

// ---- the bilateral filter.

template <class S>
class Bilateral : public ::testing::Test {};
TYPED_TEST_SUITE(Bilateral, Kinds, KindNames);

template <class S>
Rgb<S> color(double r, double g, double b) {
  return {constant<S>(r), constant<S>(g), constant<S>(b)};
}
template <class S>
Rgb<S> weight_of(double r, double depth, const Channels& s) {
  const double widest = std::min({s[0], s[1], s[2]});
  const auto of = [&](double shape) {
    return BilateralWeight<S>::at(constant<S>(r), constant<S>(depth), constant<S>(shape), constant<S>(widest)).value();
  };
  return {of(s[0]), of(s[1]), of(s[2])};
}

TYPED_TEST(Bilateral, AllWeightsZeroGiveTheCentersRadiance) {
  using S = TypeParam;
  // Numbers that a float holds, because g++ 12 drops a vectorized rounding.
  for (const Channels& center : {Channels{0.25, 3, 1e4}, Channels{0, 0x1p-20, 6e4}}) {
    BilateralMean<S> mean(color<S>(center[0], center[1], center[2]));
    EXPECT_EQ(channels(mean.value()), channels(color<S>(center[0], center[1], center[2])));  // no sample at all
    for (int i = 0; i < 20; ++i) {
      const Rgb<S> weight = weight_of<S>(0.1 * i, 1e6, {1, 2, 30});
      ASSERT_EQ(channels(weight), (Channels{0, 0, 0}));
      mean.add(weight, color<S>(7, 8, 9));
    }
    EXPECT_EQ(channels(mean.value()), channels(color<S>(center[0], center[1], center[2])));
  }
}

TYPED_TEST(Bilateral, TurnsToTheCenterWithoutAJumpAsItsSamplesRecede) {
  using S = TypeParam;
  double before = 5;
  for (double depth = 0; depth < 400; depth += 0.25) {
    BilateralMean<S> mean(color<S>(1, 1, 1));
    for (int i = 0; i < 8; ++i) mean.add(weight_of<S>(0.2 + 0.3 * i, depth, {1, 1, 1}), color<S>(5, 5, 5));
    const double now = first(mean.value().r);
    ASSERT_TRUE(now <= before + 1e-6 && now > before - 0.1 && now >= 1 - 1e-6)
        << depth;  // 0.25 deeper: 8 % of the weight
    before = now;
  }
  EXPECT_EQ(before, 1);
}

TYPED_TEST(Bilateral, WhatIsLitAlikeStaysAsItIsWhateverTheDepths) {
  using S = TypeParam;
  Random random(3);
  for (int pixel = 0; pixel < 200; ++pixel) {
    BilateralMean<S> mean(color<S>(0.7, 20, 3e-3));
    for (int i = 0; i < 55; ++i)
      mean.add(weight_of<S>(random.uniform(0, 10), std::exp(random.uniform(-9, 6)), {0.5, 2, 9}),
               color<S>(0.7, 20, 3e-3));
    const Channels got = channels(mean.value()), want{0.7, 20, 3e-3};
    for (int c = 0; c < 3; ++c) ASSERT_LE(relative_difference(got[c], want[c]), kIsFloat<S> ? 4e-6 : 1e-14);  // 55 sums
  }
}

TYPED_TEST(Bilateral, AWeightIsTheProfileOverTheDensity) {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const double drawn = std::exp(random.uniform(-3, 3)), s = drawn * std::exp(random.uniform(0, 3));
    const double r = std::exp(random.uniform(-9, 2.5)) / drawn, depth = std::exp(random.uniform(-9, 2.5)) / s;
    const double got = evaluate_row<BilateralWeightRow, TypeParam>({r, i % 2 ? depth : -depth, s, drawn})[0];
    const long double d = std::hypot(static_cast<long double>(r), depth);
    const double want =
        double(burley_density_over_area<long double>(d, s) / burley_density_over_area<long double>(r, drawn));
    ASSERT_LE(relative_difference(got, want, 1e-37), kIsFloat<TypeParam> ? 1e-5 : 1e-13) << i;  // exponents up to 85
  }
}

TYPED_TEST(Bilateral, AWeightIsFiniteEverywhere) {
  for (const double s : {1e-6, 1.0, 1e6})
    for (const double r : {0.0, 1e-30, 1e-9, 1.0, 1e4, 1e9})
      for (const double depth : {0.0, 1e-30, 1e-9, 1.0, -1e4, 1e9}) {
        const double w = evaluate_row<BilateralWeightRow, TypeParam>({r, depth, s, s})[0];
        ASSERT_TRUE(std::isfinite(w) && w >= 0 && w <= 1 + 1e-6) << s << " " << r << " " << depth;
        if (depth == 0) {
          ASSERT_NEAR(w, 1, 1e-6) << r;
        }
      }
  EXPECT_NEAR((evaluate_row<BilateralWeightRow, TypeParam>({0, 0, 1e6, 1e-6})[0]), 1e12, 1e6);
  EXPECT_EQ((evaluate_row<BilateralWeightRow, TypeParam>({1e9, 0, 1e6, 1e-6})[0]), 0);
}

// ---- slabs.

TEST(Slab, TransmissionIsTheProfileIntegratedOverTheBack) {
  for (const double s : {0.3, 1.0, 20.0})
    for (const double t : {0.0, 1e-3, 0.4, 3.0, 12.0}) {
      // In x = s sqrt(r^2 + t^2): r dr = x dx / s^2.
      double sum = 0;
      for (const Node& node : radial_nodes())
        sum += node.weight * kTwoPi * (node.x + s * t) * burley_density_over_area(node.x + s * t);
      EXPECT_NEAR(slab_transmission(t, s), sum, 1e-12);  // the quadrature's end
    }
}

TEST(Slab, FollowsItsDefinitionFromThinToOpaque) {
  EXPECT_EQ(slab_transmission(0.0, 5.0), 1);
  EXPECT_EQ(slab_transmission(1e9, 1e6), 0);
  double before = 2;
  for (double t = 0; t < 60; t += 0.1) {
    const double now = slab_transmission(t, 1.0);
    EXPECT_NEAR(now, (std::exp(-t) + 3 * std::exp(-t / 3)) / 4, 1e-16 * 4);  // rounding
    EXPECT_LT(now, before);
    before = now;
  }
}

template <class S>
class Translucency : public ::testing::Test {};
TYPED_TEST_SUITE(Translucency, Kinds, KindNames);

TYPED_TEST(Translucency, ThinIsShadowedAndFacesAway) {
  const auto at = [](double cos_i, double shadow) {
    return evaluate_row<ThinTranslucency, TypeParam>({0.9, 0.5, 0.4, 0.5, 2, 8, 0.7, cos_i, shadow});
  };
  const double near = kIsFloat<TypeParam> ? 1e-6 : 1e-14;  // rounding
  for (const double cos_i : {-1.0, -0.3, -1e-7}) {
    const auto got = at(cos_i, 0.25);
    const double albedo[]{0.9, 0.5, 0.4}, s[]{0.5, 2, 8};
    for (int c = 0; c < 3; ++c) {
      const double want = albedo[c] * slab_transmission(0.7, s[c]) * -cos_i * 0.25 / std::numbers::pi;
      EXPECT_LE(relative_difference(got[c], want), near);
    }
  }
  for (const double cos_i : {0.0, 1e-7, 1.0}) EXPECT_EQ(at(cos_i, 1), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(at(-1, 0), (std::vector<double>{0, 0, 0}));
}

TYPED_TEST(Translucency, ThickTakesTheLargerThickness) {
  const auto at = [](double baked, double map) {
    return evaluate_row<ThickTranslucency, TypeParam>({1, 1, 1, 1, 1, 1, baked, map, -0.5, 0})[0];
  };
  const double near = kIsFloat<TypeParam> ? 1e-6 : 1e-14;  // rounding
  EXPECT_LE(relative_difference(at(2, 0), 0.5 * slab_transmission(2.0, 1.0) / std::numbers::pi), near);
  EXPECT_EQ(at(2, 0), at(0, 2));
  EXPECT_EQ(at(2, 1), at(2, 0));
  EXPECT_EQ(at(0, 1e9), 0);
}

TEST(Translucency, WrappedLightKeepsItsEnergy) {
  for (const double wrap : {0.0, 0.2, 1.0}) {
    double sum = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) sum += lit_thick(wrap - (2 * (i + 0.5) / steps - 1), wrap) * 2 / steps * kTwoPi;
    EXPECT_NEAR(sum, std::numbers::pi, 1e-6);  // midpoint rule: 1e-8
  }
  EXPECT_EQ(lit_thick(-1.0, 0.0), 0);
}

}  // namespace
}  // namespace likeness::brdf
