#include "fit/coordinates.h"

#include <gtest/gtest.h>

#include "fit/pattern.h"
#include "render/files/files.h"
#include "tests/fit/known_materials.h"

namespace likeness::fit {
namespace {

using brdf::Callisto;
using brdf::Tier;

TEST(Coordinates, FoldingAndUnfoldingKeepsTheFunction) {
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    for (const std::string_view name : brdf::kModelNames) {
      brdf::AnyBrdf model;
      brdf::model_of_name(name, model);
      model = datasets_synthetic::drawn(model, seed);
      const brdf::AnyBrdf back = unfolded(model.index(), folded(model));
      for (const double theta : {0.1, 0.7, 1.3})
        for (const double d : {0.2, 0.9}) {
          const auto g = brdf::geometry_at(theta * 0.5, d, 1.2);
          const auto want = test::value_of(model, g.to_light, g.to_view),
                     got = test::value_of(back, g.to_light, g.to_view);
          EXPECT_NEAR(got.r, want.r, 1e-13 * (1 + want.r)) << name << " " << seed;  // a product and a quotient
          EXPECT_NEAR(got.b, want.b, 1e-13 * (1 + want.b)) << name << " " << seed;
        }
    }
}

// By convention the largest channel of a tint is 1, and the intensity holds the sign.
TEST(Coordinates, UnfoldedTintsAreWithinTheirBounds) {
  Callisto<double> m;
  m.smooth_terminator = -0.5;
  m.smooth_terminator_tint = {0.25, 0.5, 0.125};
  m.diffuse_fresnel = 4;
  m.diffuse_fresnel_tint = {0, 0.5, 0.25};
  m.retroreflection = 0;
  m.retroreflection_tint = {0.3, 0.4, 0.5};
  const auto got = std::get<Callisto<double>>(unfolded(0, folded(m)));
  EXPECT_EQ(got.smooth_terminator, -0.25);
  EXPECT_EQ(got.smooth_terminator_tint.r, 0.5);
  EXPECT_EQ(got.smooth_terminator_tint.g, 1);
  EXPECT_EQ(got.smooth_terminator_tint.b, 0.25);
  EXPECT_EQ(got.diffuse_fresnel, 2);
  EXPECT_EQ(got.diffuse_fresnel_tint.r, 0);
  EXPECT_EQ(got.diffuse_fresnel_tint.g, 1);
  EXPECT_EQ(got.retroreflection, 0);
  EXPECT_EQ(got.retroreflection_tint.r, 1) << "a product of 0 has a white tint";
}

// 6 for Lambert + GGX; base adds 5; advanced turns 3 products into 9 and adds 3; full adds 3.
TEST(Coordinates, EachTierHasTheVariablesOfTheTalksTable) {
  const Callisto<double> callisto;
  EXPECT_EQ(coordinates_of(callisto, Tier::kPlain).size(), 6u);
  EXPECT_EQ(coordinates_of(callisto, Tier::kBase).size(), 11u);
  EXPECT_EQ(coordinates_of(callisto, Tier::kAdvanced).size(), 20u);
  EXPECT_EQ(coordinates_of(callisto, Tier::kFull).size(), 23u);
  EXPECT_THROW(coordinates_of(brdf::Ggx<double>{}, Tier::kBase), files::UsageError);
  EXPECT_TRUE(has_tier(callisto, Tier::kFull));
  EXPECT_FALSE(has_tier(brdf::Lambert<double>{}, Tier::kFull));
}

// What a tier does not expose stays at the default, to the last bit.
TEST(Coordinates, ATierLeavesTheRestAtTheDefaults) {
  for (const Tier tier : {Tier::kPlain, Tier::kBase, Tier::kAdvanced, Tier::kFull}) {
    const Coordinates c = coordinates_of(Callisto<double>{}, tier);
    std::vector<double> x(c.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.5 * (c.variables[i].start_low + c.variables[i].start_high);
    const auto m = std::get<Callisto<double>>(unfolded(0, c.channels_at(x)));
    const Callisto<double> initial;
    const auto values = brdf::channels_of(m), defaults = brdf::channels_of(initial);
    std::size_t at = 0;
    for (const brdf::Parameter& row : Callisto<double>::kParameters)
      for (int i = 0; i < row.channels; ++i, ++at)
        if (static_cast<int>(row.tier) > static_cast<int>(tier)) {
          EXPECT_EQ(values[at], defaults[at]) << row.name;
        }
    EXPECT_EQ(c.at_channels(c.channels_at(x)), x);
  }
}

// The talk's sorting: each parameter moves its own edge of the slice.
TEST(Pattern, ParametersOfKnownEffectFallIntoTheirGroup) {
  Callisto<double> plain;
  plain.base_color = {0.4, 0.4, 0.4};
  const auto group = [&](auto change) {
    Callisto<double> m = plain;
    change(m);
    return pattern_of(m).group;
  };
  EXPECT_EQ(group([](auto&) {}), "Fresnel edge flat, retroreflection flat");
  EXPECT_EQ(group([](auto& m) { m.diffuse_fresnel = 6; }), "Fresnel edge brighter, retroreflection flat");
  EXPECT_EQ(group([](auto& m) { m.diffuse_fresnel = 0; }), "Fresnel edge darker, retroreflection flat");
  EXPECT_EQ(group([](auto& m) { m.retroreflection = 6; }), "Fresnel edge flat, retroreflection brighter");
  EXPECT_EQ(group([](auto& m) { m.retroreflection = 0; }), "Fresnel edge flat, retroreflection darker");
  EXPECT_EQ(group([](auto& m) { m.diffuse_fresnel = 6, m.retroreflection = 0; }),
            "Fresnel edge brighter, retroreflection darker");
  EXPECT_TRUE(group([](auto& m) { m.smooth_terminator = 1, m.smooth_terminator_length = 1; }).ends_with("dark corner"));
  EXPECT_EQ(group([](auto& m) { m.metallic = 1; }), "no diffuse reflection");
  EXPECT_EQ(group([](auto& m) { m.base_color = {0, 0, 0}; }), "no diffuse reflection");
}

// The specular lobes do not count: a mirror over a diffuse is sorted by its diffuse.
TEST(Pattern, SpecularLobesDoNotCount) {
  Callisto<double> m;
  m.roughness = 0.02;
  m.specular = 1;
  EXPECT_EQ(pattern_of(m).group, "Fresnel edge flat, retroreflection flat");
  m.roughness = 1;
  EXPECT_EQ(pattern_of(m).group, "Fresnel edge flat, retroreflection flat");
  EXPECT_NEAR(pattern_of(m).fresnel_stops, 0, 1e-12);  // means of equal numbers
}

}  // namespace
}  // namespace likeness::fit
