#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "render/runtime/pipeline.h"
#include "tests/render/resident.h"
#include "tests/render/runtime/scenes.h"

namespace likeness::runtime {
namespace {

std::vector<std::string> names(const std::vector<Pass>& passes) {
  std::vector<std::string> out;
  for (const Pass& p : passes) out.emplace_back(p.name);
  return out;
}

TEST(Passes, AreThoseThatTheSceneCallsFor) {
  using Names = std::vector<std::string>;
  scene::Scene s = test::spheres();
  EXPECT_EQ(names(passes_of(plan::plan_of(s), {})), Names{"visibility"});
  s.environment = scene::Environment{};
  EXPECT_EQ(names(passes_of(plan::plan_of(s), {})), (Names{"visibility", "environment"}));
  test::add_light(s, scene::PointLight{});
  EXPECT_EQ(names(passes_of(plan::plan_of(s), {})), (Names{"visibility", "light lists", "direct", "environment"}));
  s.environment.reset();
  EXPECT_EQ(names(passes_of(plan::plan_of(s), {})), (Names{"visibility", "light lists", "direct"}));
  s.images.push_back({"bumps", {1, 1, 3, {}, {0.5f, 0.5f, 1}}});
  s.materials[0].normal_map = scene::Texture{0};
  EXPECT_EQ(names(passes_of(plan::plan_of(s), {})), (Names{"visibility", "textures", "light lists", "direct"}));
}

TEST(Passes, ReadOnlyWhatWasWritten) {
  scene::Scene s = test::spheres();
  std::vector<Pass> passes = passes_of(plan::plan_of(s, 0, true), {});
  EXPECT_EQ(complaint(passes), "");
  ASSERT_EQ(passes[3].name, "direct");
  std::swap(passes[2], passes[3]);
  EXPECT_EQ(complaint(passes), "pass \"direct\" reads light lists, which no pass before it writes");
  std::swap(passes[2], passes[3]);
  passes.erase(passes.begin() + 1);
  EXPECT_EQ(complaint(passes), "pass \"direct\" reads parameters, which no pass before it writes");
}

// A light that a tile's list leaves out must not have lit any of its pixels: with and without lists the picture is one.
TEST(LightLists, LeaveOutNothingThatShines) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto direction = [&] {
    return glm::normalize(glm::vec3(uniform(engine), uniform(engine), uniform(engine) + 1e-3f));
  };
  scene::Scene all = test::spheres();
  for (int i = 0; i < 40; ++i) {
    const glm::vec3 at{4 * uniform(engine), 1.5f + 1.5f * uniform(engine), 4 * uniform(engine)};
    const float k = 1 + uniform(engine);
    switch (i % 4) {
      case 0:
        test::add_light(all, scene::PointLight{at, {k, k, k}});
        break;
      case 1:
        test::add_light(all, scene::SpotLight{at, direction(), {9 * k, 9 * k, 9 * k}, 0.1f, 0.4f});
        break;
      case 2:
        test::add_light(all, scene::DirectionalLight{direction(), {k, k, k}});
        break;
      default:
        test::add_light(all, scene::DiskLight{at, direction(), 0.2f, {k, k, k}, false});
        break;
    }
    if (i % 3 == 0) all.lights.back().range = 2;
    all.lights.back().is_visible = false;
  }
  const auto frame = [](const scene::Scene& s) {
    const world::World world(s, plan::plan_of(s));
    return Pipeline(world).frame(0, {});
  };
  const image::Picture together = frame(all);
  // Each light alone in a picture of one pixel tiles is not needed: tiles that a light is left out of show nothing of it.
  image::Picture sum(together.width, together.height);
  for (std::size_t i = 0; i < all.lights.size(); ++i) {
    scene::Scene one = all;
    for (std::size_t k = 0; k < all.lights.size(); ++k)
      if (k != i) one.lights[k].range = 1e-6f;  // it keeps its index, and its samples; it reaches nothing
    for (std::size_t k = 0; k < all.lights.size(); ++k)
      if (auto* sun = std::get_if<scene::DirectionalLight>(&one.lights[k].shape); sun != nullptr && k != i)
        sun->irradiance = glm::vec3(0);
    const image::Picture alone = frame(one);
    for (std::size_t p = 0; p < sum.rgb.size(); ++p) sum.rgb[p] += alone.rgb[p];
  }
  for (std::size_t p = 0; p < sum.rgb.size(); ++p)
    ASSERT_NEAR(sum.rgb[p], together.rgb[p], 1e-4f * (1 + together.rgb[p])) << "value " << p;  // sums in another order
}

TEST(Pipeline, TimesEveryPass) {
  scene::Scene s = test::spheres();
  test::add_light(s, scene::PointLight{{1, 3, 2}, {20, 18, 15}});
  const world::World world(s, plan::plan_of(s));
  std::vector<PassTime> times;
  Pipeline(world).frame(0, {}, 1, &times);
  ASSERT_EQ(times.size(), 3u);
  for (const PassTime& t : times) EXPECT_GT(t.seconds, 0) << t.name;
}

// Sizes that no tile divides, and one pixel.
TEST(Pipeline, RendersPicturesOfAnySize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {9, 5}, {33, 2}}) {
    scene::Scene s = test::spheres();
    test::add_light(s, scene::PointLight{{1, 3, 2}, {20, 18, 15}});
    s.cameras[0] = test::camera_at({0, 1.5f, 5}, {0, 0.7f, 0}, 35, width, height);
    const world::World world(s, plan::plan_of(s));
    const image::Picture frame = Pipeline(world).frame(0, {});
    EXPECT_EQ(frame.rgb.size(), 3u * static_cast<std::size_t>(width * height));
    EXPECT_GT(*std::max_element(frame.rgb.begin(), frame.rgb.end()), 0);
  }
}

// The second frame finds the buffers of the first, a third of another size does not.
TEST(Pipeline, MakesTheSameFrameAgainAndAgain) {
  scene::Scene s = test::spheres();
  test::add_light(s, scene::PointLight{{1, 3, 2}, {20, 18, 15}});
  s.cameras.push_back(test::camera_at({0, 1.5f, 5}, {0, 4, 0}, 35, 50, 30));  // most of it shows nothing
  s.cameras.push_back(test::camera_at({0, 1.5f, 5}, {0, 4, 0}, 35, 96, 64));
  const world::World world(s, plan::plan_of(s));
  const Pipeline pipeline(world);
  std::vector<image::Picture> first;
  for (std::size_t camera = 0; camera < 3; ++camera) first.push_back(Pipeline(world).frame(camera, {}));
  for (const std::size_t camera : {0, 0, 2, 0, 1, 1, 2, 0})
    EXPECT_EQ(pipeline.frame(camera, {}).rgb, first[camera].rgb) << camera;
}

TEST(Pipeline, TakesAtMost72BytesAPixel) {
  if (!likeness::test::kCountsMemory) GTEST_SKIP() << "a sanitizer holds memory of its own";
  constexpr int kSide = 1024;
  scene::Scene s = test::spheres();
  test::add_light(s, scene::PointLight{{1, 3, 2}, {20, 18, 15}});
  s.cameras.push_back(test::camera_at({0, 1.5f, 5}, {0, 0.7f, 0}, 35, kSide, kSide));
  const world::World world(s, plan::plan_of(s));
  const Pipeline pipeline(world);
  pipeline.frame(0, {});  // threads and their stacks
  const double before = likeness::test::resident_bytes();
  const image::Picture picture = pipeline.frame(1, {});
  const double growth = likeness::test::resident_bytes() - before;
  constexpr double kLargePages = 2 * 2097152.0;
  EXPECT_LE(growth, 72.0 * kSide * kSide + kLargePages);
  EXPECT_GE(growth, 52.0 * kSide * kSide) << "it is not seen by this test";
}

}  // namespace
}  // namespace likeness::runtime
