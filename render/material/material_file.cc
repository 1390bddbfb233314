#include "render/material/material_file.h"

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <vector>
#include <nlohmann/json.hpp>

#include "render/files/files.h"
#include "render/json/cursor.h"
#include "render/json/json.h"
#include "render/material/parameters.h"

namespace likeness::material {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kFormat = "likeness material";
constexpr int kVersion = 1;
constexpr std::array<std::string_view, 5> kKeys{"format", "version", "name", "model", "parameters"};

// A parameter as the text gives it. It can be judged only when the model is known, which may come later.
struct Given {
  std::string name;
  std::size_t line;
  std::vector<double> channels;
  bool list = false;
};

// Takes the parser's events in the order of the text, and refuses the first that does not belong there. A tree
// of values would lose duplicate keys and line numbers.
class Reader {
 public:
  Reader(std::string_view text, std::string source) : begin_(text.data()), seen_(begin_), source_(std::move(source)) {
    const char* end = begin_ + text.size();
    Json::sax_parse(json::Cursor{begin_, &seen_}, json::Cursor{end, &seen_}, this);
  }

  Material material() const {
    require(0, "a material file of Likeness begins {\"format\": \"likeness material\", \"version\": 1, ...");
    require(1, "it says how to read the rest; this program reads version 1");
    require(3, "it says which evaluator the parameters belong to");
    Material out;
    out.name = name_;
    if (!brdf::model_of_name(model_, out.brdf)) refuse(model_line_, "/model: " + no_such_model(model_));
    for (const Given& given : given_) {
      const std::string wrong = assign(out.brdf, given.name, given.channels);
      if (!wrong.empty()) refuse(given.line, "/parameters/" + wrong);
      if (given.list && given.channels.size() == 1)
        refuse(given.line, "/parameters/" + given.name + " is a list of one number; write the number alone");
    }
    return out;
  }

  // Events. Returning true goes on; refuse() throws.
  bool null() { return unexpected("null"); }
  bool boolean(bool value) { return unexpected(value ? "true" : "false"); }
  bool number_integer(Json::number_integer_t value) { return number(static_cast<double>(value)); }
  bool number_unsigned(Json::number_unsigned_t value) { return number(static_cast<double>(value)); }
  bool number_float(Json::number_float_t value, const std::string&) { return number(value); }
  bool binary(Json::binary_t&) { return unexpected("binary data"); }

  bool string(std::string& value) {
    if (place_ == Place::kTop && key_ == "format") {
      if (value != kFormat) refuse(line(), "/format = " + in_quotes(value) + "; expected \"likeness material\"");
    } else if (place_ == Place::kTop && key_ == "name") {
      name_ = value;
    } else if (place_ == Place::kTop && key_ == "model") {
      model_ = value;
      model_line_ = line();
    } else {
      return unexpected("the text " + in_quotes(value));
    }
    return true;
  }

  bool start_object(std::size_t) {
    if (place_ == Place::kOutside) {
      place_ = Place::kTop;
    } else if (place_ == Place::kTop && key_ == "parameters") {
      place_ = Place::kParameters;
    } else {
      return unexpected("an object");
    }
    return true;
  }
  bool end_object() {
    place_ = place_ == Place::kParameters ? Place::kTop : Place::kOutside;
    return true;
  }

  bool start_array(std::size_t) {
    if (place_ != Place::kParameters) return unexpected("a list");
    place_ = Place::kChannels;
    given_.back().list = true;
    return true;
  }
  bool end_array() {
    place_ = Place::kParameters;
    return true;
  }

  bool key(std::string& value) {
    if (place_ == Place::kParameters) {
      for (const Given& given : given_)
        if (given.name == value)
          refuse(line(), "/parameters/" + json::plain(value) + " is given twice (first in line " +
                             std::to_string(given.line) + ")");
      if (given_.size() == kMostParameters)
        refuse(line(),
               "/parameters has more than " + std::to_string(kMostParameters) + " entries; no model has as many");
      given_.push_back({value, line(), {}, false});
      return true;
    }
    const auto* found = std::find(kKeys.begin(), kKeys.end(), value);
    if (found == kKeys.end()) {
      const std::string near = files::nearest_name(std::string_view(value).substr(0, 60), kKeys.data(), kKeys.size());
      refuse(line(), "/" + json::plain(value) + " is not a key of a material file" +
                         (near.empty() ? "; keys are format, version, name, model, parameters"
                                       : "; did you mean \"" + near + "\"?"));
    }
    bool& had = had_[static_cast<std::size_t>(found - kKeys.begin())];
    if (had) refuse(line(), "/" + value + " is given twice");
    had = true;
    key_ = value;
    return true;
  }

  bool parse_error(std::size_t byte, const std::string&, const Json::exception& error) {
    refuse(json::line_of_byte(begin_, byte), json::syntax_text(byte, error.what()));
  }

 private:
  enum class Place { kOutside, kTop, kParameters, kChannels };
  static constexpr std::size_t kMostParameters = 256;
  static constexpr std::size_t kMostChannels = 64;

  // Of the token last read: the parser may stand one character behind it, never two.
  std::size_t line() const {
    return 1 + static_cast<std::size_t>(std::count(begin_, std::max(begin_, seen_ - 1), '\n'));
  }

  [[noreturn]] void refuse(std::size_t at, const std::string& text) const {
    throw files::InputError(source_ + ":" + std::to_string(at) + ": " + text);
  }

  void require(std::size_t key, const std::string& why) const {
    if (!had_[key]) refuse(1, "/" + std::string(kKeys[key]) + " is missing: " + why);
  }

  bool unexpected(const std::string& what) const {
    if (place_ == Place::kOutside)
      refuse(line(), "the file is " + what + "; expected an object: {\"format\": \"likeness material\", ...");
    if (place_ == Place::kTop)
      refuse(line(), "/" + key_ + " is " + what + "; expected " +
                         (key_ == "version"      ? "a whole number"
                          : key_ == "parameters" ? "an object"
                                                 : "a text"));
    refuse(line(), "/parameters/" + json::plain(given_.back().name) +
                       (place_ == Place::kChannels ? "/" + std::to_string(given_.back().channels.size()) : "") +
                       " is " + what + "; expected a number" +
                       (place_ == Place::kChannels ? "" : " or a list of three"));
  }

  bool number(double value) {
    if (place_ == Place::kTop && key_ == "version") {
      if (value != kVersion) refuse(line(), "/version = " + number_text(value) + "; this program reads version 1");
      return true;
    }
    if (place_ != Place::kParameters && place_ != Place::kChannels)
      return unexpected("the number " + number_text(value));
    if (given_.back().channels.size() == kMostChannels)
      refuse(line(), "/parameters/" + json::plain(given_.back().name) + " has more than " +
                         std::to_string(kMostChannels) + " numbers");
    given_.back().channels.push_back(value);
    return true;
  }

  const char* begin_;
  const char* seen_;
  std::string source_;
  Place place_ = Place::kOutside;
  std::string key_, name_, model_;
  std::size_t model_line_ = 1;
  std::array<bool, kKeys.size()> had_{};
  std::vector<Given> given_;
};

std::string number_in_json(double value) {
  const std::string text = number_text(value);
  return text == "-0" ? "-0.0" : text;  // the parser would take -0 as the integer 0 and lose its sign
}

}  // namespace

std::string text_of(const Material& material) {
  const std::string wrong = complaint(material.brdf);
  if (!wrong.empty()) throw std::invalid_argument("material " + in_quotes(material.name) + ": " + wrong);
  std::string out = "{\n  \"format\": \"" + std::string(kFormat) + "\",\n  \"version\": " + std::to_string(kVersion) +
                    ",\n  \"name\": " + Json(material.name).dump(-1, ' ', false, Json::error_handler_t::replace) +
                    ",\n  \"model\": \"" + std::string(model_name(material.brdf)) + "\",\n  \"parameters\": {";
  const char* separator = "\n";
  for (const Entry& entry : entries(material.brdf)) {
    out += separator;
    out += "    \"" + std::string(entry.row.name) + "\": ";
    if (entry.row.channels == 3) {
      out += "[" + number_in_json(entry.value[0]) + ", " + number_in_json(entry.value[1]) + ", " +
             number_in_json(entry.value[2]) + "]";
    } else {
      out += number_in_json(entry.value[0]);
    }
    separator = ",\n";
  }
  return out + "\n  }\n}\n";
}

Material material_of(std::string_view text, const std::string& source) { return Reader(text, source).material(); }

Material read_material(const std::filesystem::path& file) {
  return material_of(files::read_whole(file, kLargestFile), file.string());
}

void write_material(const std::filesystem::path& file, const Material& material) {
  files::write_whole(file, text_of(material));
}

}  // namespace likeness::material
