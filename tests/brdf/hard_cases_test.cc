#include "tests/brdf/hard_cases.h"

#include "tests/brdf/kinds.h"

// The cases where published formulas give NaN, infinity, a negative value or a jump; in every scalar. The same
// cases as derivatives are in derivative_test.cc.
namespace likeness::brdf {
namespace {

template <class S>
class HardCases : public ::testing::Test {
 protected:
  template <template <class> class M>
  void expect_sound(const M<double>& model, const char* what) {
    for (const Pair& pair : hard_pairs()) {
      const Channels f = eval_in<S>(model, pair.to_light, pair.to_view);
      EXPECT_TRUE(finite_and_not_negative(f))
          << what << ", " << pair.name << ": f = " << f[0] << " " << f[1] << " " << f[2];
    }
    for (double theta_h : {0.0, 0.4, std::numbers::pi / 2})
      for (double theta_d : {0.0, 1e-7, 0.7, std::numbers::pi / 2 - 1e-7, std::numbers::pi / 2})
        for (double phi_d : {0.0, 1.0, std::numbers::pi / 2}) {
          const Channels f = eval_in<S>(model, geometry_at(theta_h, theta_d, phi_d));
          EXPECT_TRUE(finite_and_not_negative(f))
              << what << ", theta_h " << theta_h << ", theta_d " << theta_d << ", phi_d " << phi_d << ": f = " << f[0];
        }
  }
  template <class M>
  void sweep(const std::vector<std::string_view>& names) {
    for_ends_of<M>(names, [&](const M& model) { expect_sound(model, M::kName.data()); });
  }
};
TYPED_TEST_SUITE(HardCases, Kinds, KindNames);

TYPED_TEST(HardCases, RoughnessZeroAndOneAreSound) {
  this->template sweep<Callisto<double>>(
      {"roughness", "metallic", "dual_specular_opacity", "dual_specular_roughness_scale"});
  this->template sweep<Disney2012<double>>({"roughness", "metallic", "anisotropic", "subsurface"});
  this->template sweep<Ggx<double>>({"roughness", "f0"});
  this->template sweep<BurleyDiffuse<double>>({"roughness", "base_color"});
  this->template sweep<Lambert<double>>({"base_color"});
}

TYPED_TEST(HardCases, DisneyLayersAtTheirEndsAreSound) {
  this->template sweep<Disney2012<double>>({"base_color", "specular_tint", "sheen", "sheen_tint"});
  this->template sweep<Disney2012<double>>({"clearcoat", "clearcoat_gloss", "specular", "roughness"});
}

TYPED_TEST(HardCases, EveryFalloffAtZeroAndOneIsSound) {
  this->template sweep<Callisto<double>>(
      {"diffuse_fresnel_falloff", "diffuse_fresnel_tangent_falloff", "diffuse_fresnel"});
  this->template sweep<Callisto<double>>(
      {"retroreflection_falloff", "retroreflection_tangent_falloff", "retroreflection"});
  this->template sweep<Callisto<double>>({"specular_fresnel_falloff", "specular", "metallic"});
}

// 0^0 = 1: a falloff of 1 means 'everywhere', also where the cosine is 0.
TYPED_TEST(HardCases, FalloffsOfOneMakeTheIntensityAConstantFactor) {
  Callisto<double> model{.base_color = Rgb<double>(1), .specular = 0, .specular_fresnel_falloff = 0};
  model.diffuse_fresnel = 3;
  model.diffuse_fresnel_falloff = model.diffuse_fresnel_tangent_falloff = 1;
  for (const Pair& pair : hard_pairs()) {
    const double f = eval_in<TypeParam>(model, pair.to_light, pair.to_view)[0];
    EXPECT_LE(relative_difference(f, 3 * std::numbers::inv_pi), 2e-7) << pair.name;  // float rounds 3 / pi to 1e-7
  }
  model.diffuse_fresnel = 1;
  model.retroreflection = 3;
  model.retroreflection_falloff = model.retroreflection_tangent_falloff = 1;
  for (const Pair& pair : hard_pairs()) {
    const double f = eval_in<TypeParam>(model, pair.to_light, pair.to_view)[0];
    EXPECT_LE(relative_difference(f, 3 * std::numbers::inv_pi), 2e-7) << pair.name;  // float rounds 3 / pi to 1e-7
  }
}

TYPED_TEST(HardCases, IntensitiesAtZeroAndGreatestAreSound) {
  this->template sweep<Callisto<double>>({"diffuse_fresnel", "retroreflection", "base_color", "smooth_terminator"});
  this->template sweep<Callisto<double>>(
      {"diffuse_fresnel", "diffuse_fresnel_tint", "retroreflection", "retroreflection_tint"});
}

TYPED_TEST(HardCases, TheTerminatorAtItsEndsIsSound) {
  this->template sweep<Callisto<double>>({"smooth_terminator", "smooth_terminator_length", "smooth_terminator_tint"});
}

// smoothstep(0, 0, x) is a step at 0, so that nothing above the horizon is changed.
TYPED_TEST(HardCases, ATerminatorOfLengthZeroChangesNothing) {
  for (const double amount : {-1.0, 1.0}) {
    Callisto<double> model;
    model.smooth_terminator = amount;
    model.smooth_terminator_length = 0;
    for (const Pair& pair : hard_pairs())
      EXPECT_EQ(eval_in<TypeParam>(model, pair.to_light, pair.to_view),
                eval_in<TypeParam>(Callisto<double>{}, pair.to_light, pair.to_view))
          << pair.name << ", smooth_terminator " << amount;
  }
}

TYPED_TEST(HardCases, NothingShinesAtOrBelowTheHorizon) {
  const auto dark = [](const auto& model) {
    for (const Pair& pair : dark_pairs())
      EXPECT_EQ(eval_in<TypeParam>(model, pair.to_light, pair.to_view), (Channels{0, 0, 0}))
          << model.kName << ", " << pair.name;
  };
  dark(Callisto<double>{});
  dark(Disney2012<double>{.sheen = 1, .clearcoat = 4});
  dark(Ggx<double>{.roughness = 0});
  dark(Lambert<double>{});
  dark(BurleyDiffuse<double>{});
}

// v rounded to float. Through volatile, because g++ 12 at -O2 drops the rounding of a whole vector that goes to
// float and back.
Vec3<double> in_float(const Vec3<double>& v) {
  volatile float x = float(v.x), y = float(v.y), z = float(v.z);
  return {double(x), double(y), double(z)};
}

// alpha = 1e-4 in float: 1 - cos^2 would lose the peak's width (1e-8) altogether.
TYPED_TEST(HardCases, TheSharpestPeakKeepsItsDigits) {
  using S = TypeParam;
  const double tolerance = kIsFloat<S> ? 2e-5 : 1e-12;  // the demand on D
  const Ggx<double> model{.f0 = Rgb<double>(1), .roughness = 0.01};
  const double top = eval_in<S>(model, {0.6, 0, 0.8}, {-0.6, 0, 0.8})[0];
  EXPECT_LE(relative_difference(top, 1 / (4 * std::numbers::pi * 1e-8 * 0.64)), 1e-6);  // V = 1 / (4 cos^2) to alpha^2
  for (const double tilt : {0.0, 1e-6, 5e-5, 1e-4, 3e-4, 1e-3, 1e-2}) {
    const auto g = geometry_at(tilt, 0.6, 0.3);
    EXPECT_LE(relative_difference(eval_in<S>(model, g)[0], eval_in<long double>(model, g)[0]), tolerance) << tilt;
    // Directions that are already rounded to float are taken at their word.
    const Vec3<double> l = in_float(g.to_light), v = in_float(g.to_view);
    const double want = channels(model.eval(l, v))[0];
    EXPECT_LE(relative_difference(eval_in<S>(model, l, v)[0], want), tolerance) << tilt;
  }
}

TYPED_TEST(HardCases, TheHalfVectorIsUnitWheneverLightAndViewAreUnit) {
  using S = TypeParam;
  auto pairs = hard_pairs();
  for (const Pair& pair : dark_pairs()) pairs.push_back(pair);
  Random random(12);
  for (int i = 0; i < 500; ++i) {  // retroreflection in the surface, where 1 - cos theta_h rounds to more than 1
    const auto l = random.direction(0, 1e-8);
    pairs.push_back({"identical, grazing", l, l});
  }
  for (const Pair& pair : pairs) {
    const Geometry<S> g(vector_in<S>(pair.to_light), vector_in<S>(pair.to_view));
    EXPECT_NEAR(first(dot(g.half, g.half)), 1, kIsFloat<S> ? 4e-7 : 1e-15) << pair.name;  // three roundings
    EXPECT_LE(first(g.cos_h), 1) << pair.name;
    EXPECT_LE(first(g.versine_h), 1) << pair.name;
    EXPECT_LE(first(g.versine_d), 1) << pair.name;
  }
}

// ---- no jump where a value is clamped or a formula changes its branch: both sides agree.

struct Join {
  std::string_view name;
  double at;
};

template <class M>
void expect_continuous(const M& model, const std::vector<Join>& joins) {
  Random random(7);
  for (const Join& join : joins) {
    for (int i = 0; i < 200; ++i) {
      const auto l = random.direction(0.01), v = i % 2 ? random.direction(0.01) : Vec3<double>{-l.x, -l.y, l.z};
      Channels f[2];
      for (int side = 0; side < 2; ++side) {
        M moved = model;
        for_each_parameter(moved, [&]<class V>(const Parameter& row, V& value) {
          if (row.name == join.name) value = V(join.at * (1 + (side ? 1e-9 : -1e-9)));
        });
        f[side] = channels(moved.eval(l, v));
      }
      for (int c = 0; c < 3;
           ++c)  // 2e-9 apart in the parameter; roughness reaches f in the power -4: 1e-8, and 4 for pow
        EXPECT_LE(relative_difference(f[0][c], f[1][c]), 4e-8)
            << M::kName << ", " << join.name << " around " << join.at;
    }
  }
}

TEST(HardCases, NoJumpWhereAParameterIsClamped) {
  expect_continuous(Ggx<double>{}, {{"roughness", 0.01}});
  Callisto<double> callisto{.metallic = 0.3, .roughness = 0.25, .smooth_terminator = 0.7};
  callisto.dual_specular_opacity = 0.4;
  callisto.diffuse_fresnel = 5;
  callisto.retroreflection = 4;
  expect_continuous(callisto, {{"roughness", 0.01},                   // alpha kept above 1e-4
                               {"roughness", 0.5},                    // second lobe's roughness reaches 1 (scale 2)
                               {"dual_specular_roughness_scale", 4},  // the same, by the scale
                               {"specular_fresnel_falloff", 0.5},     // t(2 - r) starts to clamp; power5 switches form
                               {"diffuse_fresnel_falloff", 0.5},      // power5 switches form
                               {"retroreflection_falloff", 0.5},
                               {"smooth_terminator_length", 1e-3}});
  Disney2012<double> disney{.metallic = 0.3, .roughness = 0.25, .anisotropic = 0.6};
  expect_continuous(disney, {{"roughness", std::sqrt(0.001 * std::sqrt(1 - 0.54))},  // alpha_x kept above 0.001
                             {"roughness", std::sqrt(0.001 / std::sqrt(1 - 0.54))},  // alpha_y
                             {"anisotropic", 0.5}});
}

TEST(HardCases, NoJumpWhereTheTerminatorEnds) {
  Callisto<double> model{.smooth_terminator = 1};
  model.smooth_terminator_length = 0.3;
  // Along a meridian the smoothstep ends once; steps of 1e-5 in the light's height change f by a bounded amount.
  double last = channels(model.eval(at_height(1e-5, 0), at_height(0.8, 2)))[0];
  for (double z = 2e-5; z < 0.9; z += 1e-5) {
    const double f = channels(model.eval(at_height(z, 0), at_height(0.8, 2)))[0];
    ASSERT_NEAR(f, last, 2e-5)
        << z;  // |df/dz| <= 1.5 / length * f / mask, about 1.6; a jump would be of the order of f
    last = f;
  }
}

}  // namespace
}  // namespace likeness::brdf
