#include "render/command/summary.h"

#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <ctime>

#include <nlohmann/json.hpp>

#include "render/plan/draw.h"

namespace likeness::render_command {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);  // names may be no UTF-8
}

std::string short_number(double value, const char* format = "%.3g") {
  char out[32];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

}  // namespace

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::string metadata_of(const std::string& file, const scene::Scene& scene, const plan::Plan& plan,
                        const reference::Options& options, const std::string& integrator, const Rendered& rendered) {
  const scene::Camera& camera = scene.cameras[options.camera];
  Json out;
  out["scene"] = file;
  out["camera"] = {{"index", options.camera}, {"name", camera.name}};
  out["size"] = {camera.width, camera.height};
  out["integrator"] = integrator;
  out["samples"] = rendered.samples;
  out["seed"] = options.seed;
  out["bounces"] = options.max_bounces;
  for (const auto& [name, level] : rendered.settings) out["settings"][std::string(name)] = level;
  out["finished"] = !rendered.is_interrupted;
  out["relative_error"] = number_or_null(rendered.relative_error);
  out["rejected_samples"] = rendered.rejected;
  out["repairs"] = Json::array();
  for (const scene::Repair& repair : scene.repairs)
    out["repairs"].push_back({{"what", repair.what}, {"where", repair.where}, {"count", repair.count}});
  Json on = Json::array();
  for (const plan::EffectRow& row : plan::kEffects)
    if (plan.has(row.effect)) on.push_back(row.name);
  out["plan"] = {{"digest", plan::digest_of(plan)}, {"forced", plan.is_forced}, {"on", on}};
  return text(out, -1);
}

std::string summary_json(const std::string& metadata, const scene::View& view, const Paths& paths,
                         const Rendered& rendered, const Times& times) {
  Json out = Json::parse(metadata);
  out["view"] = {{"name", view.name}, {"ev", view.ev}};
  out["samples_before"] = rendered.samples_before;
  out["seconds"] = times.seconds;
  out["cpu_seconds"] = times.cpu_seconds;
  out["seconds_all"] = times.seconds_all;
  out["cpu_seconds_all"] = times.cpu_seconds_all;
  out["peak_memory_bytes"] = peak_memory();
  out["files"] = {{"picture", paths.picture.string()}};
  if (!paths.png.empty()) out["files"]["png"] = paths.png.string();
  if (rendered.is_interrupted) out["files"]["state"] = paths.state.string();
  return text(out, 2) + "\n";
}

std::string summary_text(const scene::Scene& scene, const reference::Options& options, const Paths& paths,
                         const Rendered& rendered, const Times& times) {
  const scene::Camera& camera = scene.cameras[options.camera];
  std::string out = paths.picture.string() + "  " + std::to_string(camera.width) + " x " +
                    std::to_string(camera.height) + ", " + std::to_string(rendered.samples) +
                    (rendered.samples == 1 ? " sample" : " samples") + " a pixel in " + short_number(times.seconds) +
                    " s (" + short_number(times.cpu_seconds) + " s of CPU)";
  if (std::isfinite(rendered.relative_error))
    out += ", relative error " + short_number(rendered.relative_error, "%.2g");
  if (rendered.rejected > 0)
    out += "\n  " + std::to_string(rendered.rejected) + " samples were not finite or negative, and count as black";
  if (!paths.png.empty()) {
    const std::string ev = scene.view.ev == 0 ? "" : ", " + short_number(scene.view.ev, "%+g") + " stops";
    out += "\n" + paths.png.string() + "  as the view " + scene.view.name + " shows it" + ev;
  }
  return out + "\n";
}

}  // namespace likeness::render_command
