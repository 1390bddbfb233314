#include "brdf/realis/lobes.h"

#include <Eigen/Dense>

#include "brdf/realis/evaluators.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/kinds.h"
#include "tests/brdf/realis/by_definition.h"

// The lobes of an asset and their sum.
namespace likeness::brdf {
namespace {

template <class S>
std::vector<WindowedGaussian<S>> gaussians_of(const std::vector<WrittenLobe>& lobes) {
  std::vector<WindowedGaussian<S>> out;
  for (const WrittenLobe& lobe : lobes) out.push_back({{vector_in<S>(lobe.axis), constant<S>(lobe.sharpness), S(1.0)}});
  return out;
}
template <class S>
S residual_of(const std::vector<WrittenLobe>& lobes, const Vec3<double>& v) {
  std::vector<S> coefficients;
  for (const WrittenLobe& lobe : lobes) coefficients.push_back(constant<S>(lobe.coefficient));
  const auto gaussians = gaussians_of<S>(lobes);
  return residual<S>(gaussians, coefficients, vector_in<S>(v));
}

template <class S>
class Lobes : public ::testing::Test {
 protected:
  static constexpr double kEpsilon = kIsFloat<S> ? 6e-8 : 1.2e-16;  // half an ulp of 1
};
TYPED_TEST_SUITE(Lobes, Kinds, KindNames);

TYPED_TEST(Lobes, AddUpToTheResidual) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    std::vector<WrittenLobe> lobes(i % 97);
    for (WrittenLobe& lobe : lobes)
      lobe = {random.direction(-1), i % 5 ? std::exp(random.uniform(-3, 4)) : 0, random.uniform(-1, 1)};
    const Vec3<double> v = random.direction(-1);
    // Exponents to 110 of vectors rounded to S, and a sum of up to 96: 250 half ulps were seen of the magnitudes.
    ASSERT_NEAR(first(residual_of<TypeParam>(lobes, v)), residual_by_definition(lobes, v),
                40 * this->kEpsilon * magnitude(lobes));
  }
  EXPECT_EQ(first(residual_of<TypeParam>({}, {0, 0, 1})), 0) << "no lobes";
}

template <int kDegree, class S>
double worst_decay(double least_t = 0) {
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const double t = double(typename Arithmetic<S>::Number(least_t + (1 - least_t) * i / 20000.0));
    const double want = std::exp(-std::log(100) * t) * (1 - t) * (1 - t) * (1 + 2 * t);
    worst = std::max(worst, std::abs(first(windowed_decay<kDegree>(constant<S>(t))) / want - 1));
  }
  return worst;
}
// The errors that windowed_decay() states, and that they are no less.
TYPED_TEST(Lobes, WithoutAnExponentialAreOffByWhatIsStated) {
  const double kOwn = kIsFloat<TypeParam> ? 2e-6 : 4e-15;
  EXPECT_LE((worst_decay<3, TypeParam>()), 2.8e-3);
  EXPECT_GE((worst_decay<3, TypeParam>()), 2.6e-3);
  EXPECT_LE((worst_decay<5, TypeParam>()), 7.1e-6 + kOwn);
  EXPECT_GE((worst_decay<5, TypeParam>()), 6.9e-6 - kOwn);
  EXPECT_LE((worst_decay<7, TypeParam>()), 1.03e-8 + kOwn);
}

TYPED_TEST(Lobes, WithoutAnExponentialAreOneOnTheAxisAndNothingFromTheirEndOn) {
  const auto at = [](double t) { return first(windowed_decay(constant<TypeParam>(t))); };
  for (const double t : {0.0, 1e-45, 1e-40, 1e-38, 1e-30}) EXPECT_EQ(at(t), 1) << t;
  for (const double t : {1.0, 1.0000001, 2.0, 4.4e5, 1e30, 3e38}) EXPECT_EQ(at(t), 0) << t;
  double before = 1;
  for (int i = 1; i <= 2000; ++i) {
    const double now = at(i / 2000.0);
    EXPECT_TRUE(now >= 0 && now <= before) << i << ": they fall everywhere";
    EXPECT_GE(now, before - 0.0025) << i << ": without a step";  // the slope is 4.6 at most
    before = now;
  }
}

TYPED_TEST(Lobes, AsStoredAreThoseThatWerePlaced) {
  Random random(4);
  for (int i = 0; i < 3000; ++i) {
    const Vec3<float> axis(random.direction(-1));
    const float sharpness = i % 7 ? float(std::exp(random.uniform(-10, 5))) : 0;
    RealisLobes lobes;
    lobes.place(std::size_t(i % 256), axis, sharpness, 1);
    const Vec3<double> v = Vec3<double>(Vec3<float>(random.direction(-1)));
    const double versine = versine_between(Vec3<double>(axis), v);
    const double want = lobe_by_definition(1 - versine, sharpness);
    const double got = first(lobes.eval(std::size_t(i % 256), vector_in<TypeParam>(v)));
    // reach is a float: x is off by 3e-7 of it, where the slope is 4.6 at most and falls as the root at the end.
    ASSERT_NEAR(got, want, 7.1e-6 * want + 2e-6 * std::sqrt(want)) << sharpness << " " << versine;
  }
}

TYPED_TEST(Lobes, HoldWhereTheyAreHard) {
  for (const float sharpness : {0.f, 1e-45f, 1e-38f, 1e-7f, 1.f, 2.3f, 40.f, 1e6f, 3e38f}) {
    RealisLobes lobes;
    const Vec3<float> axis(0.6f, 0, 0.8f);
    lobes.place(7, axis, sharpness, 1);
    const auto towards = [&](const Vec3<double>& v) { return first(lobes.eval(7, vector_in<TypeParam>(v))); };
    const Vec3<double> exact(axis);
    EXPECT_EQ(towards(exact), 1) << sharpness << " along the axis";
    const double opposite = towards({-exact.x, 0, -exact.z}), nowhere = towards({0, 0, 0});
    EXPECT_NEAR(opposite, lobe_by_definition(-1, sharpness), 2e-5) << sharpness << " opposite";
    EXPECT_NEAR(nowhere, lobe_by_definition(0.5, sharpness), 2e-5) << sharpness << " no direction: 60 degrees";
    if (sharpness < 1e-6f) {
      EXPECT_NEAR(opposite, 1, 1e-6) << sharpness;
    }
    for (const double tilt : {1e-45, 1e-30, 1e-20, 1e-7, 1e-4, 1e-3}) {
      const double there = towards({exact.x + tilt, 0, exact.z});
      EXPECT_TRUE(there >= 0 && there <= 1) << sharpness << " " << tilt;
    }
  }
}

TYPED_TEST(Lobes, ThatWereNeverPlacedAddNothing) {
  const RealisLobes none;
  for (std::size_t k = 0; k < RealisLobes::kMost; ++k) {
    EXPECT_EQ(none.lobes[k].scale, (std::array<float, 3>{}));
    EXPECT_TRUE(std::isfinite(first(none.eval(k, vector_in<TypeParam>({0, 0, -1})))));
  }
}

// As many lobes as lights, no bytes, no weights: what was photographed comes back, also where the surface turns away.
TYPED_TEST(Lobes, AsManyAsLightsInvertTheBake) {
  constexpr std::size_t kLights = 96;
  constexpr double kFloor = 0.1;
  Random random(6);
  const Vec3<double> normal = Random::direction_at(0.6, 0.4);
  std::vector<WrittenLobe> lobes;
  std::vector<double> photo, render, light, cosine;
  for (std::size_t i = 0; i < kLights; ++i) {
    lobes.push_back({Random::direction_at(1 - (double(i) + 0.5) / kLights, 2.399963 * double(i)), 120, 0});
    cosine.push_back(dot(normal, lobes.back().axis));
    photo.push_back(std::exp(random.uniform(-4, 1)));
    render.push_back(photo.back() * random.uniform(0.1, 3));
    light.push_back(std::exp(random.uniform(-1, 1)));
  }
  EXPECT_LT(*std::min_element(cosine.begin(), cosine.end()), 0) << "some lights are behind the surface";
  Eigen::MatrixXd basis(kLights, kLights);
  Eigen::VectorXd e(kLights);
  for (std::size_t i = 0; i < kLights; ++i) {
    e(long(i)) = demodulated(photo[i] - render[i], light[i], cosine[i], kFloor);
    for (std::size_t k = 0; k < kLights; ++k)
      basis(long(i), long(k)) = lobe_by_definition(dot(lobes[i].axis, lobes[k].axis), 120);
  }
  const Eigen::VectorXd c = basis.partialPivLu().solve(e);
  for (std::size_t k = 0; k < kLights; ++k) lobes[k].coefficient = c(long(k));
  for (std::size_t i = 0; i < kLights; ++i) {
    using S = TypeParam;
    const S again = with_residual(constant<S>(render[i] / light[i]), residual_of<S>(lobes, lobes[i].axis), S(1.0),
                                  constant<S>(cosine[i]), constant<S>(kFloor));
    EXPECT_NEAR(first(again) * light[i] / photo[i], 1, kIsFloat<S> ? 1e-5 : 1e-12) << i;
  }
}

// The row of `likeness eval`, world directions and all.
TYPED_TEST(Lobes, AsARowAreTheDefinition) {
  Random random(12);
  for (int i = 0; i < 2000; ++i) {
    const Vec3<double> light = random.direction(-1);
    const double angle = random.uniform(-3, 3), cos_i = random.uniform(-1, 1), f_cos = random.uniform(0, 0.3);
    const double floor = random.uniform(0.02, 0.5), weight = random.uniform();
    std::vector<double> in{light.x, light.y, light.z, 0, 0, angle, cos_i, f_cos, floor, weight};
    std::vector<WrittenLobe> lobes;
    for (int k = 0; k < 3; ++k) {
      lobes.push_back({random.direction(-1), std::exp(random.uniform(-2, 3)), random.uniform(-1, 1)});
      const WrittenLobe& l = lobes.back();
      in.insert(in.end(), {l.axis.x, l.axis.y, l.axis.z, l.sharpness, l.coefficient});
    }
    const double c = std::cos(angle), s = std::sin(angle);  // about z
    const double e = residual_by_definition(lobes, {c * light.x - s * light.y, s * light.x + c * light.y, light.z});
    const auto out = evaluate_row<RealisResidual, TypeParam>(in);
    ASSERT_NEAR(out[0], e, 60 * this->kEpsilon * magnitude(lobes));
    ASSERT_NEAR(out[1], std::max(0.0, f_cos + weight * e * std::max(cos_i, floor)),
                90 * this->kEpsilon * magnitude(lobes));
  }
}

TYPED_TEST(Lobes, AsRowsOfOneAreTheDefinition) {
  Random random(13);
  for (int i = 0; i < 2000; ++i) {
    const double angle = random.uniform(0, 1.5), sharpness = double(float(std::exp(random.uniform(-2, 3))));
    const double byte = double(random.index(256)), multiplier = random.uniform(0, 2);
    const double c = multiplier * (byte - 128) / 127, want = c * lobe_by_definition(std::cos(angle), sharpness);
    const std::vector<double> in{angle, sharpness, byte, multiplier};
    const double own = 60 * this->kEpsilon * std::abs(c);
    ASSERT_NEAR((evaluate_row<RealisLobeExact, TypeParam, RealisByAngle>(in)[0]), want, own);
    ASSERT_NEAR((evaluate_row<RealisLobe3, TypeParam, RealisByAngle>(in)[0]), want, own + 2.8e-3 * std::abs(want));
    ASSERT_NEAR((evaluate_row<RealisLobe5, TypeParam, RealisByAngle>(in)[0]), want, own + 7.1e-6 * std::abs(want));
    ASSERT_NEAR((evaluate_row<RealisLobe7, TypeParam, RealisByAngle>(in)[0]), want, own + 1.1e-8 * std::abs(want));
  }
}

}  // namespace
}  // namespace likeness::brdf
