#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>

#include "tests/brdf/model_table.h"

// The tables of every evaluator, and the pages of docs/models that are made from them.
namespace likeness::brdf {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::string>& pages() {
  static const auto all = [] {
    std::map<std::string, std::string> read;
    for (const auto& entry : fs::directory_iterator(LIKENESS_SOURCE_DIR "/docs/models")) {
      if (entry.path().extension() != ".md") continue;
      std::ifstream in(entry.path());
      read[entry.path().filename().string()] = {std::istreambuf_iterator<char>(in), {}};
    }
    return read;
  }();
  return all;
}

constexpr const char* kRewrite = "rewrite it with: cmake --build BUILD --target docs_tables";

TEST(Evaluators, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (const catalog::Entry& entry : catalog::entries()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name << " stands twice";
    EXPECT_EQ(entry.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789"), entry.name.npos) << entry.name;
    EXPECT_FALSE(entry.text.empty()) << entry.name;
  }
}

TEST(Evaluators, SayOfEveryInputAndOutputWhatItIs) {
  for (const catalog::Entry& entry : catalog::entries()) {
    for (const catalog::Form& form : entry.forms) {
      std::set<std::string_view> names;
      for (const Parameter& row : form.inputs) {
        const std::string where = std::string(entry.name) + " " + std::string(row.name);
        EXPECT_TRUE(names.insert(row.name).second) << where << " stands twice";
        EXPECT_LT(row.range.low, row.range.high) << where;
        EXPECT_LE(row.typical.low, row.typical.high) << where;
        EXPECT_GE(row.typical.low, row.range.low) << where;
        EXPECT_LE(row.typical.high, row.range.high) << where;
        EXPECT_GE(row.initial, row.range.low) << where;
        EXPECT_LE(row.initial, row.range.high) << where;
        EXPECT_FALSE(row.text.empty()) << where;
        EXPECT_FALSE(row.unit.empty()) << where;
        EXPECT_TRUE(row.channels == 1 || row.channels == 3) << where;
        EXPECT_TRUE(!row.logarithmic || row.range.low >= 0) << where << " has a logarithm below 0";
        EXPECT_EQ(row.name.find_first_not_of("abcdefghijklmnopqrstuvwxyzAP_0123456789"), row.name.npos) << where;
      }
    }
    std::set<std::string_view> names;
    EXPECT_FALSE(entry.outputs.empty()) << entry.name;
    for (const Output& row : entry.outputs) {
      EXPECT_TRUE(names.insert(row.name).second) << entry.name << " returns " << row.name << " twice";
      EXPECT_FALSE(row.text.empty()) << entry.name << " " << row.name;
      EXPECT_FALSE(row.unit.empty()) << entry.name << " " << row.name;
    }
  }
}

TEST(ModelPages, EveryEvaluatorHasItsTableOnOnePage) {
  std::map<std::string, std::string> page_of;
  for (const auto& [file, page] : pages())
    for (const std::string& name : tables_in(page)) {
      if (name == kIndex) continue;
      EXPECT_NE(catalog::find(name), nullptr) << file << " has a table of " << name << ", which is no model";
      EXPECT_TRUE(page_of.emplace(name, file).second)
          << file << " and " << page_of[name] << " have a table of " << name;
    }
  for (const catalog::Entry& entry : catalog::entries())
    EXPECT_TRUE(page_of.contains(std::string(entry.name)))
        << "no page of docs/models has \"<!-- table: " << entry.name << " -->\" followed by \"<!-- end -->\"";
}

TEST(ModelPages, TablesAreThoseOfTheEvaluators) {
  for (const auto& [file, page] : pages())
    for (const std::string& name : tables_in(page)) {
      const catalog::Entry* entry = catalog::find(name);
      if (entry == nullptr) continue;
      const Span span = table_span(page, name);
      ASSERT_GT(span.first, 0u) << file << ": no \"<!-- end -->\" after the table of " << name;
      EXPECT_EQ(page.substr(span.first, span.count), markdown_table(*entry))
          << file << ", " << name << ": " << kRewrite;
    }
}

TEST(ModelPages, TheIndexNamesEveryModelWithItsPage) {
  std::map<std::string, std::string> page_of;
  for (const auto& [file, page] : pages())
    for (const std::string& name : tables_in(page)) page_of[name] = file;
  const auto index = pages().find("README.md");
  ASSERT_NE(index, pages().end());
  const Span span = table_span(index->second, kIndex);
  ASSERT_GT(span.first, 0u);
  EXPECT_EQ(index->second.substr(span.first, span.count), model_index(page_of)) << kRewrite;
}

// CMake compiles and runs what it finds by the same rule (tests/brdf/CMakeLists.txt).
TEST(ModelPages, EachHasAnExampleThatIsTested) {
  const std::regex example("```cpp\n[^`]*```\nprints\n```text\n[^`]*\n```");
  for (const auto& [file, page] : pages())
    EXPECT_TRUE(file == "README.md" || std::regex_search(page, example))
        << file << ": no example; it needs a cpp block, the line \"prints\" and a text block";
}

}  // namespace
}  // namespace likeness::brdf
