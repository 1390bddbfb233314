#include "brdf/callisto_proxima.h"

#include "brdf/any_brdf.h"
#include "tests/brdf/hard_cases.h"
#include "tests/brdf/kinds.h"

// Callisto over Proxima: what it is at its defaults, and that only the diffuse's shape differs from Callisto.
namespace likeness::brdf {
namespace {

template <class S>
class CallistoProximaIn : public ::testing::Test {};
TYPED_TEST_SUITE(CallistoProximaIn, Kinds, KindNames);

CallistoProxima<double> drawn(Random& random) {
  return random_model<CallistoProxima<double>>(random, [](const Parameter& row) { return row.typical; });
}
// The same parameters without Proxima.
Callisto<double> plain(const CallistoProxima<double>& model) { return model; }

TYPED_TEST(CallistoProximaIn, DefaultsEqualProximaPlusGgxToTheLastBit) {
  using S = TypeParam;
  Random random(2023);
  for (int i = 0; i < 10000; ++i) {
    CallistoProxima<double> model;
    model.base_color = {random.uniform(), random.uniform(), random.uniform()};
    model.specular = random.uniform();
    model.roughness = i % 7 ? random.uniform() : 0;
    const auto whole = model_in<S>(model);
    Proxima<S> diffuse;
    diffuse.base_color = whole.base_color;
    diffuse.alpha = alpha_of_roughness(whole.roughness);
    Ggx<S> ggx;
    ggx.f0 = Rgb<S>(constant<S>(0.08) * whole.specular);
    ggx.roughness = whole.roughness;
    const auto edge = hard_pairs()[random.index(hard_pairs().size())];
    const Geometry<S> g = i % 4 ? Geometry<S>(vector_in<S>(random.direction()), vector_in<S>(random.direction()))
                                : Geometry<S>(vector_in<S>(edge.to_light), vector_in<S>(edge.to_view));
    const Channels got = channels(whole.eval(g)), want = channels(diffuse.eval(g) + ggx.eval(g));
    ASSERT_EQ(got, want) << "case " << i;  // exactly: the same operations in the same order
  }
}

// Without the diffuse both are the same; the diffuse of one is that of the other times proxima_factor.
TEST(CallistoProxima, ScalesTheDiffuseOfCallistoByProximasFactor) {
  Random random(5);
  for (int i = 0; i < 20000; ++i) {
    CallistoProxima<double> model = drawn(random);
    model.metallic = 0;
    const Geometry<double> g(random.direction(0.05), random.direction(0.05));
    CallistoProxima<double> black = model;
    black.base_color = Rgb<double>(0);
    const double mirror = channels(black.eval(g))[1];
    ASSERT_EQ(mirror, channels(plain(black).eval(g))[1]);
    const double lambert = channels(plain(model).eval(g))[1] - mirror, proxima = channels(model.eval(g))[1] - mirror;
    const long double k = std::sqrt(std::max(0.0L, -static_cast<long double>(g.cos_vl)));
    const long double alpha = static_cast<long double>(model.roughness) * model.roughness;
    const double want = lambert * double(1 + alpha * (-0.55L + 0.19L / g.cos_i) * (1 - k));
    const double all = std::abs(proxima) + mirror;
    ASSERT_NEAR(proxima, want, 1e-14 * all) << i;  // a difference of two sums
  }
}

TYPED_TEST(CallistoProximaIn, WithTheCosineItIsTheSameTimesTheCosine) {
  using S = TypeParam;
  Random random(6);
  for (int i = 0; i < 3000; ++i) {
    const auto model = model_in<S>(drawn(random));
    const Geometry<S> g(vector_in<S>(random.direction(0.001)), vector_in<S>(random.direction(0.001)));
    const Channels f = channels(model.eval(g)), f_cos = channels(model.eval_cos(g));
    for (int c = 0; c < 3; ++c)
      ASSERT_LE(relative_difference(f_cos[c], f[c] * first(g.cos_i)), kIsFloat<S> ? 1e-6 : 2e-15) << i;  // order
  }
}

TYPED_TEST(CallistoProximaIn, EndsAreFiniteAndNotNegative) {
  using S = TypeParam;
  const auto sound = [](const CallistoProxima<double>& model) {
    for (const Pair& pair : hard_pairs()) {
      const Geometry<S> g(vector_in<S>(pair.to_light), vector_in<S>(pair.to_view));
      EXPECT_TRUE(finite_and_not_negative(channels(model_in<S>(model).eval(g)))) << pair.name;
      EXPECT_TRUE(finite_and_not_negative(channels(model_in<S>(model).eval_cos(g)))) << pair.name;
    }
    for (const Pair& pair : dark_pairs()) {
      const Geometry<S> g(vector_in<S>(pair.to_light), vector_in<S>(pair.to_view));
      EXPECT_EQ(channels(model_in<S>(model).eval(g)), (Channels{0, 0, 0})) << pair.name;
      EXPECT_EQ(channels(model_in<S>(model).eval_cos(g)), (Channels{0, 0, 0})) << pair.name;
    }
  };
  for_ends_of<CallistoProxima<double>>({"roughness", "metallic", "dual_specular_opacity"}, sound);
  for_ends_of<CallistoProxima<double>>({"diffuse_fresnel", "retroreflection", "smooth_terminator"}, sound);
  for_ends_of<CallistoProxima<double>>(
      {"diffuse_fresnel_falloff", "diffuse_fresnel_tangent_falloff", "smooth_terminator_length"}, sound);
}

TEST(CallistoProxima, TakesTheRoughnessOfTheSharperLobe) {
  CallistoProxima<double> model;
  model.specular = 0;
  model.specular_fresnel_falloff = 0;  // no specular at all
  model.roughness = 0.7;
  model.dual_specular_opacity = 1;
  const auto g = geometry_at(0.9, 0.5, 1.0);
  const Proxima<double> proxima{model.base_color, 0.49};
  EXPECT_LE(relative_difference(channels(model.eval(g))[0], channels(proxima.eval(g))[0]), 1e-15);
}

}  // namespace
}  // namespace likeness::brdf
