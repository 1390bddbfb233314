#include "render/blood/table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "render/columns/columns.h"
#include "render/files/files.h"
#include "render/image/tone_curve.h"
#include "render/page/html.h"

namespace likeness::blood {
namespace {

constexpr std::array<std::string_view, 1> kDropColumn{"drop"};
constexpr std::array<std::string_view, 5> kNumberColumns{"opacity", "time_s", "r", "g", "b"};
constexpr std::array<double, 4> kExampleOpacities{0.35, 0.6, 0.85, 0.98};
constexpr std::array<double, 9> kTimesOfTalk{0, 2, 5, 10, 15, 30, 45, 60, 180};  // minutes

}  // namespace

Table table_of(std::string_view bytes, const std::string& source, Encoding encoding) {
  const columns::Columns read = columns::parse(bytes, source, kDropColumn);
  std::array<std::size_t, kNumberColumns.size()> at{};
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = read.index_of(kNumberColumns[i]);
  const double most = encoding == Encoding::kSrgb ? 255 : 4;
  Table table{source, {}};
  for (const columns::Row& row : read.rows) {
    const auto within = [&](std::size_t column, double high) {
      const double value = row.numbers[at[column]];
      if (!(value >= 0 && value <= high))
        read.refuse(row, std::string(kNumberColumns[column]) + " = " + files::number_text(value) + " is outside [0, " +
                             files::number_text(high) + "]");
      return value;
    };
    Cell cell{row.texts[0], within(0, 1), within(1, 1e8), {}};
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = within(2 + c, most);
      cell.rgb[c] = encoding == Encoding::kSrgb ? image::srgb_decode(value / 255) : value;
    }
    table.cells.push_back(cell);
  }
  return table;
}

Table read_table(const std::filesystem::path& file, Encoding encoding) {
  return table_of(files::read_whole(file, columns::kMostBytes), file.string(), encoding);
}

std::string text_of(const Table& table) {
  std::string out = "drop,opacity,time_s,r,g,b\n";
  for (const Cell& cell : table.cells) {
    out += cell.drop + "," + files::number_text(cell.opacity) + "," + files::number_text(cell.time);
    for (const double value : cell.rgb) out += "," + page::fixed(255 * image::srgb_encode(std::min(value, 1.0)), 2);
    out += "\n";
  }
  return out;
}

brdf::BloodPalette<double> example_truth() { return {}; }

std::array<double, 3> example_color(double opacity, double time) {
  static const brdf::HaemoglobinWeights kWeights;
  static const brdf::BloodPalette<double> kTruth = example_truth();
  const brdf::Rgb<double> base = kTruth.spectral(kWeights, opacity, time);
  // Browning: blue and green lose less than red, slowly, most where blood is thick.
  const double age = 1 - std::exp(-time / 5400), amount = 0.45 * age * opacity;
  // What is outside the gamut is black in that channel, as a photograph has it.
  return {std::max(0.0, base.r) * std::exp(-amount), std::max(0.0, base.g) * std::exp(-0.3 * amount),
          std::max(0.0, base.b) * std::exp(-0.4 * amount)};
}

Table example_table(double noise, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  const auto normal = [&] {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  };
  Table table{"made, seed " + std::to_string(seed), {}};
  for (std::size_t d = 0; d < kExampleOpacities.size(); ++d)
    for (const double minutes : kTimesOfTalk) {
      Cell cell{"0" + std::to_string(d + 1), kExampleOpacities[d], 60 * minutes,
                example_color(kExampleOpacities[d], 60 * minutes)};
      for (double& value : cell.rgb) value = std::max(0.0, value * (1 + noise * normal()));
      table.cells.push_back(cell);
    }
  return table;
}

}  // namespace likeness::blood
