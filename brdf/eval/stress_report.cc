#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <iomanip>
#include <sstream>

#include "brdf/eval/columns.h"
#include "brdf/eval/stress.h"
#include "render/files/files.h"

namespace likeness::eval {
namespace {

std::string two_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2g", value);
  return text.data();
}

// "roughness=0.30000001 cos_h=1": as --set takes them.
std::string inputs_text(const catalog::Entry& entry, const std::vector<float>& inputs) {
  std::string text;
  std::size_t at = 0;
  for (const brdf::Parameter& p : entry.forms.front().inputs)
    for (std::size_t c = 0; c < static_cast<std::size_t>(p.channels) && at < inputs.size(); ++c, ++at) {
      std::array<char, 32> digits{};
      const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), inputs[at]);
      text += (text.empty() ? "" : " ") + std::string(p.name) +
              std::string(p.channels == 3 ? kChannelSuffixes[c] : "") + "=" + std::string(digits.data(), end);
    }
  return text;
}

// The cells of one line, as text, for people.
std::array<std::string, 10> cells_of(const Stressed& result, const Swept& s) {
  const bool compared = s.precision != "double";
  const auto error = [&](double value) { return compared ? two_digits(value) : std::string("-"); };
  const double rows = static_cast<double>(result.rows);
  return {std::string(result.entry->name),
          std::string(s.precision),
          std::to_string(result.rows),
          std::to_string(s.not_finite),
          std::to_string(s.negative),
          error(s.quantile(0.999)),
          error(s.worst.value),
          compared
              ? two_digits(100 * static_cast<double>(s.over) / std::max(1.0, static_cast<double>(s.compared))) + " %"
              : "-",
          !compared               ? "-"
          : s.ulps.inputs.empty() ? "< " + two_digits(kLeastUlps)
                                  : two_digits(s.ulps.value),
          two_digits(rows / s.seconds * 1e-6)};
}

constexpr std::array<const char*, 10> kHeads{"model",  "precision", "rows",   "not finite",        "negative",
                                             "99.9 %", "worst",     "> 2e-5", "in ulps of inputs", "Mrows/s"};
constexpr std::array kWidths{28, 10, 11, 11, 9, 9, 9, 9, 18, 8};

template <class Cells>
std::string line_of(const Cells& cells, bool markdown) {
  std::ostringstream line;
  for (std::size_t i = 0; i < kHeads.size(); ++i) {
    if (markdown) line << "| " << cells[i] << " ";
    else
      line << (i < 2 ? std::left : std::right) << std::setw(kWidths[i]) << cells[i]
           << (i + 1 < kHeads.size() ? " " : "");
  }
  line << (markdown ? "|\n" : "\n");
  return line.str();
}

}  // namespace

std::string stress_heading(bool markdown) {
  std::string text = line_of(kHeads, markdown);
  if (markdown) {
    for (std::size_t i = 0; i < kHeads.size(); ++i) text += i < 2 ? "| --- " : "| ---: ";
    text += "|\n";
  }
  return text;
}

std::string stress_lines(const Stressed& result, bool markdown) {
  std::string text;
  for (const Swept& s : result.precisions) {
    text += line_of(cells_of(result, s), markdown);
    if (markdown) continue;
    const auto where = [&](const char* what, const Found& found) {
      if (found.inputs.empty()) return;
      text += std::string("    ") + what + ": " + std::string(found.output) + " = " + files::number_text(found.got) +
              (what == std::string_view("bad") ? "" : ", in double " + files::number_text(found.want)) + " at " +
              inputs_text(*result.entry, found.inputs) + "\n";
    };
    where("bad", s.bad);
    where("worst", s.worst);
    where("in ulps", s.ulps);
  }
  return text;
}

std::string stress_csv_header() {
  return "model,family,precision,rows,not_finite,negative,rows_compared,error_999,error_worst,rows_over,ulps_worst,"
         "rows_per_second,worst_at,ulps_at,bad_at\n";
}

std::string stress_csv_lines(const Stressed& result) {
  std::string text;
  const auto number = [](double value) { return files::number_text(value); };
  for (const Swept& s : result.precisions) {
    text += std::string(result.entry->name) + "," + std::string(result.entry->family) + "," + std::string(s.precision) +
            "," + std::to_string(result.rows) + "," + std::to_string(s.not_finite) + "," + std::to_string(s.negative);
    if (s.precision == "double") text += ",,,,,";
    else
      text += "," + std::to_string(s.compared) + "," + number(s.quantile(0.999)) + "," + number(s.worst.value) + "," +
              std::to_string(s.over) + "," + number(s.ulps.value);
    text += "," + number(static_cast<double>(result.rows) / s.seconds);
    for (const Found* found : {&s.worst, &s.ulps, &s.bad}) text += "," + inputs_text(*result.entry, found->inputs);
    text += "\n";
  }
  return text;
}

}  // namespace likeness::eval
