#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/bloom/fit.h"
#include "tests/render/bloom/small_lamp.h"

namespace likeness::bloom {
namespace {

// The share of the light of one channel that is scattered farther than r pixels.
double beyond(const Kernel& kernel, std::size_t c, double r) {
  double sum = 0;
  for (const Component& component : kernel.components) {
    const std::vector<double> at = sampled(component.family, component.scale, kernel.radius);
    const int side = 2 * kernel.radius + 1;
    for (int i = 0; i < side * side; ++i)
      if (std::hypot(i % side - kernel.radius, i / side - kernel.radius) > r)
        sum += component.weight[c] * at[static_cast<std::size_t>(i)];
  }
  return sum;
}

// Radius 80: that of the fit's own square (2 x 40).
Kernel truth() {
  return {80,
          {0.90, 0.88, 0.85},
          {{Family::kGaussian, 3, {0.06, 0.07, 0.09}, 0, {}}, {Family::kCauchy, 12, {0.04, 0.05, 0.06}, 0, {}}}};
}

TEST(BloomFit, AKnownKernelComesBackWithinItsErrors) {
  const test::Lamp lamp = test::lamp(truth(), 81, 0.01, 1e9f);
  const Fit fit = fit_kernel(lamp.source, lamp.glare);
  EXPECT_EQ(fit.kernel.radius, 80);
  ASSERT_EQ(fit.kernel.components.size(), 2u);
  EXPECT_FALSE(fit.clip);
  for (std::size_t k = 0; k < 2; ++k) {
    const Component got = fit.kernel.components[k], want = truth().components[k];
    EXPECT_EQ(got.family, want.family);
    EXPECT_NEAR(got.scale, want.scale, 3 * got.scale_error) << got.scale_error;
    EXPECT_LT(got.scale_error, 0.05 * want.scale);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(got.weight[c], want.weight[c], 3 * got.weight_error[c]) << got.weight_error[c];
  }
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(fit.scale[c], 1, 0.02);  // 1 % a pixel, and the source is 38 of them: 0.3 % a sigma
    double sum = fit.kernel.direct[c];
    for (const Component& component : fit.kernel.components) sum += component.weight[c];
    EXPECT_NEAR(sum, 1, 1e-12);
  }
  EXPECT_NEAR(fit.misfit, 1, 0.4) << "errors of rings are those of the noise";
}

TEST(BloomFit, AClippedCoreIsLeftOut) {
  const test::Lamp lamp = test::lamp(truth(), 81, 0.01, 40);
  const Fit fit = fit_kernel(lamp.source, lamp.glare);
  ASSERT_TRUE(fit.clip);
  EXPECT_EQ(*fit.clip, 40);
  EXPECT_GT(fit.clipped, 20u);
  EXPECT_FALSE(fit.is_direct_seen);
  for (const double r : {6.0, 12.0, 24.0})
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(beyond(fit.kernel, c, r) / beyond(truth(), c, r), 1, 0.05) << r;
}

TEST(BloomFit, AnotherExposureIsAScaleNotAKernel) {
  const test::Lamp lamp = test::lamp(truth(), 81, 0.002, 1e9f, 0.25);
  const Fit fit = fit_kernel(lamp.source, lamp.glare);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(fit.scale[c], 0.25, 0.002);
    EXPECT_NEAR(beyond(fit.kernel, c, 8) / beyond(truth(), c, 8), 1, 0.03);
  }
}

TEST(BloomFit, NoGlareIsNoKernel) {
  const test::Lamp lamp = test::lamp({80, {1, 1, 1}, {}}, 81, 0.005, 1e9f);
  const Fit fit = fit_kernel(lamp.source, lamp.glare);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(beyond(fit.kernel, c, 2), 1e-3);
}

TEST(BloomFit, OneComponentIsEnoughWhereThereIsOne) {
  const Kernel one{80, {0.9, 0.9, 0.9}, {{Family::kCauchy, 5, {0.1, 0.1, 0.1}, 0, {}}}};
  const test::Lamp lamp = test::lamp(one, 81, 0.01, 1e9f);
  const Fit fit = fit_kernel(lamp.source, lamp.glare);
  ASSERT_EQ(fit.kernel.components.size(), 1u);
  EXPECT_EQ(fit.kernel.components[0].family, Family::kCauchy);
  EXPECT_NEAR(fit.kernel.components[0].scale, 5, 0.1);
}

TEST(BloomFit, RefusesWhatHasNoSource) {
  EXPECT_THROW(fit_kernel(image::Picture(40, 40), image::Picture(40, 40)), std::invalid_argument);
  EXPECT_THROW(fit_kernel(image::Picture(), image::Picture()), std::invalid_argument);
  image::Picture one(1, 1);
  one.rgb = {1, 1, 1};
  EXPECT_THROW(fit_kernel(one, one), std::invalid_argument);
  const test::Lamp lamp = test::lamp(truth(), 41, 0.01, 1e9f);
  EXPECT_THROW(fit_kernel(lamp.source, image::Picture(20, 20)), std::invalid_argument);
  image::Picture bad = lamp.glare;
  for (float& value : bad.rgb) value = std::nanf("");
  EXPECT_THROW(fit_kernel(lamp.source, bad), std::invalid_argument);
  bad = lamp.glare;
  bad.at(3, 3)[0] = INFINITY, bad.at(20, 20)[1] = std::nanf("");
  const Fit fit = fit_kernel(lamp.source, bad);
  EXPECT_EQ(fit.clipped, 1u) << "the corner is beyond the rings";
  EXPECT_TRUE(std::isfinite(fit.kernel.direct[0]));
}

}  // namespace
}  // namespace likeness::bloom
