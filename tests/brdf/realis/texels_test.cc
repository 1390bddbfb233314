#include "tests/brdf/realis/texels_in_set.h"

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/brdf/realis/by_definition.h"

// Many texels at once, in each instruction set.
namespace likeness::brdf {
namespace {

struct Set {
  const char* name;
  TexelsInSet texels;
};
std::vector<Set> sets_of_this_machine() {
  std::vector<Set> sets{{"baseline", texels_baseline()}};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) sets.push_back({"avx2", texels_avx2()});
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq"))
    sets.push_back({"avx512", texels_avx512()});
#endif
  return sets;
}

// Texels of one asset with some of everything: unused slots, equal lobes, sharpness from 0 to 1e6, the axes themselves.
struct Surface {
  RealisLobes lobes;
  std::vector<RealisTexel<3>> rgb;
  std::vector<RealisTexel<1>> grey;
  std::vector<float> x, y, z;
};
Surface surface_of(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Surface s;
  std::vector<Vec3<float>> axes;
  for (std::size_t k = 0; k < 96; ++k) {
    axes.emplace_back(random.direction(-1));
    const auto any = [&] { return float(std::exp(random.uniform(-6, 1))); };
    const Rgb<float> multiplier(any(), any(), any());
    const double sharpness = k % 8 == 0 ? 0 : k % 8 == 1 ? 1e6 : std::exp(random.uniform(-4, 5));
    s.lobes.place(k, axes.back(), float(sharpness), multiplier);
  }
  for (std::size_t i = 0; i < count; ++i) {
    RealisTexel<3> rgb;
    for (std::size_t j = 0; j < kRealisDominant; ++j) {
      rgb.lobes[j] = std::uint8_t(random.index(random.index(10) ? 96 : 256));
      for (auto& channel : rgb.coefficients)
        channel[j] = std::uint8_t(random.index(4) ? random.index(256) : std::size_t{128});
    }
    RealisTexel<1> grey;
    grey.lobes = rgb.lobes;
    grey.coefficients[0] = rgb.coefficients[0];
    Vec3<float> v(random.direction(-1));
    if (i % 9 == 0) v = axes[rgb.lobes[0] % 96];
    if (i % 31 == 0) v = Vec3<float>(0, 0, 0);
    if (i % 37 == 0) v = Vec3<float>(1e-42f, -1e-39f, -1);
    s.rgb.push_back(rgb), s.grey.push_back(grey);
    s.x.push_back(v.x), s.y.push_back(v.y), s.z.push_back(v.z);
  }
  return s;
}
// The sum of the coefficients' magnitudes, which an error is to be compared with.
double magnitude_of(const Surface& s, std::size_t i, std::size_t channel) {
  double sum = 0;
  for (std::size_t j = 0; j < kRealisDominant; ++j)
    sum += double(s.lobes.lobes[s.rgb[i].lobes[j]].scale[channel]) *
           std::abs(s.rgb[i].coefficients[channel][j] - kRealisZero);
  return sum;
}
constexpr double kFourUlps = 4 * 0x1p-23;

constexpr std::uint32_t kGuard = 0xffc0dead;
const float kGuardValue = std::bit_cast<float>(kGuard);

TEST(Texels, HaveTheValuesOfOneAfterTheOther) {
  for (const Set& set : sets_of_this_machine())
    for (std::size_t count = 0; count < 70; ++count) {
      const Surface s = surface_of(count, 100 + count);
      std::vector<float> out(count + 16, kGuardValue);
      set.texels.grey(s.lobes, s.grey.data(), s.x.data(), s.y.data(), s.z.data(), {out.data()}, count);
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_NEAR(out[i], residual(s.lobes, s.grey[i], Vec3<float>(s.x[i], s.y[i], s.z[i])),
                    kFourUlps * magnitude_of(s, i, 0))
            << set.name << ": " << i << " of " << count;
      for (std::size_t i = count; i < out.size(); ++i)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(out[i]), kGuard) << set.name << " writes past " << count;
    }
}

TEST(Texels, OfThreeChannelsHaveThoseOfEach) {
  for (const Set& set : sets_of_this_machine()) {
    const Surface s = surface_of(1000, 7);
    std::vector<float> r(1000), g(1000), b(1000), grey(1000);
    set.texels.rgb(s.lobes, s.rgb.data(), s.x.data(), s.y.data(), s.z.data(), {r.data(), g.data(), b.data()}, 1000);
    set.texels.grey(s.lobes, s.grey.data(), s.x.data(), s.y.data(), s.z.data(), {grey.data()}, 1000);
    EXPECT_EQ(r, grey) << set.name;
    for (std::size_t i = 0; i < 1000; ++i) {
      const Rgb<float> want = residual(s.lobes, s.rgb[i], Vec3<float>(s.x[i], s.y[i], s.z[i]));
      ASSERT_NEAR(g[i], want.g, kFourUlps * magnitude_of(s, i, 1)) << set.name;
      ASSERT_NEAR(b[i], want.b, kFourUlps * magnitude_of(s, i, 2)) << set.name;
    }
  }
}

TEST(Texels, AreTheSameInEverySet) {
  constexpr std::size_t kCount = 100000;
  const Surface s = surface_of(kCount, 11);
  const auto of = [&](const Set& set) {
    std::vector<float> out(kCount);
    set.texels.grey(s.lobes, s.grey.data(), s.x.data(), s.y.data(), s.z.data(), {out.data()}, kCount);
    return out;
  };
  const auto sets = sets_of_this_machine();
  const std::vector<float> base = of(sets[0]);
  double worst = 0;
  for (const Set& set : sets) {
    const std::vector<float> out = of(set);
    for (std::size_t i = 0; i < kCount; ++i) {
      ASSERT_TRUE(std::isfinite(out[i])) << set.name;
      const double unit = 0x1p-23 * magnitude_of(s, i, 0);
      if (std::abs(out[i] - base[i]) > 0) worst = std::max(worst, std::abs(double(out[i]) - base[i]) / unit);
    }
    EXPECT_LE(worst, 4) << set.name << ": in ulp of the sum of the magnitudes";
  }
  RecordProperty("worst_ulps", std::to_string(worst));
}

TEST(Texels, TowardsOneDirectionHaveTheValuesOfOneAfterTheOther) {
  for (const Set& set : sets_of_this_machine())
    for (std::size_t count = 0; count < 70; ++count) {
      const Surface s = surface_of(count, 300 + count);
      const Vec3<float> v(Random(count).direction(-1));
      const RealisTowards<1> towards_grey(s.lobes, v);
      const RealisTowards<3> towards(s.lobes, v);
      std::vector<float> grey(count + 16, kGuardValue), r = grey, g = grey, b = grey;
      set.texels.grey_towards(towards_grey, s.grey.data(), {grey.data()}, count);
      set.texels.rgb_towards(towards, s.rgb.data(), {r.data(), g.data(), b.data()}, count);
      for (std::size_t i = 0; i < count; ++i) {
        const Rgb<float> want = residual(towards, s.rgb[i]);
        ASSERT_EQ(grey[i], r[i]) << set.name;
        ASSERT_NEAR(r[i], want.r, kFourUlps * magnitude_of(s, i, 0)) << set.name << ": " << i << " of " << count;
        ASSERT_NEAR(g[i], want.g, kFourUlps * magnitude_of(s, i, 1)) << set.name << ": " << i << " of " << count;
        ASSERT_NEAR(b[i], want.b, kFourUlps * magnitude_of(s, i, 2)) << set.name << ": " << i << " of " << count;
      }
      for (const auto& out : {grey, r, g, b})
        for (std::size_t i = count; i < out.size(); ++i)
          ASSERT_EQ(std::bit_cast<std::uint32_t>(out[i]), kGuard) << set.name << " writes past " << count;
    }
}

// Against the specification, not another loop of this library.
TEST(Texels, HaveTheResidualOfTheDefinition) {
  Random random(9);
  for (const Set& set : sets_of_this_machine())
    for (int i = 0; i < 2000; ++i) {
      const Drawn drawn = drawn_texel(random);
      const Vec3<float> v(random.direction(-1));
      float out = 0;
      set.texels.grey(drawn.lobes, &drawn.texel, &v.x, &v.y, &v.z, {&out}, 1);
      ASSERT_NEAR(out, residual_by_definition(drawn.written, Vec3<double>(v)), 1.2e-5 * magnitude(drawn.written))
          << set.name;
    }
}

}  // namespace
}  // namespace likeness::brdf
