#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include <nlohmann/json.hpp>

#include "render/cost/study.h"
#include "render/files/files.h"
#include "render/page/html.h"

namespace likeness::scene_cost {
namespace {

using Json = nlohmann::ordered_json;
using page::number;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// NaN is an empty field.
std::string field(double value) { return std::isfinite(value) ? files::number_text(value) : ""; }

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::string padded(const std::string& text, std::size_t width, bool right = true) {
  const auto letters =
      static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
  const std::string space(letters < width ? width - letters : 0, ' ');
  return right ? space + text : text + space;
}

std::string percent(double share) {
  char out[32];
  std::snprintf(out, sizeof out, "%+.1f %%", 100 * share);
  return out;
}

std::string line_of(const std::string& name, const Errors& e) {
  return padded(name, 34, false) + padded(number(e.relmse), 10) + padded(number(e.flip), 9) +
         padded(number(e.stops_median), 9) + padded(number(e.stops_p95), 9);
}

Json json_of(const Errors& e) {
  return {{"relmse", number_or_null(e.relmse)},
          {"flip", number_or_null(e.flip)},
          {"stops_median", number_or_null(e.stops_median)},
          {"stops_p95", number_or_null(e.stops_p95)}};
}

Json json_of(const Row::Timing& t) { return {{"median", t.median}, {"low", t.low}, {"high", t.high}}; }

Json json_of(const Study& study, const Levels& levels) {
  Json out = Json::object();
  for (std::size_t i = 0; i < kSettingCount; ++i)
    if (study.matters[i]) out[std::string(runtime::kSettings[i].name)] = runtime::kSettings[i].levels[levels[i]];
  return out;
}

Json json_of(const Study& study, const Row& row) {
  Json out;
  out["kind"] = row.is_path_tracer ? "path tracer" : "pipeline";
  if (row.is_path_tracer) out["samples"] = row.samples;
  else out["settings"] = json_of(study, row.levels);
  Json ladders = Json::array();
  for (std::size_t i = 0; i < kSettingCount; ++i)
    if (row.in_ladder[i]) ladders.push_back(runtime::kSettings[i].name);
  out["ladders"] = ladders;
  out["readings"] = row.readings.size();
  out["wall_ms"] = json_of(row.timing(false)), out["cpu_ms"] = json_of(row.timing(true));
  if (!row.is_path_tracer) {
    out["predicted_wall_ms"] = row.predicted_wall_ms, out["predicted_cpu_ms"] = row.predicted_cpu_ms;
    out["feeds_model"] = row.feeds_model;
  }
  out["errors"] = json_of(row.errors);
  out["dominated_by"] = row.dominated_by.empty() ? Json(nullptr) : Json(row.dominated_by);
  return out;
}

// Rows in the order of their time; the path tracer's last.
std::vector<const Row*> in_order(const Study& study) {
  std::vector<const Row*> rows;
  for (const Row& row : study.rows) rows.push_back(&row);
  std::stable_sort(rows.begin(), rows.end(), [&](const Row* a, const Row* b) {
    if (a->is_path_tracer != b->is_path_tracer) return b->is_path_tracer;
    return a->timing(study.options.counts_cpu).median < b->timing(study.options.counts_cpu).median;
  });
  return rows;
}

}  // namespace

std::string table_of(const Study& study) {
  const bool by_cpu = study.options.counts_cpu;
  std::string out =
      study.scene + ", " + std::to_string(study.width) + " x " + std::to_string(study.height) + " pixels, on " +
      study.machine.processor + ", " +
      (study.options.threads > 0 ? std::to_string(study.options.threads) : std::to_string(study.machine.cores)) +
      (study.options.threads == 1 || (study.options.threads == 0 && study.machine.cores == 1) ? " thread"
                                                                                              : " threads") +
      "\nreference: " + study.reference.source + "\n\n" + padded(by_cpu ? "CPU ms" : "ms", 10) +
      padded("quartiles", 18) + padded("predicted", 11) + "   " + padded("", 34, false) + padded("relMSE", 10) +
      padded("FLIP", 9) + padded("stops", 9) + padded("95 %", 9) + "\n";
  for (const Row* row : in_order(study)) {
    const Row::Timing t = row->timing(by_cpu);
    const double predicted = by_cpu ? row->predicted_cpu_ms : row->predicted_wall_ms;
    out += padded(number(t.median), 10) + padded(number(t.low) + " to " + number(t.high), 18) +
           padded(row->is_path_tracer ? "" : percent(predicted / t.median - 1), 11) +
           (row->dominated_by.empty() ? "   " : " * ") + line_of(name_of(study, *row), row->errors) + "\n";
  }
  const std::string indent(42, ' ');
  if (study.direct_only) out += "\n" + indent + line_of("light after one bounce, left out", *study.direct_only) + "\n";
  if (study.reference.noise) out += indent + line_of("noise of the reference", *study.reference.noise) + "\n";
  out += "\n*: another combination is faster by more than the quartiles, and no less exact by FLIP\n";
  if (const auto a = agreement_of(study))
    out += std::string("predicted: from the passes of ") + (a->is_of_others ? "other" : "all") +
           " frames; CPU time off by " + number(100 * a->median, 2) + " % in the middle, " + number(100 * a->worst, 2) +
           " % at most, of " + std::to_string(a->rows) + " rows\n";
  return out;
}

std::string csv_of(const Study& study) {
  std::string out = "kind,name";
  for (const runtime::SettingRow& row : runtime::kSettings) out += "," + std::string(row.name);
  out +=
      ",samples,readings,wall_ms,wall_ms_low,wall_ms_high,cpu_ms,cpu_ms_low,cpu_ms_high,predicted_wall_ms,"
      "predicted_cpu_ms,relmse,flip,stops_median,stops_p95,dominated_by\n";
  const auto errors = [](const Errors& e) {
    return field(e.relmse) + "," + field(e.flip) + "," + field(e.stops_median) + "," + field(e.stops_p95);
  };
  for (const Row* row : in_order(study)) {
    out += std::string(row->is_path_tracer ? "path tracer," : "pipeline,") + quoted(name_of(study, *row));
    for (std::size_t i = 0; i < kSettingCount; ++i)
      out +=
          "," +
          (row->is_path_tracer || !study.matters[i] ? "" : std::string(runtime::kSettings[i].levels[row->levels[i]]));
    out += "," + (row->is_path_tracer ? std::to_string(row->samples) : "") + "," + std::to_string(row->readings.size());
    for (const bool of_cpu : {false, true}) {
      const Row::Timing t = row->timing(of_cpu);
      out += "," + field(t.median) + "," + field(t.low) + "," + field(t.high);
    }
    out += "," + (row->is_path_tracer ? "," : field(row->predicted_wall_ms) + "," + field(row->predicted_cpu_ms));
    out += "," + errors(row->errors) + "," + (row->dominated_by.empty() ? "" : quoted(row->dominated_by)) + "\n";
  }
  const std::string none(kSettingCount + 11, ',');
  if (study.direct_only) out += "path tracer,direct light only" + none + errors(*study.direct_only) + ",\n";
  if (study.reference.noise)
    out += "path tracer,noise of the reference" + none + errors(*study.reference.noise) + ",\n";
  return out;
}

std::string json_of(const Study& study) {
  Json out;
  out["format"] = "likeness scene cost", out["version"] = 1;
  out["scene"] = study.scene, out["camera"] = study.camera, out["view"] = study.view;
  out["size"] = {study.width, study.height};
  out["machine"] = {{"processor", study.machine.processor}, {"cores", study.machine.cores}};
  out["threads"] = study.options.threads, out["repeats"] = study.options.repeats;
  out["longest_ms"] = study.options.longest_ms;
  out["time_is"] = study.options.counts_cpu ? "cpu_ms" : "wall_ms";
  out["is_complete"] = study.is_complete;
  out["share_of_surfaces"] = study.share_of_surfaces;
  out["reference"] = {{"source", study.reference.source}, {"seconds", study.reference.seconds}};
  if (study.reference.noise) out["reference"]["noise"] = json_of(*study.reference.noise);
  if (study.direct_only) out["direct_light_only"] = json_of(*study.direct_only);
  out["best"] = json_of(study, study.best), out["cheapest"] = json_of(study, study.cheapest);
  out["left_out"] = {{"too_long", study.left_out}, {"not_promising", study.not_promising}};
  out["model"] = {{"frame_cpu_ms", study.frame_ms}};
  for (const TimeModel::Part& part : study.parts) {
    Json levels;
    if (part.setting == kSettingCount) levels = number_or_null(part.ms.front());
    else
      for (std::size_t i = 0; i < part.ms.size(); ++i)
        levels[std::string(runtime::kSettings[part.setting].levels[i])] = number_or_null(part.ms[i]);
    out["model"]["cpu_ms_a_point"][part.pass] = levels;
  }
  if (const auto a = agreement_of(study))
    out["model"]["off"] = {{"median", a->median}, {"worst", a->worst}, {"rows", a->rows}};
  out["rows"] = Json::array();
  for (const Row* row : in_order(study)) out["rows"].push_back(json_of(study, *row));
  out["seconds"] = study.seconds;
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace likeness::scene_cost
