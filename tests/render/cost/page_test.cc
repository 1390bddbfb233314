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
  EXPECT_EQ(count(table, " pts, "), 2u);
  EXPECT_EQ(count(table, "1 pt, "), 2u);
  EXPECT_EQ(count(table, "path tracer, 4 spp"), 1u);
  EXPECT_THAT(table, HasSubstr("off by 5.0 % in the middle"));
}

TEST(CostPage, NumbersFramesInPlotAndTableAlike) {
  const std::string page = page_of(study());
  EXPECT_EQ(count(page, "<title>no. 2: 4 pts, 1 shadow: "), 2u) << "in both plots";
  EXPECT_EQ(count(page, "<td class=\"n\">2</td>"), 1u) << "in the table";
  EXPECT_THAT(page, Not(HasSubstr("1 pts")));
}

struct Text {
  double x0, x1, y;
};
// The labels of a drawing, by the place and the size of their letters.
std::vector<Text> labels_of(const std::string& svg) {
  std::vector<Text> out;
  for (std::size_t at = svg.find("<text "); at != svg.npos; at = svg.find("<text ", at + 1)) {
    const std::size_t end = svg.find("</text>", at);
    const std::string text = svg.substr(at, end - at);
    if (text.find("paint-order") == text.npos) continue;
    const auto attribute = [&](const std::string& name) {
      const std::size_t from = text.find(" " + name + "=\"") + name.size() + 3;
      return text.substr(from, text.find('"', from) - from);
    };
    const double x = std::stod(attribute("x")), width = 6.2 * double(text.size() - text.find('>') - 1);
    const std::string anchor = attribute("text-anchor");
    const double x0 = anchor == "start" ? x : anchor == "end" ? x - width : x - width / 2;
    out.push_back({x0, x0 + width, std::stod(attribute("y"))});
  }
  return out;
}

TEST(ParetoPlot, LaysNoLabelOverAnotherHoweverManyThereAre) {
  page::ParetoPlot plot;
  plot.title = "crowd", plot.time_text = [](double t) { return std::to_string(t); };
  for (int i = 0; i < 40; ++i) {
    const std::string no = std::to_string(i);
    plot.points.push_back(
        {no, 100.0 + i, 0.1 - 1e-4 * i, page::ParetoMark::kDisc, false, {no + ": 1 shadow, env rays4", no}});
  }
  const std::vector<Text> labels = labels_of(drawing_of(plot));
  EXPECT_GE(labels.size(), 8u) << "there is room for some";
  for (std::size_t i = 0; i < labels.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_FALSE(std::abs(labels[i].y - labels[k].y) < 11 && labels[i].x0 < labels[k].x1 &&
                   labels[k].x0 < labels[i].x1)
          << i << " and " << k;
}

TEST(ParetoPlot, JoinsDiamondsWhereTheyAreOneWay) {
  page::ParetoPlot plot;
  plot.title = "T", plot.time_text = [](double t) { return std::to_string(t); };
  plot.points = {{"a", 1, 1, page::ParetoMark::kDiamond}, {"b", 2, 0.5, page::ParetoMark::kDiamond}};
  EXPECT_EQ(count(drawing_of(plot), "stroke-dasharray=\"5 3\""), 0u);
  plot.joins_diamonds = true;
  EXPECT_EQ(count(drawing_of(plot), "stroke-dasharray=\"5 3\""), 1u);
}

TEST(ParetoPlot, EscapesNamesAndLeavesOutThoseThatAreNotWanted) {
  page::ParetoPlot plot;
  plot.title = "T <t>", plot.time_text = [](double t) { return std::to_string(t); };
  plot.points = {{"a<b", 1, 1, page::ParetoMark::kDisc, false, {"a<b"}},
                 {"hidden", 2, 2, page::ParetoMark::kDisc, true}};
  plot.levels = {{0.5, "floor & co"}};
  const std::string svg = drawing_of(plot);
  EXPECT_THAT(svg, HasSubstr("a&lt;b"));
  EXPECT_THAT(svg, HasSubstr("floor &amp; co"));
  EXPECT_EQ(count(svg, "hidden"), 1u) << "in what the pointer shows";
}

}  // namespace
}  // namespace likeness::scene_cost
