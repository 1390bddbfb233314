#include "render/view/view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/lighting/gt_tonemap.h"
#include "render/files/files.h"
#include "render/image/tone_curve.h"
#include "render/view/color_config.h"
#include "tests/render/temporary_folder.h"

namespace likeness::view {
namespace {

using files::InputError;
using image::DisplayPicture;
using image::Picture;
using likeness::test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

// scene::View with the keys that a case names.
struct View {
  double ev = 0;
  std::string name = "srgb", display{}, config{};
  scene::View scene_view() const { return {ev, name, display, config}; }
};
DisplayPicture show(const Picture& picture, const View& view) { return view::show(picture, view.scene_view()); }

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Steps of light from 2^-12 to 2^12, grey and colored, and what is no light.
Picture steps() {
  Picture out(60, 3);
  for (int x = 0; x < 60; ++x) {
    const float v = std::exp2(static_cast<float>(x) * 0.4f - 12);
    for (std::size_t c = 0; c < 3; ++c) {
      out.at(x, 0)[c] = v;
      out.at(x, 1)[c] = v * (c == 0 ? 1.0f : 0.3f);
      out.at(x, 2)[c] = c == static_cast<std::size_t>(x % 3) ? 10 * v : -0.01f;
    }
  }
  return out;
}
Picture grey(float v) {
  Picture out(1, 1);
  for (float& c : out.rgb) c = v;
  return out;
}
int shown(float v, const View& view) { return show(grey(v), view).rgb[1]; }

std::string error_of(const View& view) {
  try {
    const Shower shower(view.scene_view());
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    return e.what();
  }
  return "no error";
}

// A config in the words of OpenColorIO: one display whose view is the scene's light to the power 1 / 2, one that is a
// factor of 2; and a data view. Its scene_linear is not Rec. 709, but it has that under an alias.
std::string config_text(const std::string& rec709_alias) {
  return R"(ocio_profile_version: 2
roles: {scene_linear: wide, default: wide}
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  screen:
    - !<View> {name: root, colorspace: root}
    - !<View> {name: twice, colorspace: twice}
  paper:
    - !<View> {name: print, colorspace: twice}
colorspaces:
  - !<ColorSpace>
    name: rec
    aliases: [)" +
         rec709_alias + R"(]
  - !<ColorSpace>
    name: wide
    to_scene_reference: !<MatrixTransform> {matrix: [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: root
    from_scene_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
  - !<ColorSpace>
    name: twice
    from_scene_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}
)";
}

TEST(SrgbView, IsTheCurveAfterExposure) {
  for (const double ev : {0.0, 1.0, -3.5}) {
    const DisplayPicture picture = show(steps(), {.ev = ev});
    const Picture light = steps();
    for (std::size_t i = 0; i < light.rgb.size(); ++i)
      EXPECT_NEAR(picture.rgb[i], 255 * std::clamp(image::srgb_encode(std::exp2(ev) * light.rgb[i]), 0.0, 1.0), 0.501);
  }
}

TEST(SrgbView, TakesEveryFloatAndEveryExposure) {
  for (const double ev : {-100.0, 0.0, 100.0}) {
    const View view{.ev = ev};
    EXPECT_EQ(shown(kNan, view), 0);
    EXPECT_EQ(shown(kInfinity, view), 255);
    EXPECT_EQ(shown(-kInfinity, view), 0);
    EXPECT_EQ(shown(-1, view), 0);
    EXPECT_EQ(shown(0, view), 0);
  }
  EXPECT_EQ(shown(1e-38f, {.ev = 100}), 0) << "2^100 x 1e-38 = 1.3e-8";
  EXPECT_EQ(shown(1e30f, {.ev = -100}), image::srgb_encode8(static_cast<float>(1e30 * std::exp2(-100))));
}

TEST(GtView, IsTheTonemapperThenTheCurve) {
  const DisplayPicture picture = show(steps(), {.ev = 1, .name = "gt"});
  const Picture light = steps();
  const brdf::GtTonemap<double> gt;
  for (std::size_t i = 0; i < light.rgb.size(); ++i)
    EXPECT_NEAR(picture.rgb[i], 255 * image::srgb_encode(gt.eval(2.0 * static_cast<double>(light.rgb[i]))),
                0.51);  // rounding
  EXPECT_LT(shown(1, {.name = "gt"}), 255) << "the shoulder";
  EXPECT_EQ(shown(kNan, {.name = "gt"}), 0);
  EXPECT_EQ(shown(kInfinity, {.name = "gt"}), 255);
}

TEST(GtView, TakesParameters) {
  brdf::GtTonemap<float> gt;
  gt.contrast = 1.5f;
  gt.linear_start = 0.1f;
  const DisplayPicture picture = Shower({0, "gt", "", ""}, gt).show(steps());
  const Picture light = steps();
  for (std::size_t i = 0; i < light.rgb.size(); ++i)
    EXPECT_EQ(picture.rgb[i], image::srgb_encode8(gt.eval(light.rgb[i])));
}

TEST(KhronosView, IsTheSpecificationsAtHandComputedColors) {
  const View khronos{.name = "khronos"};
  EXPECT_EQ(shown(0.18f, khronos), image::srgb_encode8(0.14f)) << "0.04 of sheen are taken off";
  EXPECT_EQ(shown(0.05f, khronos), image::srgb_encode8(0.015625f)) << "0.05^2 / 0.16 remain below the sheen";
  EXPECT_EQ(shown(1, khronos), image::srgb_encode8(1 - 0.0576f / 0.44f)) << "beyond the knee";
  Picture red(1, 1);
  red.rgb = {2, 0.1f, 0.1f};  // f = 0.04: p = 1.96, q = 0.96, g = 1 / 1.15
  const DisplayPicture shown_red = show(red, khronos);
  EXPECT_EQ(shown_red.rgb[0], image::srgb_encode8(0.96f));
  EXPECT_EQ(shown_red.rgb[1], image::srgb_encode8(0.06f * 0.96f / 1.96f / 1.15f + 0.96f * (1 - 1 / 1.15f)));
}

TEST(AgxView, PutsMiddleGreyInTheMiddleAndKeepsGreyGrey) {
  const View agx{.name = "agx"};
  EXPECT_EQ(shown(0.18f, agx), 128) << "the pivot of the sigmoid";
  EXPECT_EQ(shown(0.18f * 90.5f, agx), 255) << "6.5 stops above: the end of the logarithm";
  EXPECT_LE(shown(0.18f / 1024, agx), 1) << "10 stops below";
  const DisplayPicture picture = show(grey(0.5f), agx);
  EXPECT_EQ(picture.rgb[0], picture.rgb[1]);
  EXPECT_EQ(picture.rgb[1], picture.rgb[2]);
}

TEST(OwnViews, RiseAndTakeEveryFloat) {
  for (const std::string_view own : kOwnViews) {
    const View view{.name = std::string(own)};
    int before = 0;
    for (float v = 1e-6f; v < 1e6f; v *= 1.1f) {
      EXPECT_GE(shown(v, view) + (own == "khronos" ? 1 : 0), before) << own << " " << v;
      before = shown(v, view);
    }
    for (const float v : {kNan, -kInfinity, -1.0f, 0.0f}) EXPECT_LE(shown(v, view), 1) << own << " " << v;
    EXPECT_GE(shown(kInfinity, view), 254) << own;
  }
}

TEST(OwnViews, AreTheSameBeforeRounding) {
  for (const std::string_view own : kOwnViews) {
    const Shower shower({1.5, std::string(own), "", ""});
    const DisplayPicture bytes = shower.show(steps());
    std::vector<float> floats = steps().rgb;
    shower.encode(floats);
    for (std::size_t i = 0; i < floats.size(); ++i) {
      EXPECT_TRUE(floats[i] >= 0 && floats[i] <= 1) << own;
      EXPECT_NEAR(255 * floats[i], bytes.rgb[i], 0.501) << own;
    }
  }
}

TEST(AcesView, HasAShaderThatReadsNoTexture) {
  const std::string text = aces_shader_text();
  EXPECT_THAT(text, HasSubstr("vec4 aces_view("));
  EXPECT_EQ(text.find("sampler"), std::string::npos);
}

TEST(AcesView, ShowsMiddleGreyWhereAcesHasIt) {
  const View aces{.name = "aces"};
  EXPECT_EQ(shown(0.18f, aces), 91) << "0.35595 of the ACES 1.0 SDR output for sRGB";
  const DisplayPicture picture = show(grey(0.18f), aces);
  EXPECT_EQ(picture.rgb[0], picture.rgb[1]) << "grey of Rec. 709 stays grey: white is adapted";
  EXPECT_EQ(picture.rgb[1], picture.rgb[2]);
  EXPECT_EQ(shown(0.09f, {.ev = 1, .name = "aces"}), 91);
}

TEST(AcesView, RisesAndTakesEveryFloat) {
  const View aces{.name = "aces"};
  int before = -1;
  for (float v = 1e-4f; v < 1e4f; v *= 1.5f) {
    EXPECT_GE(shown(v, aces), before);
    before = shown(v, aces);
  }
  EXPECT_EQ(before, 255);
  for (const float v : {kNan, -kInfinity, -1.0f, 0.0f, -65504.0f}) EXPECT_LE(shown(v, aces), 1) << v;
  EXPECT_EQ(shown(kInfinity, aces), 255);
  Picture odd(3, 1);
  odd.rgb = {kNan, 0.18f, 0.18f, kInfinity, -kInfinity, 0, -5, 3, 1e38f};
  Picture even = odd;
  even.rgb = {0, 0.18f, 0.18f, 65504, -65504, 0, -5, 3, 65504};
  EXPECT_EQ(show(odd, aces).rgb, show(even, aces).rgb) << "NaN is black, and leaves the other channels alone";
}

TEST(ConfigView, IsLookedUpByDisplayAndName) {
  const TemporaryFolder folder;
  const std::string config = (folder / "config.ocio").string();
  files::write_whole(config, config_text("lin_rec709"));
  EXPECT_EQ(shown(0.25f, {.name = "root", .config = config}), 128);
  EXPECT_EQ(shown(0.25f, {.name = "twice", .display = "screen", .config = config}), 128);
  EXPECT_EQ(shown(0.25f, {.ev = 1, .name = "print", .display = "paper", .config = config}), 255);
  Picture red(1, 1);
  red.rgb = {0.25f, 0, 0};
  EXPECT_EQ(show(red, {.name = "twice", .config = config}).rgb[0], 128) << "as linear Rec. 709, not as scene_linear";
  files::write_whole(config, config_text("something"));
  EXPECT_EQ(show(red, {.name = "twice", .config = config}).rgb[1], 128)
      << "as scene_linear, where red and green change places";
}

TEST(ConfigView, OfTheEnvironmentIsTheDefault) {
  const TemporaryFolder folder;
  const std::string config = (folder / "config.ocio").string();
  files::write_whole(config, config_text("lin_rec709"));
  setenv("OCIO", config.c_str(), 1);
  EXPECT_EQ(shown(0.25f, {.name = "root"}), 128);
  EXPECT_EQ(shown(0.18f, {.name = "aces"}), 91) << "the built-in view needs no config";
  EXPECT_THAT(error_of({.name = "aces", .display = "screen"}), HasSubstr("has no view \"aces\""));
  unsetenv("OCIO");
  EXPECT_THAT(error_of({.name = "root"}),
              AllOf(HasSubstr("none of srgb, gt, khronos, agx and aces"), HasSubstr("$OCIO")));
}

TEST(ConfigView, ErrorsNameWhatThereIs) {
  const TemporaryFolder folder;
  const std::string config = (folder / "config.ocio").string();
  files::write_whole(config, config_text("lin_rec709"));
  EXPECT_THAT(error_of({.name = "rot", .config = config}),
              HasSubstr("has no view \"rot\"; did you mean root? It has \"root\", \"twice\""));
  EXPECT_THAT(error_of({.name = "root", .display = "wall", .config = config}),
              HasSubstr("has no display \"wall\"; it has \"screen\", \"paper\""));
  EXPECT_THAT(error_of({.name = "x", .config = (folder / "absent.ocio").string()}), HasSubstr("cannot be read"));
  EXPECT_THAT(error_of({.name = "x", .config = folder.path().string()}), HasSubstr("is a folder"));
  for (const char* text :
       {"", "no config", "ocio_profile_version: 99\n", "ocio_profile_version: 2\nroles: [\n", "\xff\xfe"}) {
    files::write_whole(config, text);
    EXPECT_THAT(error_of({.name = "x", .config = config}), HasSubstr(config + ": "));
  }
  EXPECT_THAT(error_of({.ev = 1000}), HasSubstr("ev = 1000 is outside [-100, 100]"));
  EXPECT_THAT(error_of({.ev = std::nan("")}), HasSubstr("ev = nan"));
}

TEST(ConfigView, OfThePublishedAcesConfigIsTheBuiltInOne) {
  const std::string config = std::string(LIKENESS_SHARED_DIR) + "/data/ocio/cg-config-v1.0.0_aces-v1.3_ocio-v2.1.ocio";
  if (!std::filesystem::exists(config)) GTEST_SKIP() << "there is no " << config;
  const DisplayPicture theirs =
      show(steps(), {.name = "ACES 1.0 - SDR Video", .display = "sRGB - Display", .config = config});
  EXPECT_EQ(theirs.rgb, show(steps(), {.name = "aces"}).rgb);
}

TEST(Views, DoNotDependOnTheNumberOfThreadsOrOnTheSizeOfThePicture) {
  Picture large(37, 200);
  for (std::size_t i = 0; i < large.rgb.size(); ++i) large.rgb[i] = static_cast<float>(i % 1000) * 0.003f;
  for (const std::string_view own : kOwnViews) {
    const std::string name(own);
    const Shower shower(View{.name = name}.scene_view());
    const DisplayPicture all = shower.show(large);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(shower.show(large).rgb, all.rgb) << name;
    EXPECT_EQ(shower.show(Picture()).rgb.size(), 0u);
    Picture pixel(1, 1);
    for (std::size_t c = 0; c < 3; ++c) pixel.rgb[c] = large.rgb[c + 3 * 999];
    EXPECT_EQ(shower.show(pixel).rgb[2], all.rgb[2 + 3 * 999]) << name;
  }
}

}  // namespace
}  // namespace likeness::view
