#include "fit/measured/csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <vector>

#include "fit/measured/half_angles.h"
#include "fit/measured/refuse.h"
#include "fit/measured/scattered.h"

namespace likeness::measured {
namespace {

using std::numbers::pi;
constexpr std::size_t kMostRows = 2'000'000, kMostColumns = 32;
constexpr std::array<std::string_view, 7> kColumns{"theta_i", "theta_o", "phi", "r", "g", "b", "weight"};
enum Column { kThetaI, kThetaO, kPhi, kR, kG, kB, kWeight };
constexpr std::string_view kHeader = "the header theta_i,theta_o,phi,r,g,b[,weight] (theta_i_deg, ... for degrees)";

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// The next line, without its comment, and the rest of the text.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return trimmed(line.substr(0, line.find('#')));
}

// A number as written, "nan" and "inf" included; nothing if the text is no number.
std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || text.empty()) return std::nullopt;
  // Too large or too small for a double.
  if (error == std::errc::result_out_of_range) return std::string_view(text).find("e-") != text.npos ? 0.0 : HUGE_VAL;
  if (error != std::errc{}) return std::nullopt;
  return value;
}

// By all that decides a mean, so that the order of the rows does not.
bool before(const Scattered& a, const Scattered& b) {
  return std::tie(a.angles, a.r, a.g, a.b, a.weight) < std::tie(b.angles, b.r, b.g, b.b, b.weight);
}

class Csv final : public Material {
 public:
  Csv(std::string_view text, const std::string& name) {
    source = name;
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a byte order mark
    read_header(text);
    read_rows(text);
  }

  bool evaluate(const Direction& to_light, const Direction& to_view, Rgb& f) const override {
    if (!(to_light.z > 0) || !(to_view.z > 0)) return false;
    const Elevations e = elevations(to_light, to_view);
    return samples_.interpolate(e, f) || samples_.interpolate({e.theta_o, e.theta_i, e.phi}, f);
  }

  void for_each_sample(const std::function<void(const Sample&)>& visit) const override {
    Sample sample;
    for (const Scattered& s : samples_.samples()) {
      directions_at({s.angles[0], s.angles[1], s.angles[2]}, sample.to_light, sample.to_view);
      sample.f = {s.r, s.g, s.b};
      sample.weight = double{s.weight} * scale_;
      // theta is stored in float, so 90 deg may lie a rounding above or below the horizon.
      if (sample.to_light.z > 1e-6 && sample.to_view.z > 1e-6 && sample.weight > 0) visit(sample);
    }
  }

  Coverage coverage() const override { return coverage_; }
  Format format() const override { return Format::kCsv; }

 private:
  [[noreturn]] void refuse_line(const std::string& found, const std::string& expected) const {
    refuse(source + ":" + std::to_string(line_), found, expected);
  }

  void read_header(std::string_view& text) {
    std::string_view line;
    while (line.empty() && !text.empty()) line = take_line(text), ++line_;
    if (line.empty()) refuse(source, "no header", std::string(kHeader));
    place_.fill(-1);
    columns_ = 0;
    for (std::size_t from = 0; from <= line.size(); ++columns_) {
      if (columns_ == kMostColumns) refuse_line("more than 32 columns", std::string(kHeader));
      const std::size_t comma = std::min(line.find(',', from), line.size());
      const std::string_view title = trimmed(line.substr(from, comma - from));
      from = comma + 1;
      std::string_view bare = title;
      const bool degrees = bare.ends_with("_deg");
      if (degrees) bare.remove_suffix(4);
      const auto known = std::find(kColumns.begin(), kColumns.end(), bare) - kColumns.begin();
      if (known == int(kColumns.size()) || (degrees && known > kPhi))
        refuse_line("column " + in_quotes(title), std::string(kHeader));
      if (place_[known] >= 0) refuse_line("column " + in_quotes(title) + " twice", std::string(kHeader));
      place_[known] = int(columns_);
      if (known <= kPhi) to_radians_[known] = degrees ? pi / 180 : 1;
    }
    for (int c = kThetaI; c <= kB; ++c)
      if (place_[c] < 0) refuse_line("no column \"" + std::string(kColumns[c]) + "\"", std::string(kHeader));
  }

  void read_rows(std::string_view text) {
    std::vector<Scattered> rows;
    std::array<double, kMostColumns> cells;
    while (!text.empty()) {
      const std::string_view line = take_line(text);
      ++line_;
      if (line.empty()) continue;
      if (++coverage_.stored > kMostRows) refuse_line("more than 2000000 rows", "at most that many");
      read_cells(line, cells);
      add_row(cells, rows);
    }
    if (rows.empty())
      refuse(source,
             "no valid row among " + std::to_string(coverage_.stored) + " (" + std::to_string(coverage_.negative) +
                 " negative, " + std::to_string(coverage_.not_finite) + " NaN or Inf)",
             "at least one");
    std::sort(rows.begin(), rows.end(), before);
    average_repeats(rows);
    coverage_.valid = rows.size();
    if (place_[kWeight] < 0) {
      double total = 0;
      for (Scattered& s : rows) {
        const auto sine = [](double theta) { return std::max(std::sin(theta), std::sin(pi / 360)); };
        s.weight = float(sine(s.angles[0]) * sine(s.angles[1]));
        total += s.weight;
      }
      scale_ = 4 * pi * pi / total;
    }
    samples_ = ScatteredSamples(std::move(rows), kCsvReach);
  }

  void read_cells(std::string_view line, std::array<double, kMostColumns>& cells) const {
    std::size_t column = 0;
    for (std::size_t from = 0; from <= line.size(); ++column) {
      const std::size_t comma = std::min(line.find(',', from), line.size());
      const std::string_view cell = trimmed(line.substr(from, comma - from));
      from = comma + 1;
      if (column == columns_)
        refuse_line("more than " + std::to_string(columns_) + " values", std::to_string(columns_));
      const std::optional<double> value = number_in(cell);
      if (!value) refuse_line("value " + in_quotes(cell) + " in column " + std::to_string(column + 1), "a number");
      cells[column] = *value;
    }
    if (column < columns_) refuse_line(std::to_string(column) + " values", std::to_string(columns_));
  }

  void add_row(const std::array<double, kMostColumns>& cells, std::vector<Scattered>& rows) {
    std::array<double, 7> v{};
    for (std::size_t c = 0; c < v.size(); ++c) v[c] = place_[c] < 0 ? 1 : cells[place_[c]];
    const auto finite = [](double x) { return std::isfinite(float(x)); };
    if (!std::all_of(v.begin(), v.end(), finite)) {
      ++coverage_.not_finite;
      return;
    }
    for (const Column c : {kThetaI, kThetaO}) {
      const double theta = v[c] * to_radians_[c];
      if (theta < 0 || theta > pi / 2 + 1e-5)
        refuse_line(std::string(kColumns[c]) + " = " + std::to_string(v[c]) + (to_radians_[c] == 1 ? " rad" : " deg"),
                    to_radians_[c] == 1
                        ? "0 to 1.5708; for degrees name the column " + std::string(kColumns[c]) + "_deg"
                        : "0 to 90");
      v[c] = std::min(theta, pi / 2);
    }
    if (place_[kWeight] >= 0 && v[kWeight] < 0) refuse_line("weight = " + std::to_string(v[kWeight]), "0 or more");
    v[kPhi] = std::abs(std::remainder(v[kPhi] * to_radians_[kPhi], 2 * pi));
    const bool any = v[kR] < 0 || v[kG] < 0 || v[kB] < 0, all = v[kR] < 0 && v[kG] < 0 && v[kB] < 0;
    coverage_.negative += all;
    if (all) return;
    coverage_.clipped += any;
    const auto color = [&](Column c) { return float(std::max(v[c], 0.0)); };
    rows.push_back(
        {{float(v[kThetaI]), float(v[kThetaO]), float(v[kPhi])}, color(kR), color(kG), color(kB), float(v[kWeight])});
  }

  // One row for each run of equal angles: the mean value, the summed weight.
  void average_repeats(std::vector<Scattered>& rows) {
    std::size_t kept = 0;
    for (std::size_t from = 0, to = 0; from < rows.size(); from = to) {
      double r = 0, g = 0, b = 0, weight = 0;
      for (to = from; to < rows.size() && rows[from].angles == rows[to].angles; ++to)
        r += rows[to].r, g += rows[to].g, b += rows[to].b, weight += rows[to].weight;
      const double n = double(to - from);
      rows[kept] = rows[from];
      rows[kept].r = float(r / n), rows[kept].g = float(g / n), rows[kept].b = float(b / n);
      rows[kept++].weight = float(std::min(weight, 3e38));
    }
    coverage_.repeats = rows.size() - kept;
    rows.resize(kept);
  }

  ScatteredSamples samples_;
  std::array<int, 7> place_{};                 // of each of kColumns in a row, -1 if absent
  std::array<double, 3> to_radians_{1, 1, 1};  // of the angles
  std::size_t columns_ = 0, line_ = 0;
  double scale_ = 1;  // of the stored weights
  Coverage coverage_;
};

}  // namespace

std::unique_ptr<Material> parse_csv(std::string_view text, const std::string& name) {
  return std::make_unique<Csv>(text, name);
}

std::string csv_text(const Material& material) {
  std::string text = "theta_i,theta_o,phi,r,g,b,weight\n";
  material.for_each_sample([&](const Sample& s) {
    const Elevations e = elevations(s.to_light, s.to_view);
    char line[200];
    char* at = line;
    for (const double value : {e.theta_i, e.theta_o, e.phi, s.f.r, s.f.g, s.f.b, s.weight}) {
      at = std::to_chars(at, line + sizeof line - 1, value, std::chars_format::general, 9).ptr;
      *at++ = ',';
    }
    at[-1] = '\n';
    text.append(line, at);
  });
  return text;
}

void write_csv(const std::filesystem::path& file, const Material& material) {
  files::write_whole(file, csv_text(material));
}

}  // namespace likeness::measured
