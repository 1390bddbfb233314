#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/image/write.h"
#include "tests/realis/baked_quad.h"
#include "tests/render/temporary_folder.h"

// The renderer's two integrators with a bake in a material, against `likeness realis apply` and against each other.
namespace likeness::realis {
namespace {

using namespace test;
using likeness::test::TemporaryFolder;

constexpr glm::dvec3 kLights[]{{0, 0, 1}, {0.6, 0, 0.8}, {-0.48, 0.64, 0.6}, {0, -0.96, 0.28}};

struct Way {
  const char* name;
  Baking baking;
};
class Renderers : public testing::TestWithParam<Way> {};

// A frame looks at pixel centers, which are texel centers: the very numbers of apply. Sample by sample the path tracer is the
// frame, wherever in the pixel they look.
TEST_P(Renderers, ShowWhatApplyMakes) {
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), GetParam().baking);
  for (const glm::dvec3& to_light : kLights) {
    const Beam beam{to_light, {1, 1, 1}};
    const Relit relit = relight(quad.capture, quad.bake, quad.surface, std::span(&beam, 1));
    // What the photograph saw of a unit light is exposure times what the material returns of it.
    const scene::Scene s = scene_of_quad(folder.path(), quad, sun(to_light, GetParam().baking.exposure));
    const image::Picture frame = frame_of(s);
    // The polynomial in the place of the exponential is right to 7e-6 of the coefficients' sum; textures are floats. Bakes
    // of floats are bytes here: half of a step of eight coefficients.
    // Mixes, and lobes of four bits, are a table: right to a percent of the residual, at most 0.4 here.
    const Baking& baking = GetParam().baking;
    const bool is_table = baking.mixes > 0 || baking.bits == baked::Bits::kFour;
    const double allowed = baking.is_float ? 8 * 0.5 / 127 * 0.2 / peak(relit.realis)
                           : is_table      ? 0.01 * 0.4 / peak(relit.realis)
                                           : 2e-5;
    EXPECT_LT(largest_difference(frame, relit.realis), allowed) << to_light.x << " " << to_light.y;
    if (GetParam().baking.lobes > 1) {
      EXPECT_GT(largest_difference(frame, relit.render), 0.05) << "there is a residual";
    }
    runtime::Settings four;
    four.pixel_samples = 4;
    EXPECT_LT(largest_difference(reference_of(s, 4), frame_of(s, four)), 1e-4);
  }
}
INSTANTIATE_TEST_SUITE_P(
    Realis, Renderers,
    testing::Values(Way{"Luminance", {.channels = Channels::kLuminance}}, Way{"Rgb", {}},
                    Way{"Dense", {.lobes = 7, .kept = 7}}, Way{"OneLobe", {.lobes = 1, .kept = 1}},
                    Way{"Float", {.lobes = 8, .kept = 8, .is_float = true}}, Way{"Mixes", {.kept = 6, .mixes = 6}},
                    Way{"MixesOfLuminance", {.kept = 3, .channels = Channels::kLuminance, .mixes = 6}},
                    Way{"MixesOfFourBits", {.kept = 6, .mixes = 6, .bits = baked::Bits::kFour}},
                    Way{"LobesOfFourBits", {.lobes = 7, .kept = 7, .bits = baked::Bits::kFour}},
                    Way{"SoftEnd", {.spread = 0.15, .least = 0.03}}),
    [](const auto& row) { return std::string(row.param.name); });

// With more than eight lobes a texel the path tracer has all of them, the frame the dominant ones.
TEST(RenderersWithManyLobes, PathTracerHasThemAllFramesTheDominantOnes) {
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), {.lobes = 256, .kept = 256, .size = 0.01});
  const Beam beam{kLights[1], {1, 1, 1}};
  const Relit relit = relight(quad.capture, quad.bake, quad.surface, std::span(&beam, 1));
  const scene::Scene s = scene_of_quad(folder.path(), quad, sun(kLights[1], 1.7));
  EXPECT_EQ(s.bakes[0].groups, 32u);
  const image::Picture frame = frame_of(s), reference = reference_of(s, 1);
  EXPECT_TRUE(std::isfinite(largest_difference(frame, relit.realis)));
  // One sample lies anywhere in its pixel, so means are compared: the residual of all lobes moves it, the noise of place
  // does not by more than 1 %.
  EXPECT_NEAR(mean(reference_of(s, 64)), mean(relit.realis), 0.01 * mean(relit.realis));
  for (const float x : frame.rgb) EXPECT_GE(x, 0);
}

TEST(Residuals, LightIsNeverNegativeNorNan) {
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), {.size = 50});
  const std::string lights =
      R"("lights": [{"type": "sphere", "position": [3, 2, 9], "radius": 1, "strength": 50}, {"type": "point", "position": [-9, 0, 1]}],
"environment": {"radiance": 0.5})";
  const scene::Scene s = scene_of_quad(folder.path(), quad, lights);
  for (const auto level : {runtime::EnvironmentLevel::kMaps, runtime::EnvironmentLevel::kRays4}) {
    runtime::Settings settings;
    settings.environment = level;
    for (const float x : frame_of(s, settings).rgb) EXPECT_TRUE(x >= 0 && std::isfinite(x)) << x;
  }
  for (const float x : reference_of(s, 4, 8).rgb) EXPECT_TRUE(x >= 0 && std::isfinite(x)) << x;
}

TEST(Residuals, WithoutLobesOrStrengthThePictureIsThatOfNoBake) {
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), {.lobes = 0, .kept = 0});
  const std::string lights = sun(kLights[2], 2);
  const image::Picture plain = frame_of(scene_of_quad(folder.path(), quad, lights, "none"));
  EXPECT_EQ(frame_of(scene_of_quad(folder.path(), quad, lights)).rgb, plain.rgb);
  const BakedQuad full = write_quad(folder.path(), {});
  EXPECT_EQ(frame_of(scene_of_quad(folder.path(), full, lights, R"(, "strength": 0)")).rgb, plain.rgb);
  EXPECT_NE(frame_of(scene_of_quad(folder.path(), full, lights)).rgb, plain.rgb);
  // Every effect forced changes nothing, with and without a bake.
  EXPECT_LT(largest_difference(frame_of(scene_of_quad(folder.path(), full, lights), {}, true),
                               frame_of(scene_of_quad(folder.path(), full, lights))),
            1e-6);
}

// Directions are chosen by the model or by the cosine: an environment that is the same everywhere is found by nothing else,
// and what comes back is the integral.
TEST(Residuals, ThePathTracerIsUnbiasedUnderAnEvenSky) {
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), {.size = 0.1, .has_surface = false});
  const std::string sky = R"("environment": {"radiance": 1})";
  const image::Picture with = reference_of(scene_of_quad(folder.path(), quad, sky), 1024),
                       plain = reference_of(scene_of_quad(folder.path(), quad, sky, "none"), 1024);
  // The mean over the quad of the integral of e max(cos_i, floor) over the half sphere; the cut at 0 of f + e is small with
  // a base color of a half, and the exposure is 1 without a surface.
  double sum = 0;
  std::size_t count = 0;
  for (const glm::dvec3& l : dome(2000)) {
    const Residual e(quad.bake.bake, l);
    for (std::size_t i = 0; i < quad.bake.pixels.size(); i += 7, ++count) {
      const float* n = quad.surface.normals.rgb.data() + 3 * quad.bake.pixels[i];
      const auto added =
          e.at(i, static_cast<double>(n[0]) * l.x + static_cast<double>(n[1]) * l.y + static_cast<double>(n[2]) * l.z);
      sum += (added[0] + added[1] + added[2]) / 3;
    }
  }
  const double expected = sum / static_cast<double>(count) * 2 * std::numbers::pi;
  // A tenth of the mean of |e|: noise, bilinear texels at the border and the cut.
  EXPECT_NEAR(mean(with) - mean(plain), expected, 0.015) << "of " << mean(plain);
}

// A lamp with a size is found by both ways of choosing directions, in both integrators.
TEST(Residuals, FramesFindLampsAndSkiesAsThePathTracerDoes) {
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), {});
  for (
      const std::string lights :
      {R"("lights": [{"type": "sphere", "position": [3, 2, 7], "radius": 2, "strength": 10}])",
       R"("lights": [{"type": "rectangle", "position": [0, 6, 5], "target": [0, 0, 0], "size": [8, 4], "strength": 10}])",
       R"("lights": [{"type": "disk", "position": [-9, 0, 4], "target": [0, 0, 0], "radius": 3, "strength": 10}])",
       R"("environment": {"radiance": 1})"}) {
    const scene::Scene s = scene_of_quad(folder.path(), quad, lights);
    runtime::Settings settings;
    settings.pixel_samples = 16, settings.light_samples = 4, settings.environment = runtime::EnvironmentLevel::kRays16;
    const double expected = mean(reference_of(s, 256)), got = mean(frame_of(s, settings));
    EXPECT_NEAR(got, expected, 0.01 * expected) << lights;
  }
}

// The quad turned with its light and its camera is the same picture: lobes lie in model space.
TEST(Residuals, TurnWithTheirInstance) {
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), {});
  const image::Picture still = frame_of(scene_of_quad(folder.path(), quad, sun({0.6, 0, 0.8}, 1)));
  // A quarter about y takes z to x, and x to -z.
  const scene::Scene turned =
      scene_of_quad(folder.path(), quad, sun({0.8, 0, -0.6}, 1), "", "", R"(, "rotate_deg": [0, 90, 0])",
                    R"("position": [5, 0, 0], "target": [0, 0, 0])");
  EXPECT_LT(largest_difference(frame_of(turned), still), 1e-4);
  // Mirrored with its light in x, the picture is mirrored.
  const scene::Scene mirrored =
      scene_of_quad(folder.path(), quad, sun({-0.6, 0, 0.8}, 1), "", "", R"(, "scale": [-1, 1, 1])");
  const image::Picture seen = frame_of(mirrored);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      EXPECT_NEAR(seen.at(kWidth - 1 - x, y)[0], still.at(x, y)[0], 1e-4 * peak(still)) << x << " " << y;
}

TEST(Residuals, FadeWhereTheSurfaceIsNotTheBakes) {
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), {});
  const std::string lights = sun(kLights[1], 1.7);
  const auto share = [&](const std::string& realis, const std::string& parameters) {
    const auto with = frame_of(scene_of_quad(folder.path(), quad, lights, realis, parameters)),
               without = frame_of(scene_of_quad(folder.path(), quad, lights, "none", parameters));
    double most = 0;
    for (std::size_t i = 0; i < with.rgb.size(); ++i)
      most = std::max(most, std::abs(static_cast<double>(with.rgb[i] - without.rgb[i])));
    return most;
  };
  const double whole = share("", "");
  EXPECT_GT(whole, 0.02);
  // What is added does not depend on what it is added to: only rounding does.
  EXPECT_NEAR(share("", R"(, "roughness": 0.44)"), whole, 1e-5) << "as rough, nearly";
  EXPECT_EQ(share("", R"(, "roughness": 0.75)"), 0);
  EXPECT_NEAR(share(R"(, "fades": false)", R"(, "roughness": 0.75)"), whole, 1e-5);
  EXPECT_NEAR(share(R"(, "fade_roughness": [0.5, 0.6])", R"(, "roughness": 0.75)"), whole, 1e-5);
  EXPECT_NEAR(share(R"(, "fade_roughness": [0.1, 0.3])", R"(, "roughness": 0.6)"), 0.5 * whole, 1e-5) << "the middle";
  EXPECT_NEAR(share(R"(, "strength": 0.25)", ""), 0.25 * whole, 1e-5);
  // Dirt: another base color, and another normal.
  scene::Scene s = scene_of_quad(folder.path(), quad, lights),
               plain = scene_of_quad(folder.path(), quad, lights, "none");
  for (scene::Scene* one : {&s, &plain}) one->materials[0].bindings[0].texture.scale = glm::vec3(0.02f);
  EXPECT_EQ(frame_of(s).rgb, frame_of(plain).rgb);
  s = scene_of_quad(folder.path(), quad, lights), plain = scene_of_quad(folder.path(), quad, lights, "none");
  for (scene::Scene* one : {&s, &plain}) one->materials[0].normal_strength = -1;
  EXPECT_LT(largest_difference(frame_of(s), frame_of(plain)), whole / peak(frame_of(plain)));
}

// The back was not photographed.
TEST(Residuals, AreNotOnTheBack) {
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), {.has_surface = false});
  const std::string behind = R"("position": [0, 0, -5], "target": [0, 0, 0])";
  const std::string lights = sun({0.6, 0, -0.8}, 1);
  EXPECT_EQ(frame_of(scene_of_quad(folder.path(), quad, lights, "", "", "", behind)).rgb,
            frame_of(scene_of_quad(folder.path(), quad, lights, "none", "", "", behind)).rgb);
}

// Drawn lobes are another picture each frame, whose mean is that of all lobes.
TEST(Residuals, JitterIsRightInTheMean) {
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), {.size = 0.01});  // small, so that the cut at 0 plays no part
  const std::string lights = sun(kLights[1], 1.7);
  const scene::Scene all = scene_of_quad(folder.path(), quad, lights),
                     plain = scene_of_quad(folder.path(), quad, lights, "none"),
                     some = scene_of_quad(folder.path(), quad, lights, R"(, "jitter": 2)");
  const image::Picture expected = frame_of(all);
  const world::World world(some, plan::plan_of(some));
  const runtime::Pipeline pipeline(world);
  constexpr int kFrames = 256;
  std::vector<double> sum(expected.rgb.size());
  image::Picture first;
  for (int i = 0; i < kFrames; ++i) {
    runtime::Settings settings;
    settings.seed = static_cast<std::uint32_t>(1000 * i);
    const image::Picture frame = pipeline.frame(0, settings);
    if (i == 0) first = frame;
    if (i == 1) {
      EXPECT_NE(frame.rgb, first.rgb);
    }
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += static_cast<double>(frame.rgb[k]) / kFrames;
  }
  image::Picture got = expected;
  for (std::size_t k = 0; k < sum.size(); ++k) got.rgb[k] = static_cast<float>(sum[k]);
  const double whole = largest_difference(expected, frame_of(plain));
  EXPECT_LT(largest_difference(got, expected), 0.25 * whole)
      << "of the largest residual; a frame alone is off by " << largest_difference(first, expected) / whole;
}

// Maps of the environment against the integral of e max(cos_i, floor) over the half sphere: the error of a lobe's mean
// direction.
TEST(Residuals, MapsOfTheEnvironmentComeNearTheIntegral) {
  const TemporaryFolder folder;
  for (const std::size_t mixes : {std::size_t{0}, std::size_t{6}}) {
    const BakedQuad quad =
        write_quad(folder.path(), {.kept = mixes > 0 ? mixes : 8, .has_surface = false, .mixes = mixes});
    const std::string sky = R"("environment": {"radiance": 1})";
    const image::Picture with = frame_of(scene_of_quad(folder.path(), quad, sky)),
                         plain = frame_of(scene_of_quad(folder.path(), quad, sky, "none"));
    std::vector<double> expected(with.rgb.size());
    const auto directions = dome(1500);
    for (const glm::dvec3& l : directions) {
      const Residual e(quad.bake.bake, l);
      for (std::size_t i = 0; i < quad.bake.pixels.size(); ++i) {
        const float* n = quad.surface.normals.rgb.data() + 3 * i;
        const auto added = e.at(
            i, static_cast<double>(n[0]) * l.x + static_cast<double>(n[1]) * l.y + static_cast<double>(n[2]) * l.z);
        for (std::size_t c = 0; c < 3; ++c)
          expected[3 * i + c] += added[c] * 2 * std::numbers::pi / static_cast<double>(directions.size());
      }
    }
    double error = 0, whole = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double d = static_cast<double>(with.rgb[i] - plain.rgb[i]) - expected[i];
      error += d * d, whole += expected[i] * expected[i];
    }
    std::printf("maps of the environment, %zu mixes: residual off by %.3f of its rms\n", mixes,
                std::sqrt(error / whole));
    EXPECT_LT(error, 0.2 * 0.2 * whole);
  }
}

// Under an even sky the soft end of light adds base_color spread^2: the integral of beyond_hard() over the sphere is pi spread^2.
TEST(Residuals, MapsOfTheEnvironmentEndSoftly) {
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), {.lobes = 0, .kept = 0, .exposure = 1, .spread = 0.15});
  const std::string sky = R"("environment": {"radiance": 1})";
  const image::Picture with = frame_of(scene_of_quad(folder.path(), quad, sky)),
                       plain = frame_of(scene_of_quad(folder.path(), quad, sky, "none"));
  for (std::size_t i = 0; i < with.rgb.size(); ++i) {
    // Cells of the sky are 4 degrees, half of the spread: 2 %.
    const double expected = static_cast<double>(quad.surface.base_colors.rgb[i]) * 0.15 * 0.15;
    EXPECT_NEAR(static_cast<double>(with.rgb[i] - plain.rgb[i]), expected, 0.02 * expected + 1e-6);
  }
}

std::string complaint_of(const std::filesystem::path& file) {
  try {
    scene::read_scene(file);
  } catch (const files::InputError& error) {
    return error.what();
  }
  return "nothing";
}

TEST(Residuals, WhatCannotBeUsedIsNamed) {
  using testing::HasSubstr;
  const TemporaryFolder folder;
  const BakedQuad quad = write_quad(folder.path(), {});
  scene_of_quad(folder.path(), quad, sun({0, 0, 1}, 1));
  const auto file = folder.path() / "scene.json";
  const std::string text = files::read_whole(file, 1 << 20);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const auto at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    files::write_whole(file, changed.replace(at, from.size(), to));
    return complaint_of(file);
  };
  const std::string bake = R"("realis": {"bake": "bake"})";
  EXPECT_THAT(with(bake, R"("realis": {})"), HasSubstr("bake"));
  EXPECT_THAT(with(bake, R"("realis": {"bake": "cake"})"), HasSubstr("cake/bake.json"));
  EXPECT_THAT(with(bake, R"("realis": {"bake": "bake", "strenght": 1})"), HasSubstr("did you mean \"strength\"?"));
  EXPECT_THAT(with(bake, R"("realis": {"bake": "bake", "jitter": 9})"), HasSubstr("[0, 8]"));
  EXPECT_THAT(with(bake, R"("realis": {"bake": "bake", "fade_roughness": [0.3, 0.3]})"),
              HasSubstr("smaller number first"));
  files::write_whole(folder.path() / "quad.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n");
  files::write_whole(file, R"({"format": "likeness scene", "version": 1, "meshes": {"quad": {"file": "quad.obj"}},
"materials": {"subject": {"realis": {"bake": "bake"}}}, "instances": [{"mesh": "quad", "material": "subject"}]})");
  EXPECT_THAT(complaint_of(file), testing::AllOf(HasSubstr("has no texture coordinates"), HasSubstr("has a bake")));
  std::filesystem::remove(folder.path() / "bake" / "lobes_001.png");
  files::write_whole(file, text);
  EXPECT_THAT(complaint_of(file), HasSubstr("lobes_001.png"));
  write_quad(folder.path(), {.lobes = 10});
  image::write_png(folder.path() / "bake" / "normal.png", image::DisplayPicture(3, 3));
  EXPECT_THAT(complaint_of(file), HasSubstr("is of another size"));
}

}  // namespace
}  // namespace likeness::realis
