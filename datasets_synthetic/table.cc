#include "datasets_synthetic/table.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numbers>
#include <thread>

#include "fit/measured/merl.h"

namespace likeness::datasets_synthetic {
namespace {

using measured::Format;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kMark = -1;  // of 'not measured', in the binary formats

// Calls body(first index) for every index below count, spread over the threads.
template <class F>
void spread(int count, int threads, const F& body) {
  const int asked = threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
  const int used = std::clamp(asked, 1, std::max(1, std::min(count, 64)));
  std::vector<std::jthread> others;
  const auto run = [&](int first) {
    for (int i = first; i < count; i += used) body(i);
  };
  for (int t = 1; t < used; ++t) others.emplace_back(run, t);
  run(0);
}

static_assert(std::endian::native == std::endian::little, "both binary formats are little-endian");

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

double stored(const Table& table, std::size_t channel, std::size_t at) {
  const bool absent = table.state[at] == State::kBelowHorizon || table.state[at] == State::kInvalid;
  return absent ? kMark : table.f[channel][at];
}

// Not measured::merl_bytes, which writes a mark in the place of NaN and negative values: here they are wanted.
std::string merl_file(const Table& table) {
  std::string bytes;
  bytes.reserve(12 + 24 * table.grid.size());
  for (const int n : table.grid.bins) append(bytes, static_cast<std::int32_t>(n));
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t at = 0; at < table.grid.size(); ++at) {
      const double f = stored(table, c, at);
      append(bytes, f == kMark ? kMark : f / measured::kMerlScale[c]);
    }
  return bytes;
}

std::string mbsdf_file(const Table& table) {
  std::string bytes = "NVIDIA ARC MBSDF V1\nMBSDF_DATA_REFLECTION=\n";
  bytes.reserve(bytes.size() + 12 + 12 * table.grid.size());
  append(bytes, std::uint32_t{1});  // three channels
  append(bytes, static_cast<std::uint32_t>(table.grid.bins[0]));
  append(bytes, static_cast<std::uint32_t>(table.grid.bins[2]));
  for (std::size_t at = 0; at < table.grid.size(); ++at)
    for (std::size_t c = 0; c < 3; ++c) append(bytes, static_cast<float>(stored(table, c, at)));
  return bytes;
}

void append_number(std::string& text, double value, char after) {
  if (std::isnan(value)) {
    text += "nan";  // without the sign that a NaN may carry
  } else {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  }
  text += after;
}

std::string csv_file(const Table& table) {
  std::string text = "theta_i_deg,theta_o_deg,phi_deg,r,g,b\n";
  const auto& bins = table.grid.bins;
  std::size_t at = 0;
  for (int i = 0; i < bins[0]; ++i)
    for (int j = 0; j < bins[1]; ++j)
      for (int k = 0; k < bins[2]; ++k, ++at) {
        if (table.state[at] == State::kInvalid || table.state[at] == State::kBelowHorizon) continue;
        append_number(text, (i + 0.5) * 90 / bins[0], ',');
        append_number(text, (j + 0.5) * 90 / bins[1], ',');
        append_number(text, (k + 0.5) * 180 / bins[2], ',');
        append_number(text, table.f[0][at], ',');
        append_number(text, table.f[1][at], ',');
        append_number(text, table.f[2][at], '\n');
      }
  return text;
}

}  // namespace

Grid grid_of(Format format, int theta, int phi) {
  if (format == Format::kMerl) return {};
  return {format, {theta, theta, phi}};
}

brdf::Geometry<double> geometry_of(const Grid& grid, int i, int j, int k) {
  const double a = (i + grid.within) / grid.bins[0], b = (j + grid.within) / grid.bins[1],
               c = (k + grid.within) / grid.bins[2];
  if (grid.format == Format::kMerl) return brdf::geometry_at(a * a * 90 * kDegree, b * 90 * kDegree, c * 180 * kDegree);
  const double theta_i = a * 90 * kDegree, theta_o = b * 90 * kDegree, phi = c * 180 * kDegree;
  return {{std::sin(theta_i), 0, std::cos(theta_i)},
          {std::sin(theta_o) * std::cos(phi), std::sin(theta_o) * std::sin(phi), std::cos(theta_o)}};
}

Table tabulate(const brdf::AnyBrdf& brdf, const Grid& grid, int threads) {
  Table table{grid, {}, std::vector<State>(grid.size(), State::kBelowHorizon)};
  for (auto& channel : table.f) channel.resize(grid.size());
  std::visit(
      [&](const auto& model) {
        spread(grid.bins[0], threads, [&](int i) {
          std::size_t at = std::size_t(i) * std::size_t(grid.bins[1]) * std::size_t(grid.bins[2]);
          for (int j = 0; j < grid.bins[1]; ++j)
            for (int k = 0; k < grid.bins[2]; ++k, ++at) {
              const brdf::Geometry<double> g = geometry_of(grid, i, j, k);
              if (!g.above) continue;
              const brdf::Rgb<double> f = model.eval(g);
              table.state[at] = State::kMeasured;
              table.f[0][at] = f.r;
              table.f[1][at] = f.g;
              table.f[2][at] = f.b;
            }
        });
      },
      brdf);
  return table;
}

std::string bytes_of(const Table& table) {
  switch (table.grid.format) {
    case Format::kMbsdf:
      return mbsdf_file(table);
    case Format::kCsv:
      return csv_file(table);
    default:
      return merl_file(table);
  }
}

}  // namespace likeness::datasets_synthetic
