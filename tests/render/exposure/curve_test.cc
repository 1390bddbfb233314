#include "render/exposure/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "render/view/view.h"
#include "tests/render/exposure/pictures_of_light.h"

namespace likeness::exposure {
namespace {

using test::greys;
using test::kInfinity;

scene::View view_named(const std::string& name, double ev = 0) { return {ev, name, "", ""}; }

int most_code(double light, const scene::View& view) {
  const auto shown = view::show(greys({static_cast<float>(light)}), view);
  return std::max({shown.rgb[0], shown.rgb[1], shown.rgb[2]});
}

TEST(Curve, HasItsBordersWhereTheCodesOfTheViewChange) {
  for (const std::string_view name : view::kOwnViews) {
    const scene::View view = view_named(std::string(name));
    const Curve curve = curve_of(view);
    ASSERT_TRUE(std::isfinite(curve.clipped_from)) << name;
    EXPECT_EQ(most_code(curve.clipped_from, view), 255) << name;
    EXPECT_LT(most_code(std::nextafter(static_cast<float>(curve.clipped_from), 0.0f), view), 255) << name;
    EXPECT_GT(curve.crushed_below, 0) << name;
    EXPECT_GT(most_code(curve.crushed_below, view), 0) << name;
    EXPECT_EQ(most_code(std::nextafter(static_cast<float>(curve.crushed_below), 0.0f), view), 0) << name;
    EXPECT_LT(curve.toe_end, 0.25) << name;
    EXPECT_GT(curve.shoulder_start, 0.18) << name;
  }
}

TEST(Curve, OfGtHasItsOwnLine) {
  const Curve curve = curve_of(view_named("gt"));
  EXPECT_EQ(curve.toe_end, 0.22);
  EXPECT_NEAR(curve.shoulder_start, 0.532, 1e-12);
  brdf::GtTonemap<double> gt;
  gt.linear_start = 0.1;
  gt.linear_length = 0.2;
  gt.contrast = 1.5;
  EXPECT_EQ(curve_of(view_named("gt"), gt).toe_end, 0.1);
  EXPECT_NEAR(curve_of(view_named("gt"), gt).shoulder_start, 0.1 + 0.9 * 0.2 / 1.5, 1e-12);
}

TEST(Curve, DoesNotDependOnTheExposure) {
  const Curve at_0 = curve_of(view_named("srgb")), at_3 = curve_of(view_named("srgb", 3));
  EXPECT_EQ(at_0.clipped_from, at_3.clipped_from);
  EXPECT_EQ(at_0.shoulder_start, at_3.shoulder_start);
}

TEST(Curve, OfAPedestalCrushesNothingAndOfADimOneClipsNothing) {
  brdf::GtTonemap<double> gt;
  gt.pedestal = 0.05;
  EXPECT_EQ(curve_of(view_named("gt"), gt).crushed_below, 0);
  gt.max_brightness = 0.9;
  EXPECT_EQ(curve_of(view_named("gt"), gt).clipped_from, kInfinity);
}

}  // namespace
}  // namespace likeness::exposure
