#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>

#include "render/json/json.h"
#include "render/page/pareto_plot.h"
#include "tests/render/cost/toy_study.h"

namespace likeness::scene_cost {
namespace {

using testing::HasSubstr;
using testing::Not;

Study study() {
  Study s = test::toy_study();
  find_dominated(s);
  return s;
}

std::size_t count(const std::string& text, std::string_view part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

TEST(CostPage, NeedsNothingFromElsewhere) {
  const std::string page = page_of(study());
  EXPECT_TRUE(page.starts_with("<!doctype html>") || page.starts_with("<!DOCTYPE html>"));
  for (const char* outside : {"http://", "https://", "<link", "<script", "url(", "@import"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  EXPECT_EQ(count(page, "<img "), count(page, "<img src=\"data:image/png;base64,"));
}

TEST(CostPage, EscapesWhatTheSceneSays) {
  const std::string page = page_of(study());
  EXPECT_THAT(page, HasSubstr("a &quot;room&quot; &amp; &lt;script&gt;"));
  EXPECT_THAT(page, HasSubstr("Processor &lt;&amp;&gt;"));
}

TEST(CostPage, HasAPlotOfEachMetricForTheWholeAndForEachSettingThatMatters) {
  const std::string page = page_of(study());
  EXPECT_EQ(count(page, "<svg "), 6u);
  EXPECT_EQ(count(page, "<h2 id=\"pixel_samples\">"), 1u);
  EXPECT_EQ(count(page, "<h2 id=\"light_samples\">"), 1u);
  EXPECT_EQ(count(page, "<h2 id=\"environment\">"), 0u);
}

TEST(CostPage, MarksWhatIsBeatenAndByWhat) {
  const std::string page = page_of(study());
  EXPECT_EQ(count(page, "<tr class=\"fixed\">"), 1u);
  EXPECT_THAT(page, HasSubstr("beaten by 4 pts, 1 shadow"));
}

TEST(CostPage, SaysThatItWasInterrupted) {
  Study s = study();
  EXPECT_THAT(page_of(s), Not(HasSubstr("interrupted")));
  s.is_complete = false;
  EXPECT_THAT(page_of(s), HasSubstr("interrupted"));
}

TEST(CostPage, StandsWithoutReferenceNoisePathTracerAndDirectLight) {
  Study s = study();
  s.reference.noise.reset(), s.direct_only.reset();
  s.direct_map_png.clear();
  s.rows.pop_back();
  EXPECT_THAT(page_of(s), HasSubstr("</html>"));
}

TEST(CostCsv, HasTheSameFieldsInEveryLine) {
  std::istringstream lines(csv_of(study()));
  std::string line;
  std::size_t rows = 0, fields = 0;
  while (std::getline(lines, line)) {
    std::size_t n = 1;
    bool in_quotes = false;
    for (const char c : line) in_quotes ^= c == '"', n += c == ',' && !in_quotes;
    if (rows++ == 0) fields = n;
    EXPECT_EQ(n, fields) << line;
  }
  EXPECT_EQ(rows, 1u + 5 + 2);
}

TEST(CostJson, HoldsEveryRow) {
  const json::Value root = json::parse(json_of(study()), "json");
  EXPECT_EQ(root.find("scene")->text, study().scene);
  const auto& rows = root.find("rows")->items;
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0].find("settings")->find("pixel_samples")->text, "1") << "the fastest first";
  EXPECT_EQ(rows[0].find("wall_ms")->find("median")->number, 1);
  EXPECT_EQ(rows[2].find("dominated_by")->text, "4 pts, 1 shadow");
  EXPECT_EQ(rows[4].find("kind")->text, "path tracer") << "at the end";
}

TEST(CostTable, HasALineForEachRow) {
  const std::string table = table_of(study());
  EXPECT_EQ(count(table, " pts, "), 4u);
  EXPECT_EQ(count(table, "path tracer, 4 spp"), 1u);
  EXPECT_THAT(table, HasSubstr("off by 5.0 % in the middle"));
}

TEST(ParetoPlot, EscapesNamesAndLeavesOutThoseThatAreNotWanted) {
  page::ParetoPlot plot;
  plot.title = "T <t>", plot.time_text = [](double t) { return std::to_string(t); };
  plot.points = {{"a<b", 1, 1}, {"hidden", 2, 2, page::ParetoMark::kDisc, true, false}};
  plot.levels = {{0.5, "floor & co"}};
  const std::string svg = drawing_of(plot);
  EXPECT_THAT(svg, HasSubstr("a&lt;b"));
  EXPECT_THAT(svg, HasSubstr("floor &amp; co"));
  EXPECT_EQ(count(svg, "hidden"), 1u) << "in what the pointer shows";
}

}  // namespace
}  // namespace likeness::scene_cost
