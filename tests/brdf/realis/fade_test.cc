#include "brdf/realis/fade.h"

#include "brdf/realis/evaluators.h"
#include "tests/brdf/evaluator_row.h"

// Where the surface is no longer what was baked.
namespace likeness::brdf {
namespace {

template <class S>
class Fade : public ::testing::Test {
 protected:
  static RealisProperties<S> properties(const Rgb<double>& color, double roughness, const Vec3<double>& normal) {
    return {{constant<S>(color.r), constant<S>(color.g), constant<S>(color.b)},
            constant<S>(roughness),
            vector_in<S>(normal)};
  }
  static double weight(const RealisProperties<S>& now) {
    return first(RealisFade{}.weight(properties({0.4, 0.2, 0.02}, 0.5, {0, 0, 1}), now));
  }
};
TYPED_TEST_SUITE(Fade, Kinds, KindNames);

Vec3<double> tilted(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return {std::sin(angle), 0, std::cos(angle)};
}

TYPED_TEST(Fade, LeavesAloneWhatIsAsItWasBaked) {
  EXPECT_EQ(this->weight(this->properties({0.4, 0.2, 0.02}, 0.5, {0, 0, 1})), 1);
  EXPECT_EQ(this->weight(this->properties({0.4 * 0.91, 0.2, 0.02}, 0.5, {0, 0, 1})), 1) << "10 % of a color";
  EXPECT_EQ(this->weight(this->properties({0.4, 0.2, 0.029}, 0.5, {0, 0, 1})), 1) << "the last bits of a dark one";
  EXPECT_EQ(this->weight(this->properties({0.4, 0.2, 0.02}, 0.549, tilted(5))), 1);
}

TYPED_TEST(Fade, TakesAwayWhereOneThingDiffersAtAll) {
  EXPECT_EQ(this->weight(this->properties({0.4, 0.09, 0.02}, 0.5, {0, 0, 1})), 0) << "green";
  EXPECT_EQ(this->weight(this->properties({0.81, 0.2, 0.02}, 0.5, {0, 0, 1})), 0) << "red, upwards";
  EXPECT_EQ(this->weight(this->properties({0.4, 0.2, 0.08}, 0.5, {0, 0, 1})), 0) << "blue";
  EXPECT_EQ(this->weight(this->properties({0.4, 0.2, 0.02}, 0.81, {0, 0, 1})), 0);
  EXPECT_EQ(this->weight(this->properties({0.4, 0.2, 0.02}, 0.19, {0, 0, 1})), 0);
  EXPECT_EQ(this->weight(this->properties({0.4, 0.2, 0.02}, 0.5, tilted(26))), 0);
  EXPECT_EQ(this->weight(this->properties({0.4, 0.2, 0.02}, 0.5, tilted(180))), 0);
}

TYPED_TEST(Fade, IsHalfHalfwayAndMultiplies) {
  EXPECT_NEAR(this->weight(this->properties({0.4 * 0.7, 0.2, 0.02}, 0.5, {0, 0, 1})), 0.5, 1e-6);
  EXPECT_NEAR(this->weight(this->properties({0.4, 0.2, 0.02}, 0.675, {0, 0, 1})), 0.5, 1e-6);
  EXPECT_NEAR(this->weight(this->properties({0.4 * 0.7, 0.2, 0.02}, 0.675, {0, 0, 1})), 0.25, 1e-6);
  const double halfway = std::acos(1 - 0.052) * 180 / std::numbers::pi;
  EXPECT_NEAR(this->weight(this->properties({0.4 * 0.7, 0.2, 0.02}, 0.325, tilted(halfway))), 0.125, 1e-6);
}

TYPED_TEST(Fade, NeitherJumpsNorLeavesItsRange) {
  double before = 1;
  for (int i = 0; i <= 1000; ++i) {
    const double w = this->weight(this->properties({0.4, 0.2, 0.02}, 0.5 + 0.0005 * i, {0, 0, 1}));
    EXPECT_TRUE(w >= 0 && w <= before && w >= before - 0.004) << i;  // the slope is 1.5 / 0.25
    before = w;
  }
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const auto any = [&] { return random.index(3) ? random.uniform() : double(random.index(2)); };
    const double w = this->weight(this->properties({any(), any(), any()}, any(), random.direction(-1)));
    ASSERT_TRUE(w >= 0 && w <= 1) << w;
  }
}

TYPED_TEST(Fade, AsARowIsTheSame) {
  const auto out =
      evaluate_row<RealisFaded, TypeParam>({0.4, 0.2, 0.02, 0.5, 0.28, 0.2, 0.02, 0.675, std::acos(1 - 0.052)});
  EXPECT_NEAR(out[0], 0.125, 1e-6);
}

TEST(ColorDistance, IsSymmetricAndCountsTheLargestChannel) {
  const Rgb<double> a(0.5, 0.2, 0.01), b(0.4, 0.25, 0.03);
  EXPECT_NEAR(base_color_distance(a, b), 0.2, 1e-15);
  EXPECT_EQ(base_color_distance(a, b), base_color_distance(b, a));
  EXPECT_EQ(base_color_distance(a, a), 0);
  EXPECT_EQ(base_color_distance(Rgb<double>(0, 0, 0), Rgb<double>(0, 0, 0)), 0) << "black and black";
  EXPECT_EQ(base_color_distance(Rgb<double>(0, 0, 0), Rgb<double>(0, 1, 0)), 1);
}

}  // namespace
}  // namespace likeness::brdf
