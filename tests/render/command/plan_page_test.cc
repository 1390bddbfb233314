#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/plan/draw.h"

// A plan as a table, as JSON, as a page and as a drawing.
namespace likeness::plan {
namespace {

Plan small_plan(const std::string& material = "paint") {
  scene::Scene s;
  s.cameras.emplace_back();
  s.meshes.emplace_back().is_sphere = true;
  brdf::Callisto<double> model;
  model.retroreflection = 4;
  s.materials.emplace_back().name = material;
  s.materials[0].brdf = model;
  s.instances.push_back({"ball", 0, 0, glm::mat4(1)});
  return plan_of(s);
}

Costs some_costs() {
  Costs costs;
  costs[static_cast<std::size_t>(Effect::kDiffuse)] = {
      .with_ms = 400, .without_ms = 300, .low_ms = 90, .high_ms = 120, .difference_ms = 100, .is_measured = true};
  costs[static_cast<std::size_t>(Effect::kRetroreflection)] = {
      .with_ms = 400, .without_ms = 403, .low_ms = -5, .high_ms = 2, .difference_ms = -3, .is_measured = true};
  return costs;
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(PlanText, SaysOfEveryEffectWhetherItIsOnAndWhy) {
  const Plan plan = small_plan();
  const std::string text = text_of(plan, nullptr);
  for (const EffectRow& row : kEffects) {
    const Decision& d = plan.decisions[static_cast<std::size_t>(row.effect)];
    const std::string name(row.name);
    const std::string line =
        (d.is_on ? "  on   " : "  off  ") + name + std::string(21 - name.size(), ' ') + d.because + "\n";
    EXPECT_NE(text.find(line), std::string::npos) << line;
  }
  EXPECT_NE(text.find("on: 2 of " + std::to_string(kEffectCount)), std::string::npos) << text;
  EXPECT_NE(text.find("kernel: first specular lobe, diffuse, retroreflection\n"), std::string::npos) << text;
}

TEST(PlanText, HasTheCostsWhereTheyWereMeasured) {
  const Costs costs = some_costs();
  const std::string text = text_of(small_plan(), &costs);
  EXPECT_NE(text.find("+100 ms [+90, +120]"), std::string::npos) << text;
  EXPECT_NE(text.find("-3 ms [-5, +2]"), std::string::npos) << text;
  EXPECT_EQ(count_of(text, " ms ["), 2u);
}

TEST(PlanJson, CanBeRead) {
  const Costs costs = some_costs();
  const auto json = nlohmann::json::parse(json_of(small_plan(), "room.json", &costs));
  EXPECT_EQ(json.at("scene"), "room.json");
  EXPECT_EQ(json.at("digest"), digest_of(small_plan()));
  ASSERT_EQ(json.at("effects").size(), kEffectCount);
  EXPECT_EQ(json.at("effects")[0].at("name"), "diffuse");
  EXPECT_EQ(json.at("effects")[0].at("on"), true);
  EXPECT_EQ(json.at("effects")[0].at("ms_per_million_samples").at("difference"), 100);
  EXPECT_FALSE(json.at("effects")[1].contains("ms_per_million_samples"));
  EXPECT_EQ(json.at("materials")[0].at("kernel"), (std::vector<std::string>{"diffuse", "retroreflection"}));
}

TEST(PlanJson, TakesANameThatIsNoText) {
  EXPECT_NO_THROW(nlohmann::json::parse(json_of(small_plan("\xff\xfe\"<"), "\xff", nullptr)));
}

TEST(PlanPage, IsWholeAndShowsEveryEffectOnce) {
  const Costs costs = some_costs();
  for (const Costs* measured : {static_cast<const Costs*>(nullptr), &costs}) {
    const std::string page = page_of(small_plan(), "room.json", measured);
    EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
    EXPECT_TRUE(page.ends_with("</html>\n"));
    EXPECT_EQ(count_of(page, "<g><title>"), kEffectCount);
    EXPECT_EQ(count_of(page, "http"), 0u) << "it needs no network";
    EXPECT_EQ(count_of(page, "<rect "), measured == nullptr ? 0u : 2u) << "a bar for each cost";
    for (const Decision& d : small_plan().decisions)
      EXPECT_NE(page.find(d.because.substr(0, d.because.find('"'))), std::string::npos) << d.because;
  }
}

TEST(PlanPage, FillsTheDotsOfWhatIsOn) {
  // One filled and one hollow dot are the legend's.
  const std::string page = page_of(small_plan(), "room.json", nullptr);
  EXPECT_EQ(count_of(page, "fill=\"#0b5394\" stroke"), 2u + 1);
  EXPECT_EQ(count_of(page, "fill=\"#fff\" stroke"), kEffectCount - 2 + 1);
}

TEST(PlanPage, EscapesNames) {
  const std::string page = page_of(small_plan("<script>alert(1)</script>"), "<b>.json", nullptr);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("<b>"), std::string::npos);
}

TEST(PlanPage, CutsALongFactAndKeepsItInTheTooltip) {
  const std::string name(200, 'x');
  const std::string svg = svg_of(small_plan(name), "room.json", nullptr);
  EXPECT_NE(svg.find(std::string(60, 'x') + "…"), std::string::npos);
  EXPECT_NE(svg.find(name), std::string::npos);
}

TEST(PlanDrawing, StandsAlone) {
  const std::string svg = svg_of(small_plan(), "room.json", nullptr);
  EXPECT_TRUE(svg.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\""));
  for (const std::string tag : {"svg", "g", "text", "title"})
    EXPECT_EQ(count_of(svg, "<" + tag + ">") + count_of(svg, "<" + tag + " "), count_of(svg, "</" + tag + ">")) << tag;
}

}  // namespace
}  // namespace likeness::plan
