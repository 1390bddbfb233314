#include "render/json/fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/files/files.h"

namespace likeness::json {
namespace {

using files::in_quotes;
using files::number_text;

bool is_matrix(const Value& value) {
  if (!value.is_list() || (value.items.size() != 3 && value.items.size() != 4)) return false;
  return std::all_of(value.items.begin(), value.items.end(), [](const Value& row) {
    return row.is_list() && row.items.size() == 4 &&
           std::all_of(row.items.begin(), row.items.end(), [](const Value& n) { return n.is_number(); });
  });
}

bool is_numbers(const Value& value) {
  return value.is_list() &&
         std::all_of(value.items.begin(), value.items.end(), [](const Value& n) { return n.is_number(); });
}
bool is_numbers(const Value& value, std::size_t count) { return is_numbers(value) && value.items.size() == count; }

std::string wanted_text(const Key& key) {
  switch (key.form) {
    case Form::kText:
      return "a text";
    case Form::kFile:
      return "the name of a file";
    case Form::kChoice:
      return "one of its words";
    case Form::kFlag:
      return "true or false";
    case Form::kWhole:
      return "a whole number";
    case Form::kNumber:
      return "a number";
    case Form::kPair:
      return "a list of two numbers";
    case Form::kVector:
      return "a list of three numbers";
    case Form::kScale:
    case Form::kColor:
      return "a number or a list of three";
    case Form::kMatrix:
      return "three or four rows of four numbers: [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z]]";
    case Form::kNumbers:
      return "a list of numbers";
    case Form::kTexts:
      return "a list of texts";
    case Form::kList:
      return "a list of objects";
    case Form::kParameters:
    case Form::kNames:
    case Form::kObject:
    case Form::kMap:
      return "an object";
  }
  return "";
}

bool has_form(const Value& value, Form form) {
  switch (form) {
    case Form::kText:
    case Form::kFile:
    case Form::kChoice:
      return value.is_text();
    case Form::kFlag:
      return value.kind == Kind::kFlag;
    case Form::kWhole:
      return value.is_number() && value.number == std::floor(value.number);
    case Form::kNumber:
      return value.is_number();
    case Form::kPair:
      return is_numbers(value, 2);
    case Form::kVector:
      return is_numbers(value, 3);
    case Form::kScale:
    case Form::kColor:
      return value.is_number() || is_numbers(value, 3);
    case Form::kMatrix:
      return is_matrix(value);
    case Form::kNumbers:
      return is_numbers(value);
    case Form::kTexts:
      return value.is_list() &&
             std::all_of(value.items.begin(), value.items.end(), [](const Value& t) { return t.is_text(); });
    case Form::kList:
      return value.is_list();
    case Form::kParameters:
    case Form::kNames:
    case Form::kObject:
    case Form::kMap:
      return value.is_object();
  }
  return false;
}

bool inside(const Key& key, double x) {
  return x <= key.range.high && (key.above ? x > key.range.low : x >= key.range.low);
}

// " is outside (0, 1e9] m (of the disk)".
std::string outside_text(const Key& key) {
  return std::string(" is outside ") + (key.above ? "(" : "[") + number_text(key.range.low) + ", " +
         number_text(key.range.high) + "]" + (key.unit.empty() ? "" : " " + std::string(key.unit)) + " (" +
         std::string(key.text) + ")";
}

// Where a value is no number within its range: what to say behind the path; empty if all is well.
std::string complaint(const Key& key, const Value& value) {
  if (!has_form(value, key.form)) {
    std::string found = kind_text(value);
    if (value.is_list() && key.form != Form::kMatrix)
      found += " of " + std::to_string(value.items.size()) + (value.items.size() == 1 ? " value" : " values");
    return " is " + found + "; expected " + wanted_text(key) + " (" + std::string(key.text) + ")";
  }
  if (key.form == Form::kChoice && std::find(key.choices.begin(), key.choices.end(), value.text) == key.choices.end())
    return " = " + in_quotes(value.text) + " is not known" +
           near_text(value.text, std::vector<std::string_view>(key.choices.begin(), key.choices.end()));
  if (value.is_number() && !inside(key, value.number)) return " = " + number_text(value.number) + outside_text(key);
  if (value.is_list() && key.form != Form::kList && key.form != Form::kTexts && key.form != Form::kMatrix)
    for (std::size_t i = 0; i < value.items.size(); ++i)
      if (!inside(key, value.items[i].number))
        return "/" + std::to_string(i) + " = " + number_text(value.items[i].number) + outside_text(key);
  if (key.form == Form::kMatrix) {
    for (std::size_t r = 0; r < value.items.size(); ++r)
      for (std::size_t c = 0; c < 4; ++c) {
        const double x = value.items[r].items[c].number;
        const std::string at = "/" + std::to_string(r) + "/" + std::to_string(c) + " = " + number_text(x);
        if (!inside(key, x)) return at + outside_text(key);
        if (r == 3 && x != (c == 3 ? 1 : 0))
          return at + "; the fourth row is 0 0 0 1 (the matrix is written row by row)";
      }
  }
  return "";
}

}  // namespace

void refuse_at(const std::string& source, std::size_t line, const std::string& text) {
  throw files::InputError(source + ":" + std::to_string(line) + ": " + text);
}

std::string near_text(std::string_view wanted, const std::vector<std::string_view>& names) {
  const std::string near =
      wanted.size() > 60 || names.size() > 2000 ? "" : files::nearest_name(wanted, names.data(), names.size());
  if (!near.empty()) return "; did you mean " + in_quotes(near) + "?";
  if (names.empty()) return "; there is none";
  std::string all = "; there " + std::string(names.size() == 1 ? "is " : "are ");
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == 24) return all + ", ...";
    all += (i ? ", " : "") + plain(names[i]);
  }
  return all;
}

Fields::Fields(const std::string& source, const Value& value, const Section& section, std::string path)
    : source_(&source), value_(&value), section_(&section), path_(std::move(path)) {
  if (!value.is_object()) refuse(" is " + kind_text(value) + "; expected an object");
  std::vector<std::string_view> names;
  for (const Key& key : section.keys) names.push_back(key.name);
  for (const Value& member : value.items) {
    if (member.key == kComment) continue;
    const Key* key = section.find(member.key);
    const std::string at = path_ + "/" + plain(member.key);
    if (!key)
      refuse_at(source, member.line,
                at + " is not a key of a " + std::string(section.name) + near_text(member.key, names));
    const std::string wrong = complaint(*key, member);
    if (!wrong.empty()) refuse_at(source, member.line, at + wrong);
  }
  for (const Key& key : section.keys)
    if (key.required && !has(key.name)) refuse("/" + std::string(key.name) + " is missing: " + std::string(key.text));
}

void Fields::only_one_of(std::string_view a, std::string_view b) const {
  if (has(a) && has(b)) refuse(b, " and " + std::string(a) + " are both given; only one of them can hold");
}

void Fields::refuse(std::string_view key, const std::string& text) const {
  const Value* member = value_->find(key);
  refuse_at(*source_, member ? member->line : value_->line, path_ + "/" + std::string(key) + text);
}
void Fields::refuse(const std::string& text) const {
  refuse_at(*source_, value_->line, (path_.empty() && text.starts_with(" ") ? "the file" : path_) + text);
}

std::string Fields::text(std::string_view key) const {
  const Value* member = value_->find(key);
  return member ? member->text : std::string(section_->find(key)->initial);
}

bool Fields::flag(std::string_view key) const {
  const Value* member = value_->find(key);
  return member ? member->number != 0 : section_->find(key)->initial == "true";
}

std::vector<std::string> Fields::texts(std::string_view key) const {
  std::vector<std::string> out;
  if (const Value* member = value_->find(key))
    for (const Value& item : member->items) out.push_back(item.text);
  return out;
}

std::vector<double> Fields::numbers(std::string_view key) const {
  std::vector<double> out;
  if (const Value* member = value_->find(key)) {
    if (member->is_number()) return {member->number};
    for (const Value& item : member->items) out.push_back(item.number);
    return out;
  }
  const std::string_view text = section_->find(key)->initial;
  for (const char *at = text.data(), *end = at + text.size(); at < end; ++at) {
    at = std::from_chars(at, end, out.emplace_back()).ptr;
  }
  if (out.empty()) out.push_back(0);
  return out;
}

double Fields::number(std::string_view key) const { return numbers(key)[0]; }
glm::dvec2 Fields::pair(std::string_view key) const {
  const auto all = numbers(key);
  return all.size() == 2 ? glm::dvec2(all[0], all[1]) : glm::dvec2(all[0]);
}
glm::dvec3 Fields::vector(std::string_view key) const {
  const auto all = numbers(key);
  return all.size() == 3 ? glm::dvec3(all[0], all[1], all[2]) : glm::dvec3(all[0]);
}

glm::dmat4 Fields::matrix(std::string_view key) const {
  glm::dmat4 out(1);
  const Value& rows = *value_->find(key);
  for (std::size_t r = 0; r < rows.items.size(); ++r)
    for (std::size_t c = 0; c < 4; ++c) out[static_cast<int>(c)][static_cast<int>(r)] = rows.items[r].items[c].number;
  return out;
}

glm::dmat4 Fields::rigid(std::string_view key) const {
  glm::dmat4 m = matrix(key);
  for (int c = 0; c < 3; ++c) {
    const double length = glm::length(glm::dvec3(m[c]));
    if (!(std::abs(length - 1) < 1e-3))
      refuse(key, ": column " + std::to_string(c) + " has the length " + number_text(length) +
                      "; expected 1, as a camera is turned and moved but not scaled");
  }
  const double turn = glm::determinant(glm::dmat3(m));
  if (!(std::abs(turn - 1) < 1e-2)) refuse(key, " is not a turn (determinant " + number_text(turn) + "; expected 1)");
  // What is a frame already keeps its bits, so that a file which is read and written again stays the same.
  const glm::dmat3 turned(m), rest = glm::transpose(turned) * turned - glm::dmat3(1);
  double most = 0;
  for (int c = 0; c < 3; ++c) most = std::max(most, glm::length(rest[c]));
  if (most < 1e-12) return m;
  const glm::dvec3 z = glm::normalize(glm::dvec3(m[2]));
  const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(m[1]), z));
  m[0] = glm::dvec4(x, 0);
  m[1] = glm::dvec4(glm::cross(z, x), 0);
  m[2] = glm::dvec4(z, 0);
  return m;
}

glm::dvec3 Fields::direction(std::string_view key) const {
  const glm::dvec3 v = vector(key);
  const double length = glm::length(v);
  if (!(length > 1e-12))
    refuse(key, " has no length; expected a direction (" + std::string(section_->find(key)->text) + ")");
  return v / length;
}

std::vector<Fields> Fields::list(std::string_view key) const {
  std::vector<Fields> out;
  const Value* member = value_->find(key);
  if (!member) return out;
  const auto sections = section_->find(key)->sections;
  out.reserve(member->items.size());
  for (std::size_t i = 0; i < member->items.size(); ++i) {
    const Value& item = member->items[i];
    if (member->is_object() && item.key == kComment) continue;
    const std::string at =
        path_ + "/" + std::string(key) + "/" + (member->is_object() ? plain(item.key) : std::to_string(i));
    const Section* section = sections[0];
    if (sections.size() > 1) {
      if (!item.is_object()) refuse_at(*source_, item.line, at + " is " + kind_text(item) + "; expected an object");
      const Value* type = item.find("type");
      std::vector<std::string_view> names;
      for (const Section* one : sections) names.push_back(one->name);
      if (!type) refuse_at(*source_, item.line, at + "/type is missing" + near_text("", names));
      const auto found = std::find(names.begin(), names.end(), type->text);
      if (found == names.end())
        refuse_at(*source_, type->line, at + "/type is " + kind_text(*type) + near_text(type->text, names));
      section = sections[static_cast<std::size_t>(found - names.begin())];
    }
    out.emplace_back(*source_, item, *section, at);
  }
  return out;
}

std::optional<Fields> Fields::object(std::string_view key) const {
  const Value* member = value_->find(key);
  if (!member) return std::nullopt;
  return Fields(*source_, *member, *section_->find(key)->sections[0], path_ + "/" + std::string(key));
}

}  // namespace likeness::json
