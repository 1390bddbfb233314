#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "olat/compare/compare.h"
#include "render/files/files.h"

namespace likeness::olat_compare {
namespace {

using Json = nlohmann::ordered_json;
using metric::kStatistics;
using metric::Summary;

constexpr std::size_t kWorst = 5;

std::string padded(std::string text, std::size_t width, bool left = false) {
  if (text.size() < width) text.insert(left ? text.size() : 0, width - text.size(), ' ');
  return text;
}

std::string four_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

// RFC 4180
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

// The summaries of a metric over the rows for which `keep` is true.
template <class Keep>
Summary total_of(const Comparison& comparison, std::size_t metric, const Keep& keep) {
  std::vector<const Summary*> all;
  for (const Row& row : comparison.rows)
    if (row.state == State::kCompared && keep(row)) all.push_back(&row.summaries[metric]);
  return total(all);
}

// Rows by their rms of the first metric, worst first.
std::vector<const Row*> worst_rows(const Comparison& comparison, std::size_t metric, std::size_t count) {
  std::vector<const Row*> rows;
  for (const Row& row : comparison.rows)
    if (row.state == State::kCompared) rows.push_back(&row);
  std::ranges::stable_sort(rows, std::ranges::greater{}, [&](const Row* r) { return r->summaries[metric].rms; });
  rows.resize(std::min(rows.size(), count));
  return rows;
}

std::map<State, std::size_t> states_of(const Comparison& comparison) {
  std::map<State, std::size_t> count;
  for (const Row& row : comparison.rows) ++count[row.state];
  return count;
}

Json json_of_summary(const Summary& summary) {
  Json out;
  for (const auto& statistic : kStatistics) out[std::string(statistic.id)] = summary.*statistic.value;
  out["pixels"] = summary.pixels;
  if (summary.not_finite > 0) out["not_finite"] = summary.not_finite;
  return out;
}

template <class Keep>
Json json_of_totals(const Comparison& comparison, const Keep& keep) {
  Json out = Json::object();
  for (std::size_t k = 0; k < comparison.metrics.size(); ++k)
    out[std::string(metric::row_of(comparison.metrics[k]).id)] = json_of_summary(total_of(comparison, k, keep));
  return out;
}

// Totals, and the pairs that are farthest apart.
std::string totals_text(const Comparison& comparison, const capture::Capture& capture) {
  std::string out = padded("metric", 10, true);
  for (const auto& statistic : kStatistics) out += padded(std::string(statistic.id), 10);
  out += "  unit\n";
  for (std::size_t k = 0; k < comparison.metrics.size(); ++k) {
    const metric::MetricRow& row = metric::row_of(comparison.metrics[k]);
    const Summary summary = total_of(comparison, k, [](const Row&) { return true; });
    out += padded(std::string(row.id), 10, true);
    for (const auto& statistic : kStatistics) out += padded(four_digits(summary.*statistic.value), 10);
    out += "  " + std::string(row.unit) + "\n";
  }
  out += "\nworst pairs by the rms of " + std::string(metric::row_of(comparison.metrics[0]).id) + "\n";
  for (const Row* row : worst_rows(comparison, 0, kWorst)) {
    const Summary& s = row->summaries[0];
    out += "  camera " + capture.cameras[row->camera].id + ", light " + capture.lights[row->light].id + ": rms " +
           four_digits(s.rms) + ", median " + four_digits(s.median) + ", p95 " + four_digits(s.p95) + "\n";
  }
  return out;
}

}  // namespace

std::string table_of(const Comparison& comparison, const capture::Capture& capture) {
  const auto states = states_of(comparison);
  std::string out =
      states.contains(State::kCompared) ? totals_text(comparison, capture) : std::string("nothing was compared\n");
  for (const Row& row : comparison.rows)
    if (!row.fault.empty()) out += std::string(kStates[static_cast<std::size_t>(row.state)]) + ": " + row.fault + "\n";
  out += "\n";
  std::string counts;
  for (const auto& [state, count] : states)
    counts += (counts.empty() ? "" : ", ") + std::to_string(count) + " " +
              std::string(kStates[static_cast<std::size_t>(state)]);
  out += (counts.empty() ? "no pairs" : counts) + "; variant " + comparison.variant + ", match gain " +
         std::string(kMatches[static_cast<std::size_t>(comparison.match)].word) + ", weight " +
         std::string(kWeights[static_cast<std::size_t>(comparison.weight)].word) + ", view " + comparison.view +
         ", exposure " + four_digits(comparison.ev) + " stops, HDR-FLIP from " + four_digits(capture.flip_first_ev) +
         " to " + four_digits(capture.flip_last_ev) + " stops\n";
  for (std::size_t camera = 0; camera < comparison.noise_floor.size() && camera < 3; ++camera) {
    const auto& n = comparison.noise_floor[camera];
    out += "noise floor of camera " + capture.cameras[camera].id + ": " + four_digits(n[0]) + " " + four_digits(n[1]) +
           " " + four_digits(n[2]) + (comparison.noise_is_measured[camera] ? " (measured now)" : " (cameras.json)") +
           "\n";
  }
  if (comparison.noise_floor.size() > 3) out += "the noise floors of the other cameras are in --json\n";
  return out;
}

std::string csv_of(const Comparison& comparison, const capture::Capture& capture) {
  std::string out = "camera,light,state,metric,unit";
  for (const auto& statistic : kStatistics) out += "," + std::string(statistic.id);
  out += ",pixels,not_finite,gain_r_ev,gain_g_ev,gain_b_ev,clipped\n";
  for (const Row& row : comparison.rows) {
    const std::string place = quoted(capture.cameras[row.camera].id) + "," + quoted(capture.lights[row.light].id) +
                              "," + std::string(kStates[static_cast<std::size_t>(row.state)]);
    if (row.state != State::kCompared) {
      out += place + ",,,,,,,,,,,,,\n";
      continue;
    }
    for (std::size_t k = 0; k < comparison.metrics.size(); ++k) {
      const metric::MetricRow& metric = metric::row_of(comparison.metrics[k]);
      out += place + "," + std::string(metric.id) + "," + std::string(metric.unit);
      for (const auto& statistic : kStatistics) out += "," + files::number_text(row.summaries[k].*statistic.value);
      out += "," + std::to_string(row.summaries[k].pixels) + "," + std::to_string(row.summaries[k].not_finite);
      for (const double gain : row.gain_ev) out += "," + files::number_text(gain);
      out += "," + std::to_string(row.clipped) + "\n";
    }
  }
  return out;
}

std::string json_of(const Comparison& comparison, const capture::Capture& capture) {
  Json rows = Json::array(), metrics = Json::array(), cameras = Json::array(), lights = Json::array(),
       worst = Json::array();
  for (const auto metric : comparison.metrics) {
    const metric::MetricRow& row = metric::row_of(metric);
    metrics.push_back({{"id", row.id}, {"unit", row.unit}, {"signed", row.is_signed}, {"text", row.text}});
  }
  for (const Row& row : comparison.rows) {
    Json one{{"camera", capture.cameras[row.camera].id},
             {"light", capture.lights[row.light].id},
             {"state", kStates[static_cast<std::size_t>(row.state)]}};
    if (!row.fault.empty()) one["fault"] = row.fault;
    if (row.state == State::kCompared) {
      one["gain_ev"] = row.gain_ev;
      one["weight"] = row.weight;
      one["clipped"] = row.clipped;
      for (std::size_t k = 0; k < comparison.metrics.size(); ++k)
        one["metrics"][std::string(metric::row_of(comparison.metrics[k]).id)] = json_of_summary(row.summaries[k]);
    }
    rows.push_back(std::move(one));
  }
  for (std::size_t i = 0; i < capture.cameras.size(); ++i) {
    if (std::ranges::none_of(comparison.rows, [&](const Row& r) { return r.camera == i; })) continue;
    cameras.push_back({{"camera", capture.cameras[i].id},
                       {"noise_floor", comparison.noise_floor[i]},
                       {"noise_floor_from", comparison.noise_is_measured[i] ? "photos" : "cameras.json"},
                       {"metrics", json_of_totals(comparison, [&](const Row& r) { return r.camera == i; })}});
  }
  for (std::size_t i = 0; i < capture.lights.size(); ++i) {
    if (std::ranges::none_of(comparison.rows, [&](const Row& r) { return r.light == i; })) continue;
    lights.push_back({{"light", capture.lights[i].id},
                      {"metrics", json_of_totals(comparison, [&](const Row& r) { return r.light == i; })}});
  }
  for (std::size_t k = 0; k < comparison.metrics.size(); ++k)
    for (const Row* row : worst_rows(comparison, k, kWorst))
      worst.push_back({{"metric", metric::row_of(comparison.metrics[k]).id},
                       {"camera", capture.cameras[row->camera].id},
                       {"light", capture.lights[row->light].id},
                       {"rms", row->summaries[k].rms}});
  Json counts = Json::object();
  for (const auto& [state, count] : states_of(comparison))
    counts[std::string(kStates[static_cast<std::size_t>(state)])] = count;
  const Json out{{"type", "olat compare"},
                 {"version", 1},
                 {"capture", capture.name},
                 {"variant", comparison.variant},
                 {"match_gain", kMatches[static_cast<std::size_t>(comparison.match)].word},
                 {"weight", kWeights[static_cast<std::size_t>(comparison.weight)].word},
                 {"view", comparison.view},
                 {"ev", comparison.ev},
                 {"flip", {{"first_ev", capture.flip_first_ev}, {"last_ev", capture.flip_last_ev}}},
                 {"complete", comparison.is_complete},
                 {"pairs", counts},
                 {"metrics", metrics},
                 {"total", json_of_totals(comparison, [](const Row&) { return true; })},
                 {"worst", worst},
                 {"cameras", cameras},
                 {"lights", lights},
                 {"rows", rows}};
  return out.dump(1) + "\n";
}

}  // namespace likeness::olat_compare
