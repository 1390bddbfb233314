#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/plan/effects.h"
#include "tests/render/command/process.h"

namespace likeness::render_command {
namespace {

using test::Ran;
using test::Workshop;
using Json = nlohmann::json;

TEST(PlanCommand, PrintsEveryEffectAndTheMaterials) {
  const Workshop shop;
  shop.write_ball();
  const Ran ran = shop.run({"plan", "ball.json"});
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  for (const plan::EffectRow& row : plan::kEffects)
    EXPECT_NE(ran.out.find("  " + std::string(row.name) + " "), std::string::npos) << row.name;
  EXPECT_NE(ran.out.find("light \"lamp\": sphere"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("plastic"), std::string::npos);
  EXPECT_EQ(shop.files(), (std::vector<std::string>{"ball.json"}));
}

TEST(PlanCommand, ReadsTheHeadOfTheManual) {
  const std::filesystem::path scene = std::filesystem::path(LIKENESS_SOURCE_DIR) / "docs/scenes/head.json";
  if (!std::filesystem::exists(scene.parent_path() / "../../../shared/data/heads"))
    GTEST_SKIP() << "no shared/data/heads beside the checkout";
  const Workshop shop;
  const Ran ran = shop.run({"plan", scene.string(), "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  for (const Json& effect : Json::parse(ran.out).at("effects"))
    for (const char* name : {"textures", "normal_maps", "area_lights", "environment_picture", "second_lobe"})
      if (effect.at("name") == name) {
        EXPECT_EQ(effect.at("on"), true) << name;
      }
}

TEST(PlanCommand, DrawsAPageAndADrawing) {
  const Workshop shop;
  shop.write_ball();
  ASSERT_EQ(shop.run({"plan", "ball.json", "--out", "out/plan.html"}).exit_code, 0);
  ASSERT_EQ(shop.run({"plan", "ball.json", "--out", "plan.svg", "--force", "all"}).exit_code, 0);
  EXPECT_NE(shop.content("out/plan.html").find("What ball.json calls for"), std::string::npos);
  EXPECT_TRUE(shop.content("plan.svg").starts_with("<?xml"));
}

TEST(PlanCommand, MeasuresWhatIsOn) {
  const Workshop shop;
  shop.write_ball();
  const Ran ran = shop.run({"plan", "ball.json", "--time", "--repeats", "3", "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  int measured = 0;
  const Json plan = Json::parse(ran.out);
  for (const Json& effect : plan.at("effects")) {
    EXPECT_EQ(effect.contains("ms_per_million_samples"), effect.at("on").get<bool>()) << effect.at("name");
    if (!effect.contains("ms_per_million_samples")) continue;
    ++measured;
    const Json& ms = effect.at("ms_per_million_samples");
    EXPECT_GT(ms.at("with").get<double>(), 1);
    EXPECT_GT(ms.at("without").get<double>(), 1);
    EXPECT_LE(ms.at("quartiles")[0].get<double>(), ms.at("difference").get<double>());
    EXPECT_LE(ms.at("difference").get<double>(), ms.at("quartiles")[1].get<double>());
    // A shadow ray for each of most samples is no noise: tens of milliseconds for a million.
    if (effect.at("name") == "area_lights") {
      EXPECT_GT(ms.at("difference").get<double>(), 5);
    }
  }
  EXPECT_EQ(measured, 3);
}

TEST(PlanCommand, LooksThroughTheCameraThatIsNamed) {
  const Workshop shop;
  shop.write_ball("ball.json", "\"name\": \"side\",", "\"name\": \"side\", \"aperture_radius\": 0.1,");
  const auto lens = [&](const char* camera) {
    return Json::parse(shop.run({"plan", "ball.json", "--json", "--camera", camera}).out)
        .at("effects")
        .back()
        .at("on")
        .get<bool>();
  };
  EXPECT_FALSE(lens("front"));
  EXPECT_TRUE(lens("side"));
}

}  // namespace
}  // namespace likeness::render_command
