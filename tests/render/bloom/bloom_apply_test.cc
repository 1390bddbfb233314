#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/bloom/apply.h"
#include "render/bloom/fourier.h"
#include "render/bloom/kernel.h"
#include "render/files/files.h"

namespace likeness::bloom {
namespace {

Kernel colored() {
  return {24,
          {0.9, 0.8, 0.7},
          {{Family::kGaussian, 2, {0.06, 0.1, 0.2}, 0, {}}, {Family::kCauchy, 6, {0.04, 0.1, 0.1}, 0, {}}}};
}

double sum_of(const image::Picture& picture, std::size_t c) {
  double sum = 0;
  for (std::size_t i = c; i < picture.rgb.size(); i += 3) sum += static_cast<double>(picture.rgb[i]);
  return sum;
}

TEST(BloomKernel, SamplesSumToOneAndFallWithDistance) {
  for (const FamilyRow& row : kFamilies)
    for (const double scale : {0.1, 0.5, 1.0, 3.0, 40.0}) {
      const std::vector<double> at = sampled(row.family, scale, 20);
      double sum = 0;
      for (const double value : at) sum += value;
      EXPECT_NEAR(sum, 1, 1e-12) << row.name << scale;
      for (int x = 1; x <= 20; ++x)
        EXPECT_LE(at[20 * 41 + 20 + static_cast<std::size_t>(x)], at[20 * 41 + 19 + static_cast<std::size_t>(x)]);
      EXPECT_EQ(at[0], 0) << "the corner is beyond the radius";
    }
}

TEST(BloomKernel, DensitiesHoldOneOverThePlane) {
  for (const FamilyRow& row : kFamilies) {
    double sum = 0;  // of 2 pi r density dr, with r = exp(u)
    for (double u = -12; u < 14; u += 1e-3)
      sum += 2 * 3.14159265358979 * std::exp(2 * u) * density(row.family, 3, std::exp(u)) * 1e-3;
    EXPECT_NEAR(sum, 1, 1e-5) << row.name;
  }
}

TEST(BloomKernel, TextReadsBack) {
  const Kernel kernel = colored(), again = kernel_of(text_of(kernel), "k.json");
  EXPECT_EQ(text_of(again), text_of(kernel));
  const auto message = [](std::string text, const std::string& what, const std::string& by) -> std::string {
    if (const auto at = text.find(what); at != std::string::npos) text.replace(at, what.size(), by);
    try {
      kernel_of(text, "k.json");
    } catch (const files::InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  using testing::HasSubstr;
  EXPECT_THAT(message(text_of(kernel), "0.9", "0.8"), HasSubstr("add up to 0.9"));
  EXPECT_THAT(message(text_of(kernel), "\"cauchy\"", "\"lorentz\""), HasSubstr("\"lorentz\""));
  EXPECT_THAT(message(text_of(kernel), "\"scale\": 2.0", "\"scale\": 0"), HasSubstr("k.json:"));
  EXPECT_THAT(message(text_of(kernel), "0.06", "-0.06"), HasSubstr("[0, 1]"));
  EXPECT_THAT(message(text_of(kernel), "likeness bloom", "likeness"), HasSubstr("likeness bloom"));
  EXPECT_THAT(message("[]", "", ""), HasSubstr("object"));
}

TEST(BloomFourier, ForwardAndBackIsTheSame) {
  for (const int size : {1, 2, 30, 45}) {
    Square square(size), before(size);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) before(x, y) = square(x, y) = {std::sin(3.0 * x + y * y), std::cos(x * y)};
    transform(square, false);
    transform(square, true);
    for (std::size_t i = 0; i < square.at.size(); ++i) EXPECT_LT(std::abs(square.at[i] - before.at[i]), 1e-13);
  }
  EXPECT_EQ(fast_size(7), 8);
  EXPECT_EQ(fast_size(1025), 1080);
}

TEST(BloomApply, AnImpulseBecomesTheKernel) {
  const Kernel kernel = colored();
  image::Picture picture(101, 83);
  for (std::size_t c = 0; c < 3; ++c) picture.at(50, 40)[c] = 8;
  const Applied out = apply(picture, kernel);
  std::array<std::vector<double>, 2> parts{sampled(Family::kGaussian, 2, 24), sampled(Family::kCauchy, 6, 24)};
  for (int y = 0; y < 83; ++y)
    for (int x = 0; x < 101; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        double want = x == 50 && y == 40 ? kernel.direct[c] : 0;
        if (std::abs(x - 50) <= 24 && std::abs(y - 40) <= 24)
          for (std::size_t k = 0; k < 2; ++k)
            want +=
                kernel.components[k].weight[c] * parts[k][static_cast<std::size_t>((y - 40 + 24) * 49 + x - 50 + 24)];
        ASSERT_NEAR(static_cast<double>(out.picture.at(x, y)[c]), 8 * want, 1e-6 * 8) << x << " " << y;  // float
      }
}

TEST(BloomApply, LightIsKept) {
  image::Picture picture(97, 64);
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] = static_cast<float>((i * 7919) % 1000) / 100.0f;
  picture.at(0, 0)[0] = 1e6f;  // in the corner, where most would be lost
  const Applied mirrored = apply(picture, colored(), {Edges::kReflect, {}});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(sum_of(mirrored.picture, c) / sum_of(picture, c), 1, 1e-6);
  const Applied lost = apply(picture, colored());
  EXPECT_LT(sum_of(lost.picture, 0), 0.98 * sum_of(picture, 0));
}

TEST(BloomApply, TilesMakeNoDifference) {
  // Wider than one tile of 2048: a point at the seam looks like one in the middle.
  Kernel kernel = colored();
  kernel.radius = 40;
  image::Picture wide(5000, 60), narrow(200, 60);
  const int seam = 2048 - 80;
  for (std::size_t c = 0; c < 3; ++c) wide.at(seam, 30)[c] = narrow.at(100, 30)[c] = 5, wide.at(4990, 3)[c] = 1;
  const Applied a = apply(wide, kernel), b = apply(narrow, kernel);
  for (int y = 0; y < 60; ++y)
    for (int x = -90; x < 90; ++x) ASSERT_NEAR(a.picture.at(seam + x, y)[1], b.picture.at(100 + x, y)[1], 1e-6f);
}

TEST(BloomApply, DarkPixelsBesideAHotOneAreExact) {
  image::Picture picture(64, 64);
  for (float& value : picture.rgb) value = 1e-6f;
  for (std::size_t c = 0; c < 3; ++c) picture.at(5, 5)[c] = 60000;
  const Applied out = apply(picture, colored(), {Edges::kReflect, {}});
  EXPECT_NEAR(out.picture.at(60, 60)[0], 1e-6f, 1e-10f) << "the hot pixel is farther than the radius";
  for (const float value : out.picture.rgb) ASSERT_GE(value, 0);
}

TEST(BloomApply, AnyFloatIsSafe) {
  using Limits = std::numeric_limits<float>;
  for (const Edges edges : {Edges::kLose, Edges::kReflect}) {
    for (const float odd :
         {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), -5.0f, Limits::max(), Limits::denorm_min()}) {
      image::Picture picture(9, 5);
      for (float& value : picture.rgb) value = 1;
      picture.at(4, 2)[1] = odd;
      const Applied out = apply(picture, colored(), {edges, {}});
      for (const float value : out.picture.rgb) ASSERT_TRUE(std::isfinite(value)) << odd;
      EXPECT_EQ(out.not_a_number, std::isnan(odd) ? 1u : 0u);
      EXPECT_EQ(out.infinite, std::isinf(odd) ? 1u : 0u);
    }
    image::Picture one(1, 1);
    one.rgb = {1, 2, 3};
    const Applied out = apply(one, colored(), {edges, {}});
    EXPECT_GT(out.picture.rgb[2], edges == Edges::kReflect ? 2.999f : 2.0f);
    EXPECT_EQ(apply(image::Picture(), colored(), {edges, {}}).picture.rgb.size(), 0u);
    const Applied black = apply(image::Picture(30, 20), colored(), {edges, {}});
    for (const float value : black.picture.rgb) ASSERT_EQ(value, 0);
  }
}

TEST(BloomApply, ItIsLinear) {
  image::Picture a(40, 40), b(40, 40), both(40, 40);
  a.at(10, 10)[0] = 3, b.at(30, 22)[0] = 500;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) both.rgb[i] = 2 * a.rgb[i] + b.rgb[i];
  const Applied pa = apply(a, colored()), pb = apply(b, colored()), pc = apply(both, colored());
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    ASSERT_NEAR(pc.picture.rgb[i], 2 * pa.picture.rgb[i] + pb.picture.rgb[i], 5e-5f);
}

}  // namespace
}  // namespace likeness::bloom
