#include "brdf/realis/shade.h"

#include "brdf/realis/evaluators.h"
#include "tests/brdf/evaluator_row.h"

// The residual within shading.
namespace likeness::brdf {
namespace {

template <class S>
class Shade : public ::testing::Test {};
TYPED_TEST_SUITE(Shade, Kinds, KindNames);

TYPED_TEST(Shade, DividesAndMultipliesByTheSameCosine) {
  Random random(1);
  const double kTolerance = kIsFloat<TypeParam> ? 3e-7 : 6e-16;
  for (int i = 0; i < 3000; ++i) {
    const double error = random.uniform(-10, 10), light = std::exp(random.uniform(-8, 8));
    const double cos_i = i % 5 ? random.uniform(-1, 1) : 0, floor = random.uniform(1e-3, 1);
    const auto out = evaluate_row<RealisDemodulated, TypeParam>({error, light, cos_i, floor});
    EXPECT_NEAR(out[0], error / (light * std::max(cos_i, floor)), 2 * kTolerance * std::abs(out[0])) << cos_i;
    EXPECT_NEAR(out[1], error, 2 * kTolerance * std::abs(error)) << cos_i << ", floor " << floor;
  }
}

TYPED_TEST(Shade, OfNoLightHasNoResidual) {
  for (const double light : {0.0, -1.0, -1e30, 1e-40}) {
    const auto out = evaluate_row<RealisDemodulated, TypeParam>({3, light, 0.5, 0.1});
    EXPECT_TRUE(std::isfinite(out[0]) && std::isfinite(out[1])) << light;
    if (light <= 0) {
      EXPECT_EQ(out[0], 0) << light;
    }
  }
}

TYPED_TEST(Shade, IsNeverNegative) {
  const auto seen = [](double f_cos, double e, double weight, double cos_i) {
    using S = TypeParam;
    return first(with_residual(constant<S>(f_cos), constant<S>(e), constant<S>(weight), constant<S>(cos_i), S(0.125)));
  };
  EXPECT_EQ(seen(0.25, -3, 1, 0.5), 0);
  EXPECT_EQ(seen(0.25, -0.25, 1, 0.5), 0.125);
  EXPECT_EQ(seen(0.25, -0.25, 0.5, 0.5), 0.1875);
  EXPECT_EQ(seen(0.25, -3, 0, 0.5), 0.25) << "faded out";
  EXPECT_EQ(seen(0, 0.5, 1, -0.7), 0.0625) << "turned away: the floor";
  EXPECT_EQ(seen(0, 0, 1, -0.7), 0);
}

TYPED_TEST(Shade, OfThreeChannelsIsThreeOfOne) {
  using S = TypeParam;
  const Rgb<S> f(S(0.25), S(0.5), S(0.75)), e(S(-3.0), S(0.25), S(1.0));
  const Rgb<S> out = with_residual(f, e, S(0.5), S(0.5), S(0.125));
  EXPECT_EQ(first(out.r), 0);
  EXPECT_EQ(first(out.g), 0.5625);
  EXPECT_EQ(first(out.b), 1);
}

TYPED_TEST(Shade, TurnsDirectionsIntoTheModelsSpace) {
  using S = TypeParam;
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const Vec3<double> turn = random.direction(-1) * random.uniform(0, 6), v = random.direction(-1);
    const auto r = Rotation<double>::about(turn);
    Rotation<S> rotation{vector_in<S>(r.x), vector_in<S>(r.y), vector_in<S>(r.z)};
    const Vec3<double> mirror{i % 2 ? 1. : -1., i % 4 < 2 ? 1. : -1., 1};
    const Vec3<S> got = to_model(rotation, vector_in<S>(mirror), vector_in<S>(v));
    EXPECT_NEAR(first(got.x), mirror.x * dot(r.x, v), 4e-7);
    EXPECT_NEAR(first(got.y), mirror.y * dot(r.y, v), 4e-7);
    EXPECT_NEAR(first(got.z), dot(r.z, v), 4e-7);
    EXPECT_NEAR(first(dot(got, got)), 1, 1e-6) << "still a unit vector";
  }
  // A model turned by 90 degrees about z: its x axis points along y of the world.
  const Rotation<S> quarter{vector_in<S>({0, 1, 0}), vector_in<S>({-1, 0, 0}), vector_in<S>({0, 0, 1})};
  const Vec3<S> along = to_model(quarter, vector_in<S>({-1, 1, 1}), vector_in<S>({0, 1, 0}));
  EXPECT_EQ(first(along.x), -1) << "and its mirrored half sees it from the other side";
  EXPECT_EQ(first(along.y), 0);
}

}  // namespace
}  // namespace likeness::brdf
