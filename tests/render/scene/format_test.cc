#include <gtest/gtest.h>

#include <set>

#include "render/files/files.h"
#include "render/json/json.h"
#include "render/scene/format.h"
#include "tests/render/scene/pages.h"
#include "tests/render/scene/refusal.h"

// The table of keys, and the schema and the page that are made from it.
namespace likeness::scene::test {
namespace {

const std::string kDocs = LIKENESS_SOURCE_DIR "/docs/";
constexpr const char* kRewrite = "rewrite it with: cmake --build BUILD --target scene_pages";

// A validator of what the schema uses of JSON Schema, so that the reader's table and the schema are held to one another.
bool is_valid(const json::Value& value, const json::Value& schema, const json::Value& root) {
  using json::Kind;
  if (schema.kind == Kind::kFlag) return schema.number != 0;
  if (const json::Value* ref = schema.find("$ref")) {
    const std::string name = ref->text.substr(std::string("#/$defs/").size());
    return is_valid(value, *root.find("$defs")->find(name), root);
  }
  if (const json::Value* fixed = schema.find("const")) return value.is_text() && value.text == fixed->text;
  if (const json::Value* words = schema.find("enum")) {
    for (const json::Value& word : words->items)
      if (value.is_text() && word.text == value.text) return true;
    return false;
  }
  if (const json::Value* any = schema.find("oneOf")) {
    int count = 0;
    for (const json::Value& one : any->items) count += is_valid(value, one, root);
    return count == 1;
  }
  const std::string type = schema.find("type")->text;
  if (type == "string") return value.is_text();
  if (type == "boolean") return value.kind == Kind::kFlag;
  if (type == "number" || type == "integer") {
    if (!value.is_number() || (type == "integer" && value.number != std::floor(value.number))) return false;
    const json::Value *low = schema.find("minimum"), *above = schema.find("exclusiveMinimum"),
                      *high = schema.find("maximum");
    return !(low && value.number < low->number) && !(above && value.number <= above->number) &&
           !(high && value.number > high->number);
  }
  if (type == "array") {
    if (!value.is_list()) return false;
    const json::Value *least = schema.find("minItems"), *most = schema.find("maxItems");
    if ((least && double(value.items.size()) < least->number) || (most && double(value.items.size()) > most->number))
      return false;
    for (const json::Value& item : value.items)
      if (!is_valid(item, *schema.find("items"), root)) return false;
    return true;
  }
  if (!value.is_object()) return false;
  if (const json::Value* required = schema.find("required"))
    for (const json::Value& key : required->items)
      if (!value.find(key.text)) return false;
  for (const json::Value& member : value.items) {
    const json::Value* known = schema.find("properties") ? schema.find("properties")->find(member.key) : nullptr;
    if (!is_valid(member, known ? *known : *schema.find("additionalProperties"), root)) return false;
  }
  return true;
}

TEST(SceneFormat, EveryKeySaysWhatItIs) {
  std::set<std::string> sections;
  for (const std::string& name : section_names()) EXPECT_TRUE(sections.insert(name).second) << name;
  EXPECT_EQ(sections.size(), 15u);
  const auto check = [](const auto& self, const Section& section) -> void {
    EXPECT_FALSE(section.text.empty()) << section.name;
    std::set<std::string_view> keys;
    for (const Key& key : section.keys) {
      EXPECT_TRUE(keys.insert(key.name).second) << section.name << " " << key.name << " stands twice";
      EXPECT_FALSE(key.text.empty()) << section.name << " " << key.name;
      EXPECT_LE(key.range.low, key.range.high) << key.name;
      EXPECT_EQ(key.form == Form::kChoice, !key.choices.empty()) << key.name;
      EXPECT_FALSE(key.required && !key.initial.empty()) << key.name;
      for (const Section* inner : key.sections) self(self, *inner);
    }
  };
  check(check, kSceneSection);
}

TEST(SceneFormat, TheSchemaIsThatOfTheTable) {
  EXPECT_TRUE(likeness::files::read_whole(kDocs + "schema/scene.schema.json", 1 << 20) == schema_text()) << kRewrite;
}

TEST(SceneFormat, ThePageHasEveryTable) {
  const std::string page = likeness::files::read_whole(kDocs + "scene.md", 1 << 20);
  std::string written = page;
  for (const std::string& section : section_names())
    EXPECT_TRUE(put_table(written, section, table_text(section))) << section << " has no place in docs/scene.md";
  EXPECT_TRUE(page == written) << kRewrite;
}

TEST(SceneFormat, EveryExampleOfThePageIsAccepted) {
  const std::string page = likeness::files::read_whole(kDocs + "scene.md", 1 << 20);
  const json::Value schema = json::parse(schema_text(), "schema");
  int count = 0;
  for (std::size_t at = page.find("```json\n"); at != std::string::npos; at = page.find("```json\n", at + 1), ++count) {
    const std::string text = page.substr(at + 8, page.find("\n```", at) - at - 8);
    EXPECT_EQ(refusal_of_text(text), "") << text;
    EXPECT_TRUE(is_valid(json::parse(text, "example"), schema, schema)) << text;
  }
  EXPECT_GE(count, 2);
}

TEST(SceneFormat, TheSchemaTakesWhatTheReaderTakes) {
  const json::Value schema = json::parse(schema_text(), "schema");
  const auto is_valid_text = [&](const std::string& text) { return is_valid(json::parse(text, "t"), schema, schema); };
  EXPECT_TRUE(is_valid_text(small_scene()));
  for (const std::string members :
       {"\"lihgts\": []", "\"lights\": [{\"type\": \"sphere\", \"radius\": -1}]",
        "\"cameras\": [{\"position\": [1, 2]}]", "\"cameras\": [{\"width\": 1.5}]", "\"lights\": [{}]",
        "\"lights\": [{\"type\": \"point\", \"unit\": \"lx\"}]", "\"cameras\": [{\"focus_distance\": 0}]",
        "\"environment\": {\"radiance\": [1, -1, 1]}", "\"instances\": [{}]", "\"view\": {\"name\": 1}",
        "\"materials\": {\"a\": {\"parameters\": {\"roughness\": {}}}}"}) {
    EXPECT_FALSE(is_valid_text(scene_with(members))) << members;
    if (members.find("materials") == std::string::npos) {
      EXPECT_NE(refusal(members), "") << members;
    }
  }
}

}  // namespace
}  // namespace likeness::scene::test
