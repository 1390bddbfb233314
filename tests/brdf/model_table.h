#pragma once

#include <cstdio>
#include <string>

#include "brdf/any_brdf.h"

// The parameter table of a model as Markdown, made from its kParameters, and its place in a page.
namespace likeness::brdf {

inline std::string shortest(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", x);
  return text;
}

inline std::string interval_text(const Interval& in, int channels) {
  return "[" + shortest(in.low) + ", " + shortest(in.high) + "]" + (channels == 3 ? "³" : "");
}

template <class M>
std::string markdown_table() {
  bool tiers = false;
  for (const Parameter& row : M::kParameters) tiers = tiers || row.tier != Tier::kPlain;
  std::string text = "| parameter | range | usual | default |";
  text += tiers ? " tier | what it does |\n| --- | --- | --- | --- | --- | --- |\n"
                : " what it does |\n| --- | --- | --- | --- | --- |\n";
  for (const Parameter& row : M::kParameters) {
    text += "| `" + std::string(row.name) + "` | " + interval_text(row.range, row.channels) + " | " +
            interval_text(row.typical, row.channels) + " | " + shortest(row.initial) + " | ";
    if (tiers) text += std::string(kTierNames[std::size_t(row.tier)]) + " | ";
    text += std::string(row.text) + (row.unit == "1" ? "" : " [" + std::string(row.unit) + "]") + " |\n";
  }
  return text;
}

// Where a page holds the table: between "<!-- table: NAME -->\n" and "<!-- end -->". Empty if there is no such place.
struct Span {
  std::size_t first = 0, count = 0;
};
inline Span table_span(const std::string& page, std::string_view model) {
  const std::string open = "<!-- table: " + std::string(model) + " -->\n";
  const std::size_t first = page.find(open), last = page.find("<!-- end -->", first);
  if (first == std::string::npos || last == std::string::npos) return {};
  return {first + open.size(), last - first - open.size()};
}

// Calls visit(M{}) for every alternative of AnyBrdf.
template <class F>
void for_each_model(F&& visit) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (visit(std::variant_alternative_t<I, AnyBrdf>{}), ...);
  }(std::make_index_sequence<std::variant_size_v<AnyBrdf>>{});
}

}  // namespace likeness::brdf
