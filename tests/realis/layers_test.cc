#include "realis/layers.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "realis/bake.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "tests/render/temporary_folder.h"

namespace likeness::realis {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::string_view kFolder = "realis/bake";

// Three pixels, of which the mask leaves the middle out, under the first and the last of three lights.
capture::Capture some_capture(const std::filesystem::path& root) {
  capture::Capture out;
  out.root = root, out.name = "three pixels";
  capture::Camera camera;
  camera.id = "c0", camera.width = 3, camera.height = 1, camera.intrinsics = {3, 0, 0, 0, 3, 0, 1.5, 0.5, 1};
  out.cameras = {camera};
  for (const char* id : {"l0", "l1", "l2"}) {
    capture::Light light;
    light.id = id, light.place = capture::DistantLight{{0, 0, 1}};
    out.lights.push_back(light);
  }
  out.variants = {{"render", "renders/{variant}/{camera}/{light}.exr"}};
  return out;
}

Subject some_subject() {
  Subject s;
  s.width = 3, s.height = 1;
  s.pixels = {0, 2}, s.lights = {0, 2};
  s.to_lights = {{0, 0, 1}, {0.6, 0, 0.8}}, s.irradiance = {4, 0.5};
  // The texels one after the other, in each the lights.
  s.photo = {{0.5f, 0.25f, 1}, {1, 1, 1}, {2, 2, 2}, {kNan, 0.5f, 0.5f}};
  s.render = {{0.25f, 0.5f, 1}, {0.5f, 0.5f, 0.5f}, {0.5f, 1.25f, 1.5f}, {0.5f, 0.5f, 0.5f}};
  s.cosine = {-0.25f, 0.25f, 0.75f, 1};
  s.weight = {1, 0.5f, 0.25f, 0};
  return s;
}

// Two lobes of three channels: texel by texel, channel by channel, the lobes.
baked::Bake some_bake() {
  baked::Bake out;
  out.basis.lobes = {{{0, 0, 1}, 2}, {{0.8, 0, 0.6}, 5}};
  out.basis.spread = {1, 1};
  out.channels = Channels::kRgb, out.floor = 0.5, out.kept = 2;
  out.coefficients = {0.1f, -0.2f, 0.3f, -0.4f, 0.5f, -0.6f, 1, 2, 3, 4, 5, 6};
  return out;
}

std::vector<float> layer(const capture::Capture& capture, std::string_view id, std::size_t light) {
  const std::size_t at = capture::variant_of(capture, id);
  if (at == capture::kAbsent) return {};
  return capture::read_render(capture, capture.variants[at], 0, light).rgb;
}

TEST(Layers, OfErrorsAreThePhotoWithoutTheRenderAndThatOfTheLightReceived) {
  const likeness::test::TemporaryFolder folder;
  capture::Capture capture = some_capture(folder.path());
  write_layers(capture, some_subject(), some_bake(), {}, kFolder);
  const capture::Capture found = capture::read_capture(folder.path());
  EXPECT_EQ(layer(found, "raw_error", 0), (std::vector<float>{0.25f, -0.25f, 0, 0, 0, 0, 1.5f, 0.75f, 0.5f}));
  // 4 x 0.5, the floor, for the first texel; 4 x 0.75 for the last.
  EXPECT_EQ(layer(found, "demodulated", 0), (std::vector<float>{0.125f, -0.125f, 0, 0, 0, 0, 0.5f, 0.25f, 0.5f / 3}));
  // Under the other light 0.5 x 0.5. What is no number says so, and its neighbours are what they are.
  for (const auto& [id, grey] : {std::pair("raw_error", 0.5f), std::pair("demodulated", 2.0f)}) {
    const std::vector<float> last = layer(found, id, 2);
    ASSERT_EQ(last.size(), 9);
    for (const std::size_t c : {0U, 1U, 2U}) EXPECT_EQ(last[c], grey) << id;
    EXPECT_TRUE(std::isnan(last[6])) << id;
    EXPECT_EQ(last[7], 0) << id;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "realis/bake/layers/raw_error/c0/l1.exr")) << "no photograph";
}

TEST(Layers, OfCoefficientsSumUpToTheResidual) {
  const likeness::test::TemporaryFolder folder;
  capture::Capture capture = some_capture(folder.path());
  const Subject s = some_subject();
  const baked::Bake bake = some_bake();
  write_layers(capture, s, bake, {}, kFolder);
  const capture::Capture found = capture::read_capture(folder.path());
  const std::vector<float> first = layer(found, "coefficient_000", 0), second = layer(found, "coefficient_001", 0);
  EXPECT_EQ(first, (std::vector<float>{0.1f, 0.3f, 0.5f, 0, 0, 0, 1, 3, 5}));
  EXPECT_EQ(layer(found, "coefficient_001", 1), second) << "the same under every light";
  ASSERT_EQ(second.size(), 9);
  for (std::size_t i = 0; i < s.lights.size(); ++i) {
    const std::vector<double> lobes = values(bake.basis, std::span(&s.to_lights[i], 1));
    for (std::size_t texel = 0; texel < s.texels(); ++texel) {
      const auto cosine = static_cast<double>(s.cosine[s.samples_of(texel) + i]);
      const auto residual = Residual(bake, s.to_lights[i]).at(texel, cosine);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = 3 * std::size_t{s.pixels[texel]} + c;
        const double sum = static_cast<double>(first[at]) * lobes[0] + static_cast<double>(second[at]) * lobes[1];
        EXPECT_NEAR(sum * std::max(cosine, 0.5), residual[c], 1e-12);
      }
    }
  }
}

TEST(Layers, OfLuminanceAreGrey) {
  const likeness::test::TemporaryFolder folder;
  capture::Capture capture = some_capture(folder.path());
  baked::Bake bake = some_bake();
  bake.channels = Channels::kLuminance, bake.coefficients = {1, -2, 3, -4};
  write_layers(capture, some_subject(), bake, {}, kFolder);
  EXPECT_EQ(layer(capture, "coefficient_001", 0), (std::vector<float>{-2, -2, -2, 0, 0, 0, -4, -4, -4}));
}

TEST(Layers, OfWeightsAreEachWeightAndTheirProduct) {
  const likeness::test::TemporaryFolder folder;
  capture::Capture capture = some_capture(folder.path());
  const std::vector<weight::Layer> weights{{"shadow", {1, 0.5f, 0.5f, 1}}};
  write_layers(capture, some_subject(), some_bake(), weights, kFolder);
  const capture::Capture found = capture::read_capture(folder.path());
  EXPECT_EQ(layer(found, "weight_shadow", 2), (std::vector<float>{0.5f, 0.5f, 0.5f, 0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(layer(found, "weight_all", 0), (std::vector<float>{1, 1, 1, 0, 0, 0, 0.25f, 0.25f, 0.25f}));
}

// A bake of fewer lobes, or without a weight, after one with: what is left over would be taken for its own.
TEST(Layers, TakeTheOnesOfAnEarlierBakeOutAndLeaveOtherVariantsFirst) {
  const likeness::test::TemporaryFolder folder;
  capture::Capture capture = some_capture(folder.path());
  for (const char* id : {"weight_specular", "coefficient_077", "weighted"})
    capture.variants.push_back({id, "renders/{variant}/{camera}/{light}.exr"});
  write_layers(capture, some_subject(), some_bake(), {}, kFolder);
  std::vector<std::string> ids;
  for (const capture::Variant& one : capture::read_capture(folder.path()).variants) ids.push_back(one.id);
  EXPECT_EQ(ids, (std::vector<std::string>{"render", "weighted", "raw_error", "demodulated", "weight_all",
                                           "coefficient_000", "coefficient_001"}));
}

TEST(Layers, AreNoMoreThanACaptureHasRoomFor) {
  const likeness::test::TemporaryFolder folder;
  capture::Capture capture = some_capture(folder.path());
  baked::Bake bake = some_bake();
  bake.basis.lobes.assign(baked::kMostLobes, {{0, 0, 1}, 2});
  bake.coefficients.assign(2 * 3 * bake.basis.size(), 0.5f);
  write_layers(capture, some_subject(), bake, {}, kFolder);
  EXPECT_EQ(capture::read_capture(folder.path()).variants.size(), capture::kMostVariants);
}

}  // namespace
}  // namespace likeness::realis
