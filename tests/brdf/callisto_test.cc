#include "tests/brdf/hard_cases.h"
#include "tests/brdf/kinds.h"

// What Callisto is made of: at its defaults Lambert + GGX, and each control where the talk says it acts.
namespace likeness::brdf {
namespace {

template <class S>
class CallistoIn : public ::testing::Test {};
TYPED_TEST_SUITE(CallistoIn, Kinds, KindNames);

TYPED_TEST(CallistoIn, DefaultsEqualLambertPlusGgxToTheLastBit) {
  using S = TypeParam;
  Random random(1760);
  for (int i = 0; i < 20000; ++i) {
    Callisto<double> model;
    if (i > 0) {
      model.base_color = {random.uniform(), random.uniform(), random.uniform()};
      model.specular = random.uniform();
      model.roughness = random.uniform();
    }
    const auto lambert = model_in<S>(Lambert<double>{model.base_color});
    const auto callisto = model_in<S>(model);
    Ggx<S> ggx;
    ggx.f0 = Rgb<S>(constant<S>(0.08) * callisto.specular);
    ggx.roughness = callisto.roughness;
    const auto edge = hard_pairs()[random.index(hard_pairs().size())];
    const Geometry<S> g = i % 4 ? Geometry<S>(vector_in<S>(random.direction()), vector_in<S>(random.direction()))
                                : Geometry<S>(vector_in<S>(edge.to_light), vector_in<S>(edge.to_view));
    const Channels whole = channels(callisto.eval(g)), sum = channels(lambert.eval(g) + ggx.eval(g));
    ASSERT_EQ(whole, sum) << "case " << i;  // exactly: the same operations in the same order
  }
}

double diffuse(const Callisto<double>& model, double theta_h, double theta_d) {
  return channels(model.eval(geometry_at(theta_h, theta_d, std::numbers::pi / 2)))[0];
}

TEST(Callisto, DiffuseFresnelActsAtTheTopOfTheSliceAndRetroreflectionAtItsRight) {
  Callisto<double> plain{.specular = 0, .specular_fresnel_falloff = 0};
  Callisto<double> rise = plain, retro = plain;
  rise.diffuse_fresnel = retro.retroreflection = 8;
  EXPECT_GT(diffuse(rise, 0.1, 1.5), 3 * diffuse(plain, 0.1, 1.5));
  EXPECT_LT(diffuse(rise, 1.5, 0.1), 1.01 * diffuse(plain, 1.5, 0.1));
  EXPECT_GT(diffuse(retro, 1.5, 0.1), 3 * diffuse(plain, 1.5, 0.1));
  EXPECT_LT(diffuse(retro, 0.1, 1.5), 1.01 * diffuse(plain, 0.1, 1.5));
}

TEST(Callisto, TheTerminatorLeavesTheFresnelAndRetroreflectionCornersAlone) {
  Callisto<double> plain, dark;
  dark.smooth_terminator = 1;
  const double near = std::numbers::pi / 2 - 1e-4;
  EXPECT_NEAR(diffuse(dark, near, 0.2) / diffuse(plain, near, 0.2), 1, 1e-3);  // mask there is 3e-4
  EXPECT_NEAR(diffuse(dark, 0.2, near) / diffuse(plain, 0.2, near), 1, 1e-3);  // mask there is 3e-4
  EXPECT_LT(diffuse(dark, 1.1, 1.1), 0.8 * diffuse(plain, 1.1, 1.1));
}

TEST(Callisto, ASpecularFalloffOfZeroRemovesTheRise) {
  Callisto<double> flat{.base_color = Rgb<double>(0), .specular_fresnel_falloff = 0};
  const auto g = geometry_at(0.1, 1.3, 1.0);
  Ggx<double> no_rise{.f0 = Rgb<double>(0.04)};
  const double lobe = channels(Ggx<double>{.f0 = Rgb<double>(1)}.eval(g))[0];
  EXPECT_LE(relative_difference(channels(flat.eval(g))[0], 0.04 * lobe), 1e-15);  // two roundings
  EXPECT_GT(channels(no_rise.eval(g))[0], 2 * channels(flat.eval(g))[0]);
}

TEST(Callisto, MetalsHaveNoDiffuse) {
  Callisto<double> metal{.base_color = Rgb<double>{0.9, 0.6, 0.3}, .metallic = 1};
  const Ggx<double> ggx{.f0 = metal.base_color};
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const auto l = random.direction(), v = random.direction();
    EXPECT_EQ(channels(metal.eval(l, v)), channels(ggx.eval(l, v)));
  }
}

}  // namespace
}  // namespace likeness::brdf
