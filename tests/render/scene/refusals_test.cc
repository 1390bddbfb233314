#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/render/scene/refusal.h"
#include "tests/render/scene/sound.h"

// Every way in which a scene file can be wrong is one line that says where, what, and what was expected.
namespace likeness::scene::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(SceneRefusals, NameAnUnknownKeyAndTheNearestOne) {
  EXPECT_EQ(refusal("\"lights\": [{\"type\": \"sphere\"},\n{\"type\": \"sphere\", \"radus\": 1}]"),
            "room.json:3: /lights/1/radus is not a key of a sphere; did you mean \"radius\"?");
  EXPECT_EQ(refusal("\"lihgts\": []"), "room.json:2: /lihgts is not a key of a scene; did you mean \"lights\"?");
  EXPECT_THAT(refusal("\"view\": {\"qqqqqqqq\": 1}"),
              AllOf(StartsWith("room.json:2: /view/qqqqqqqq is not a key of a view"),
                    HasSubstr("there are ev, name, display, config")));
  EXPECT_THAT(
      refusal("\"materials\": {\"a\": {\"parameters\": {\"roughness\": {\"file\": \"grey.png\", \"wrp\": 1}}}},"
              "\"meshes\": {\"m\": {\"shape\": \"sphere\"}}, \"instances\": [{\"mesh\": \"m\", \"material\": \"a\"}]"),
      HasSubstr("/materials/a/parameters/roughness/wrp is not a key of a texture; did you mean \"wrap\"?"));
}

TEST(SceneRefusals, NameTheRangeOfANumber) {
  EXPECT_EQ(refusal("\"lights\": [{\"type\": \"sphere\", \"radius\": -1}]"),
            "room.json:2: /lights/0/radius = -1 is outside [1e-06, 1e+06] m (of the sphere)");
  EXPECT_THAT(refusal("\"cameras\": [{\"width\": 0}]"), HasSubstr("/cameras/0/width = 0 is outside [1, 65536] pixel"));
  EXPECT_THAT(refusal("\"cameras\": [{\"focus_distance\": 0}]"),
              HasSubstr("/focus_distance = 0 is outside (0, 1e+09] m"));
  EXPECT_THAT(refusal("\"environment\": {\"radiance\": [1, -0.5, 1]}"),
              HasSubstr("/environment/radiance/1 = -0.5 is outside [0, 1e+12]"));
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"rectangle\", \"size\": [1, 0]}]"),
              HasSubstr("/lights/0/size/1 = 0 is outside"));
}

TEST(SceneRefusals, NameTheKindOfValueThatWasExpected) {
  EXPECT_THAT(refusal("\"cameras\": [{\"position\": [1, 2]}]"),
              HasSubstr("/cameras/0/position is a list of 2 values; expected a list of three numbers"));
  EXPECT_THAT(refusal("\"cameras\": [{\"fov_deg\": \"40\"}]"),
              HasSubstr("/fov_deg is the text \"40\"; expected a number"));
  EXPECT_THAT(refusal("\"cameras\": [{\"width\": 1.5}]"), HasSubstr("is the number 1.5; expected a whole number"));
  EXPECT_THAT(refusal("\"cameras\": {}"), HasSubstr("/cameras is an object; expected a list of objects"));
  EXPECT_THAT(refusal("\"cameras\": [7]"), HasSubstr("/cameras/0 is the number 7; expected an object"));
  EXPECT_THAT(refusal("\"lights\": [7]"), HasSubstr("/lights/0 is the number 7; expected an object"));
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"disk\", \"movable\": 1}]"), HasSubstr("expected true or false"));
  EXPECT_THAT(refusal("\"name\": null"), HasSubstr("/name is null; expected a text"));
  EXPECT_THAT(refusal("\"instances\": [{\"mesh\": \"m\", \"matrix\": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}]"),
              HasSubstr("expected three or four rows of four numbers"));
  EXPECT_THAT(
      refusal(
          "\"instances\": [{\"mesh\": \"m\", \"matrix\": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [1, 2, 3, 1]]}]"),
      HasSubstr("/matrix/3/0 = 1; the fourth row is 0 0 0 1"));
  EXPECT_THAT(refusal_of_text("[]"), HasSubstr("room.json:1: the file is a list; expected an object"));
}

TEST(SceneRefusals, NameAnUnknownWord) {
  EXPECT_EQ(refusal("\"lights\": [{\"type\": \"spere\"}]"),
            "room.json:2: /lights/0/type is the text \"spere\"; did you mean \"sphere\"?");
  EXPECT_THAT(refusal("\"lights\": [{}]"), HasSubstr("/lights/0/type is missing; there are point, spot, directional"));
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"point\", \"unit\": \"lx\"}]"),
              HasSubstr("/lights/0/unit = \"lx\" is not known; did you mean \"lm\"?"));
}

TEST(SceneRefusals, NameWhatIsNotInTheLists) {
  const std::string one =
      "\"meshes\": {\"ball\": {\"shape\": \"sphere\"}}, \"materials\": {\"gold\": {}},\n\"instances\": ";
  EXPECT_EQ(refusal(one + "[{\"mesh\": \"bal\"}]"),
            "room.json:3: /instances/0/mesh = \"bal\" is not in /meshes; did you mean \"ball\"?");
  EXPECT_EQ(refusal(one + "[{\"mesh\": \"ball\", \"material\": \"golf\"}]"),
            "room.json:3: /instances/0/material = \"golf\" is not in /materials; did you mean \"gold\"?");
  EXPECT_THAT(refusal(one + "[{}]"), HasSubstr("/instances/0/mesh is missing: key in meshes"));
  const std::string obj = "\"meshes\": {\"o\": {\"file\": \"square.obj\"}}, \"instances\": [{\"mesh\": \"o\", ";
  EXPECT_THAT(refusal(obj + "\"materials\": {\"rad\": \"gold\"}}]"),
              HasSubstr("/instances/0/materials/rad is no material of the mesh's file; did you mean \"red\"?"));
  EXPECT_THAT(refusal(obj + "\"materials\": {\"red\": \"gold\"}}]"),
              HasSubstr("\"gold\" is not in /materials; there is none"));
  EXPECT_THAT(refusal(obj + "\"materials\": {\"red\": 1}}]"),
              HasSubstr("/materials/red is the number 1; expected a key in"));
}

TEST(SceneRefusals, NameParametersThatTheModelDoesNotHave) {
  const auto with = [](const std::string& parameters, const std::string& model = "callisto") {
    return refusal(
        "\"meshes\": {\"b\": {\"shape\": \"sphere\"}}, \"instances\": [{\"mesh\": \"b\", \"material\": \"m\"}],\n"
        "\"materials\": {\"m\": {\"model\": \"" +
        model + "\",\n\"parameters\": {" + parameters + "}}}");
  };
  EXPECT_EQ(with("\"rougness\": 0.1"),
            "room.json:4: /materials/m/parameters/\"rougness\" is not a parameter of model \"callisto\"; did you mean "
            "\"roughness\"?");
  EXPECT_THAT(with("\"rougness\": {\"file\": \"grey.png\"}"), HasSubstr("did you mean \"roughness\"?"));
  EXPECT_THAT(with("\"roughness\": 2"), HasSubstr("/parameters/roughness = 2 is outside [0, 1]"));
  EXPECT_THAT(with("\"roughness\": [1, 1, 1]"), HasSubstr("roughness has 3 numbers; it takes 1"));
  EXPECT_THAT(with("\"roughness\": \"grey.png\""), HasSubstr("or a texture {\"file\": ...}"));
  EXPECT_THAT(with("\"roughness\": {}"), HasSubstr("/materials/m/parameters/roughness/file is missing: picture"));
  EXPECT_THAT(with("\"base_color\": {\"file\": \"rgb.png\", \"channel\": \"g\"}"),
              HasSubstr("a color takes red, green and blue"));
  EXPECT_THAT(with("\"roughness\": {\"file\": \"rgb.png\", \"channel\": \"a\"}"),
              HasSubstr("the picture has 3 channels"));
  EXPECT_THAT(with("", "calisto"), HasSubstr("/materials/m/model: no model \"calisto\"; did you mean \"callisto\"?"));
}

TEST(SceneRefusals, NameTwoKeysThatExcludeEachOther) {
  for (const std::string camera :
       {"\"fov_deg\": 40, \"focal_mm\": 50", "\"focal_px\": [9, 9], \"focal_mm\": 50",
        "\"aperture_radius\": 1, \"f_number\": 2", "\"orthographic_height\": 1, \"fov_deg\": 40",
        "\"orthographic_height\": 1, \"aperture_radius\": 1",
        "\"position\": [0, 0, 0], \"matrix\": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]"})
    EXPECT_THAT(refusal("\"cameras\": [{" + camera + "}]"), HasSubstr("are both given; only one of them can hold"))
        << camera;
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"spot\", \"direction\": [0, 0, 1], \"target\": [0, 0, 1]}]"),
              HasSubstr("both given"));
  EXPECT_THAT(refusal("\"environment\": {\"file\": \"light.hdr\", \"radiance\": 1}"), HasSubstr("both given"));
  EXPECT_THAT(
      refusal(
          "\"instances\": [{\"mesh\": \"m\", \"scale\": 2, \"matrix\": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]}]"),
      HasSubstr("both given"));
  EXPECT_THAT(refusal("\"meshes\": {\"m\": {}}, \"instances\": [{\"mesh\": \"m\"}]"),
              HasSubstr("/meshes/m has neither \"file\" nor \"shape\""));
}

TEST(SceneRefusals, NameGeometryThatCannotBe) {
  const std::string ball = "\"meshes\": {\"b\": {\"shape\": \"sphere\"}}, \"instances\": [{\"mesh\": \"b\", ";
  EXPECT_THAT(refusal(ball + "\"scale\": [1, 2, 1]}]"),
              HasSubstr("is a sphere that is stretched or sheared; use the shape"));
  EXPECT_EQ(refusal(ball + "\"scale\": -2, \"rotate_deg\": [10, 20, 30]}]"), "");
  EXPECT_THAT(refusal(ball + "\"matrix\": [[1, 0.5, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]}]"), HasSubstr("sheared"));
  EXPECT_THAT(refusal(ball + "\"scale\": [1, 0, 1]}]"), HasSubstr("/instances/0/scale makes the mesh flat (axis 1)"));
  EXPECT_THAT(refusal(ball + "\"matrix\": [[1, 1, 0, 0], [1, 1, 0, 0], [0, 0, 1, 0]]}]"),
              HasSubstr("makes the mesh flat (determinant 0)"));
  EXPECT_THAT(refusal("\"cameras\": [{\"target\": [0, 0, 0]}]"), HasSubstr("/target is where the camera stands"));
  EXPECT_THAT(refusal("\"cameras\": [{\"up\": [0, 0, 0]}]"), HasSubstr("/up has no length"));
  EXPECT_THAT(refusal("\"cameras\": [{\"matrix\": [[2, 0, 0, 0], [0, 2, 0, 0], [0, 0, 2, 0]]}]"),
              HasSubstr("column 0 has the length 2; expected 1"));
  EXPECT_THAT(refusal("\"cameras\": [{\"matrix\": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0]]}]"),
              HasSubstr("determinant -1"));
  EXPECT_THAT(refusal("\"cameras\": [{\"width\": 65536, \"height\": 65536}]"),
              HasSubstr("4294967296 pixels; expected at most 268435456"));
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"disk\", \"target\": [0, 0, 0]}]"),
              HasSubstr("/target is where the light stands"));
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"rectangle\", \"half_u\": [1, 0, 0], \"half_v\": [2, 0, 0]}]"),
              HasSubstr("span no area"));
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"rectangle\", \"half_u\": [1, 0, 0], \"half_v\": [1, 1, 0]}]"),
              HasSubstr("right angles"));
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"rectangle\", \"half_u\": [1, 0, 0]}]"), HasSubstr("stands alone"));
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"spot\", \"inner_deg\": 50}]"),
              HasSubstr("inner_deg = 50 is beyond outer_deg = 30"));
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"point\", \"unit\": \"profile\"}]"),
              HasSubstr("there is no \"profile\""));
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"spot\", \"unit\": \"lm\", \"profile\": \"lamp.ies\"}]"),
              HasSubstr("state W/sr, cd or profile"));
  EXPECT_THAT(refusal("\"lights\": [{\"type\": \"point\", \"profile\": \"lamp.ies\", \"profile_zero\": [0, 1, 0]}]"),
              HasSubstr("along profile_axis"));
}

TEST(SceneRefusals, NameFilesThatAreNotThere) {
  EXPECT_THAT(refusal("\"meshes\": {\"m\": {\"file\": \"none.glb\"}}, \"instances\": [{\"mesh\": \"m\"}]"),
              StartsWith("none.glb: cannot be read"));
  EXPECT_THAT(refusal("\"meshes\": {\"m\": {\"file\": \"a.fbx\"}}, \"instances\": [{\"mesh\": \"m\"}]"),
              HasSubstr("expected a mesh: .glb, .gltf, .obj or .ply"));
  EXPECT_THAT(
      refusal("\"meshes\": {\"m\": {\"file\": \"square.ply\", \"part\": \"x\"}}, \"instances\": [{\"mesh\": \"m\"}]"),
      HasSubstr("has no parts"));
  EXPECT_THAT(
      refusal(
          "\"meshes\": {\"m\": {\"file\": \"square.obj\", \"part\": \"squre\"}}, \"instances\": [{\"mesh\": \"m\"}]"),
      HasSubstr("has no object or group \"squre\"; did you mean \"square\"?"));
  EXPECT_THAT(
      refusal("\"meshes\": {\"m\": {\"file\": \"square.glb\", \"part\": \"lef\"}}, \"instances\": [{\"mesh\": \"m\"}]"),
      HasSubstr("has no node \"lef\" in its scene; did you mean \"leaf\"?"));
}

TEST(SceneRefusals, SayWhatTheFileShouldBe) {
  EXPECT_THAT(refusal_of_text("{}"), StartsWith("room.json:1: /format is missing: a scene of Likeness begins"));
  EXPECT_THAT(refusal_of_text("{\"format\": \"likeness scene\"}"), HasSubstr("/version is missing"));
  EXPECT_THAT(refusal_of_text("{\"format\": \"likeness scene\",\n\"version\": 2}"),
              HasSubstr("room.json:2: /version = 2 is outside [1, 1]"));
  EXPECT_THAT(refusal_of_text("{\"format\": \"gltf\", \"version\": 1}"),
              HasSubstr("/format = \"gltf\"; expected \"likeness scene\""));
  EXPECT_THAT(refusal_of_text("{\n// no comments\n}"), StartsWith("room.json:2: not JSON (byte"));
  EXPECT_THAT(refusal("\"view\": {\"ev\": NaN}"), StartsWith("room.json:2: not JSON"));
  EXPECT_THAT(refusal("\"view\": {\"ev\": 1,\n\"ev\": 2}"),
              StartsWith("room.json:3: /view/ev is given twice (first in line 2)"));
  EXPECT_THAT(refusal_of_text(std::string(100'000, '[')), HasSubstr("nested deeper than 64"));
  EXPECT_THAT(refusal("\"cameras\": [{\"name\": \"a\"}, {\"name\": \"a\"}]"),
              HasSubstr("/cameras/1/name = \"a\" is the name of /cameras/0 too"));
}

TEST(SceneRefusals, ATextureNeedsCoordinates) {
  EXPECT_THAT(
      refusal("\"meshes\": {\"m\": {\"file\": \"flat.ply\"}}, \"instances\": [{\"mesh\": \"m\", \"material\": \"a\"}],"
              "\"materials\": {\"a\": {\"normal_map\": {\"file\": \"rgb.png\"}}}"),
      HasSubstr("flat.ply: cannot be read"));
  Files files = small_files();
  files["flat.ply"] = small_binary_ply();
  EXPECT_THAT(refusal_of_text(
                  scene_with("\"meshes\": {\"m\": {\"file\": \"flat.ply\"}}, \"instances\": [{\"mesh\": \"m\", "
                             "\"material\": \"a\"}],\"materials\": {\"a\": {\"opacity\": {\"file\": \"grey.png\"}}}"),
                  files),
              HasSubstr("/instances/0/mesh = \"m\" has no texture coordinates, but material \"a\" has textures"));
}

TEST(SceneRefusals, EveryTruncationOfASceneIsOneLine) {
  const std::string text = small_scene();
  EXPECT_EQ(refusal_of_text(text), "");
  for (std::size_t size = 0; size < text.size(); ++size) {
    const std::string said = refusal_of_text(text.substr(0, size));
    ASSERT_THAT(said, StartsWith("room.json:")) << size << " bytes";
  }
}

}  // namespace
}  // namespace likeness::scene::test
