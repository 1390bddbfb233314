#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fit/measured/mbsdf.h"
#include "render/files/files.h"
#include "tests/fit/measured_files.h"

namespace likeness::measured {
namespace {

using files::InputError;
using test::small_mbsdf;

TEST(Mbsdf, ReturnsStoredValuesAtBinCentres) {
  const auto material = parse_mbsdf(small_mbsdf(9, 8), "m");
  material->for_each_sample([&](const Sample& s) {
    Rgb f;
    ASSERT_TRUE(material->evaluate(s.to_light, s.to_view, f));
    EXPECT_NEAR(f.g, test::glossy(s.to_light, s.to_view).g, 1e-6);  // stored in float
  });
  EXPECT_EQ(material->coverage().valid, 9u * 9 * 8);
}

// f = theta_in + 10 theta_out + 100 phi is linear, so that the interpolant is f itself between the centres; its
// coefficients differ, so that no two axes can be confused.
TEST(Mbsdf, InterpolatesLinearlyInTheOrderThetaInThetaOutPhi) {
  const auto linear = [](const Direction& l, const Direction& v) {
    const Elevations e = elevations(l, v);
    return Rgb(e.theta_i + 10 * e.theta_o + 100 * e.phi);
  };
  const auto material = parse_mbsdf(small_mbsdf(9, 12, linear), "m");
  Direction l, v;
  for (const Elevations e : {Elevations{0.2, 0.9, 1.0}, Elevations{1.1, 0.3, 2.5}, Elevations{0.7, 0.7, 0.2}}) {
    directions_at(e, l, v);
    Rgb f;
    ASSERT_TRUE(material->evaluate(l, v, f));
    EXPECT_NEAR(f.r, e.theta_i + 10 * e.theta_o + 100 * e.phi, 1e-4);  // 300 in float has 3e-5
    v.y = -v.y;
    ASSERT_TRUE(material->evaluate(l, v, f)) << "the mirrored pair";
    EXPECT_NEAR(f.r, e.theta_i + 10 * e.theta_o + 100 * e.phi, 1e-4);  // as above
  }
}

TEST(Mbsdf, WeightsAddUpToTwoPiSquared) {
  double total = 0;
  parse_mbsdf(small_mbsdf(5, 7), "m")->for_each_sample([&](const Sample& s) { total += s.weight; });
  EXPECT_NEAR(total / (4 * std::numbers::pi * std::numbers::pi), 1, 1e-12);  // exact integrals of the bins
}

TEST(Mbsdf, DropsCopiesOfTheLastMeasuredAngleAndSwapsInstead) {
  const auto padded = [](const Direction& l, const Direction& v) {
    Elevations e = elevations(l, v);
    e.theta_i = std::min(e.theta_i, 1.0);  // rows whose centres lie beyond are copies of one another
    Direction l2, v2;
    directions_at(e, l2, v2);
    return test::glossy(l2, v2);
  };
  const auto material = parse_mbsdf(small_mbsdf(18, 6, padded), "m");  // centres 2.5, 7.5, .. 87.5 deg; 1.0 = 57.3 deg
  EXPECT_EQ(material->coverage().padding, 6u * 18 * 6) << "62.5 to 87.5 deg; the first copy cannot be told from data";
  Direction l, v;
  directions_at({80 * std::numbers::pi / 180, 22.5 * std::numbers::pi / 180, 1.0}, l, v);
  Rgb f, swapped;
  ASSERT_TRUE(material->evaluate(l, v, f));
  ASSERT_TRUE(material->evaluate(v, l, swapped));
  EXPECT_EQ(f.r, swapped.r);
  directions_at({80 * std::numbers::pi / 180, 80 * std::numbers::pi / 180, 1.0}, l, v);
  EXPECT_FALSE(material->evaluate(l, v, f)) << "neither direction was in reach as the light's";
}

TEST(Mbsdf, KeepsAConstantMaterialWhole) {
  const auto white = parse_mbsdf(small_mbsdf(4, 4, [](auto&, auto&) { return Rgb(0.3); }), "m");
  EXPECT_EQ(white->coverage().padding, 0u);
  EXPECT_EQ(white->coverage().valid, 64u);
}

TEST(Mbsdf, ClipsANegativeChannelAndDropsAnAllNegativeOrNaNSample) {
  std::string bytes = small_mbsdf();
  const std::size_t first = bytes.size() - 36 * 12;
  const float negative = -1, nan = std::nanf("");
  std::memcpy(bytes.data() + first + 4, &negative, 4);                                       // sample 0: green
  for (int c = 0; c < 3; ++c) std::memcpy(bytes.data() + first + 12 + 4 * c, &negative, 4);  // sample 1: all
  std::memcpy(bytes.data() + first + 24, &nan, 4);                                           // sample 2: red
  const auto material = parse_mbsdf(bytes, "m");
  EXPECT_EQ(material->coverage().clipped, 1u);
  EXPECT_EQ(material->coverage().negative, 1u);
  EXPECT_EQ(material->coverage().not_finite, 1u);
  EXPECT_EQ(material->coverage().valid, 34u);
  bool first_sample = true;
  material->for_each_sample([&](const Sample& s) {
    if (first_sample) {
      EXPECT_EQ(s.f.g, 0);
    }
    first_sample = false;
  });
}

TEST(Mbsdf, ReadsPastATransmissionBlock) {
  std::string transmission = small_mbsdf();
  transmission.erase(0, transmission.find("MBSDF_DATA"));
  transmission.replace(0, std::string("MBSDF_DATA_REFLECTION").size(), "MBSDF_DATA_TRANSMISSION");
  EXPECT_EQ(parse_mbsdf(small_mbsdf() + transmission, "m")->coverage().valid, 36u);
  EXPECT_THROW(parse_mbsdf("NVIDIA ARC MBSDF V1\n" + transmission, "m"), InputError) << "nothing else";
}

TEST(Mbsdf, RefusesEveryTruncationAndAnExtraByte) {
  const std::string bytes = small_mbsdf();
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(parse_mbsdf(bytes.substr(0, size), "m"), InputError) << size << " bytes";
  EXPECT_THROW(parse_mbsdf(bytes + '\0', "m"), InputError);
}

TEST(Mbsdf, RefusesHugeDeclaredDimensions) {
  std::string bytes = small_mbsdf();
  const std::uint32_t huge = 0xffffffff;
  std::memcpy(bytes.data() + bytes.size() - 36 * 12 - 8, &huge, 4);
  try {
    parse_mbsdf(bytes, "paint.mbsdf");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "paint.mbsdf: resolution 4294967295 theta, 4 phi; expected 1 to 720 theta and 1 to 1440 phi");
  }
}

}  // namespace
}  // namespace likeness::measured
