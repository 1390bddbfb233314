#include "olat/pair/state.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <set>
#include <utility>
#include <vector>

#include "olat/metric/metric.h"
#include "render/files/files.h"
#include "render/json/json.h"
#include "render/view/view.h"

namespace likeness::olat_pair {
namespace {

using files::in_quotes;
using files::UsageError;
using Gt = brdf::GtTonemap<double>;

constexpr auto kMetricNames = [] {
  std::array<std::string_view, metric::kMetrics.size()> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = metric::kMetrics[i].id;
  return names;
}();

std::vector<Field> make_fields() {
  std::vector<Field> all{
      {"camera", &State::camera, "id of the camera; the first"},
      {"light", &State::light, "id of the light; the first"},
      {"variant", &State::variant, "id of the renders; the first"},
      {.name = "mode", .at = &State::mode, .text = "what is shown", .choices = kModes},
      {"split", &State::split, "of wipe: share of the width that is photo", {0, 1}},
      {"mix", &State::mix, "of onion: share of the render", {0, 1}},
      {.name = "metric", .at = &State::metric, .text = "of the difference", .names = kMetricNames},
      {"range", &State::range, "value at the end of the map's colors; 0: the metric's own", {0, 1e6}},
      {"noise", &State::noise, "noise floor [light]; 0: the camera's", {0, 1e3}},
      {"ev", &State::ev, "exposure of both [stop]", {-30, 30}, true},
      {.name = "match", .at = &State::match, .text = "gain of the render", .is_shared = true, .choices = kMatches},
      {.name = "view",
       .at = &State::view,
       .text = "from light to the display",
       .is_shared = true,
       .names = view::kOwnViews},
  };
  static constexpr std::array<std::string_view, Gt::kParameters.size()> kGtNames{"gt_P", "gt_a", "gt_m",
                                                                                 "gt_l", "gt_c", "gt_b"};
  const std::array at{&Gt::max_brightness, &Gt::contrast, &Gt::linear_start,
                      &Gt::linear_length,  &Gt::black,    &Gt::pedestal};
  for (std::size_t i = 0; i < kGtNames.size(); ++i)
    all.push_back({kGtNames[i],
                   at[i],
                   Gt::kParameters[i].text,
                   {Gt::kParameters[i].range.low, Gt::kParameters[i].range.high},
                   true});
  all.insert(all.end(),
             {{.name = "channel", .at = &State::channel, .text = "what of the light", .choices = kChannels},
              {.name = "overlay", .at = &State::overlay, .text = "colors instead of the picture", .choices = kOverlays},
              {"zebra", &State::zebra, "stripes where the display, or the sensor, is full"},
              {"wedge", &State::wedge, "17 greys, a stop apart, through the same exposure and view"},
              {"zoom", &State::zoom, "screen pixels for a picture's pixel; 0: all of it fits", {0, 64}},
              {"x", &State::x, "what is in the middle, share of the width", {0, 1}},
              {"y", &State::y, "what is in the middle, share of the height", {0, 1}}});
  return all;
}

// What is kept of a number: four decimals.
double kept(double value) { return std::floor(value * 1e4 + 0.5) / 1e4; }

std::string number_of(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4f", kept(value));
  std::string out = text;
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

bool is_plain(unsigned char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' ||
         c == '_' || c == '~';
}

std::string percent_encoded(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (is_plain(byte)) {
      out += c;
    } else {
      char code[4];
      std::snprintf(code, sizeof code, "%%%02X", byte);
      out += code;
    }
  }
  return out;
}

int hex_digit(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                : -1;
}

// A '%' that no two digits follow stands for itself.
std::string percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0) {
      out += static_cast<char>(16 * hex_digit(text[i + 1]) + hex_digit(text[i + 2]));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

template <class Names>
[[noreturn]] void unknown(std::string_view what, std::string_view word, const Names& names) {
  std::string list;
  for (const std::string_view n : names) list += (list.empty() ? "" : ", ") + std::string(n);
  const std::string near = files::nearest_name(word, names.data(), names.size());
  throw UsageError("state: " + std::string(what) + " " + in_quotes(word) + " is not known" +
                   (near.empty() ? "; there are " + list : "; did you mean " + near + "?"));
}

std::vector<std::string_view> words_of(std::span<const Choice> choices) {
  std::vector<std::string_view> out;
  for (const Choice& c : choices) out.push_back(c.word);
  return out;
}

double number_from(const Field& field, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw UsageError("state: " + std::string(field.name) + " = " + in_quotes(text) + " is not a number (" +
                     std::string(field.text) + ")");
  if (!(value >= field.range[0] && value <= field.range[1]))
    throw UsageError("state: " + std::string(field.name) + " = " + in_quotes(text) + " is outside [" +
                     files::number_text(field.range[0]) + ", " + files::number_text(field.range[1]) + "] (" +
                     std::string(field.text) + ")");
  return kept(value);
}

struct Assign {
  State& state;
  const Field& field;
  const std::string& text;

  void operator()(std::string State::* at) const {
    constexpr std::size_t kLongest = 1024;
    if (text.size() > kLongest) throw UsageError("state: " + std::string(field.name) + " is longer than 1024 bytes");
    if (!field.names.empty() && std::find(field.names.begin(), field.names.end(), text) == field.names.end())
      unknown(field.name, text, field.names);
    state.*at = text;
  }
  void operator()(double State::* at) const { state.*at = number_from(field, text); }
  void operator()(double Gt::* at) const { state.gt.*at = number_from(field, text); }
  void operator()(bool State::* at) const {
    if (text != "1" && text != "0" && text != "true" && text != "false")
      throw UsageError("state: " + std::string(field.name) + " = " + in_quotes(text) + " is neither 1 nor 0");
    state.*at = text == "1" || text == "true";
  }
  template <class Enum>
  void operator()(Enum State::* at) const {
    const auto found =
        std::find_if(field.choices.begin(), field.choices.end(), [&](const Choice& c) { return c.word == text; });
    if (found == field.choices.end()) unknown(field.name, text, words_of(field.choices));
    state.*at = static_cast<Enum>(found - field.choices.begin());
  }
};

struct Print {
  const State& state;
  const Field& field;

  std::string operator()(std::string State::* at) const { return state.*at; }
  std::string operator()(double State::* at) const { return number_of(state.*at); }
  std::string operator()(double Gt::* at) const { return number_of(state.gt.*at); }
  std::string operator()(bool State::* at) const { return state.*at ? "1" : "0"; }
  template <class Enum>
  std::string operator()(Enum State::* at) const {
    return std::string(field.choices[static_cast<std::size_t>(state.*at)].word);
  }
};

std::string printed(const State& state, const Field& field) { return std::visit(Print{state, field}, field.at); }

// The pairs of either form, decoded.
std::vector<std::pair<std::string, std::string>> pairs_in(std::string_view text) {
  std::vector<std::pair<std::string, std::string>> pairs;
  if (text.find_first_not_of(" \t\r\n") != std::string_view::npos && text[text.find_first_not_of(" \t\r\n")] == '{') {
    json::Value tree;
    try {
      tree = json::parse(text, "state", {.values = 200, .depth = 3});
    } catch (const files::InputError& e) {
      throw UsageError(e.what());
    }
    for (const json::Value& item : tree.items) {
      if (item.kind == json::Kind::kText) pairs.emplace_back(item.key, item.text);
      else if (item.kind == json::Kind::kNumber) pairs.emplace_back(item.key, files::number_text(item.number));
      else if (item.kind == json::Kind::kFlag) pairs.emplace_back(item.key, item.number != 0 ? "1" : "0");
      else
        throw UsageError("state: " + json::plain(item.key) + " is " + json::kind_text(item) + "; a text or a number");
    }
    return pairs;
  }
  if (text.starts_with('?')) text.remove_prefix(1);
  while (!text.empty()) {
    const std::string_view part = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    if (part.empty()) continue;
    const std::size_t at = part.find('=');
    if (at == std::string_view::npos)
      throw UsageError("state: " + in_quotes(part) + " has no '='; a state is key=value&key=value");
    pairs.emplace_back(percent_decoded(part.substr(0, at)), percent_decoded(part.substr(at + 1)));
  }
  return pairs;
}

}  // namespace

std::span<const Field> fields() {
  static const std::vector<Field> kAll = make_fields();
  return kAll;
}

bool State::operator==(const State& other) const { return text_of(*this) == text_of(other); }

std::string value_of(const State& state, const Field& field) {
  static const State kDefault;
  const std::string text = printed(state, field);
  return text == printed(kDefault, field) ? "" : text;
}

std::string text_of(const State& state) {
  std::string out;
  for (const Field& field : fields())
    if (const std::string value = value_of(state, field); !value.empty())
      out += (out.empty() ? "" : "&") + std::string(field.name) + "=" + percent_encoded(value);
  return out;
}

State state_of(std::string_view text) {
  constexpr std::size_t kLongest = 1 << 16;
  if (text.size() > kLongest) throw UsageError("state: longer than 65536 bytes");
  State state;
  std::set<std::string> seen;
  for (const auto& [key, value] : pairs_in(text)) {
    const auto all = fields();
    const auto field = std::find_if(all.begin(), all.end(), [&](const Field& f) { return f.name == key; });
    if (field == all.end()) {
      std::vector<std::string_view> names;
      for (const Field& f : all) names.push_back(f.name);
      unknown("key", key, names);
    }
    if (!seen.insert(key).second) throw UsageError("state: " + key + " is there twice");
    std::visit(Assign{state, *field, value}, field->at);
  }
  return state;
}

bool has_field(std::string_view text, std::string_view name) {
  const auto pairs = pairs_in(text);
  return std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) { return pair.first == name; });
}

std::string pipeline_of(const State& state) {
  std::string out = "lin_rec709_scene";
  for (const Field& field : fields()) {
    const bool is_gt = std::holds_alternative<double Gt::*>(field.at);
    if (field.is_shared && (!is_gt || state.view == "gt"))
      out += ";" + std::string(field.name) + "=" + printed(state, field);
  }
  return out + ";oetf=srgb";
}

std::string hash_of(std::string_view pipeline) {
  std::uint32_t hash = 2166136261u;
  for (const char c : pipeline) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  char text[16];
  std::snprintf(text, sizeof text, "%08x", hash);
  return text;
}

double scale_of(std::string_view id) {
  using metric::Metric;
  switch (metric::metric_of(id)) {
    case Metric::kStops:
      return 2;
    case Metric::kSigned:
    case Metric::kAbsolute:
      return 0.5;
    case Metric::kSmape:
      return 2;
    case Metric::kDeltaE:
      return 10;
    case Metric::kFlip:
    case Metric::kHdrFlip:
      return 1;
  }
  return 1;
}

}  // namespace likeness::olat_pair
