#include "brdf/realis/mixes.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace likeness::brdf {
namespace {

Vec3<float> unit(const Vec3<double>& v) {
  const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return {static_cast<float>(v.x / length), static_cast<float>(v.y / length), static_cast<float>(v.z / length)};
}

std::vector<Vec3<float>> directions(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3<float>> out;
  for (int i = 0; i < count; ++i) out.push_back(unit({normal(random), normal(random), normal(random)}));
  return out;
}

// Interpolated directions are the direction itself, to the bend of a cell: that finds wrong places, folds and shares.
TEST(Octahedron, PlacesAboutADirectionAreNearIt) {
  const Octahedron table{65};
  std::vector<Vec3<float>> all = directions(20000, 1);
  for (const float x : {-1.0f, 0.0f, 1.0f})
    for (const float y : {-1.0f, 0.0f, 1.0f})
      for (const float z : {-1.0f, 0.0f, 1.0f})
        if (x != 0 || y != 0 || z != 0) all.push_back(unit({x, y, z}));
  for (const Vec3<float>& d : all) {
    const Octahedron::Three near = table.about(d);
    Vec3<float> mean(0, 0, 0);
    float whole = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_LT(near.places[i], table.count());
      EXPECT_GE(near.shares[i], 0);
      whole += near.shares[i];
      mean = mean + table.direction(static_cast<int>(near.places[i] % 65), static_cast<int>(near.places[i] / 65)) *
                        near.shares[i];
    }
    EXPECT_NEAR(whole, 1, 1e-6);
    const Vec3<float> off = mean - d;
    // A cell is 2 / 64 wide on the square and at most sqrt(3) times that on the sphere; a triangle's bend is h^2.
    EXPECT_LT(std::sqrt(dot(off, off)), 1.05 * (2.0 / 64) * (2.0 / 64)) << d.x << " " << d.y << " " << d.z;
  }
}

TEST(Octahedron, EveryDirectionHasAPlace) {
  const Octahedron table{9};
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const Vec3<float>& d : {Vec3<float>(0, 0, 0), Vec3<float>(nan, 0, 1), Vec3<float>(inf, 0, 0),
                               Vec3<float>(3e38f, 3e38f, 3e38f), Vec3<float>(-0.0f, -0.0f, -1)})
    for (const std::size_t place : table.about(d).places) EXPECT_LT(place, table.count());
}

// The table against its definition, lobes that are broad and lobes that are narrow.
TEST(RealisMixes, AreTheSumOfTheirLobes) {
  for (const double sharpness : {0.0, 4.0, 48.0, 400.0}) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0, 1);
    std::vector<Vec3<double>> axes;
    for (const Vec3<float>& d : directions(30, 2)) axes.emplace_back(Vec3<double>(d.x, d.y, d.z));
    const std::vector<double> sharpnesses(axes.size(), sharpness);
    constexpr std::size_t kMixes = 5;
    std::vector<double> mix(kMixes * axes.size());
    for (double& m : mix) m = normal(random);
    RealisMixes mixes;
    mixes.place(axes, sharpnesses, mix);
    ASSERT_EQ(mixes.count, kMixes);
    for (std::size_t j = 0; j < kMixes; ++j) mixes.scale[0][j] = 1 + static_cast<float>(j);
    RealisMixes::Towards towards{};
    for (const Vec3<float>& d : directions(2000, 3)) {
      mixes.towards(d, 1, towards);
      for (std::size_t j = 0; j < kMixes; ++j) {
        double sum = 0, size = 0;
        for (std::size_t k = 0; k < axes.size(); ++k) {
          WindowedGaussian<double> lobe;
          lobe.plain.sharpness = sharpness;
          const double versine = versine_between(axes[k], Vec3<double>(d.x, d.y, d.z));
          sum += mix[j * axes.size() + k] * lobe.eval(versine);
          // The table's triangles reach a little beyond where a lobe ends.
          if (sharpness * versine < 1.3 * WindowedGaussian<double>::kEnd) size += std::abs(mix[j * axes.size() + k]);
        }
        // RealisMixes, Error, with the side that it takes; 1e-6 of floats.
        EXPECT_NEAR(towards[0][j], (1 + static_cast<double>(j)) * sum,
                    (1 + static_cast<double>(j)) * (0.01 * size + 1e-6))
            << sharpness << " " << d.x << " " << d.y << " " << d.z;
      }
    }
  }
}

TEST(RealisMixes, NarrowLobesAndManyMixesStayWithinTheirMemory) {
  const std::vector<Vec3<double>> axes(3, Vec3<double>(0, 0, 1));
  RealisMixes mixes;
  mixes.place(axes, std::vector<double>(3, 1e9), std::vector<double>(3 * RealisMixes::kMost, 1.0));
  EXPECT_LE(mixes.values.size(), RealisMixes::kMostValues);
  mixes.place(axes, std::vector<double>(3, 1e9), std::vector<double>(3, 1.0));
  EXPECT_EQ(mixes.places.side, RealisMixes::kMostSide);
  mixes.place({}, {}, {});
  EXPECT_EQ(mixes.count, 0u);
}

}  // namespace
}  // namespace likeness::brdf
