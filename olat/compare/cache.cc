#include "olat/compare/cache.h"

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "render/files/files.h"

namespace likeness::olat_compare {
namespace {

constexpr std::string_view kHead = "likeness olat compare cache 1\n";
constexpr std::size_t kMostBytes = std::size_t{1} << 28;

// Exactly so many finite numbers, with a space between.
std::optional<std::vector<double>> numbers(const std::string& text, std::size_t count) {
  std::vector<double> out;
  const char* at = text.c_str();
  for (std::size_t i = 0; i < count; ++i) {
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    if (end == at || !std::isfinite(value)) return {};
    out.push_back(value);
    at = end;
  }
  return *at == '\0' ? std::optional(out) : std::nullopt;
}

std::string text_of(const std::vector<double>& values) {
  std::string out;
  for (const double v : values) out += (out.empty() ? "" : " ") + files::number_text(v);
  return out;
}

std::size_t count_of(double value) { return value > 0 && value < 1e18 ? static_cast<std::size_t>(value) : 0; }

}  // namespace

Cache::Cache(const std::string& file) : file_(file) {
  if (file_.empty()) return;
  std::string bytes;
  std::error_code ignored;
  if (std::filesystem::exists(file_, ignored)) {
    try {
      bytes = files::read_whole(file_, kMostBytes);
    } catch (const files::InputError&) {}
  }
  if (!bytes.starts_with(kHead)) {
    files::write_whole(file_, kHead);
    return;
  }
  std::size_t at = kHead.size();
  for (std::size_t end; (end = bytes.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string line = bytes.substr(at, end - at);
    const std::size_t first = line.find(' '), second = first == line.npos ? line.npos : line.find(' ', first + 1);
    if (second != line.npos) lines_[line.substr(0, second)] = line.substr(second + 1);
  }
  // A line that a killed run left without its end must not become part of the next one.
  if (at != bytes.size()) files::write_whole(file_, std::string_view(bytes).substr(0, at));
}

std::optional<metric::Summary> Cache::find(const std::string& key, metric::Metric metric) const {
  const std::scoped_lock lock(mutex_);
  const auto line = lines_.find(key + " " + std::string(metric::row_of(metric).id));
  if (line == lines_.end()) return {};
  const auto v = numbers(line->second, 7);
  if (!v) return {};
  return metric::Summary{(*v)[0], (*v)[1], (*v)[2], (*v)[3], (*v)[4], count_of((*v)[5]), count_of((*v)[6])};
}

std::optional<PairFacts> Cache::find(const std::string& key) const {
  const std::scoped_lock lock(mutex_);
  const auto line = lines_.find(key + " pair");
  if (line == lines_.end()) return {};
  const auto v = numbers(line->second, 5);
  if (!v) return {};
  return PairFacts{{(*v)[0], (*v)[1], (*v)[2]}, (*v)[3], count_of((*v)[4])};
}

void Cache::add(const std::string& key, metric::Metric metric, const metric::Summary& s) {
  append(key + " " + std::string(metric::row_of(metric).id),
         text_of({s.mean, s.median, s.p95, s.rms, s.largest, static_cast<double>(s.pixels),
                  static_cast<double>(s.not_finite)}));
}

void Cache::add(const std::string& key, const PairFacts& facts) {
  append(key + " pair", text_of({facts.gain_ev[0], facts.gain_ev[1], facts.gain_ev[2], facts.weight,
                                 static_cast<double>(facts.clipped)}));
}

void Cache::append(const std::string& name, const std::string& values) {
  if (file_.empty()) return;
  const std::scoped_lock lock(mutex_);
  lines_[name] = values;
  std::ofstream out(file_, std::ios::app | std::ios::binary);
  out << name + " " + values + "\n" << std::flush;
  if (!out) throw std::runtime_error(file_ + ": cannot be written to");
}

}  // namespace likeness::olat_compare
