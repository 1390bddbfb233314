#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "fit/measured/rgl.h"
#include "fit/measured/vndf_warp.h"
#include "render/files/files.h"
#include "tests/fit/measured_files.h"

namespace likeness::measured {
namespace {

using files::InputError;
using test::RglParts;
using test::small_rgl;

// A density without symmetry, 0 in a corner.
Warp uneven() {
  std::vector<float> nodes(5 * 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x) nodes[y * 5 + x] = float(x * x + 3 * y * (4 - x) % 5 + 2 * y);
  return Warp(nodes.data(), 5, 4);
}

TEST(Warp, CumulatesWhatItSamples) {
  const Warp warp = uneven();
  for (double x = 0.03; x < 1; x += 0.07)
    for (double y = 0.02; y < 1; y += 0.06) {
      double density = 0;
      const Point2 u = warp.sample({x, y}, density), back = warp.cumulated(u).place();
      EXPECT_NEAR(back.x, x, 1e-12);  // a square root each way
      EXPECT_NEAR(back.y, y, 1e-12);
      EXPECT_NEAR(density, warp.density(u), 1e-10);
    }
}

TEST(Warp, SampledDensityIntegratesToOne) {
  const Warp warp = uneven();
  double sum = 0;
  for (int i = 0; i < 400; ++i)
    for (int j = 0; j < 400; ++j) sum += warp.density({(i + 0.5) / 400, (j + 0.5) / 400}) / 160000;
  EXPECT_NEAR(sum, 1, 1e-5);  // midpoint rule where grids do not coincide
}

TEST(Rgl, EvaluatesTheBoxedEquation) {
  const auto material = parse_rgl(small_rgl(), "m");
  Direction l, v;
  directions_at({0.4, 0.8, 2.0}, l, v);
  Rgb f;
  ASSERT_TRUE(material->evaluate(l, v, f));
  EXPECT_NEAR(f.r, 0.5 * 2 / (4 * 0.5 * std::cos(0.8)), 1e-7);  // color ndf / (4 sigma cos theta_o), float
  EXPECT_NEAR(f.b / f.r, 0.25, 1e-7);
}

TEST(Rgl, ReturnsStoredValuesAtItsSamples) {
  const auto material = parse_rgl(small_rgl(), "m");
  int count = 0;
  material->for_each_sample([&](const Sample& s) {
    Rgb f;
    ASSERT_TRUE(material->evaluate(s.to_light, s.to_view, f));
    EXPECT_NEAR(f.r, s.f.r, 1e-9 * s.f.r);
    ++count;
  });
  EXPECT_GT(count, 5);
}

TEST(Rgl, WeightsCoverAllButTheLastThetaI) {
  double total = 0;
  parse_rgl(small_rgl({.theta = 9, .map = 16, .colors = 16}), "m")->for_each_sample([&](const Sample& s) {
    total += s.weight;
  });
  const double last = std::cos((7.5 / 8) * std::numbers::pi / 2);  // from half way to the last of nine theta_i
  EXPECT_NEAR(total / (4 * std::numbers::pi * std::numbers::pi), 1 - last,
              0.01);  // solid angles are sums over two grids
}

TEST(Rgl, RefusesAnisotropicAndSpectralFilesByName) {
  const auto message = [](const RglParts& parts) {
    try {
      parse_rgl(small_rgl(parts), "silk.bsdf");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message({.phi = 3}),
            "silk.bsdf: an anisotropic material (3 phi_i); expected an isotropic one (1 or 2 phi_i)");
  EXPECT_THAT(message({.color_name = "spectra"}), testing::HasSubstr("spectral file"));
}

TEST(Rgl, RefusesEveryTruncation) {
  const std::string bytes = small_rgl();
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(parse_rgl(bytes.substr(0, size), "m"), InputError) << size << " bytes";
}

TEST(Rgl, RefusesAShapeWhoseProductOverflows) {
  std::string bytes = small_rgl();
  const std::size_t at = bytes.find("vndf") + 4 + 2 + 1 + 8;
  const std::uint64_t huge = std::uint64_t{1} << 62;
  std::memcpy(bytes.data() + at, &huge, 8);
  std::memcpy(bytes.data() + at + 8, &huge, 8);
  EXPECT_THROW(parse_rgl(bytes, "m"), InputError);
}

TEST(Rgl, TakesAFirstThetaIThatIsARoundingBelowZero) {
  std::string bytes = small_rgl();
  const float below = -1e-9f;
  const std::size_t header = bytes.find("theta_i") + 7 + 2 + 1;  // then uint64 offset
  std::uint64_t offset = 0;
  std::memcpy(&offset, bytes.data() + header, 8);
  std::memcpy(bytes.data() + offset, &below, 4);
  parse_rgl(bytes, "m")->for_each_sample([](const Sample& s) {
    ASSERT_TRUE(std::isfinite(s.weight) && std::isfinite(s.f.r));
  });
}

TEST(Rgl, RefusesNaNInItsParametrisationAndDropsItInItsColors) {
  EXPECT_THROW(parse_rgl(small_rgl({.sigma = std::nanf("")}), "m"), InputError);
  EXPECT_THROW(parse_rgl(small_rgl({.color = Rgb(std::nan(""))}), "m"), InputError) << "no valid sample";
  std::string bytes = small_rgl();
  const float nan = std::nanf("");
  std::memcpy(bytes.data() + bytes.size() - 5, &nan, 4);  // the last color; one byte of jacobian follows
  EXPECT_EQ(parse_rgl(bytes, "m")->coverage().not_finite, 1u);
}

}  // namespace
}  // namespace likeness::measured
