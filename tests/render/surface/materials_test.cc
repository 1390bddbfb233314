#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "render/surface/materials.h"

namespace likeness::surface {
namespace {

scene::Scene scene_with(const brdf::AnyBrdf& brdf, const std::vector<float>& texel) {
  scene::Scene scene;
  scene.images = {{"", {1, 1, static_cast<int>(texel.size()), {}, texel}}};
  scene.materials.resize(1);
  scene.materials[0].brdf = brdf;
  return scene;
}

// Each row of each model, given by a texture, lands where the model has it and nowhere else, clamped to its range.
TEST(Textures, GiveTheParameterTheyNameClampedToItsRange) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const auto name : brdf::kModelNames) {
    brdf::AnyBrdf any;
    ASSERT_TRUE(brdf::model_of_name(name, any));
    std::visit(
        [&]<template <class> class M>(const M<double>& model) {
          const auto members = M<float>::members();
          [&]<std::size_t... I>(std::index_sequence<I...>) {
            const auto check = [&](auto index) {
              constexpr std::size_t kRow = decltype(index)::value;
              const brdf::Parameter& row = M<double>::kParameters[kRow];
              const auto low = static_cast<float>(row.range.low), high = static_cast<float>(row.range.high);
              for (const float x : {low + 0.375f * (high - low), low - 1, high + 1, nan, infinity, -infinity}) {
                auto scene = scene_with(model, {x, x, x});
                scene.materials[0].bindings = {{kRow, {.image = 0}}};
                const auto prepared = prepare_materials(scene);
                ModelBytes scratch;
                const auto& at = *static_cast<const M<float>*>(prepared[0].model_at({0.3f, 0.4f}, scratch));
                const auto& plain = *reinterpret_cast<const M<float>*>(&prepared[0].model);
                const float expected = std::isnan(x) ? low : std::min(std::max(x, low), high);
                const auto expect_row = [&](auto member, bool is_it) {
                  if constexpr (requires { (at.*member).r; }) {
                    EXPECT_EQ((at.*member).r, is_it ? expected : (plain.*member).r) << row.name;
                    EXPECT_EQ((at.*member).g, is_it ? expected : (plain.*member).g) << row.name;
                    EXPECT_EQ((at.*member).b, is_it ? expected : (plain.*member).b) << row.name;
                  } else {
                    EXPECT_EQ(at.*member, is_it ? expected : plain.*member) << row.name;
                  }
                };
                (expect_row(std::get<I>(members), I == kRow), ...);
              }
            };
            (check(std::integral_constant<std::size_t, I>{}), ...);
          }(std::make_index_sequence<std::tuple_size_v<std::remove_const_t<decltype(members)>>>{});
        },
        any);
  }
}

TEST(Textures, AreReadOnlyWhereThereAreAny) {
  auto scene = scene_with(brdf::Callisto<double>(), {0.25f, 0.5f, 0.75f});
  auto prepared = prepare_materials(scene);
  ModelBytes scratch;
  EXPECT_EQ(prepared[0].model_at({0, 0}, scratch), &prepared[0].model);
  EXPECT_FALSE(prepared[0].has_textures());
  scene.materials[0].bindings = {{0, {.image = 0}}, {3, {.image = 0, .channel = 2}}};
  prepared = prepare_materials(scene);
  EXPECT_TRUE(prepared[0].has_textures());
  const auto& model = *static_cast<const brdf::Callisto<float>*>(prepared[0].model_at({0, 0}, scratch));
  EXPECT_EQ(model.base_color.r, 0.25f);
  EXPECT_EQ(model.base_color.b, 0.75f);
  EXPECT_EQ(model.roughness, 0.75f);
}

}  // namespace
}  // namespace likeness::surface
