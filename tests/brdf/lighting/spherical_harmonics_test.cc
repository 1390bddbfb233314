#include "brdf/lighting/spherical_harmonics.h"

#include "brdf/lighting/evaluators.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/lighting/sphere_quadrature.h"

// Real spherical harmonics of bands 0 to 2.
namespace likeness::brdf {
namespace {

template <class S>
class Harmonics : public ::testing::Test {
 protected:
  static constexpr double kTolerance = kIsFloat<S> ? 2e-6 : 1e-14;
};
TYPED_TEST_SUITE(Harmonics, Kinds, KindNames);

using Nine = std::array<double, kShCount>;
Sh<double> random_sh(Random& random) {
  Sh<double> out;
  for (double& c : out.c) c = random.uniform(-1, 1);
  return out;
}
template <class S>
Sh<S> sh_in(const Sh<double>& from) {
  Sh<S> out;
  for (std::size_t i = 0; i < kShCount; ++i) out.c[i] = constant<S>(from.c[i]);
  return out;
}
template <class S>
Nine numbers(const std::array<S, kShCount>& c) {
  Nine out;
  for (std::size_t i = 0; i < kShCount; ++i) out[i] = first(c[i]);
  return out;
}

TYPED_TEST(Harmonics, AreOrthonormal) {
  for (std::size_t i = 0; i < kShCount; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double inner = over_sphere([&](const Vec3<double>& d) {
        const Nine y = numbers(Sh<TypeParam>::basis(vector_in<TypeParam>(d)));
        return y[i] * y[j];
      });
      EXPECT_NEAR(inner, i == j, this->kTolerance) << i << " " << j;
    }
}

TYPED_TEST(Harmonics, HaveTheOrderAndSignsOfTheTable) {
  const double h = std::sqrt(0.5);
  const auto at = [](double x, double y, double z) {
    return numbers(Sh<TypeParam>::basis(vector_in<TypeParam>({x, y, z})));
  };
  EXPECT_GT(at(0, 1, 0)[1], 0.48);
  EXPECT_GT(at(0, 0, 1)[2], 0.48);
  EXPECT_GT(at(1, 0, 0)[3], 0.48);
  EXPECT_GT(at(h, h, 0)[4], 0.54);
  EXPECT_GT(at(0, h, h)[5], 0.54);
  EXPECT_GT(at(0, 0, 1)[6], 0.63);
  EXPECT_GT(at(h, 0, h)[7], 0.54);
  EXPECT_GT(at(1, 0, 0)[8], 0.54);
  EXPECT_LT(at(0, 1, 0)[8], -0.54);
}

TYPED_TEST(Harmonics, ProjectAndEvaluate) {
  Random random(1);
  for (int i = 0; i < 5; ++i) {
    const Sh<double> want = random_sh(random);
    Sh<TypeParam> got;  // from samples: one for each direction of the rule, with its weight
    over_sphere([&](const Vec3<double>&) { return 0.0; });
    for (std::size_t k = 0; k < kShCount; ++k)
      got.c[k] = constant<TypeParam>(over_sphere([&](const Vec3<double>& d) {
        return first(sh_in<TypeParam>(want).eval(vector_in<TypeParam>(d))) * Sh<double>::basis(d)[k];
      }));
    for (std::size_t k = 0; k < kShCount; ++k) EXPECT_NEAR(first(got.c[k]), want.c[k], this->kTolerance) << k;
  }
}

TYPED_TEST(Harmonics, AddUpFromSamples) {  // Fibonacci's spiral: nearly equal areas
  Sh<TypeParam> sum;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const Vec3<double> d = Random::direction_at(1 - (2 * i + 1.0) / kSamples, 2.399963229728653 * i);
    sum.add(vector_in<TypeParam>(d),
            constant<TypeParam>((1 + 2 * d.x * d.y + 3 * d.z) * 4 * std::numbers::pi / kSamples));
  }
  const Nine got = numbers(sum.c);
  const double unit[]{1 / sh::kBand0, 0, 3 / sh::kBand1, 0, 2 / sh::kCross, 0, 0, 0, 0};
  for (std::size_t k = 0; k < kShCount; ++k) EXPECT_NEAR(got[k], unit[k], 3e-3) << k;
}

TYPED_TEST(Harmonics, RotateAsTheFunctionDoes) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Sh<double> f = random_sh(random);
    const auto turn = Rotation<double>::about(random.direction(-1) * random.uniform(-7, 7));
    Rotation<TypeParam> rounded;
    rounded.x = vector_in<TypeParam>(turn.x);
    rounded.y = vector_in<TypeParam>(turn.y);
    rounded.z = vector_in<TypeParam>(turn.z);
    const Nine got = numbers(sh_in<TypeParam>(f).rotated(rounded).c);
    // Projected again: the turned function at d is f at the direction that was turned to d.
    const Rotation<double> back{
        {turn.x.x, turn.y.x, turn.z.x}, {turn.x.y, turn.y.y, turn.z.y}, {turn.x.z, turn.y.z, turn.z.z}};
    for (std::size_t k = 0; k < kShCount; ++k) {
      const double want =
          over_sphere([&](const Vec3<double>& d) { return f.eval(back * d) * Sh<double>::basis(d)[k]; });
      EXPECT_NEAR(got[k], want, kIsFloat<TypeParam> ? 2e-6 : 1e-14) << i << " " << k;  // measured 3.3e-7 and 3.4e-15
    }
  }
}

TYPED_TEST(Harmonics, RotateByRowsOfATable) {
  const std::vector<double> in{1, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0, 0, std::numbers::pi / 2};
  const auto out = evaluate_row<ShRotated, TypeParam>(in);  // a quarter turn about z: x to y, y to -x
  const double want[]{1, 0.3, 0.2, -0.1, -0.4, 0.7, 0.6, -0.5, -0.8};
  for (std::size_t k = 0; k < kShCount; ++k) EXPECT_NEAR(out[k], want[k], 2 * this->kTolerance) << k;
}

TYPED_TEST(Harmonics, TurnByNothingAndBySmallAngles) {
  for (const double angle : {0.0, 1e-30, 1e-12, 0.99e-4, 1.01e-4, 1e-2, 3.0, std::numbers::pi, 6.2}) {
    const auto r = Rotation<TypeParam>::about(vector_in<TypeParam>({0, 0, angle}));
    EXPECT_NEAR(first(r.y.x), std::sin(angle), 2 * this->kTolerance * std::min(1.0, angle)) << angle;
    EXPECT_NEAR(first(r.x.x), std::cos(angle), 2 * this->kTolerance) << angle;
    EXPECT_EQ(first(r.z.z), 1);
    const double length = squared(first(r.x.x)) + squared(first(r.x.y));
    EXPECT_NEAR(length, 1, this->kTolerance) << angle;
  }
}

TYPED_TEST(Harmonics, KeepTheirEnergyWhenTheyRotate) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Sh<double> f = random_sh(random);
    const auto turn = random.direction(-1) * 2.0;
    const Nine got = numbers(sh_in<TypeParam>(f).rotated(Rotation<TypeParam>::about(vector_in<TypeParam>(turn))).c);
    double before[3]{}, after[3]{};
    for (std::size_t k = 0; k < kShCount; ++k) {
      before[k == 0 ? 0 : k < 4 ? 1 : 2] += f.c[k] * f.c[k];
      after[k == 0 ? 0 : k < 4 ? 1 : 2] += got[k] * got[k];
    }
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(after[band], before[band], 8 * this->kTolerance) << band;
  }
}

TYPED_TEST(Harmonics, ConvolveWithTheCosine) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const Sh<double> f = random_sh(random);
    const Rotation<double> frame = Rotation<double>::about(random.direction(-1) * random.uniform(0, 6));
    const Vec3<double> normal = frame * Vec3<double>(0, 0, 1);
    const double want = over_sphere([&](const Vec3<double>& d) { return f.eval(frame * d) * d.z; }, 0, 1);
    std::vector<double> in(f.c.begin(), f.c.end());
    in.insert(in.end(), {normal.x, normal.y, normal.z});
    const auto out = evaluate_row<ShValue, TypeParam>(in);
    EXPECT_NEAR(out[1], want, kIsFloat<TypeParam> ? 4e-6 : 2e-14) << i;
    EXPECT_NEAR(out[0], f.eval(normal), this->kTolerance * 4) << i;
  }
  Sh<double> constant_light;
  constant_light.c[0] = 1 / sh::kBand0;
  EXPECT_NEAR(constant_light.convolved_with_cosine().eval({0.6, 0, 0.8}), std::numbers::pi, 1e-15) << "radiance 1";
}

}  // namespace
}  // namespace likeness::brdf
