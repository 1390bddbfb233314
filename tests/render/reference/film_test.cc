#include <atomic>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "render/files/files.h"
#include "render/image/layers.h"
#include "tests/render/reference/small_scenes.h"
#include "tests/render/temporary_folder.h"

namespace likeness::reference {
namespace {

// Two spheres over a floor with a sky and a light: noise in every pixel, many bounces.
scene::Scene stage(int size = 40) {
  scene::Scene scene;
  scene.meshes = {square_mesh(), sphere_mesh()};
  brdf::Callisto<double> callisto;
  callisto.roughness = 0.3;
  scene.materials = {material_of(lambert(0.6)), material_of(callisto)};
  scene.instances = {
      {"", 0, 0, placed({0, -1, 0}, 5)}, {"", 1, 1, placed({-1, 0, 0})}, {"", 1, 0, placed({1, 0, 0.5f}, 0.8f)}};
  scene.lights = {{"", scene::SphereLight{{1, 3, 2}, 0.3f, {20, 10, 5}}}};
  scene.environment = scene::Environment{scene::kNone, {0.2f, 0.3f, 0.4f}, 0};
  scene.cameras = {camera_at({0, 0.5f, 5}, {0, 0, 0}, size, size, 1)};
  return scene;
}
bool goes_on(const Progress&) { return true; }

void expect_same_bits(const Film& a, const Film& b) {
  const image::Layers x = a.layers(), y = b.layers();
  ASSERT_EQ(x.layers.size(), y.layers.size());
  for (std::size_t i = 0; i < x.layers.size(); ++i) EXPECT_EQ(x.layers[i].data, y.layers[i].data) << x.layers[i].name;
  EXPECT_EQ(a.state("k").find("sum")->data, b.state("k").find("sum")->data);
  EXPECT_EQ(a.state("k").find("square")->data, b.state("k").find("square")->data);
}

TEST(Render, IsTheSameForEveryNumberOfThreads) {
  const auto scene = stage();
  const auto one = rendered(scene, {.samples = 8, .threads = 1, .has_layers = true});
  EXPECT_GT(one.mean.g, 0.1);
  for (const int threads : {2, 3, 8})
    expect_same_bits(one.film, rendered(scene, {.samples = 8, .threads = threads, .has_layers = true}).film);
  // Another seed is another picture.
  EXPECT_NE(one.picture.rgb, rendered(scene, {.samples = 8, .seed = 1}).picture.rgb);
}

TEST(Render, GoesOnAfterAnInterruptionAsIfThereHadBeenNone) {
  const auto scene = stage();
  const world::World world(scene, plan::plan_of(scene));
  const test::TemporaryFolder folder;
  const Options options{.samples = 21, .threads = 2, .has_layers = true};
  const auto whole = rendered(scene, options);
  for (const int stop_after : {1, 5, 12, 30}) {  // questions: between passes, and within one
    Film film(40, 40, true);
    std::atomic<int> asked = 0;
    render(world, options, film, [&](const Progress&) { return ++asked < stop_after; });
    ASSERT_LT(film.least_samples(), 21u);
    // Through a file, as the command does it.
    image::write_layers(folder / "state.exr", film.state("key"));
    Film again = Film::of_state(image::read_layers(folder / "state.exr"), "key", "state.exr");
    EXPECT_EQ(again.has_layers(), true);
    render(world, options, again, goes_on);
    EXPECT_EQ(again.least_samples(), 21u);
    expect_same_bits(again, whole.film);
  }
  // More samples later are those that would have come.
  Film film(40, 40, true);
  Options fewer = options;
  fewer.samples = 7;
  render(world, fewer, film, goes_on);
  render(world, options, film, goes_on);
  expect_same_bits(film, whole.film);
}

// Sums of very bright and very dim samples keep all of their bits, and the squares do not overflow.
TEST(Film, StateKeepsEveryBit) {
  Film film(1, 1, false);
  for (int i = 0; i < 1000; ++i) {
    const float x = i % 100 == 7 ? 1e25f : std::pow(10.0f, -20 + static_cast<float>(i % 37)) * 1.2345678f;
    film.add(0, {x, 0.1f + static_cast<float>(i) * 1.1e-7f, i == 3 ? 3e38f : 0.0f}, nullptr);
  }
  const test::TemporaryFolder folder;
  image::write_layers(folder / "state.exr", film.state("key"));
  const Film again = Film::of_state(image::read_layers(folder / "state.exr"), "key", "state.exr");
  EXPECT_EQ(again.layers().find("variance")->data, film.layers().find("variance")->data);
  EXPECT_EQ(again.picture().rgb, film.picture().rgb);
  // One more sample each, and still the same bits.
  Film a = film, b = again;
  a.add(0, {0.3f, 0.3f, 0.3f}, nullptr), b.add(0, {0.3f, 0.3f, 0.3f}, nullptr);
  EXPECT_EQ(a.state("k").find("sum")->data, b.state("k").find("sum")->data);
  EXPECT_EQ(a.state("k").find("square")->data, b.state("k").find("square")->data);
}

TEST(Film, StateOfSomethingElseIsRefused) {
  Film film(2, 2, true);
  const auto refused = [&](image::Layers state, const char* key) {
    try {
      Film::of_state(state, key, "f.exr");
    } catch (const files::InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const image::Layers state = film.state("this");
  EXPECT_EQ(refused(state, "this"), "");
  EXPECT_NE(refused(state, "that").find("f.exr: the state of another scene"), std::string::npos);
  auto other = state;
  other.metadata = "{}";
  EXPECT_NE(refused(other, "this").find("not the state of a render"), std::string::npos);
  for (std::size_t i = 0; i + 1 < state.layers.size(); ++i) {
    other = state;
    other.layers.erase(other.layers.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(refused(other, "this").find("missing"), std::string::npos) << i;
  }
  other = state;
  for (auto& layer : other.layers)
    if (layer.name == "count") layer.data[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(refused(other, "this"), "");
  EXPECT_NE(key_of({.seed = 1}, "s"), key_of({.seed = 2}, "s"));
  EXPECT_NE(key_of({.max_bounces = 1}, "s"), key_of({.max_bounces = 2}, "s"));
  EXPECT_NE(key_of({.camera = 0}, "s"), key_of({.camera = 1}, "s"));
  EXPECT_NE(key_of({.has_layers = true}, "s"), key_of({.has_layers = false}, "s"));
  EXPECT_EQ(key_of({.samples = 1, .seconds = 3, .threads = 3}, "s"), key_of({.samples = 9}, "s"));
}

TEST(Film, WhatIsNoRadianceIsBlackAndCounted) {
  Film film(1, 1, true);
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  First good;
  good.depth = 4, good.direct = {1, 2, 3}, good.diffuse = {1, 2, 3};
  film.add(0, {1, 2, 3}, &good);
  for (const glm::vec3& bad : {glm::vec3(nan, 1, 1), glm::vec3(1, infinity, 1), glm::vec3(1, 1, -0.1f)}) {
    First first = good;
    first.direct = bad;
    film.add(0, bad, &first);
  }
  EXPECT_EQ(film.rejected(), 3u);
  EXPECT_EQ(film.samples(0), 4u);
  EXPECT_EQ(film.picture().rgb, (std::vector<float>{0.25f, 0.5f, 0.75f}));
  const image::Layers layers = film.layers();
  // The layers of light are those of the same samples.
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_FLOAT_EQ(layers.find("direct")->data[k], film.picture().rgb[k]);
    EXPECT_FLOAT_EQ(layers.find("diffuse")->data[k], film.picture().rgb[k]);
  }
  EXPECT_FLOAT_EQ(layers.find("depth")->data[0], 4);
}

TEST(Film, VarianceIsThatOfTheMean) {
  Film film(1, 1, false);
  EXPECT_EQ(film.relative_error(), std::numeric_limits<double>::infinity());
  for (const float x : {1.0f, 2.0f, 4.0f, 5.0f}) film.add(0, {x, 3, 0}, nullptr);
  const image::Layers layers = film.layers();
  // Sample variance (4 + 1 + 1 + 4) / 3 over 4.
  EXPECT_FLOAT_EQ(layers.find("variance")->data[0], 10.0f / 12);
  EXPECT_FLOAT_EQ(layers.find("variance")->data[1], 0);
  // Mean 3, 3, 0: of the picture 2. The mean over channels of variance / (mean^2 + 0.01 * 4).
  EXPECT_NEAR(film.relative_error(), 10.0 / 12 / 9.04 / 3, 1e-12);
}

// Against the error that there is, of 24 seeds: never below it, and near to it for samples without a pattern.
TEST(Film, RelativeErrorIsAnUpperEstimateOfTheRealOne) {
  const auto scene = stage(16);
  for (const std::uint32_t samples : {16u, 64u}) {
    constexpr int kSeeds = 24;
    std::vector<image::Picture> pictures;
    double stated = 0;
    for (int s = 0; s < kSeeds; ++s) {
      const auto r = rendered(scene, {.samples = samples, .seed = static_cast<std::uint32_t>(s)});
      pictures.push_back(r.picture), stated += r.film.relative_error() / kSeeds;
    }
    double real = 0, all = 0;
    const std::size_t values = pictures[0].rgb.size();
    for (const auto& p : pictures)
      for (const float x : p.rgb) all += static_cast<double>(x) / (kSeeds * static_cast<double>(values));
    for (std::size_t i = 0; i < values; ++i) {
      double mean = 0, square = 0;
      for (const auto& p : pictures) mean += static_cast<double>(p.rgb[i]) / kSeeds;
      for (const auto& p : pictures) square += std::pow(static_cast<double>(p.rgb[i]) - mean, 2) / (kSeeds - 1);
      real += square / (mean * mean + 0.01 * all * all) / static_cast<double>(values);
    }
    EXPECT_LT(real, 1.05 * stated) << samples;
    EXPECT_GT(real, 0.05 * stated) << samples;
    RecordProperty("stated_over_real_" + std::to_string(samples), std::to_string(stated / real));
  }
}

TEST(Render, StopsAtItsTargets) {
  const auto scene = stage(16);
  const world::World world(scene, plan::plan_of(scene));
  Film film(16, 16, false);
  render(world, {.samples = 100000, .relative_error = 0.05}, film, goes_on);
  EXPECT_LE(film.relative_error(), 0.05);
  EXPECT_LT(film.least_samples(), 2000u);
  Film timed(16, 16, false);
  render(world, {.samples = 1u << 30, .seconds = 0.2}, timed, goes_on);
  EXPECT_GE(timed.least_samples(), 1u);
  Film none(16, 16, false);
  render(world, {.samples = 0}, none, goes_on);
  EXPECT_EQ(none.least_samples(), 0u);
  // The share of the work grows to 1.
  double share = 0;
  Film counted(16, 16, false);
  render(world, {.samples = 20, .threads = 1}, counted, [&](const Progress& p) {
    if (p.share >= 0) {
      EXPECT_GE(p.share, share);
      share = p.share;
    }
    return true;
  });
  EXPECT_EQ(share, 1);
}

}  // namespace
}  // namespace likeness::reference
