#pragma once

#include <cstdio>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/catalog/catalog.h"

// The tables of docs/models, made from the evaluators: of inputs and outputs, and the index of all models.
namespace likeness::brdf {

inline std::string shortest(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", x);
  return text;
}

inline std::string interval_text(const Interval& in, int channels) {
  return "[" + shortest(in.low) + ", " + shortest(in.high) + "]" + (channels == 3 ? "³" : "");
}

// A pair of directions and then the model's parameters: its page shows the parameters alone, since the directions are
// the same for all.
inline bool is_surface_model(const catalog::Entry& entry) {
  const auto inputs = entry.forms.front().inputs;
  if (inputs.size() < Vectors::kInputs.size()) return false;
  for (std::size_t i = 0; i < Vectors::kInputs.size(); ++i)
    if (inputs[i].name != Vectors::kInputs[i].name) return false;
  return true;
}

inline std::string input_table(std::span<const Parameter> inputs, std::string_view first_heading) {
  bool tiers = false;
  for (const Parameter& row : inputs) tiers = tiers || row.tier != Tier::kPlain;
  std::string text = "| " + std::string(first_heading) + " | range | usual | default |";
  text += tiers ? " tier | what it does |\n| --- | --- | --- | --- | --- | --- |\n"
                : " what it does |\n| --- | --- | --- | --- | --- |\n";
  for (const Parameter& row : inputs) {
    text += "| `" + std::string(row.name) + "` | " + interval_text(row.range, row.channels) + " | " +
            interval_text(row.typical, row.channels) + " | " + shortest(row.initial) + " | ";
    if (tiers) text += std::string(kTierNames[std::size_t(row.tier)]) + " | ";
    text += std::string(row.text) + (row.unit == "1" ? "" : " [" + std::string(row.unit) + "]") + " |\n";
  }
  return text;
}

inline std::string output_table(std::span<const Output> outputs) {
  std::string text = "| output | what it is |\n| --- | --- |\n";
  for (const Output& row : outputs)
    text += "| `" + std::string(row.name) + "`" + (row.channels == 3 ? "³" : "") + " | " + std::string(row.text) +
            (row.unit == "1" ? "" : " [" + std::string(row.unit) + "]") + " |\n";
  return text;
}

// What stands between the marks of an evaluator.
inline std::string markdown_table(const catalog::Entry& entry) {
  if (is_surface_model(entry)) {
    const auto inputs = entry.forms.front().inputs;
    return input_table(inputs.subspan(Vectors::kInputs.size()), "parameter");
  }
  std::string text;
  for (std::size_t i = 0; i < entry.forms.size(); ++i)
    text += (i == 0 ? "" : "\nor\n\n") + input_table(entry.forms[i].inputs, "input");
  return text + "\n" + output_table(entry.outputs);
}

// Where a page holds a table: between "<!-- table: NAME -->\n" and "<!-- end -->". Empty if there is no such place.
struct Span {
  std::size_t first = 0, count = 0;
};
inline Span table_span(const std::string& page, std::string_view name) {
  const std::string open = "<!-- table: " + std::string(name) + " -->\n";
  const std::size_t first = page.find(open), last = page.find("<!-- end -->", first);
  if (first == std::string::npos || last == std::string::npos) return {};
  return {first + open.size(), last - first - open.size()};
}

// The names for which a page has a place, in order.
inline std::vector<std::string> tables_in(const std::string& page) {
  constexpr std::string_view kOpen = "<!-- table: ", kClose = " -->\n";
  std::vector<std::string> names;
  for (std::size_t at = page.find(kOpen); at != std::string::npos; at = page.find(kOpen, at)) {
    at += kOpen.size();
    const std::size_t end = page.find(kClose, at);
    if (end != std::string::npos) names.push_back(page.substr(at, end - at));
  }
  return names;
}

// The page of models: every evaluator by family, with its page. `pages` is the file of each evaluator's table.
inline constexpr std::string_view kIndex = "index";
inline std::string model_index(const std::map<std::string, std::string>& pages) {
  std::string text;
  std::string_view family;
  for (const catalog::Entry& entry : catalog::entries()) {
    if (entry.family != family) {
      family = entry.family;
      std::string heading(family);
      heading.front() = static_cast<char>(heading.front() - 'a' + 'A');
      text += (text.empty() ? "" : "\n") + ("## " + heading) + "\n\n| model | what it is |\n| --- | --- |\n";
    }
    const std::string name(entry.name);
    const auto page = pages.find(name);
    text += "| " + (page == pages.end() ? "`" + name + "`" : "[`" + name + "`](" + page->second + ")") + " | " +
            std::string(entry.text) + " |\n";
  }
  return text;
}

}  // namespace likeness::brdf
