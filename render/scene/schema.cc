#include <algorithm>
#include <vector>

#include "render/files/files.h"
#include "render/scene/format.h"

namespace likeness::scene {
namespace {

using files::number_text;
using json::default_text;
using json::in_json;

std::string number_schema(const Key& key) {
  return std::string("\"type\": \"") + (key.form == Form::kWhole ? "integer" : "number") + "\", \"" +
         (key.above ? "exclusiveMinimum" : "minimum") + "\": " + number_text(key.range.low) +
         ", \"maximum\": " + number_text(key.range.high);
}

std::string list_schema(const std::string& item, std::size_t least, std::size_t most) {
  return "\"type\": \"array\", \"items\": {" + item + "}, \"minItems\": " + std::to_string(least) +
         ", \"maxItems\": " + std::to_string(most);
}

std::string reference(const Section& section) { return "\"$ref\": \"#/$defs/" + std::string(section.name) + "\""; }

// Of an object of one of the sections.
std::string any_of(std::span<const Section* const> sections) {
  if (sections.size() == 1) return reference(*sections[0]);
  std::string out;
  for (const Section* section : sections) out += (out.empty() ? "{" : ", {") + reference(*section) + "}";
  return "\"oneOf\": [" + out + "]";
}

std::string map_schema(const std::string& item) {
  return "\"type\": \"object\", \"properties\": {\"comment\": true}, \"additionalProperties\": {" + item + "}";
}

std::string value_schema(const Key& key, std::string_view section) {
  if (section == "scene" && key.name == "format") return "\"const\": " + in_json(kFormatName);
  if (key.name == "type") return "\"const\": " + in_json(section);
  const std::string number = number_schema(key);
  switch (key.form) {
    case Form::kText:
    case Form::kFile:
      return "\"type\": \"string\"";
    case Form::kChoice: {
      std::string words;
      for (const std::string_view word : key.choices) words += (words.empty() ? "" : ", ") + in_json(word);
      return "\"enum\": [" + words + "]";
    }
    case Form::kFlag:
      return "\"type\": \"boolean\"";
    case Form::kWhole:
    case Form::kNumber:
      return number;
    case Form::kPair:
      return list_schema(number, 2, 2);
    case Form::kVector:
      return list_schema(number, 3, 3);
    case Form::kScale:
    case Form::kColor:
      return "\"oneOf\": [{" + number + "}, {" + list_schema(number, 3, 3) + "}]";
    case Form::kMatrix:
      return list_schema(list_schema(number, 4, 4), 3, 4);
    case Form::kNumbers:
      return "\"type\": \"array\", \"items\": {" + number + "}";
    case Form::kTexts:
      return "\"type\": \"array\", \"items\": {\"type\": \"string\"}";
    case Form::kParameters:
      return map_schema("\"oneOf\": [{\"type\": \"number\"}, {" + list_schema("\"type\": \"number\"", 3, 3) + "}, {" +
                        reference(*key.sections[0]) + "}]");
    case Form::kNames:
      return map_schema("\"type\": \"string\"");
    case Form::kObject:
      return any_of(key.sections);
    case Form::kList:
      return "\"type\": \"array\", \"items\": {" + any_of(key.sections) + "}";
    case Form::kMap:
      return map_schema(any_of(key.sections));
  }
  return "";
}

std::string section_schema(const Section& section, const std::string& indent) {
  std::string out = indent + "\"description\": " + in_json(section.text) + ",\n" + indent + "\"type\": \"object\",\n" +
                    indent + "\"properties\": {\n" + indent + "  \"comment\": true";
  std::string required;
  for (const Key& key : section.keys) {
    const std::string initial = default_text(key), unit = key.unit.empty() ? "" : " [" + std::string(key.unit) + "]";
    out += ",\n" + indent + "  " + in_json(key.name) + ": {" + value_schema(key, section.name) +
           (initial.empty() ? "" : ", \"default\": " + initial) +
           ", \"description\": " + in_json(std::string(key.text) + unit) + "}";
    if (key.required) required += (required.empty() ? "" : ", ") + in_json(key.name);
  }
  out += "\n" + indent + "},\n";
  if (!required.empty()) out += indent + "\"required\": [" + required + "],\n";
  return out + indent + "\"additionalProperties\": false";
}

// All that hang on the file, each once, in the order in which they are met.
std::vector<const Section*> all_sections() {
  std::vector<const Section*> out;
  const auto add = [&](const auto& self, const Section& section) -> void {
    for (const Key& key : section.keys)
      for (const Section* inner : key.sections) {
        if (std::find(out.begin(), out.end(), inner) != out.end()) continue;
        out.push_back(inner);
        self(self, *inner);
      }
  };
  add(add, kSceneSection);
  return out;
}

}  // namespace

std::string schema_text() {
  std::string out =
      "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": " + in_json(kFormatName) +
      ",\n" + section_schema(kSceneSection, "  ") + ",\n  \"$defs\": {";
  const char* separator = "\n";
  for (const Section* section : all_sections()) {
    out += separator + std::string("    ") + in_json(section->name) + ": {\n" + section_schema(*section, "      ") +
           "\n    }";
    separator = ",\n";
  }
  return out + "\n  }\n}\n";
}

std::string table_text(std::string_view name) {
  std::vector<const Section*> sections = all_sections();
  sections.push_back(&kSceneSection);
  for (const Section* section : sections) {
    if (section->name == name) return json::table_text(*section);
  }
  return "";
}

std::vector<std::string> section_names() {
  std::vector<std::string> out{std::string(kSceneSection.name)};
  for (const Section* section : all_sections()) out.emplace_back(section->name);
  return out;
}

}  // namespace likeness::scene
