#include "tests/brdf/kinds.h"
#include "tests/brdf/sampled_cases.h"

// The light of a white sky that comes back, by quadrature: images and means of samples cannot see an f and a pdf that are
// wrong together. What a model promises (brdf/promises.h), and the numbers on the pages in docs/models.
namespace likeness::brdf {
namespace {

template <class M>
class EveryModelsEnergy : public ::testing::Test {};
TYPED_TEST_SUITE(EveryModelsEnergy, TypesOf<AnyBrdf>::Type, ModelNames);

constexpr std::array kHeights{1.0, 0.9, 0.6, 0.3, 0.1, 0.01};

TYPED_TEST(EveryModelsEnergy, IsWhatTheModelPromises) {
  constexpr Energy kPromised = TypeParam::kPromises.energy;
  Random random(41);
  for (int i = 0; i < 30; ++i) {
    const auto model = random_edges<TypeParam>(random);
    for (const double height : kHeights) {
      const double a = albedo(model, view_at(height));
      EXPECT_TRUE(std::isfinite(a) && a >= 0) << height;
      if constexpr (kPromised != Energy::kUnbounded) {
        EXPECT_LE(a, 1 + 1e-6) << height;  // the quadrature's 1e-7
      }
      if constexpr (kPromised == Energy::kBaseColor) {
        EXPECT_NEAR(a, model.base_color.r, 1e-9) << height;  // the quadrature's 2e-10
      }
    }
  }
}

// Against a rule of half as many nodes a side, whose error the difference shows: 6e-5 for Callisto's cusps and kinks, 7e-5
// for Disney's anisotropic lobe, 1.1e-4 for Oren and Nayar's kink at cos_i = cos_o. The whole rule is ten times better
// (sampled_cases.h).
TYPED_TEST(EveryModelsEnergy, QuadratureHasConverged) {
  for (const auto& model : parameter_sets<TypeParam>())
    for (const double height : kViewHeights) {
      const Vec3<double> v = view_at(height);
      const auto f_cos = [&](const Vec3<double>& l) { return channels(model.eval(l, v))[0] * l.z; };
      EXPECT_NEAR(over_lights(model, v, f_cos, 48, 24), over_lights(model, v, f_cos), 2e-4) << height;
    }
}

// In closed form: D = 1 / pi and V = 1 / (2 (1 + mu)) at alpha 1 and normal view, and the integral of mu / (1 + mu) is
// 1 - ln 2. The normals that such a surface shows to a view are mirrored above the horizon in 1 / (1 + cos_o) of the cases.
TEST(GgxEnergy, IsThatOfTheClosedFormAtAlphaOne) {
  const Ggx<double> model{Rgb<double>(1), 1};
  EXPECT_NEAR(albedo(model, view_at(1)), 1 - std::numbers::ln2, 1e-13);  // 1e-15 measured
  for (const double height : {1.0, 0.7, 0.2, 0.01}) {
    const Vec3<double> v = view_at(height);
    EXPECT_NEAR(over_lights(model, v, [&](const Vec3<double>& l) { return model.pdf(l, v); }), 1 / (1 + height), 1e-9);
  }
}
TEST(BurleyDiffuseEnergy, IsThatOfTheClosedFormAtNormalView) {
  // 1 + 2 times the integral of c (0.5 + c) (1 - c)^5.
  EXPECT_NEAR(albedo(BurleyDiffuse<double>{Rgb<double>(1), 1}, view_at(1)), 1 + 1.0 / 28, 1e-13);
}

// ---- the numbers of the pages, to their last digit.

template <class M>
void expect_albedos(const M& model, const std::array<double, 4>& want) {
  constexpr std::array kPageHeights{1.0, 0.5, 0.2, 0.01};  // 0, 60, 78 and 89.4 degrees
  for (std::size_t i = 0; i < want.size(); ++i)
    EXPECT_NEAR(albedo(model, view_at(kPageHeights[i])), want[i], 6e-4) << "at height " << kPageHeights[i];
}
TEST(GgxEnergy, IsAsItsPageSays) {
  const auto white = [](double roughness) { return Ggx<double>{Rgb<double>(1), roughness}; };
  expect_albedos(white(0), {1, 1, 1, 1});
  expect_albedos(white(0.3), {0.991, 0.975, 0.914, 0.975});
  expect_albedos(white(0.5), {0.916, 0.857, 0.848, 0.982});
  expect_albedos(white(1), {0.307, 0.451, 0.642, 0.954});
}
TEST(BurleyDiffuseEnergy, IsAsItsPageSays) {
  const auto white = [](double roughness) { return BurleyDiffuse<double>{Rgb<double>(1), roughness}; };
  expect_albedos(white(0), {0.976, 0.961, 0.816, 0.512});
  expect_albedos(white(0.5), {1.006, 1.008, 1.025, 1.008});
  expect_albedos(white(1), {1.036, 1.057, 1.245, 1.538});
}
TEST(Disney2012Energy, IsAsItsPageSays) {
  using D = Disney2012<double>;
  const Rgb<double> white(1);
  expect_albedos(D{.base_color = white}, {1.041, 1.049, 1.087, 1.072});
  expect_albedos(D{.base_color = white, .roughness = 1}, {1.048, 1.076, 1.275, 1.581});
  expect_albedos(D{.base_color = white, .subsurface = 1}, {0.789, 1.119, 1.370, 1.135});
  expect_albedos(D{.base_color = white, .roughness = 1, .sheen = 1, .clearcoat = 1}, {1.058, 1.106, 1.367, 1.688});
  expect_albedos(D{.base_color = white, .metallic = 1, .roughness = 0.5}, {0.877, 0.657, 0.463, 0.349});
}
TEST(CallistoEnergy, IsAsItsPageSays) {
  Callisto<double> model;
  model.base_color = Rgb<double>(1);
  expect_albedos(model, {1.037, 1.056, 1.128, 1.218});
  model.diffuse_fresnel = 25;
  expect_albedos(model, {1.111, 1.708, 2.127, 2.330});
  model.diffuse_fresnel = 1;
  model.retroreflection = 25;
  expect_albedos(model, {1.111, 2.161, 3.287, 4.183});
}

TEST(CallistoProximaEnergy, IsAsItsPageSays) {
  CallistoProxima<double> model;
  model.base_color = Rgb<double>(1);
  expect_albedos(model, {0.994, 1.012, 1.091, 1.186});
  model.roughness = 1;
  expect_albedos(model, {0.842, 0.847, 0.889, 0.950});
  model.roughness = 0.5;
  model.diffuse_fresnel = 25;
  expect_albedos(model, {1.073, 1.651, 2.070, 2.280});
  model.diffuse_fresnel = 1;
  model.retroreflection = 25;
  expect_albedos(model, {1.073, 2.135, 3.274, 4.183});
}

}  // namespace
}  // namespace likeness::brdf
