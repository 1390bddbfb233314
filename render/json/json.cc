#include "render/json/json.h"

#include <algorithm>
#include <unordered_map>
#include <nlohmann/json.hpp>

#include "render/files/files.h"
#include "render/json/cursor.h"

namespace likeness::json {
namespace {

using Parser = nlohmann::json;

// Takes the parser's events; returning true goes on, refuse() throws.
class Builder {
 public:
  Builder(std::string_view text, const std::string& source, const Limits& limits)
      : begin_(text.data()), seen_(begin_), counted_(begin_), source_(source), limits_(limits) {
    const char* end = begin_ + text.size();
    Parser::sax_parse(Cursor{begin_, &seen_}, Cursor{end, &seen_}, this);
  }
  Value take() { return std::move(root_); }

  bool null() { return add(Kind::kNull), true; }
  bool boolean(bool value) { return add(Kind::kFlag).number = value, true; }
  bool number_integer(Parser::number_integer_t value) { return number(static_cast<double>(value)); }
  bool number_unsigned(Parser::number_unsigned_t value) { return number(static_cast<double>(value)); }
  bool number_float(Parser::number_float_t value, const std::string&) { return number(value); }
  bool string(std::string& value) { return add(Kind::kText).text = std::move(value), true; }
  bool binary(Parser::binary_t&) { return false; }  // not in text
  bool start_object(std::size_t) { return open(Kind::kObject); }
  bool start_array(std::size_t) { return open(Kind::kList); }
  bool end_array() { return open_.pop_back(), true; }
  bool key(std::string& value) {
    key_ = std::move(value);
    return true;
  }
  bool end_object() {
    refuse_twins(*open_.back());
    open_.pop_back();
    return true;
  }
  bool parse_error(std::size_t byte, const std::string&, const Parser::exception& error) {
    refuse(line_of_byte(begin_, byte), syntax_text(byte, error.what()));
  }

 private:
  // Of the token last read: the parser may stand one character behind it, never two.
  std::uint32_t line() {
    const char* end = std::max(counted_, seen_ - 1);
    lines_ += static_cast<std::uint32_t>(std::count(counted_, end, '\n'));
    counted_ = end;
    return lines_;
  }

  [[noreturn]] void refuse(std::size_t at, const std::string& text) const {
    throw files::InputError(source_ + ":" + std::to_string(at) + ": " + text);
  }

  bool number(double value) { return add(Kind::kNumber).number = value, true; }

  Value& add(Kind kind) {
    if (++count_ > limits_.values)
      refuse(line(), "has more than " + std::to_string(limits_.values) + " values; that is no file of this kind");
    Value* at = &root_;
    if (!open_.empty()) at = &open_.back()->items.emplace_back();
    at->kind = kind;
    at->line = line();
    if (!open_.empty() && open_.back()->is_object()) at->key = std::move(key_);
    return *at;
  }

  bool open(Kind kind) {
    // Only the innermost open value grows, so the pointers to those around it stay good.
    open_.push_back(&add(kind));
    if (open_.size() > limits_.depth)
      refuse(line(), "is nested deeper than " + std::to_string(limits_.depth) + " brackets");
    return true;
  }

  void refuse_twins(const Value& object) const {
    std::unordered_map<std::string_view, std::uint32_t> lines;
    for (const Value& member : object.items) {
      const auto [first, fresh] = lines.emplace(member.key, member.line);
      if (!fresh)
        refuse(member.line, path() + "/" + plain(member.key) + " is given twice (first in line " +
                                std::to_string(first->second) + ")");
    }
  }

  // Of the innermost open value.
  std::string path() const {
    std::string out;
    for (std::size_t i = 1; i < open_.size(); ++i)
      out += "/" + (open_[i - 1]->is_object() ? plain(open_[i]->key) : std::to_string(open_[i - 1]->items.size() - 1));
    return out;
  }

  const char* begin_;
  const char* seen_;
  const char* counted_;  // lines are counted up to here
  std::uint32_t lines_ = 1;
  const std::string& source_;
  const Limits& limits_;
  std::size_t count_ = 0;
  Value root_;
  std::vector<Value*> open_;
  std::string key_;
};

}  // namespace

const Value* Value::find(std::string_view name) const {
  for (const Value& item : items)
    if (item.key == name) return &item;
  return nullptr;
}

Value parse(std::string_view text, const std::string& source, const Limits& limits) {
  return Builder(text, source, limits).take();
}

std::string kind_text(const Value& value) {
  switch (value.kind) {
    case Kind::kNull:
      return "null";
    case Kind::kFlag:
      return value.number != 0 ? "true" : "false";
    case Kind::kNumber:
      return "the number " + files::number_text(value.number);
    case Kind::kText:
      return "the text " + files::in_quotes(value.text);
    case Kind::kList:
      return "a list";
    case Kind::kObject:
      return "an object";
  }
  return "";
}

std::string plain(std::string_view key) {
  const std::string text = files::in_quotes(key);
  return text.substr(1, text.size() - 2);
}

}  // namespace likeness::json
