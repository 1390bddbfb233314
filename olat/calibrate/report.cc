#include <array>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

#include "olat/calibrate/calibrate.h"
#include "olat/calibrate/undistort.h"
#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/image/write.h"

namespace likeness::olat_calibrate {
namespace {

namespace fs = std::filesystem;

std::string three_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

// The first of NAME.1.json, NAME.2.json, ... that is not there.
fs::path free_name(const fs::path& file) {
  for (int i = 1;; ++i) {
    const fs::path name = file.parent_path() / (file.stem().string() + "." + std::to_string(i) + ".json");
    std::error_code ignored;
    if (!fs::exists(name, ignored)) return name;
  }
}

std::filesystem::path flat_file_of(const capture::Capture& capture) {
  for (const auto& layer : capture.layers)
    if (layer.layer == capture::Layer::kFlatField && layer.file.is_relative()) return layer.file;
  return {};
}

}  // namespace

std::vector<std::string> write_result(const Result& result, const std::string& folder) {
  std::vector<std::string> lines;
  capture::Capture capture = result.capture;
  if (!folder.empty()) {
    capture = moved_to(result.capture, folder);
    if (!result.capture.variants.empty())
      lines.push_back("renders stay with the old capture; likeness olat render makes new ones");
    if (result.flat) {
      const fs::path flat = flat_file_of(result.capture);
      for (std::size_t i = 0; i < capture.layers.size(); ++i)
        if (result.capture.layers[i].file == flat) capture.layers[i].file = flat;
      image::write_exr(capture.root / flat, *result.flat);
    }
    capture::write_capture(capture);
    lines.push_back("written: " + (fs::path(folder) / "capture.json").string());
    return lines;
  }
  if (result.flat) {
    const fs::path file = capture.root / flat_file_of(capture);
    image::write_exr(file, *result.flat);
    lines.push_back("written: " + file.string());
  }
  std::set<std::string> changed;
  for (const Change& change : result.changes) changed.insert(change.file);
  const capture::CaptureTexts texts = capture::texts_of(capture);
  for (const std::string& name : changed) {
    const fs::path file = capture.root / name, old = free_name(file);
    files::write_whole(old, files::read_whole(file, capture::kMostCaptureBytes));
    files::write_whole(file, name == "lights.json"    ? texts.lights
                             : name == "cameras.json" ? texts.cameras
                                                      : texts.frames);
    lines.push_back("written: " + file.string() + " (before: " + old.filename().string() + ")");
  }
  return lines;
}

std::string text_of(const Result& result) {
  std::string out;
  for (const Change& change : result.changes)
    out += change.file + " " + change.id + ": " + change.what +
           (change.before.empty() ? " " : " from " + change.before + " to ") + change.after + "\n";
  if (result.chart) {
    out += "chart, against " + result.chart_space + " values, exposed by " + three_digits(result.chart->exposure_ev) +
           " stops\n  Delta E 2000        mean  largest (patch)\n";
    for (const Stage& stage : result.chart->stages) {
      std::string name(stage.name);
      name.resize(18, ' ');
      std::array<char, 64> numbers{};
      std::snprintf(numbers.data(), numbers.size(), "%6.2f  %7.2f (%zu)\n", stage.mean, stage.largest, stage.worst + 1);
      out += "  " + name + numbers.data();
    }
    for (std::size_t k = 1; k < 3; ++k)
      if (result.chart->stages[k].mean > result.chart->stages[k - 1].mean ||
          result.chart->stages[k].largest > result.chart->stages[k - 1].largest)
        out += "  " + std::string(result.chart->stages[k].name) + " is worse than " +
               std::string(result.chart->stages[k - 1].name) +
               ": are the corners, the reference and the light those of this chart?\n";
  }
  for (const std::string& note : result.notes) out += note + "\n";
  return out.empty() ? "nothing to change\n" : out;
}

std::string json_of(const Result& result) {
  using Json = nlohmann::ordered_json;
  Json changes = Json::array();
  for (const Change& c : result.changes)
    changes.push_back({{"file", c.file}, {"id", c.id}, {"what", c.what}, {"before", c.before}, {"after", c.after}});
  Json out{{"type", "olat calibrate"}, {"version", 1}, {"changes", changes}, {"notes", result.notes}};
  if (result.chart) {
    Json stages = Json::array(), matrix = Json::array();
    for (std::size_t k = 0; k < 3; ++k) {
      const Stage& stage = result.chart->stages[k];
      stages.push_back({{"name", stage.name},
                        {"mean", stage.mean},
                        {"largest", stage.largest},
                        {"worst_patch", stage.worst + 1},
                        {"delta_e", result.chart->delta_e[k]}});
    }
    for (int i = 0; i < 9; ++i) matrix.push_back(result.chart->matrix[i % 3][i / 3]);
    out["chart"] = {{"reference", result.chart_space},
                    {"exposure_ev", result.chart->exposure_ev},
                    {"stages", stages},
                    {"rec709_from_camera", matrix}};
  }
  return out.dump(1) + "\n";
}

}  // namespace likeness::olat_calibrate
