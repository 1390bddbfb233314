#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "olat/photograph/hdr.h"
#include "render/files/files.h"

namespace likeness::olat_photograph {
namespace {

using photograph::FrameReport;
using photograph::Merged;
using Json = nlohmann::ordered_json;

std::string cell_text(double value, const char* format) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::string shift_text(const FrameReport& report) {
  if (!report.shift || !std::isfinite(report.shift->sigma)) return "-";
  return cell_text(report.shift->dx, "%+.2f") + " " + cell_text(report.shift->dy, "%+.2f");
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

const char* weighting_name(photograph::Weighting weighting) {
  for (const auto& row : photograph::kWeightings)
    if (row.weighting == weighting) return row.name.data();
  return "";
}

}  // namespace

std::string text_of(const Merged& merged) {
  std::string out =
      "frame                     exposure [s]   well exposed   clipped   black   error [stop]   shift [pixel]\n";
  for (std::size_t k = 0; k < merged.reports.size(); ++k) {
    const FrameReport& r = merged.reports[k];
    std::array<char, 200> line{};
    std::snprintf(line.data(), line.size(), "%-24s  %12.6g   %10.1f %%   %5.1f %%  %4.1f %%   %12s   %s%s\n",
                  r.bracket.file.filename().string().substr(0, 24).c_str(), r.exposure, 100 * r.well_exposed,
                  100 * r.clipped, 100 * r.black, cell_text(merged.judgement.errors[k], "%+.3f").c_str(),
                  shift_text(r).c_str(), k == merged.reference ? "   reference" : "");
    out += line.data();
  }
  out += "response      " + merged.response.name;
  if (merged.recovered) {
    out += " from " + std::to_string(merged.recovered->used) + " pixels; unexplained";
    for (const double rms : merged.recovered->rms_stops) out += " " + cell_text(rms, "%.3f");
    out += " stops (red, green, blue)";
  }
  out += "\nweights       " + std::string(weighting_name(merged.weighting)) + "\nnot known     " +
         std::to_string(merged.unknown) + " pixels; clipped in every frame " + std::to_string(merged.clipped_in_all) +
         ", black in every frame " + std::to_string(merged.black_in_all) + "\nghosts        " +
         std::to_string(merged.ghosts) + " pixels (" +
         cell_text(100 * static_cast<double>(merged.ghosts) / static_cast<double>(merged.ghost.size()), "%.2f") + " %)";
  if (merged.taken_from_reference > 0)
    out += ", " + std::to_string(merged.taken_from_reference) + " taken from the reference";
  out += "\n";
  for (const std::string& warning : merged.warnings) out += "warning: " + warning + "\n";
  return out;
}

std::string json_of(const Merged& merged) {
  Json frames = Json::array();
  for (std::size_t k = 0; k < merged.reports.size(); ++k) {
    const FrameReport& r = merged.reports[k];
    Json frame{{"file", r.bracket.file.string()},
               {"exposure", r.exposure},
               {"is_light", r.is_light},
               {"well_exposed", r.well_exposed},
               {"clipped", r.clipped},
               {"black", r.black},
               {"ignored", r.ignored},
               {"error_stops", number_or_null(merged.judgement.errors[k])},
               {"moved", {r.moved_x, r.moved_y}}};
    if (r.shift) frame["shift"] = {{"x", r.shift->dx}, {"y", r.shift->dy}, {"sigma", number_or_null(r.shift->sigma)}};
    frames.push_back(std::move(frame));
  }
  Json out{{"width", merged.light.width},
           {"height", merged.light.height},
           {"response", merged.response.name},
           {"weights", weighting_name(merged.weighting)},
           {"frames", std::move(frames)},
           {"reference", merged.reports[merged.reference].bracket.file.filename().string()},
           {"noise_stops", merged.judgement.noise},
           {"unknown", merged.unknown},
           {"clipped_in_all", merged.clipped_in_all},
           {"black_in_all", merged.black_in_all},
           {"ghosts", merged.ghosts},
           {"taken_from_reference", merged.taken_from_reference},
           {"warnings", merged.warnings}};
  if (merged.recovered)
    out["recovered"] = {{"pixels", merged.recovered->used},
                        {"unexplained_stops", merged.recovered->rms_stops},
                        {"flattened", merged.recovered->flattened}};
  if (merged.suggested_ignored) out["suggested_ignore_color"] = *merged.suggested_ignored;
  return out.dump(1) + "\n";
}

double sensible_ev(const Merged& merged) {
  std::vector<float> light;
  const std::size_t step = std::max<std::size_t>(1, merged.confidence.size() / 100000);
  for (std::size_t i = 0; i < merged.confidence.size(); i += step) {
    const float* const rgb = merged.light.rgb.data() + 3 * i;
    const float y = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
    if (merged.confidence[i] > 0 && y > 0) light.push_back(y);
  }
  if (light.empty()) return 0;
  const auto at = light.begin() + static_cast<std::ptrdiff_t>(light.size() * 9 / 10);
  std::ranges::nth_element(light, at);
  return std::clamp(std::log2(0.5 / static_cast<double>(*at)), -90.0, 90.0);
}

}  // namespace likeness::olat_photograph
