#include <random>
#include <string_view>

#include <gtest/gtest.h>

#include "brdf/callisto.h"

namespace likeness::brdf {
namespace {

template <class S>
using Model = Callisto<S>;

template <class S>
class Draws {
 public:
  S operator()(double low = 0, double high = 1) { return static_cast<S>(low + (high - low) * uniform_(engine_)); }
  Vec3<S> direction() {
    const double z = uniform_(engine_), r = std::sqrt(1 - z * z), phi = 6.2831853 * uniform_(engine_);
    return {S(r * std::cos(phi)), S(r * std::sin(phi)), S(z)};
  }
  Rgb<S> color() { return {(*this)(), (*this)(), (*this)()}; }

 private:
  std::mt19937 engine_{7};
  std::uniform_real_distribution<double> uniform_{0, 1};
};

// A material that needs `parts` and no other.
template <class S>
Model<S> material(unsigned parts, Draws<S>& random) {
  Model<S> m;
  m.base_color = random.color();
  m.specular = random();
  m.roughness = random();
  m.metallic = (parts & Model<S>::kDiffuse) != 0 ? random(0, 0.9) : S(1);
  if ((parts & Model<S>::kRise) != 0) m.diffuse_fresnel = random(2, 30), m.diffuse_fresnel_tint = random.color();
  if ((parts & Model<S>::kRetro) != 0) m.retroreflection = random(2, 30), m.retroreflection_tint = random.color();
  if ((parts & Model<S>::kTerminator) != 0) m.smooth_terminator = random(0.1, 1);
  if ((parts & Model<S>::kFalloff) != 0) m.specular_fresnel_falloff = random(0.6, 0.9);
  if ((parts & Model<S>::kSecondLobe) != 0) m.dual_specular_opacity = random(0.1, 1);
  m.diffuse_fresnel_falloff = random();
  m.retroreflection_falloff = random();
  m.smooth_terminator_length = random();
  m.dual_specular_roughness_scale = random(1, 16);
  return m;
}

template <class S>
bool same(const Rgb<S>& a, const Rgb<S>& b) {
  return a.r == b.r && a.g == b.g && a.b == b.b;
}

template <class S, unsigned kParts>
void expect_same_as_whole(Draws<S>& random) {
  constexpr bool kIsPossible =
      (kParts & Model<S>::kDiffuse) != 0 || (kParts & (Model<S>::kRise | Model<S>::kRetro)) == 0;
  if constexpr (kIsPossible) {
    for (int i = 0; i < 300; ++i) {
      const Model<S> m = material<S>(kParts, random);
      ASSERT_EQ(m.parts([](std::string_view) { return true; }), kParts);
      const Vec3<S> v = random.direction(), l = random.direction();
      const Geometry<S> g(l, v);
      ASSERT_TRUE(same(m.template eval<kParts>(g), m.eval(g))) << "parts " << kParts << ", case " << i;
      ASSERT_EQ(lobes_pdf(m.template lobes<kParts>(v), g), m.pdf(l, v)) << "parts " << kParts << ", case " << i;
    }
  }
}

template <class S>
void every_set() {
  Draws<S> random;
  [&]<unsigned... P>(std::integer_sequence<unsigned, P...>) {
    (expect_same_as_whole<S, P>(random), ...);
  }(std::make_integer_sequence<unsigned, 64>{});
}

TEST(CallistoParts, WhatAMaterialDoesNotNeedChangesNoBit) {
  every_set<float>();
  every_set<double>();
}

TEST(CallistoParts, DefaultsNeedTheDiffuseOnly) {
  EXPECT_EQ(Model<double>{}.parts([](std::string_view) { return true; }), Model<double>::kDiffuse);
}

TEST(CallistoParts, AParameterThatATextureGivesNeedsItsPart) {
  const auto but = [](std::string_view varied) {
    return Model<double>{}.parts([&](std::string_view name) { return name != varied; });
  };
  EXPECT_EQ(but("roughness"), Model<double>::kDiffuse);
  EXPECT_EQ(but("diffuse_fresnel"), Model<double>::kDiffuse | Model<double>::kRise);
  EXPECT_EQ(but("retroreflection_tint"), Model<double>::kDiffuse | Model<double>::kRetro);
  EXPECT_EQ(but("smooth_terminator"), Model<double>::kDiffuse | Model<double>::kTerminator);
  EXPECT_EQ(but("specular_fresnel_falloff"), Model<double>::kDiffuse | Model<double>::kFalloff);
  EXPECT_EQ(but("dual_specular_opacity"), Model<double>::kDiffuse | Model<double>::kSecondLobe);
  Model<double> metal;
  metal.metallic = 1;
  EXPECT_EQ(metal.parts([](std::string_view) { return true; }), 0u);
  EXPECT_EQ(metal.parts([](std::string_view name) { return name != "metallic"; }), Model<double>::kDiffuse);
}

}  // namespace
}  // namespace likeness::brdf
