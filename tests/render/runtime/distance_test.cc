#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "brdf/normal_length.h"
#include "render/reference/reference.h"
#include "render/runtime/pipeline.h"
#include "tests/render/runtime/scenes.h"

// Surfaces of which a pixel shows more than a texel, against the path tracer, which looks at many points.
namespace likeness::runtime {
namespace {

using texture::Filter;

// Bumps as wide as four texels whose normals lean by up to `lean` (its sine).
scene::Image bumps(float lean, int side = 64) {
  scene::Image image{"bumps", {side, side, 3, {}, {}}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const float phase = 2 * std::numbers::pi_v<float> / 4;
      const float nx = lean * std::sin(phase * (static_cast<float>(x) + 0.3f)),
                  ny = lean * std::cos(phase * (static_cast<float>(y) + 0.6f));
      for (const float c : {nx, ny, std::sqrt(1 - nx * nx - ny * ny)}) image.texels.floats.push_back(0.5f + 0.5f * c);
    }
  return image;
}

struct Look {
  float roughness = 0.3f, lean = 0.3f, repeats = 4;
  bool is_metal = false;
};

// A square of 2 m in the x-y plane that faces +z and a lamp; the camera looks at its middle from `from`.
scene::Scene wall(const Look& look, const glm::vec3& from, int size = 24) {
  scene::Scene s;
  brdf::Callisto<double> c;
  c.base_color = {0.6, 0.5, 0.4}, c.roughness = static_cast<double>(look.roughness), c.metallic = look.is_metal ? 1 : 0;
  const scene::Index material = test::add_material(s, c, "wall");
  s.images.push_back(bumps(look.lean));
  scene::Texture map{0};
  map.uv_scale = glm::vec2(look.repeats);
  s.materials[material].normal_map = map;
  test::add_quad(s, material, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}, {-1, -1, 0});
  const float fov = 2 * std::atan(0.8f / glm::length(from)) * 180 / std::numbers::pi_v<float>;
  s.cameras.push_back(test::camera_at(from, {0, 0, 0}, fov, size, size));
  test::add_light(s, scene::PointLight{{-1.5f, 1, 4}, {30, 30, 30}});
  return s;
}

Settings with(Filter filter, DistantDiffuse diffuse = DistantDiffuse::kProxima, int points = 1) {
  Settings settings;
  settings.textures = filter, settings.distant_diffuse = diffuse, settings.pixel_samples = points;
  return settings;
}

image::Picture distant_frame(const scene::Scene& s, const Settings& settings, bool force_all = false) {
  const world::World world(s, plan::plan_of(s, 0, force_all));
  return Pipeline(world).frame(0, settings);
}
image::Picture distant_reference(const scene::Scene& s, std::uint32_t samples = 256) {
  const world::World world(s, plan::plan_of(s));
  reference::Options options;
  options.samples = samples, options.max_bounces = 1;
  reference::Film film(s.cameras[0].width, s.cameras[0].height, false);
  reference::render(world, options, film, [](const auto&) { return true; });
  return film.picture();
}

double mean_light(const image::Picture& p) {
  double sum = 0;
  for (const float x : p.rgb) sum += static_cast<double>(x);
  return sum / static_cast<double>(p.rgb.size());
}
// Mean squared difference over the mean of the reference's square.
double distant_error(const image::Picture& frame, const image::Picture& reference) {
  double squares = 0, whole = 0;
  for (std::size_t i = 0; i < frame.rgb.size(); ++i) {
    const double d = static_cast<double>(frame.rgb[i]) - static_cast<double>(reference.rgb[i]);
    squares += d * d, whole += static_cast<double>(reference.rgb[i]) * static_cast<double>(reference.rgb[i]);
  }
  return squares / whole;
}
bool is_finite(const image::Picture& p) {
  return std::all_of(p.rgb.begin(), p.rgb.end(), [](float x) { return std::isfinite(x) && x >= 0; });
}

TEST(Distance, AFrameOfLevelsIsNearerToTheReferenceThanOneOfFullSize) {
  for (const float roughness : {0.15f, 0.3f, 0.6f}) {
    const scene::Scene s = wall({.roughness = roughness, .is_metal = true}, {0.3f, 0.2f, 4});
    const image::Picture reference = distant_reference(s);
    const double full = distant_error(distant_frame(s, with(Filter::kFull)), reference);
    for (const Filter filter : {Filter::kNearest, Filter::kTrilinear, Filter::kAnisotropic}) {
      const image::Picture frame = distant_frame(s, with(filter));
      EXPECT_LT(distant_error(frame, reference), 0.35 * full) << roughness << " " << static_cast<int>(filter);
      // The slopes of these bumps are a sine's and not GGX's, which shows the more the smoother they are: 19 %, 14 % and
      // 6 % met. Without the length of their mean the highlight would be several times too bright (the next test).
      EXPECT_NEAR(mean_light(frame) / mean_light(reference), 1, 0.22) << roughness;
    }
  }
}

TEST(Distance, BumpsThatAreTooSmallToBeSeenWidenTheHighlight) {
  // So far away that the whole map is in a pixel: the highlight of the smooth wall is not what the bumps show.
  const scene::Scene s = wall({.roughness = 0.15f, .lean = 0.3f, .repeats = 32, .is_metal = true}, {0, 0, 4});
  scene::Scene smooth = s;
  smooth.materials[0].normal_map.reset();
  const image::Picture reference = distant_reference(s), frame = distant_frame(s, with(Filter::kAnisotropic));
  const auto brightest = [](const image::Picture& p) { return *std::max_element(p.rgb.begin(), p.rgb.end()); };
  EXPECT_GT(brightest(distant_frame(smooth, {})), 4 * brightest(reference));
  EXPECT_LT(brightest(frame), 1.5f * brightest(reference));
  EXPECT_GT(brightest(frame), 0.6f * brightest(reference));
}

TEST(Distance, NearSurfacesAreUnchanged) {
  // A texel is many pixels wide.
  for (const bool is_metal : {false, true}) {
    const scene::Scene s = wall({.repeats = 0.1f, .is_metal = is_metal}, {0.3f, 0.2f, 2});
    const image::Picture full = distant_frame(s, with(Filter::kFull));
    for (const Filter filter : {Filter::kNearest, Filter::kTrilinear, Filter::kAnisotropic})
      EXPECT_EQ(distant_frame(s, with(filter)).rgb, full.rgb) << static_cast<int>(filter);
  }
}

TEST(Distance, MorePointsInAPixelMeanSmallerFootprints) {
  const scene::Scene s = wall({.roughness = 0.4f, .repeats = 2, .is_metal = true}, {0.3f, 0.2f, 4}, 64);
  const image::Picture full = distant_frame(s, with(Filter::kFull, {}, 64));
  const double one = distant_error(distant_frame(s, with(Filter::kAnisotropic, {}, 1)), full);
  const double many = distant_error(distant_frame(s, with(Filter::kAnisotropic, {}, 64)), full);
  EXPECT_LT(many, 0.02 * one);
}

// The diffuse of bumps, which are dark where the light grazes only on their far sides.
TEST(Distance, ProximaIsNearerToBumpyDiffuseThanLambertIs) {
  double lambert = 0, proxima = 0;
  for (const float height : {0.3f, 0.6f, 1.5f}) {
    scene::Scene s = wall({.lean = 0.6f, .repeats = 32}, {0, 0, 4});
    std::get<brdf::Callisto<double>>(s.materials[0].brdf).specular = 0;
    std::get<scene::PointLight>(s.lights[0].shape).position = {-4, 0, height};
    const image::Picture reference = distant_reference(s);
    lambert += distant_error(distant_frame(s, with(Filter::kAnisotropic, DistantDiffuse::kLambert)), reference);
    proxima += distant_error(distant_frame(s, with(Filter::kAnisotropic, DistantDiffuse::kProxima)), reference);
  }
  EXPECT_LT(proxima, 0.4 * lambert) << lambert;
}

TEST(Distance, AtAGrazingViewPlacesAlongTheFootprintKeepWhatLevelsWashOut) {
  // Stripes that run away from the camera on a floor: a pixel covers many along, few across.
  scene::Scene s;
  brdf::Callisto<double> c;
  c.specular = 0;
  const scene::Index material = test::add_material(s, c, "stripes");
  scene::Image stripes{"stripes", {64, 64, 1, {}, {}}};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) stripes.texels.floats.push_back(x % 8 < 4 ? 0.8f : 0.1f);
  s.images.push_back(stripes);
  scene::Texture texture{0};
  texture.uv_scale = {2, 2};
  s.materials[material].bindings = {{0, texture}};
  test::add_quad(s, material, {-1, 0, -8}, {1, 0, -8}, {1, 0, 1}, {-1, 0, 1});
  s.cameras.push_back(test::camera_at({0, 0.25f, 1.5f}, {0, 0, -1.5f}, 30, 64, 32));
  test::add_light(s, scene::DirectionalLight{{0, -1, 0}, {3, 3, 3}});
  const image::Picture reference = distant_reference(s);
  const double trilinear = distant_error(distant_frame(s, with(Filter::kTrilinear)), reference);
  const double anisotropic = distant_error(distant_frame(s, with(Filter::kAnisotropic)), reference);
  const double full = distant_error(distant_frame(s, with(Filter::kFull)), reference);
  EXPECT_LT(anisotropic, 0.5 * trilinear);
  EXPECT_LT(anisotropic, 0.5 * full);
}

// A camera that moves by parts of a pixel sees the same wall; points of it at full size flicker.
TEST(Distance, SparklesLessWhenTheCameraMovesByPartsOfAPixel) {
  const auto flicker = [](Filter filter) {
    constexpr int kSteps = 8;
    std::vector<double> sums, squares;
    for (int i = 0; i < kSteps; ++i) {
      scene::Scene s = wall({.roughness = 0.15f, .repeats = 16, .is_metal = true}, {0.3f, 0.2f, 4});
      s.cameras[0].center_x += i / static_cast<double>(kSteps);
      s.cameras[0].center_y += 0.37 * i / kSteps;
      const image::Picture frame = distant_frame(s, with(filter));
      sums.resize(frame.rgb.size()), squares.resize(frame.rgb.size());
      for (std::size_t k = 0; k < frame.rgb.size(); ++k) {
        sums[k] += static_cast<double>(frame.rgb[k]);
        squares[k] += static_cast<double>(frame.rgb[k]) * static_cast<double>(frame.rgb[k]);
      }
    }
    double variance = 0, whole = 0;
    for (std::size_t k = 0; k < sums.size(); ++k) {
      const double m = sums[k] / kSteps;
      variance += squares[k] / kSteps - m * m, whole += m * m;
    }
    return variance / whole;
  };
  EXPECT_LT(flicker(Filter::kAnisotropic), 0.02 * flicker(Filter::kFull));
}

// Mirrored uvs, two-sided surfaces from behind, a mirrored instance: the same bumps, the same distance.
TEST(Distance, IsTheSameForMirroredTexturesAndFromBehind) {
  const Look look{.roughness = 0.25f, .is_metal = true};
  for (const int what : {0, 1, 2}) {
    scene::Scene s = wall(look, {0.3f, 0.2f, what == 1 ? -4.0f : 4.0f});
    if (what == 0)
      for (glm::vec2& uv : s.meshes[0].uvs) uv.x = -uv.x;
    if (what == 1) std::get<scene::PointLight>(s.lights[0].shape).position.z *= -1;
    if (what == 2) s.instances[0].world_from_object[0] *= -1.0f;
    const image::Picture reference = distant_reference(s);
    EXPECT_LT(distant_error(distant_frame(s, with(Filter::kAnisotropic)), reference),
              0.35 * distant_error(distant_frame(s, with(Filter::kFull)), reference))
        << what;
  }
}

TEST(Distance, OfASphereAndOfDualNormals) {
  scene::Scene s = wall({.roughness = 0.3f, .repeats = 8}, {0, 0, 5});
  s.meshes[0] = {}, s.meshes[0].is_sphere = true;
  s.materials[0].normal_map->uv_scale = {16, 8};
  for (const bool is_dual : {false, true}) {
    if (is_dual) s.materials[0].diffuse_normal_map = s.materials[0].normal_map;
    const image::Picture reference = distant_reference(s);
    EXPECT_LT(distant_error(distant_frame(s, with(Filter::kAnisotropic)), reference),
              0.35 * distant_error(distant_frame(s, with(Filter::kFull)), reference))
        << is_dual;
  }
}

TEST(Distance, StaysFiniteWhereFootprintsDoNot) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto expect_sound = [](const scene::Scene& s, const char* what) {
    for (const Filter filter : {Filter::kFull, Filter::kNearest, Filter::kTrilinear, Filter::kAnisotropic})
      EXPECT_TRUE(is_finite(distant_frame(s, with(filter)))) << what << " " << static_cast<int>(filter);
  };
  scene::Scene s = wall({}, {0, 4, 1e-6f});  // along the wall
  expect_sound(s, "grazing");
  s = wall({}, {0, 0, 4}), s.meshes[0].uvs.clear();
  expect_sound(s, "no uvs");
  s = wall({}, {0, 0, 4}), s.meshes[0].uvs.assign(4, {0.5f, 0.5f});
  expect_sound(s, "one uv");
  s = wall({}, {0, 0, 4}), s.meshes[0].uvs = {{1e30f, 0}, {-1e30f, 0}, {1e30f, 1e30f}, {0, 0}};
  expect_sound(s, "huge uvs");
  s = wall({}, {0, 0, 4}), s.meshes[0].uvs[1] = {nan, nan};
  expect_sound(s, "uvs that are no numbers");
  s = wall({}, {0, 0, 4});
  for (std::size_t i = 0; i < s.images[0].texels.floats.size(); i += 7) s.images[0].texels.floats[i] = nan;
  expect_sound(s, "texels that are no numbers");
  s = wall({}, {0, 0, 4}), s.materials[0].normal_map->uv_scale = {0, 5};
  expect_sound(s, "a texture that does not move along u");
  s = wall({}, {0, 0, 4}), s.materials[0].normal_map->wrap = scene::Wrap::kClamp;
  expect_sound(s, "clamped");
  s = wall({}, {0, 0, 4}), s.images[0] = bumps(0.3f, 37);
  s.images[0].texels.height = 5, s.images[0].texels.floats.resize(37 * 5 * 3);
  expect_sound(s, "a size that is no power of two");
  s = wall({.roughness = 0}, {0, 0, 4});
  expect_sound(s, "a mirror");
  s = wall({.lean = 0.99f}, {3.9f, 0, 0.4f});
  expect_sound(s, "steep bumps from aside");
}

// One texel is the same everywhere: nothing to filter, and forcing it changes nothing.
TEST(Distance, OfOneTexelIsNothing) {
  scene::Scene s = wall({}, {0.3f, 0.2f, 4});
  s.images[0] = {"one", {1, 1, 3, {}, {0.6f, 0.45f, 0.9f}}};
  EXPECT_FALSE(plan::plan_of(s).has(plan::Effect::kTextureLevels));
  const image::Picture full = distant_frame(s, with(Filter::kFull));
  EXPECT_EQ(distant_frame(s, with(Filter::kAnisotropic)).rgb, full.rgb);
  const image::Picture forced = distant_frame(s, with(Filter::kAnisotropic), true);
  for (std::size_t i = 0; i < full.rgb.size(); ++i) ASSERT_NEAR(forced.rgb[i], full.rgb[i], 1e-6f * (1 + full.rgb[i]));
}

// What shines by a texture is filtered too.
TEST(Distance, OfEmissionIsItsMean) {
  scene::Scene s = wall({}, {0, 0, 4});
  s.lights.clear();
  s.materials[0].normal_map.reset();
  scene::Image checker{"checker", {64, 64, 1, {}, {}}};
  for (int i = 0; i < 64 * 64; ++i) checker.texels.floats.push_back((i + i / 64) % 2 == 0 ? 1.0f : 0.0f);
  s.images[0] = checker;
  s.materials[0].emission = {2, 2, 2};
  s.materials[0].emission_map = scene::Texture{0};
  s.materials[0].emission_map->uv_scale = glm::vec2(16);
  const image::Picture frame = distant_frame(s, with(Filter::kAnisotropic));
  // What it sends itself, and what it receives from itself: nothing, as it is flat.
  for (const float x : frame.rgb) ASSERT_NEAR(x, 1, 1e-4f);
  for (const float x : distant_frame(s, with(Filter::kFull)).rgb) ASSERT_TRUE(x >= 0 && x <= 2);
}

TEST(Distance, WhatANormalMapAndARoughnessLoseAddsUp) {
  // A rough wall with bumps is as the same wall whose bumps are in its roughness.
  const scene::Scene s = wall({.roughness = 0.5f, .lean = 0.4f, .repeats = 32, .is_metal = true}, {0, 0, 4});
  const world::World world(s, plan::plan_of(s));
  const surface::SceneLevels levels(world.materials);
  EXPECT_GT(levels.bytes(), 0u);
  EXPECT_LE(levels.bytes(), 64u * 64 * 3 * sizeof(float) / 3);
  surface::ModelBytes model = world.materials[0].model;
  const float before = 0.5f;
  surface::roughen(world.materials[0], 0.08f, model);
  const float after = reinterpret_cast<const float*>(model.bytes.data())[world.materials[0].roughness_at];
  const double deficit = 1 - (1 - brdf::normal_deficit(0.25)) * (1 - 0.08);
  EXPECT_GT(after, before);
  EXPECT_NEAR(after, std::sqrt(brdf::alpha_of_normal_deficit(deficit)), 3e-4);  // one step of the inverse
}

}  // namespace
}  // namespace likeness::runtime
