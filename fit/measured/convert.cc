#include "fit/measured/convert.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <numbers>
#include <thread>

#include "fit/measured/csv.h"
#include "fit/measured/merl.h"
#include "fit/measured/refuse.h"

namespace likeness::measured {
namespace {

constexpr double kAll = 4 * std::numbers::pi * std::numbers::pi;  // all pairs of directions, [sr^2]

Format format_to_write(const ConvertOptions& options) {
  const std::string extension = options.out.extension().string();
  if (extension == ".binary") return Format::kMerl;
  if (extension == ".csv") return Format::kCsv;
  throw files::UsageError("output " + options.out.string() + " has the extension \"" + extension +
                          "\"; write a name that ends in .binary (MERL) or .csv");
}

double directions(const Material& material) {
  double sum = 0;
  material.for_each_sample([&](const Sample& s) { sum += s.weight; });
  return sum / kAll;
}

void compare(const Material& source, const Material& written, Conversion& result) {
  std::vector<float> differences;
  source.for_each_sample([&](const Sample& s) {
    ++result.compared;
    Rgb g;
    if (!written.evaluate(s.to_light, s.to_view, g)) {
      ++result.lost;
      return;
    }
    const auto difference = [](double f, double other) { return 100 * std::abs(other - f) / (f + 0.001); };
    differences.push_back(float(std::max({difference(s.f.r, g.r), difference(s.f.g, g.g), difference(s.f.b, g.b)})));
  });
  if (differences.empty()) return;
  result.worst_pct = *std::max_element(differences.begin(), differences.end());
  const auto middle = differences.begin() + differences.size() / 2;
  std::nth_element(differences.begin(), middle, differences.end());
  result.median_pct = *middle;
}

// printf into a string.
__attribute__((format(printf, 1, 2))) std::string formatted(const char* format, ...) {
  char line[512];
  va_list arguments;
  va_start(arguments, format);
  const int length = std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  return std::string(line, std::clamp(length, 0, int(sizeof line) - 1));
}

double percent(std::size_t part, std::size_t whole) { return whole == 0 ? 0 : 100.0 * double(part) / double(whole); }

}  // namespace

std::vector<Rgb> merl_table_of(const Material& material) {
  const MerlSize size;
  std::vector<Rgb> table(size.bins(), Rgb(-1));
  std::atomic<int> next = 0;
  const auto fill = [&] {
    for (int h = next++; h < size.theta_h; h = next++) {
      std::size_t bin = std::size_t(h) * size.theta_d * size.phi_d;
      for (int d = 0; d < size.theta_d; ++d)
        for (int p = 0; p < size.phi_d; ++p, ++bin) {
          const HalfAngles a = merl_bin_centre(size, h, d, p);
          const brdf::Geometry<double> g = brdf::geometry_at(a.theta_h, a.theta_d, a.phi_d);
          material.evaluate(g.to_light, g.to_view, table[bin]);
        }
    }
  };
  std::vector<std::jthread> others;
  for (unsigned i = 1; i < std::max(1u, std::thread::hardware_concurrency()); ++i) others.emplace_back(fill);
  fill();
  others.clear();
  return table;
}

Conversion convert(const ConvertOptions& options) {
  Conversion result;
  result.to = format_to_write(options);
  std::error_code ignored;
  if (std::filesystem::equivalent(options.in, options.out, ignored))
    throw files::UsageError("output " + options.out.string() + " is the input; write another name");
  const std::unique_ptr<Material> source = read(options.in);
  result.in = source->coverage();
  result.from = source->format();
  result.directions_in = directions(*source);
  result.resampled = result.to == Format::kMerl && result.from != Format::kMerl;

  std::string bytes = result.to == Format::kMerl ? merl_bytes(merl_table_of(*source)) : csv_text(*source);
  std::unique_ptr<Material> written;
  if (result.to == Format::kMerl) {
    files::write_whole(options.out, bytes);
    written = parse_merl(std::move(bytes), options.out.string());
  } else {
    // A CSV is written only if it can be read: a dense source may exceed its limits.
    if (bytes.size() > kLargestFile)
      refuse(options.in.string(), std::to_string(bytes.size() / 1000000) + " MB as CSV",
             "at most 128 MB; convert to .binary");
    written = parse_csv(bytes, options.out.string());
    files::write_whole(options.out, bytes);
  }
  result.out = written->coverage();
  result.directions_out = directions(*written);
  compare(*source, *written, result);
  return result;
}

std::string text_of(const Conversion& c, const ConvertOptions& options) {
  const auto lines = [](const char* title, const std::filesystem::path& file, Format format, const Coverage& k,
                        double share) {
    std::string text =
        formatted("%s  %s (%s)\n", title, file.string().c_str(), std::string(kFormatNames[int(format)]).c_str());
    text += formatted("  samples    %zu stored, %zu valid (%.1f %%), %.1f %% of all pairs of directions\n", k.stored,
                      k.valid, percent(k.valid, k.stored), 100 * share);
    const auto counted = [&](std::size_t n, const char* what) {
      if (n > 0) text += formatted("  %-10zu %s\n", n, what);
    };
    counted(k.negative, format == Format::kMerl ? "dropped: negative in a channel, not measured"
                                                : "dropped: negative in every channel");
    counted(k.not_finite, "dropped: NaN or Inf in a channel");
    counted(k.padding, "dropped: copies of the last measured angle in place of data");
    counted(k.repeats, "averaged: more samples of the same directions");
    counted(k.clipped, "clipped: a negative channel reads as 0");
    return text;
  };
  std::string text = lines("from", options.in, c.from, c.in, c.directions_in) +
                     lines("to  ", options.out, c.to, c.out, c.directions_out);
  text += c.resampled ? "  resampled: every bin holds the source's interpolant at the bin's centre\n"
                      : "  not resampled: every valid sample above the horizon was copied\n";
  text += formatted(
      "read back at the %zu valid samples of the source:\n  difference  median %.3g %%, worst %.3g %% (of f + 0.001 / "
      "sr)\n",
      c.compared, c.median_pct, c.worst_pct);
  text += formatted("  lost        %zu samples (%.2f %%) have no value in what was written\n", c.lost,
                    percent(c.lost, c.compared));
  return text;
}

int run_convert(const ConvertOptions& options) {
  const Conversion conversion = convert(options);
  const std::string report = options.json ? json_of(conversion, options) : text_of(conversion, options);
  std::fwrite(report.data(), 1, report.size(), stdout);
  return 0;
}

}  // namespace likeness::measured
