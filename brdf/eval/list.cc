#include "brdf/eval/list.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>
#include <nlohmann/json.hpp>

#include "render/files/files.h"

namespace likeness::eval {
namespace {

using catalog::Entry;
using catalog::Form;
using Json = nlohmann::ordered_json;

void pad(std::string& line, std::size_t width) { line.append(line.size() < width ? width - line.size() : 1, ' '); }

// Six digits: pi/2 is 1.5708 to people. The JSON has them all.
std::string short_number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string range_text(const brdf::Interval& range, int channels) {
  return "[" + short_number(range.low) + ", " + short_number(range.high) + "]" + (channels == 3 ? "^3" : "");
}

std::string input_line(const brdf::Parameter& p) {
  std::string line = "    " + std::string(p.name);
  pad(line, 38);
  line += range_text(p.range, p.channels);
  pad(line, 62);
  line += short_number(p.initial);
  pad(line, 72);
  line += p.unit;
  pad(line, 78);
  return line + std::string(p.text) + "\n";
}

// How many inputs at the end all forms share.
std::size_t shared_inputs(const std::vector<Form>& forms) {
  std::size_t shared = forms.size() < 2 ? 0 : forms.front().inputs.size();
  for (const Form& form : forms) {
    const auto a = forms.front().inputs, b = form.inputs;
    std::size_t same = 0;
    while (same < std::min(a.size(), b.size()) && a[a.size() - 1 - same].name == b[b.size() - 1 - same].name) ++same;
    shared = std::min(shared, same);
  }
  return shared;
}

std::string entry_text(const Entry& entry) {
  std::string text = std::string(entry.name) + ": " + std::string(entry.text) + "\n";
  const std::size_t shared = shared_inputs(entry.forms);
  for (std::size_t i = 0; i < entry.forms.size(); ++i) {
    text += i == 0
                ? (entry.forms.size() == 1 ? "  inputs                              range                   default   "
                                             "unit  what it is\n"
                                           : "  inputs, in one of these ways        range                   default   "
                                             "unit  what it is\n")
                : "  or\n";
    for (const brdf::Parameter& p : entry.forms[i].inputs.first(entry.forms[i].inputs.size() - shared))
      text += input_line(p);
  }
  if (shared > 0) {
    text += "  and\n";
    for (const brdf::Parameter& p : entry.forms.front().inputs.last(shared)) text += input_line(p);
  }
  text += "  outputs\n";
  for (const brdf::Output& output : entry.outputs) {
    std::string line = "    " + std::string(output.name) + (output.channels == 3 ? " (linear RGB)" : "");
    pad(line, 72);
    line += output.unit;
    pad(line, 78);
    text += line + std::string(output.text) + "\n";
  }
  return text;
}

Json json_of(const brdf::Parameter& p) {
  return {{"name", p.name},
          {"default", p.initial},
          {"range", {p.range.low, p.range.high}},
          {"usual", {p.typical.low, p.typical.high}},
          {"unit", p.unit},
          {"channels", p.channels},
          {"logarithmic", p.logarithmic},
          {"text", p.text}};
}

Json json_of(const Entry& entry) {
  Json forms = Json::array(), outputs = Json::array();
  for (const Form& form : entry.forms) {
    Json inputs = Json::array();
    for (const brdf::Parameter& p : form.inputs) inputs.push_back(json_of(p));
    forms.push_back({{"inputs", inputs}});
  }
  for (const brdf::Output& o : entry.outputs)
    outputs.push_back({{"name", o.name},
                       {"unit", o.unit},
                       {"channels", o.channels},
                       {"may_be_negative", o.may_be_negative},
                       {"text", o.text}});
  return {{"name", entry.name}, {"family", entry.family}, {"text", entry.text}, {"in_batches", !entry.one_by_one},
          {"forms", forms},     {"outputs", outputs}};
}

}  // namespace

std::string list_text(std::span<const Entry> entries) {
  std::string text;
  std::string_view family;
  for (const Entry& entry : entries) {
    if (entry.family != family) {
      family = entry.family;
      std::string heading(family);
      std::transform(heading.begin(), heading.end(), heading.begin(),
                     [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
      text += (text.empty() ? "" : "\n") + heading + "\n\n";
    } else {
      text += "\n";
    }
    text += entry_text(entry);
  }
  return text;
}

std::string list_json(std::span<const Entry> entries) {
  Json list = Json::array();
  for (const Entry& entry : entries) list.push_back(json_of(entry));
  return list.dump(2) + "\n";
}

const Entry& entry_named(std::string_view name) {
  if (const Entry* entry = catalog::find(name)) return *entry;
  std::vector<std::string_view> names;
  for (const Entry& entry : catalog::entries()) names.push_back(entry.name);
  const std::string near = files::nearest_name(name, names.data(), names.size());
  throw files::UsageError("no model " + files::in_quotes(name) + (near.empty() ? "" : "; did you mean " + near + "?") +
                          " (likeness eval --list prints them all)");
}

}  // namespace likeness::eval
