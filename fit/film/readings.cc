#include "fit/film/readings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "brdf/eval/csv.h"
#include "render/columns/columns.h"
#include "render/files/files.h"

namespace likeness::film {
namespace {

constexpr double kShortestNm = 300, kLongestNm = 1100;
constexpr std::array<std::string_view, 1> kTextColumns{"subject"};

// In percent, as the table has them.
constexpr std::array<std::array<double, 2>, 10> kOlsen{{{3.94, 2.65},
                                                        {3.60, 2.26},
                                                        {5.31, 3.25},
                                                        {3.25, 2.43},
                                                        {5.13, 4.52},
                                                        {2.66, 2.58},
                                                        {3.70, 3.20},
                                                        {3.82, 3.79},
                                                        {4.52, 2.69},
                                                        {4.62, 4.27}}};

std::string wavelength_range() {
  return "[" + files::number_text(kShortestNm) + ", " + files::number_text(kLongestNm) + "] nm";
}

// What is wrong with a reflectance, or nothing.
std::string reflectance_fault(double value) {
  if (value > 0 && value < 1) return "";
  return files::number_text(value) + " is outside (0, 1)" + (value >= 1 && value < 100 ? "; 4 % is written 0.04" : "");
}

bool is_wavelength(double nm) { return nm >= kShortestNm && nm <= kLongestNm; }

// The columns in the order of their wavelengths.
Readings in_order(Readings readings) {
  std::vector<std::size_t> order(readings.wavelengths_nm.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return readings.wavelengths_nm[a] < readings.wavelengths_nm[b]; });
  const auto arranged = [&](const std::vector<double>& values) {
    std::vector<double> out;
    for (const std::size_t i : order) out.push_back(values[i]);
    return out;
  };
  readings.wavelengths_nm = arranged(readings.wavelengths_nm);
  for (Subject& subject : readings.subjects) subject.reflectance = arranged(subject.reflectance);
  return readings;
}

bool has_repeats(const std::vector<double>& increasing) {
  return std::adjacent_find(increasing.begin(), increasing.end()) != increasing.end();
}

}  // namespace

std::vector<double> Readings::mean() const {
  std::vector<double> out(wavelengths_nm.size(), 0.0);
  for (const Subject& subject : subjects)
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] += subject.reflectance[i] / static_cast<double>(subjects.size());
  return out;
}

std::vector<double> Readings::deviation() const {
  std::vector<double> out(wavelengths_nm.size(), 0.0);
  if (subjects.size() < 2) return out;
  const std::vector<double> middle = mean();
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (const Subject& subject : subjects) out[i] += std::pow(subject.reflectance[i] - middle[i], 2);
    out[i] = std::sqrt(out[i] / static_cast<double>(subjects.size() - 1));
  }
  return out;
}

Readings olsen() {
  Readings readings{"Olsen 1985, table 1", {500, 700}, {}};
  for (std::size_t i = 0; i < kOlsen.size(); ++i)
    readings.subjects.push_back({std::to_string(i + 1), {kOlsen[i][0] / 100, kOlsen[i][1] / 100}});
  return readings;
}

Readings readings_of(std::string_view bytes, const std::string& source) {
  const columns::Columns table = columns::parse(bytes, source, kTextColumns);
  Readings readings{source, {}, {}};
  for (const std::string& name : table.names) {
    const auto nm = eval::number_in(name);
    if (!nm || !is_wavelength(*nm))
      throw files::InputError(source + ": column " + files::in_quotes(name) +
                              " is neither \"subject\" nor a wavelength in " + wavelength_range());
    readings.wavelengths_nm.push_back(*nm);
  }
  if (readings.wavelengths_nm.size() < 2)
    throw files::InputError(source + ": " + std::to_string(readings.wavelengths_nm.size()) +
                            " wavelengths; a thickness needs two or more columns named by theirs in nm");
  for (const columns::Row& row : table.rows) {
    for (std::size_t i = 0; i < row.numbers.size(); ++i)
      if (const std::string fault = reflectance_fault(row.numbers[i]); !fault.empty())
        table.refuse(row, "the reflectance at " + table.names[i] + " nm, " + fault);
    const std::string name = row.texts[0].empty() ? std::to_string(readings.subjects.size() + 1) : row.texts[0];
    readings.subjects.push_back({name, row.numbers});
  }
  readings = in_order(std::move(readings));
  if (has_repeats(readings.wavelengths_nm)) throw files::InputError(source + ": two columns are of one wavelength");
  return readings;
}

Readings read_readings(const std::filesystem::path& file) {
  return readings_of(files::read_whole(file, columns::kMostBytes), file.string());
}

Readings readings_of(const std::vector<std::string>& pairs) {
  Readings readings{"--reflectance", {}, {{"1", {}}}};
  for (const std::string& pair : pairs) {
    const std::string_view text = pair;
    const std::size_t colon = std::min(text.find(':'), text.size());
    const auto nm = eval::number_in(text.substr(0, colon));
    const auto value = eval::number_in(text.substr(std::min(colon + 1, text.size())));
    const std::string place = "--reflectance " + files::in_quotes(pair);
    if (!nm || !value) throw files::UsageError(place + ": write WAVELENGTH:REFLECTANCE, for example 500:0.0406");
    if (!is_wavelength(*nm)) throw files::UsageError(place + ": the wavelength is outside " + wavelength_range());
    if (const std::string fault = reflectance_fault(*value); !fault.empty())
      throw files::UsageError(place + ": " + fault);
    readings.wavelengths_nm.push_back(*nm);
    readings.subjects[0].reflectance.push_back(*value);
  }
  if (pairs.size() < 2) throw files::UsageError("--reflectance: a thickness needs two or more wavelengths");
  readings = in_order(std::move(readings));
  if (has_repeats(readings.wavelengths_nm)) throw files::UsageError("--reflectance: a wavelength is given twice");
  return readings;
}

}  // namespace likeness::film
