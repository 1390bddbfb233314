#include "olat/import/light_lists.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "olat/import/color_space.h"
#include "render/files/files.h"

namespace likeness::olat_import {
namespace {

using files::InputError;
using testing::HasSubstr;

glm::dvec3 direction(const ListedLight& one) { return std::get<capture::DistantLight>(one.light.place).to_light; }

template <class Read>
std::string refusal(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find('\n'), text.npos) << text;
    return text;
  }
  return "accepted";
}

TEST(LightsCsv, DirectionsAreUnitAndIntensitiesAreKept) {
  const LightList got = read_lights_csv(
      "\xef\xbb\xbf# 16-bit linear RGB\r\nfile,lx,ly,lz,ir,ig,ib\r\n a b.png , 0,3,4,1,+2,3e0\r\n\n", "l.csv");
  ASSERT_EQ(got.lights.size(), 1u);
  EXPECT_EQ(got.lights[0].file, "a b.png");
  EXPECT_LT(glm::distance(direction(got.lights[0]), glm::dvec3(0, 0.6, 0.8)), 1e-15);
  EXPECT_EQ(got.lights[0].light.intensity, glm::dvec3(1, 2, 3));
  EXPECT_EQ(got.remarks, "16-bit linear RGB");
  EXPECT_EQ(read_lights_csv("file,lx,ly,lz\nx,1,0,0\n", "l").lights[0].light.intensity, glm::dvec3(1));
}

TEST(LightsCsv, WhatIsWrongIsNamedWithItsLine) {
  const std::string head = "file,lx,ly,lz,ir,ig,ib\n";
  const auto text = [&](const std::string& row) { return refusal([&] { read_lights_csv(head + row, "l.csv"); }); };
  EXPECT_EQ(text("a,0,0,0,1,1,1"), "l.csv:2: the direction to the light has no length that is finite and above 0");
  EXPECT_THAT(text("a,0,0,nan,1,1,1"), HasSubstr("lz = \"nan\"; expected a finite number"));
  EXPECT_THAT(text("a,0,0,1,1,0,1"), HasSubstr("l.csv:2: ig = 0 is outside (0, 1e9]"));
  EXPECT_THAT(text("a,0,0,1"), HasSubstr("has 4 columns; the header has 7"));
  EXPECT_THAT(text(",0,0,1,1,1,1"), HasSubstr("names no file"));
  EXPECT_THAT(text(""), HasSubstr("has no lights"));
  EXPECT_THAT(refusal([] { read_lights_csv("file,x,y,z\n", "l.csv"); }), HasSubstr("expected file,lx,ly,lz,ir,ig,ib"));
  EXPECT_THAT(refusal([] { read_lights_csv("", "l.csv"); }), HasSubstr("has no header"));
}

TEST(Lp, NamesMayHoldBlanksAndLengthsAreDropped) {
  const LightList got = read_lp("2\r\nmy photo.png 0 0 5\r\nb.png\t3 0 4\r\n", "c.lp");
  ASSERT_EQ(got.lights.size(), 2u);
  EXPECT_EQ(got.lights[0].file, "my photo.png");
  EXPECT_EQ(direction(got.lights[0]), glm::dvec3(0, 0, 1));
  EXPECT_LT(glm::distance(direction(got.lights[1]), glm::dvec3(0.6, 0, 0.8)), 1e-15);
  EXPECT_EQ(lp_text(read_lp(lp_text(got.lights), "again").lights), lp_text(got.lights));
}

TEST(Lp, WhatIsWrongIsNamedWithItsLine) {
  EXPECT_THAT(refusal([] { read_lp("2\na 0 0 1\n", "c.lp"); }), HasSubstr("has 1 lights; its first line says 2"));
  EXPECT_THAT(refusal([] { read_lp("many\n", "c.lp"); }), HasSubstr("c.lp:1: \"many\"; expected the number of lights"));
  EXPECT_THAT(refusal([] { read_lp("1\n0 0 1\n", "c.lp"); }), HasSubstr("c.lp:2"));
  EXPECT_THAT(refusal([] { read_lp("1\na 0 0 0\n", "c.lp"); }), HasSubstr("has no length"));
  EXPECT_THAT(refusal([] { read_lp("", "c.lp"); }), HasSubstr("is empty"));
}

TEST(Dome, TakesTheListThatItsConfigurationNames) {
  const std::string text = R"({"label": "d", "lightConfiguration": "CONF", "directions": [{"x": 0, "y": 0, "z": 2}],
    "positionsSphere": [{"x": 10, "y": 0, "z": 0}], "positions3d": [[0, 20, 0]],
    "lightsCalibration": [{"intensity": 2, "whiteBalance": {"r": 1, "g": 0.5, "b": 2}}]})";
  const auto with = [&](const std::string& configuration) {
    std::string out = text;
    return out.replace(out.find("CONF"), 4, configuration);
  };
  EXPECT_EQ(direction(read_dome(with("directional"), "d", 0).lights[0]), glm::dvec3(0, 0, 1));
  const auto position = [&](const std::string& configuration) {
    return std::get<capture::NearLight>(read_dome(with(configuration), "d", 0.01).lights[0].light.place).position;
  };
  EXPECT_LT(glm::distance(position("spherical"), glm::dvec3(0.1, 0, 0)), 1e-15);
  EXPECT_LT(glm::distance(position("lights3d"), glm::dvec3(0, 0.2, 0)), 1e-15);
  EXPECT_EQ(read_dome(with("directional"), "d", 0).lights[0].light.intensity, glm::dvec3(2, 1, 4));
  EXPECT_THAT(refusal([&] { read_dome(with("spherical"), "d", 0); }), HasSubstr("say --unit-m 0.01 (cm)"));
  EXPECT_THAT(refusal([&] { read_dome(with("round"), "d", 0); }),
              HasSubstr("expected directional, spherical or lights3d"));
  EXPECT_THAT(refusal([] { read_dome("{}", "d", 0); }), HasSubstr("has neither directions nor positions"));
  EXPECT_THAT(refusal([] { read_dome(R"({"directions": [[0,0,1]], "lightsCalibration": [{}, {}]})", "d", 0); }),
              HasSubstr("has 2 rows for 1 lights"));
}

TEST(ColorSpaces, OnlyTheWordLinearByItselfSaysSo) {
  EXPECT_TRUE(known_by_remark("16-bit linear RGB", "x"));
  EXPECT_TRUE(known_by_remark("Linear", "x"));
  EXPECT_FALSE(known_by_remark("non-linear, nonlinear, linearly, near-linear", "x"));
  EXPECT_TRUE(known_by_format("a.EXR"));
  EXPECT_TRUE(known_by_format("a.dng"));
  EXPECT_FALSE(known_by_format("a.png"));
  EXPECT_THROW(color_space_named("sgrb"), files::UsageError);
}

}  // namespace
}  // namespace likeness::olat_import
