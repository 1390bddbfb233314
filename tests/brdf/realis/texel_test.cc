#include "brdf/realis/texel.h"

#include "tests/brdf/kinds.h"
#include "tests/brdf/realis/by_definition.h"

// A texel's eight lobes.
namespace likeness::brdf {
namespace {

template <class S>
class Texel : public ::testing::Test {};
TYPED_TEST_SUITE(Texel, Kinds, KindNames);

// What the polynomial, the float of reach and the sum leave.
constexpr double kOff = 1e-5;

TYPED_TEST(Texel, HasTheResidualOfItsEightLobes) {
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const Drawn drawn = drawn_texel(random);
    const Vec3<double> v = Vec3<double>(Vec3<float>(random.direction(-1)));
    ASSERT_NEAR(first(residual(drawn.lobes, drawn.texel, vector_in<TypeParam>(v))),
                residual_by_definition(drawn.written, v), kOff * magnitude(drawn.written));
  }
}

TYPED_TEST(Texel, OfThreeChannelsIsThreeOfOne) {
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const Drawn drawn = drawn_texel(random);
    RealisTexel<3> rgb;
    rgb.lobes = drawn.texel.lobes;
    std::array<RealisTexel<1>, 3> grey;
    for (std::size_t c = 0; c < 3; ++c) {
      grey[c].lobes = rgb.lobes;
      for (std::size_t j = 0; j < kRealisDominant; ++j)
        rgb.coefficients[c][j] = grey[c].coefficients[0][j] = std::uint8_t(random.index(256));
    }
    const auto v = vector_in<TypeParam>(random.direction(-1));
    const auto e = residual(drawn.lobes, rgb, v);
    EXPECT_EQ(first(e.r), first(residual(drawn.lobes, grey[0], v)));
    EXPECT_EQ(first(e.g), first(residual(drawn.lobes, grey[1], v)));
    EXPECT_EQ(first(e.b), first(residual(drawn.lobes, grey[2], v)));
  }
}

TYPED_TEST(Texel, HasAMultiplierForEachChannel) {
  Random random(7);
  const Vec3<float> axis(0.6f, 0, 0.8f);
  RealisLobes lobes;
  lobes.place(3, axis, 5, Rgb<float>(0.5f, 0.25f, 2));
  RealisTexel<3> texel;
  texel.lobes[4] = 3;
  for (auto& channel : texel.coefficients) channel[4] = 255;
  for (int i = 0; i < 100; ++i) {
    const Vec3<double> v = Vec3<double>(Vec3<float>(random.direction()));
    const double g = lobe_by_definition(1 - versine_between(Vec3<double>(axis), v), 5);
    const auto e = residual(lobes, texel, vector_in<TypeParam>(v));
    EXPECT_NEAR(first(e.r), 0.5 * g, kOff);
    EXPECT_NEAR(first(e.g), 0.25 * g, kOff);
    EXPECT_NEAR(first(e.b), 2 * g, 2 * kOff);
    const Rgb<float> towards = residual(RealisTowards<3>(lobes, Vec3<float>(v)), texel);
    EXPECT_NEAR(towards.g, 0.25 * g, kOff);
    EXPECT_NEAR(towards.b, 2 * g, 2 * kOff);
  }
}

TYPED_TEST(Texel, WithoutLobesIsNothing) {
  Random random(3);
  const Drawn drawn = drawn_texel(random);
  const auto v = vector_in<TypeParam>(random.direction());
  EXPECT_EQ(first(residual(drawn.lobes, RealisTexel<1>{}, v)), 0) << "a new one";
  EXPECT_EQ(first(residual(RealisLobes{}, drawn.texel, v)), 0) << "of an asset without lobes";
  RealisTexel<1> beyond = drawn.texel;
  for (auto& number : beyond.lobes) number = std::uint8_t(96 + random.index(160));
  EXPECT_EQ(first(residual(drawn.lobes, beyond, v)), 0) << "that names lobes which are not there";
}

TYPED_TEST(Texel, OfAnyBytesIsFinite) {
  Random random(4);
  const double kEdges[] = {0, 1, -1, 1e-20, 1e-42};
  for (int i = 0; i < 20000; ++i) {
    Drawn drawn = drawn_texel(random, 1e6, 256);
    for (std::size_t j = 0; j < kRealisDominant; ++j) drawn.texel.coefficients[0][j] = std::uint8_t(random.index(256));
    drawn.lobes.place(drawn.texel.lobes[0], {0, 0, 1}, random.index(2) ? 0 : 1e6f, 1e30f);
    Vec3<double> v = random.direction(-1);
    if (i % 4 == 0) v = {kEdges[random.index(5)], kEdges[random.index(5)], kEdges[random.index(5)]};
    ASSERT_TRUE(std::isfinite(first(residual(drawn.lobes, drawn.texel, vector_in<TypeParam>(v)))));
  }
}

TEST(Towards, AreTheSameValuesForManyTexels) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Drawn drawn = drawn_texel(random, 40, i % 2 ? 96 : 256);
    const Vec3<float> v(random.direction(-1));
    const RealisTowards<1> towards(drawn.lobes, v);
    EXPECT_NEAR(residual(towards, drawn.texel), residual(drawn.lobes, drawn.texel, v), 5e-7 * magnitude(drawn.written));
    RealisTexel<3> rgb;
    rgb.lobes = drawn.texel.lobes;
    rgb.coefficients[1] = drawn.texel.coefficients[0];
    const Rgb<float> e = residual(RealisTowards<3>(drawn.lobes, v), rgb);
    EXPECT_EQ(e.r, 0);
    EXPECT_EQ(e.g, residual(towards, drawn.texel));
  }
  EXPECT_EQ(residual(RealisTowards<1>(), RealisTexel<1>()), 0);
}

}  // namespace
}  // namespace likeness::brdf
