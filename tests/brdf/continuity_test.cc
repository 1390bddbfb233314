#include "tests/brdf/kinds.h"
#include "tests/brdf/sampled_cases.h"

// No model jumps: not where a formula changes its branch or a clamp begins, nor anywhere along a line through the range
// of its parameters and directions.
namespace likeness::brdf {
namespace {

// ---- at the branches and clamps by name.

template <class S>
class Branch : public ::testing::Test {
 public:
  // f_at(t) on both sides of t = at, and on it. Steps and slopes: f changes by at most 100 times the step, relatively.
  template <class F>
  static void expect_no_jump(const char* where, double at, F&& f_at) {
    const double step = (kIsFloat<S> ? 1e-6 : 1e-11) * at;
    const Channels below = f_at(at - step), on = f_at(at), above = f_at(at + step);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(below[c] / on[c], 1, kIsFloat<S> ? 1e-4 : 1e-9) << where;
      EXPECT_NEAR(above[c] / on[c], 1, kIsFloat<S> ? 1e-4 : 1e-9) << where;
    }
  }
};
TYPED_TEST_SUITE(Branch, Kinds, KindNames);

const Vec3<double> kLight = Random::direction_at(0.45, 0.3), kView = Random::direction_at(0.7, 2.6);

Callisto<double> lively_callisto() {
  Callisto<double> model;
  model.base_color = {0.7, 0.5, 0.3};
  model.roughness = 0.3;
  model.diffuse_fresnel = 4;
  model.retroreflection = 3;
  model.smooth_terminator = 0.8;
  model.smooth_terminator_length = 0.9;
  model.dual_specular_opacity = 0.4;
  return model;
}

TYPED_TEST(Branch, CallistoAtTheEndOfItsTerminator) {
  const Geometry<double> g(kLight, kView);
  const double a = g.versine_d * g.versine_d * g.versine_d, b = g.versine_h * g.versine_h * g.versine_h;
  const double end = g.cos_i / ((1 - a) * (1 - b));  // the length at which the mask ends at this light
  ASSERT_LT(end, 1);
  this->expect_no_jump("smooth_terminator_length", end, [](double length) {
    auto model = lively_callisto();
    model.smooth_terminator_length = length;
    return eval_in<TypeParam>(model, kLight, kView);
  });
  auto model = lively_callisto();
  model.smooth_terminator_length = 0;  // at length 0 the mask ends before any light that is above the horizon
  const Channels none = eval_in<TypeParam>(model, kLight, kView);
  model.smooth_terminator_length = 1e-9;
  EXPECT_EQ(eval_in<TypeParam>(model, kLight, kView), none);
}
TYPED_TEST(Branch, CallistoWhereTheSecondRoughnessReachesOne) {
  this->expect_no_jump("dual_specular_roughness_scale", 1 / 0.3, [](double scale) {
    auto model = lively_callisto();
    model.dual_specular_roughness_scale = scale;
    return eval_in<TypeParam>(model, kLight, kView);
  });
}
TYPED_TEST(Branch, CallistoWhereItsFresnelStartsToClamp) {
  this->expect_no_jump("specular_fresnel_falloff", 0.5, [](double falloff) {
    auto model = lively_callisto();
    model.specular_fresnel_falloff = falloff;
    return eval_in<TypeParam>(model, kLight, kView);
  });
}
// At falloff 0.5 a power is a product of five; at 1 the exponent is 0.
TYPED_TEST(Branch, CallistoAtTheSpecialFalloffs) {
  using C = Callisto<double>;
  for (double C::* falloff : {&C::diffuse_fresnel_falloff, &C::retroreflection_falloff,
                              &C::diffuse_fresnel_tangent_falloff, &C::retroreflection_tangent_falloff})
    for (const double at : {0.5, 1.0})
      this->expect_no_jump("a falloff", at, [&](double t) {
        auto model = lively_callisto();
        model.*falloff = std::min(t, 1.0);
        return eval_in<TypeParam>(model, kLight, kView);
      });
}
TYPED_TEST(Branch, AlphaWhereItIsHeld) {
  const Vec3<double> mirrored{-kLight.x, -kLight.y, kLight.z};
  this->expect_no_jump("roughness of GGX", 0.01, [&](double roughness) {
    return eval_in<TypeParam>(Ggx<double>{Rgb<double>(0.5), roughness}, kLight, mirrored);
  });
  this->expect_no_jump("roughness of Callisto", 0.01, [&](double roughness) {
    auto model = lively_callisto();
    model.roughness = roughness;
    return eval_in<TypeParam>(model, kLight, mirrored);
  });
  const double aspect = std::sqrt(1 - 0.9 * 0.5);
  for (const double alpha : {0.001 * aspect, 0.001 / aspect})  // where alpha_x, and where alpha_y is held
    this->expect_no_jump("roughness of Disney", std::sqrt(alpha), [&](double roughness) {
      return eval_in<TypeParam>(Disney2012<double>{.roughness = roughness, .anisotropic = 0.5}, kLight, mirrored);
    });
}

// ---- anywhere.

template <class M>
class EveryModelsContinuity : public ::testing::Test {};
TYPED_TEST_SUITE(EveryModelsContinuity, TypesOf<AnyBrdf>::Type, ModelNames);

template <template <class> class M>
double f_of(const M<double>&, const double* values, const Vec3<double>& l, const Vec3<double>& v) {
  return model_from_channels<M, double>(values).eval(l, v).r;
}
Vec3<double> between(const Vec3<double>& a, const Vec3<double>& b, double t) {
  const Vec3<double> c = a * (1 - t) + b * t;
  return c * (1 / std::sqrt(dot(c, c)));
}

// What is left of the change over a piece of a segment that is halved forty times, each time keeping the half that changes
// more: f's slope times 1e-12, if f does not jump there.
TYPED_TEST(EveryModelsContinuity, DoesNotJumpAlongAnyLine) {
  Random random(51);
  for (int line = 0; line < 200; ++line) {
    const auto from = random_model<TypeParam>(random, [](const Parameter& row) { return row.range; });
    const auto to = random_model<TypeParam>(random, [](const Parameter& row) { return row.range; });
    const auto l0 = random.direction(0.02), l1 = random.direction(0.02);
    const auto v0 = random.direction(0.02), v1 = random.direction(0.02);
    const auto start = channels_of(from), end = channels_of(to);
    const auto f_at = [&](double t) {
      auto values = start;
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = start[i] * (1 - t) + end[i] * t;
      return f_of(from, values.data(), between(l0, l1, t), between(v0, v1, t));
    };
    constexpr int kPieces = 16;
    for (int piece = 0; piece < kPieces; ++piece) {
      double low = double(piece) / kPieces, high = double(piece + 1) / kPieces;
      double f_low = f_at(low), f_high = f_at(high);
      for (int halving = 0; halving < 40; ++halving) {
        const double middle = 0.5 * (low + high), f_middle = f_at(middle);
        const bool keep_low = std::abs(f_middle - f_low) > std::abs(f_high - f_middle);
        (keep_low ? high : low) = middle;
        (keep_low ? f_high : f_low) = f_middle;
      }
      // A power with a small exponent starts with an infinite slope: 1e-12^0.3 and less.
      ASSERT_LE(std::abs(f_high - f_low), 1e-4 * (f_low + f_high) + 1e-12) << "line " << line << " at " << low;
    }
  }
}

// The value of f has a step at the horizon; f cos, which is what a renderer adds up, fades: but for models that say no.
TYPED_TEST(EveryModelsContinuity, FadesWithTheLightsCosineIfItPromisesThat) {
  for (const auto& model : parameter_sets<TypeParam>())
    for (const double height : {1e-4, 1e-6, 1e-8}) {
      const auto l = Random::direction_at(height, 0.3);
      const double f_cos = channels(model.eval(l, kView))[0] * height;
      if (TypeParam::kPromises.fades) EXPECT_LE(f_cos, 100 * height);  // f < 100 for lights that graze
      else EXPECT_LE(f_cos, 0.1);                                      // Proxima ends at 0.19 rho alpha / pi
    }
}

}  // namespace
}  // namespace likeness::brdf
