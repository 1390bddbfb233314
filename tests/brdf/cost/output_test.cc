#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>

#include "brdf/cost/pareto_figure.h"
#include "tests/brdf/cost/toy_study.h"

// The CSV, the table and the page of results that are known.
namespace likeness::cost {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// As RFC 4180 has it.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells{""};
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') cells.back() += line[++i];
    else if (line[i] == '"') quoted = !quoted;
    else if (line[i] == ',' && !quoted) cells.emplace_back();
    else cells.back() += line[i];
  }
  return cells;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(CostCsv, HasOneLineForEachFormAndPrecision) {
  const auto lines = lines_of(csv_of(test::toy_study()));
  ASSERT_EQ(lines.size(), 1u + 5 * 3);
  const auto header = cells_of(lines[0]);
  for (const std::string& line : lines) EXPECT_EQ(cells_of(line).size(), header.size()) << line;
  const auto column = [&](const std::string& name) {
    return std::size_t(std::find(header.begin(), header.end(), name) - header.begin());
  };
  const auto first = cells_of(lines[1]);
  EXPECT_EQ(first[column("form")], "cheap, rough");
  EXPECT_EQ(first[column("precision")], "double");
  EXPECT_EQ(first[column("ns")], "10");
  EXPECT_EQ(first[column("rms_error")], "0.2");
  EXPECT_EQ(first[column("energy_error")], "-0.2");
  EXPECT_EQ(first[column("worst_at")], "x = 1, y = 2");
  EXPECT_EQ(first[column("machine")], "Processor, \"fast\"");
  EXPECT_EQ(cells_of(lines[7])[column("form")], "a \"table\"");
  EXPECT_EQ(cells_of(lines[4])[column("dominated_by")], "cheap, rough");
}

TEST(CostCsv, QuotesWhatHasCommasOrQuotes) {
  const std::string csv = csv_of(test::toy_study());
  EXPECT_THAT(csv, HasSubstr("toys,\"cheap, rough\",a,double,scalar,"));
  EXPECT_THAT(csv, HasSubstr("toys,\"a \"\"table\"\"\",c,double,"));
}

TEST(CostCsv, SaysOneByOneInPlaceOfATime) {
  const auto cells = cells_of(lines_of(csv_of(test::toy_study()))[12]);
  EXPECT_EQ(cells[1], "walk");
  EXPECT_EQ(cells[3], "batch");
  EXPECT_EQ(cells[4], "one by one");
  EXPECT_EQ(cells[5], "");
}

TEST(CostMarkdown, HasARowForEachFormWithTheBatchesFirst) {
  const auto lines = lines_of(markdown_of(test::toy_study()));
  ASSERT_EQ(lines.size(), 2u + 2 + 5);
  EXPECT_EQ(lines.front(), "<!-- table: toys -->");
  EXPECT_EQ(lines.back(), "<!-- end -->");
  for (std::size_t i = 1; i + 1 < lines.size(); ++i)
    EXPECT_EQ(std::count(lines[i].begin(), lines[i].end(), '|'), std::count(lines[1].begin(), lines[1].end(), '|'));
  EXPECT_THAT(lines[3], HasSubstr("| cheap, rough | "));
  EXPECT_THAT(lines[3], HasSubstr("| 10 | 0.2 |")) << "double, and its error";
  EXPECT_THAT(lines[6], HasSubstr("one by one"));
}

TEST(CostTable, KeepsItsColumnsApart) {
  Study study = test::toy_study();
  study.families[0].family.energy_name = "a very long name of an energy";
  const auto lines = lines_of(table_of(study));
  const std::string& header = lines.at(3);
  EXPECT_THAT(header, HasSubstr("worst  a very long name of an energy"));
  for (std::size_t i = 4; i < 9; ++i) EXPECT_EQ(lines[i].size(), header.size()) << lines[i];
  EXPECT_THAT(lines[5], HasSubstr("3*")) << "dominated";
  EXPECT_THAT(lines[7], HasSubstr("one by one"));
}

TEST(CostTable, StatesTheNoiseOfARandomReference) {
  Study study = test::toy_study();
  EXPECT_THAT(table_of(study), Not(HasSubstr("is random")));
  study.families[0].noise = 0.0071;
  EXPECT_THAT(table_of(study), HasSubstr("its own rms error is 0.0071"));
  EXPECT_THAT(page_of(study), HasSubstr("is 0.0071"));
}

TEST(CostPage, EscapesWhatIsNotItsOwn) {
  const std::string page = page_of(test::toy_study());
  EXPECT_THAT(page, HasSubstr("Toys &amp; &lt;tools&gt;"));
  EXPECT_THAT(page, HasSubstr("a &lt;note&gt;"));
  EXPECT_THAT(page, HasSubstr("Processor, &quot;fast&quot;"));
  for (const char* raw : {"<tools>", "<note>", "slow & rough", "a \"table\""}) EXPECT_THAT(page, Not(HasSubstr(raw)));
}

TEST(CostPage, StandsAlone) {
  const std::string page = page_of(test::toy_study());
  for (const char* outside : {"http", "src=", "@import", "url(", "<script", "<link"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(page.ends_with("</html>\n"));
}

TEST(CostPage, NamesEveryFormInTheTableAndInEveryPlot) {
  const Study study = test::toy_study();
  const std::string page = page_of(study);
  EXPECT_EQ(count(page, "<svg"), 3u);
  for (const char* name : {"cheap, rough", "slow &amp; rough", "a &quot;table&quot;", "walk", "exact"}) {
    EXPECT_THAT(page, HasSubstr("<th scope=\"row\">" + std::string(name)));
    for (const Precision p : {Precision::kDouble, Precision::kFloat, Precision::kBatch}) {
      const std::string figure = pareto_figure(study.families[0], p);
      EXPECT_THAT(figure, HasSubstr("<title>" + std::string(name)));
      EXPECT_GE(count(figure, name), 2u) << "a label beside the tip";
    }
  }
}

TEST(CostPage, ShowsWhatIsDominated) {
  const Study study = test::toy_study();
  EXPECT_THAT(page_of(study), HasSubstr("dominated by cheap, rough (batch, float, double)"));
  const std::string batch = pareto_figure(study.families[0], Precision::kBatch);
  EXPECT_EQ(count(batch, "<circle"), 4u);
  EXPECT_EQ(count(batch, "r=\"6.00\" fill=\"#fff\""), 1u) << "slow & rough is hollow";
  EXPECT_THAT(batch, HasSubstr("one by one")) << "the walk has no batches";
  // In double the walk is a disc, hollow: the table is faster and more exact.
  const std::string wide = pareto_figure(study.families[0], Precision::kDouble);
  EXPECT_EQ(count(wide, "<circle"), 5u);
  EXPECT_EQ(count(wide, "r=\"6.00\" fill=\"#fff\""), 2u);
}

TEST(CostPage, EveryMarkAndNameIsWithinTheDrawing) {
  for (const Precision p : {Precision::kDouble, Precision::kFloat, Precision::kBatch}) {
    const std::string figure = pareto_figure(test::toy_family(), p);
    for (const std::string key : {"cx=\"", "cy=\"", "<text x=\""})
      for (std::size_t at = figure.find(key); at != std::string::npos; at = figure.find(key, at + 1)) {
        const double place = std::stod(figure.substr(at + key.size()));
        EXPECT_TRUE(place > 0 && place < (key == "cy=\"" ? 372 : 580)) << figure.substr(at, 20);
      }
  }
}

}  // namespace
}  // namespace likeness::cost
