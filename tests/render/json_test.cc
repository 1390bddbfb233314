#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/files/files.h"
#include "render/json/json.h"

// A tree of values that knows its lines.
namespace likeness::json {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& text, const Limits& limits = {}) {
  try {
    parse(text, "a.json", limits);
  } catch (const files::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Json, EveryValueKnowsItsLine) {
  const Value root = parse("{\"a\": [1,\n 2.5,\n\"three\"],\n\"b\": {\"c\": true, \"d\": null}\n}", "a.json");
  ASSERT_TRUE(root.is_object());
  const Value& a = *root.find("a");
  ASSERT_EQ(a.items.size(), 3u);
  EXPECT_EQ(a.line, 1u);
  EXPECT_EQ(a.items[0].number, 1);
  EXPECT_EQ(a.items[1].number, 2.5);
  EXPECT_EQ(a.items[1].line, 2u);
  EXPECT_EQ(a.items[2].text, "three");
  EXPECT_EQ(a.items[2].line, 3u);
  EXPECT_EQ(root.find("b")->line, 4u);
  EXPECT_EQ(root.find("b")->find("c")->number, 1);
  EXPECT_EQ(root.find("b")->find("d")->kind, Kind::kNull);
  EXPECT_EQ(root.find("z"), nullptr);
}

TEST(Json, AMemberThatIsGivenTwiceIsNamedByItsPath) {
  EXPECT_EQ(refusal("{\"a\": [{}, {\"b\": 1,\n\"b\": 2}]}"), "a.json:2: /a/1/b is given twice (first in line 1)");
}

TEST(Json, WhatIsNotJsonIsSaidInOneLine) {
  EXPECT_THAT(refusal("{\n\"a\": oops}"), testing::StartsWith("a.json:2: not JSON (byte 8): syntax error"));
  for (const std::string text :
       {"", "[1,]", "{\"a\" 1}", "[NaN]", "[1e999]", "\"\xff\"", "[1] 2", "[\"\n\"]", "// no\n1"})
    EXPECT_THAT(refusal(text), HasSubstr("not JSON (byte ")) << text;
}

TEST(Json, DepthAndNumberOfValuesAreBounded) {
  EXPECT_EQ(refusal("[[[[]]]]", {.values = 10, .depth = 4}), "");
  EXPECT_EQ(refusal("[[[[[]]]]]", {.values = 10, .depth = 4}), "a.json:1: is nested deeper than 4 brackets");
  EXPECT_THAT(refusal("[1,2,3,4,5]", {.values = 5, .depth = 4}), HasSubstr("has more than 5 values"));
  EXPECT_THAT(refusal(std::string(1'000'000, '[')), HasSubstr("nested deeper than 64"));
}

}  // namespace
}  // namespace likeness::json
