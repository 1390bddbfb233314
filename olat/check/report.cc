#include <string>

#include <nlohmann/json.hpp>

#include "olat/check/check.h"
#include "olat/check/finder.h"

namespace likeness::olat_check {
namespace {

std::string place_text(const Finding& f) {
  std::string text = f.camera.empty() ? "" : "camera " + f.camera;
  if (!f.light.empty()) text += (text.empty() ? "" : ", ") + ("light " + f.light);
  return text.empty() ? "" : text + ": ";
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace

std::string text_of(const Report& report, const capture::Capture& capture) {
  std::string out;
  std::size_t errors = 0;
  const RuleRow* above = nullptr;
  for (const Finding& f : report.findings) {
    const RuleRow& row = row_of(f.rule);
    if (&row != above)
      out += (above == nullptr ? "" : "\n") + std::string(kSeverities[static_cast<std::size_t>(row.severity)]) + " " +
             std::string(row.id) + ": " + std::string(row.text) + "\n  allowed " + number(row.allowed) + " " +
             std::string(row.unit) + "; way out: " + std::string(row.way_out) + "\n";
    above = &row;
    errors += row.severity == Severity::kError ? 1 : 0;
    out += "  " + place_text(f) + f.text + (f.file.empty() ? "" : " (" + f.file + ")") + "\n";
  }
  std::string measured;
  for (const Measured& m : report.measured)
    measured += "  " + std::string(row_of(m.rule).id) + " of camera " + m.camera + ": " + m.text + "\n";
  if (!measured.empty()) out += (out.empty() ? "" : "\n") + ("measured\n" + measured);
  std::string skipped;
  for (const NotChecked& n : report.not_checked)
    skipped += "  " + std::string(row_of(n.rule).id) + (n.camera.empty() ? "" : " of camera " + n.camera) + ": " +
               n.reason + "\n";
  if (!skipped.empty()) out += (out.empty() ? "" : "\n") + ("not checked\n" + skipped);
  out += (out.empty() ? "" : "\n") + (capture.name.empty() ? "" : capture.name + ": ") +
         counted(capture.cameras.size(), "camera") + ", " + counted(capture.lights.size(), "light") + ", " +
         counted(report.photos, "photo") + " and " + counted(report.renders, "render") + " read; " +
         (report.findings.empty()
              ? "nothing found"
              : counted(errors, "error") + ", " + counted(report.findings.size() - errors, "warning")) +
         (report.is_complete ? "\n" : "; interrupted\n");
  return out;
}

std::string json_of(const Report& report, const capture::Capture& capture) {
  using Json = nlohmann::ordered_json;
  Json findings = Json::array(), not_checked = Json::array();
  for (const Finding& f : report.findings) {
    const RuleRow& row = row_of(f.rule);
    Json one{{"rule", row.id}, {"severity", kSeverities[static_cast<std::size_t>(row.severity)]}};
    if (!f.camera.empty()) one["camera"] = f.camera;
    if (!f.light.empty()) one["light"] = f.light;
    if (!f.file.empty()) one["file"] = f.file;
    one["value"] = f.value;
    one["allowed"] = row.allowed;
    one["unit"] = row.unit;
    one["text"] = f.text;
    one["way_out"] = row.way_out;
    findings.push_back(std::move(one));
  }
  Json measured = Json::array();
  for (const Measured& m : report.measured)
    measured.push_back({{"rule", row_of(m.rule).id}, {"camera", m.camera}, {"value", m.value}, {"text", m.text}});
  for (const NotChecked& n : report.not_checked) {
    Json one{{"rule", row_of(n.rule).id}};
    if (!n.camera.empty()) one["camera"] = n.camera;
    one["reason"] = n.reason;
    not_checked.push_back(std::move(one));
  }
  const Json out{{"type", "olat check"},           {"version", 1},
                 {"capture", capture.name},        {"variant", report.variant},
                 {"photos", report.photos},        {"renders", report.renders},
                 {"complete", report.is_complete}, {"findings", findings},
                 {"measured", measured},           {"not_checked", not_checked}};
  return out.dump(1) + "\n";
}

std::string rules_table() {
  std::string out =
      "| rule | | finds | allowed | why | needs | way out |\n| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const RuleRow& row : kRules)
    out += "| `" + std::string(row.id) + "` | " + std::string(kSeverities[static_cast<std::size_t>(row.severity)]) +
           " | " + std::string(row.text) + " | " + number(row.allowed) + " " + std::string(row.unit) + " | " +
           std::string(row.reason) + " | " + std::string(kNeeds[static_cast<std::size_t>(row.needs)]) + " | " +
           std::string(row.way_out) + " |\n";
  return out;
}

}  // namespace likeness::olat_check
