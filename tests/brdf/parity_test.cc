#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "tests/brdf/evaluate.h"
#include "tests/brdf/parity_lanes.h"

// The instruction sets agree: what a renderer shows and what a fit was done with do not depend on the machine.
namespace likeness::brdf::parity {

namespace {

constexpr std::int64_t kUlps = 4;

std::vector<float> random_columns() {
  Random random(13);
  std::vector<float> columns((kChannels + 6) * kCases);
  for (std::size_t i = 0; i < kCases; ++i) {
    const auto model = random_model<Callisto<double>>(random, [](const Parameter& row) { return row.typical; });
    const auto values = channels_of(model);
    const auto l = random.direction(), v = random.direction();
    const double xyz[]{l.x, l.y, l.z, v.x, v.y, v.z};
    for (std::size_t k = 0; k < kChannels; ++k) columns[k * kCases + i] = float(values[k]);
    for (std::size_t k = 0; k < 6; ++k) columns[(kChannels + k) * kCases + i] = float(xyz[k]);
  }
  return columns;
}

// Units in the last place between two floats >= 0.
std::int64_t ulps(float a, float b) {
  return std::abs(std::int64_t(std::bit_cast<std::uint32_t>(a)) - std::int64_t(std::bit_cast<std::uint32_t>(b)));
}

void expect_parity(void (*evaluate_lanes)(const float*, float*), const char* name) {
  const auto columns = random_columns();
  std::vector<float> want(kCases), got(kCases);
  with_sse2(columns.data(), want.data());
  evaluate_lanes(columns.data(), got.data());
  std::int64_t worst = 0;
  std::size_t equal = 0;
  for (std::size_t i = 0; i < kCases; ++i) {
    worst = std::max(worst, ulps(got[i], want[i]));
    equal += got[i] == want[i];
  }
  ::testing::Test::RecordProperty("worst_ulp", std::to_string(worst));
  ::testing::Test::RecordProperty("equal_of_4096", std::to_string(equal));
  EXPECT_LE(worst, kUlps) << name << ": " << equal << " of " << kCases << " equal";
}

TEST(Parity, Avx2EqualsSse2) {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
    GTEST_SKIP() << "this processor has no AVX2 with FMA";
  expect_parity(with_avx2, "AVX2");
}
TEST(Parity, Avx512EqualsSse2) {
  if (!__builtin_cpu_supports("avx512bw")) GTEST_SKIP() << "this processor has no AVX-512BW";
  expect_parity(with_avx512, "AVX-512");
}

}  // namespace
}  // namespace likeness::brdf::parity
