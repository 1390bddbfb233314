#include "brdf/dual_normal.h"

#include "brdf/surface_evaluators.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/hard_cases.h"

// Callisto about two normals: one normal is Callisto, and nothing jumps where a direction passes a normal's horizon.
namespace likeness::brdf {
namespace {

Vec3<double> tilted(double x, double y) { return {x, y, std::sqrt(1 - x * x - y * y)}; }

template <class S>
Channels dual(const Callisto<double>& model, const Vec3<double>& diffuse, const Vec3<double>& specular,
              const Vec3<double>& l, const Vec3<double>& v) {
  const auto about = [&](const Vec3<double>& n) { return geometry_in<S>(geometry_about(n, l, v)); };
  return channels(dual_normal(model_in<S>(model), about(diffuse), about(specular)));
}

Callisto<double> drawn_callisto(Random& random) {
  return random_model<Callisto<double>>(random, [](const Parameter& row) { return row.typical; });
}

template <class S>
class DualNormalIn : public ::testing::Test {};
TYPED_TEST_SUITE(DualNormalIn, Kinds, KindNames);

TYPED_TEST(DualNormalIn, TheFramesOwnNormalTwiceIsCallistoTimesTheCosine) {
  using S = TypeParam;
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const Callisto<double> model = drawn_callisto(random);
    const auto l = random.direction(0.001), v = random.direction(0.001);
    const Channels got = dual<S>(model, {0, 0, 1}, {0, 0, 1}, l, v), f = eval_in<S>(model, Geometry<double>(l, v));
    const double cosine = first(constant<S>(l.z));
    for (int c = 0; c < 3; ++c)
      ASSERT_LE(relative_difference(got[c], f[c] * cosine), kIsFloat<S> ? 1e-6 : 2e-15) << i;  // sums in another order
  }
}

// About one tilted normal it is Callisto in that normal's frame, which no isotropic model sees.
TYPED_TEST(DualNormalIn, OneTiltedNormalTwiceIsCallistoInItsFrame) {
  using S = TypeParam;
  Random random(2);
  for (int i = 0; i < 3000; ++i) {
    Callisto<double> model = drawn_callisto(random);
    model.roughness = random.uniform(0.2, 1);
    const double angle = random.uniform(-1, 1), c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](const Vec3<double>& w) { return Vec3<double>{c * w.x + s * w.z, w.y, c * w.z - s * w.x}; };
    const auto l = random.direction(0.1), v = random.direction(0.1);
    if (turned(l).z < 0.1 || turned(v).z < 0.1) continue;
    const Channels got = dual<S>(model, turned({0, 0, 1}), turned({0, 0, 1}), turned(l), turned(v));
    const Channels f = eval_in<double>(model, l, v);
    for (int k = 0; k < 3; ++k)
      ASSERT_LE(relative_difference(got[k], f[k] * l.z), kIsFloat<S> ? 2e-5 : 2e-13)
          << i;  // a rotation: 1e-16 / alpha^2
  }
}

TYPED_TEST(DualNormalIn, ALightBelowOneNormalStillLightsTheOtherPart) {
  using S = TypeParam;
  Callisto<double> model;
  model.roughness = 0.6;
  const Vec3<double> up{0, 0, 1}, away = tilted(0.9, 0), l = at_height(0.3, std::numbers::pi), v = at_height(0.8, 0);
  ASSERT_LT(dot(away, l), 0);
  Callisto<double> no_diffuse = model, no_specular = model;
  no_diffuse.base_color = Rgb<double>(0);
  no_specular.specular = no_specular.specular_fresnel_falloff = 0;
  const auto plain = [&](const Callisto<double>& m) { return dual<S>(m, up, up, l, v)[0]; };
  const double both_parts = plain(model);
  EXPECT_NEAR(dual<S>(model, up, away, l, v)[0], plain(no_specular), 1e-7);  // the diffuse alone
  EXPECT_NEAR(dual<S>(model, away, up, l, v)[0], plain(no_diffuse), 1e-7);   // the specular alone
  EXPECT_EQ(dual<S>(model, away, away, l, v)[0], 0);
  EXPECT_NEAR(plain(no_specular) + plain(no_diffuse), both_parts, 1e-7);
}

TYPED_TEST(DualNormalIn, NothingShinesThroughTheSurface) {
  using S = TypeParam;
  Callisto<double> model;
  const Vec3<double> n = tilted(0.7, 0);
  EXPECT_EQ(dual<S>(model, n, n, at_height(-0.1, 0), at_height(0.5, 1)), (Channels{0, 0, 0}));
  EXPECT_EQ(dual<S>(model, n, n, at_height(0.5, 1), at_height(-0.1, 0)), (Channels{0, 0, 0}));
  for (const Pair& pair : dark_pairs())
    EXPECT_EQ(dual<S>(model, n, tilted(-0.5, 0.2), pair.to_light, pair.to_view), (Channels{0, 0, 0})) << pair.name;
}

TYPED_TEST(DualNormalIn, IsFiniteAndNotNegativeForAnyNormals) {
  using S = TypeParam;
  Random random(4);
  const auto pairs = hard_pairs();
  for (int i = 0; i < 20000; ++i) {
    const Callisto<double> model = random_model<Callisto<double>>(random, [&](const Parameter& row) -> Interval {
      const double ends[]{row.range.low, row.range.high, row.initial};
      const double x = ends[random.index(3)];
      return random.index(2) ? Interval{x, x} : row.range;
    });
    const Pair& pair = pairs[random.index(pairs.size())];
    const bool hard = random.index(2);
    const auto l = hard ? pair.to_light : random.direction(1e-6), v = hard ? pair.to_view : random.direction(1e-6);
    const auto normal = [&] {
      return random.index(4) ? random.direction(-1) : random.index(2) ? l : Vec3<double>{0, 0, -1};
    };
    const Vec3<double> a = normal(), b = normal();
    const Channels f = dual<S>(model, a, b, l, v);
    ASSERT_TRUE(finite_and_not_negative(f)) << i << ": " << f[0] << " " << f[1] << " " << f[2];
    // And with everything in S from the start.
    const auto about = [&](const Vec3<double>& n) {
      return geometry_about(vector_in<S>(n), vector_in<S>(l), vector_in<S>(v));
    };
    ASSERT_TRUE(finite_and_not_negative(channels(dual_normal(model_in<S>(model), about(a), about(b))))) << i;
  }
}

// A direction is moved across the horizon of either normal, a light and a view each, in steps of 1e-4 rad: what changes
// in one step is of the order of a step, and halving the steps halves it.
TEST(DualNormal, NothingJumpsWhereADirectionPassesAHorizon) {
  Callisto<double> model;
  model.roughness = 0.5;
  model.smooth_terminator = 0.7;
  model.retroreflection = 4;
  model.diffuse_fresnel = 4;
  const Vec3<double> one = tilted(0.6, 0.1), other = tilted(-0.55, 0.3);
  for (const bool moves_light : {true, false})
    for (const bool swapped : {false, true}) {
      const auto largest_step = [&](int steps) {
        double last = -1, most = 0;
        for (int i = 0; i <= steps; ++i) {
          const double angle =
              0.02 + (std::numbers::pi - 0.04) * i / steps;  // from one side of the surface to the other
          const Vec3<double> moving{std::cos(angle), 0, std::sin(angle)}, still = at_height(0.9, 0.5);
          const double f = dual<double>(model, swapped ? other : one, swapped ? one : other,
                                        moves_light ? moving : still, moves_light ? still : moving)[0];
          if (last >= 0) most = std::max(most, std::abs(f - last));
          last = f;
        }
        return most;
      };
      const double coarse = largest_step(20000), fine = largest_step(40000);
      EXPECT_LT(coarse, 1e-3) << moves_light << swapped;
      EXPECT_LT(fine, 0.55 * coarse) << moves_light << swapped;  // a jump would stay
    }
}

TYPED_TEST(DualNormalIn, TheRowIsNearDouble) {
  using S = TypeParam;
  Random random(9);
  for (int i = 0; i < 5000; ++i) {
    std::vector<double> in;
    for (const Vec3<double>& w :
         {random.direction(0.01), random.direction(0.01), random.direction(0.5), random.direction(0.5)})
      in.insert(in.end(), {w.x, w.y, w.z});
    for (const double x : channels_of(drawn_callisto(random))) {
      volatile float rounded = float(x);  // parameters are floats already: 1 - metallic has what digits its input has
      in.push_back(double(rounded));
    }
    const auto got = evaluate_row<DualNormal, S>(in), want = evaluate_row<DualNormal, double>(in);
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_LE(relative_difference(got[c], want[c], 1e-30), kIsFloat<S> ? 2e-5 : 2e-14) << i;  // pow in batches
  }
}

}  // namespace
}  // namespace likeness::brdf
