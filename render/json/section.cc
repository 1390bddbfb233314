#include "render/json/section.h"

#include "render/files/files.h"

namespace likeness::json {
namespace {

using files::number_text;

std::string range_text(const Key& key) {
  if (key.range.low == -1e9 && key.range.high == 1e9) return "";
  if (key.range.low == key.range.high) return ", " + number_text(key.range.low);
  return std::string(", ") + (key.above ? "above " : "") + number_text(key.range.low) + " to " +
         number_text(key.range.high);
}

std::string value_text(const Key& key) {
  const std::string range = range_text(key);
  switch (key.form) {
    case Form::kText:
      return "text";
    case Form::kFile:
      return "file";
    case Form::kChoice: {
      std::string words;
      for (const std::string_view word : key.choices) words += (words.empty() ? "`" : ", `") + std::string(word) + "`";
      return words;
    }
    case Form::kFlag:
      return "`true`, `false`";
    case Form::kWhole:
      return "whole number" + range;
    case Form::kNumber:
      return "number" + range;
    case Form::kPair:
      return "[x, y]" + range;
    case Form::kVector:
      return "[x, y, z]" + range;
    case Form::kScale:
      return "number or [x, y, z]" + range;
    case Form::kColor:
      return "number or [r, g, b]" + range;
    case Form::kMatrix:
      return "3 or 4 rows of 4 numbers";
    case Form::kNumbers:
      return "list of numbers" + range;
    case Form::kTexts:
      return "list of texts";
    case Form::kParameters:
      return "object";
    case Form::kNames:
      return "object of texts";
    case Form::kObject:
      return key.sections[0]->name == key.name ? "object" : std::string(key.sections[0]->name);
    case Form::kList:
      return "list of " + std::string(key.sections.size() > 1 ? "lights" : key.name);
    case Form::kMap:
      return "object of " + std::string(key.name);
  }
  return "";
}

}  // namespace

std::string in_json(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string default_text(const Key& key) {
  const std::string text(key.initial);
  if (text.empty()) return "";
  if (key.form == Form::kText || key.form == Form::kChoice) return in_json(text);
  if (text.find(' ') == std::string::npos) return text;
  std::string list;
  for (const char c : text) list += c == ' ' ? std::string(", ") : std::string(1, c);
  return "[" + list + "]";
}

std::string table_text(const Section& section) {
  std::string out = "| key | value | default | unit | what it does |\n| --- | --- | --- | --- | --- |\n";
  for (const Key& key : section.keys) {
    const std::string initial = default_text(key);
    out += "| `" + std::string(key.name) + "` | " + value_text(key) + " | " +
           (key.required      ? "needed"
            : initial.empty() ? ""
                              : "`" + initial + "`") +
           " | " + std::string(key.unit) + " | " + std::string(key.text) + " |\n";
  }
  return out;
}

}  // namespace likeness::json
