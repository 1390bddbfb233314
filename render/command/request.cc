#include "render/command/request.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "render/command/camera_choice.h"
#include "render/files/files.h"
#include "render/view/view_list.h"

namespace likeness::render_command {
namespace {

using files::UsageError;
namespace fs = std::filesystem;

constexpr double kMostSamples = 16'777'216;  // what the state of a film counts to
constexpr double kSamplesWithoutNumber = 65536;

double within(const char* option, double value, double low, double high, const char* unit = "") {
  if (value >= low && value <= high) return value;
  throw UsageError(std::string(option) + " " + files::number_text(value) + " is outside [" + files::number_text(low) +
                   ", " + files::number_text(high) + "]" + unit);
}
double whole_within(const char* option, double value, double low, double high) {
  within(option, value, low, high);
  if (value == std::floor(value)) return value;
  throw UsageError(std::string(option) + " " + files::number_text(value) + " is no whole number");
}

void check_ending(const char* option, const fs::path& file, std::string_view ending) {
  if (file.filename().empty() || file.extension() != ending)
    throw UsageError(std::string(option) + " " + files::in_quotes(file.string()) + " is no " +
                     std::string(ending.substr(1)) + " file; expected a name that ends with " + std::string(ending));
}

}  // namespace

Paths paths_of(const Request& r) {
  Paths p;
  p.picture = r.out.empty() ? fs::path(r.scene).stem().concat(".exr") : fs::path(r.out);
  check_ending("--out", p.picture, ".exr");
  if (r.no_png && !r.png.empty()) throw UsageError("--png and --no-png exclude each other; give one of them");
  if (!r.no_png) p.png = r.png.empty() ? fs::path(p.picture).replace_extension(".png") : fs::path(r.png);
  if (!p.png.empty()) check_ending("--png", p.png, ".png");
  p.preview = r.preview;
  if (!p.preview.empty()) check_ending("--preview", p.preview, ".png");
  if (!p.preview.empty() && p.preview.lexically_normal() == p.png.lexically_normal())
    throw UsageError("--preview " + files::in_quotes(r.preview) +
                     " is where the finished picture goes; give it another name");
  p.state = fs::path(p.picture).replace_extension(".state.exr");
  return p;
}

reference::Options options_of(const Request& r) {
  reference::Options o;
  o.seconds = within("--time", r.seconds, 0, 1e9, " s (0: no limit)");
  o.relative_error = within("--error", r.relative_error, 0, 1e9, " (0: no limit)");
  const bool has_another_end = o.seconds > 0 || o.relative_error > 0;
  const double samples = r.samples.value_or(has_another_end ? kSamplesWithoutNumber : o.samples);
  o.samples = static_cast<std::uint32_t>(whole_within("--spp", samples, 1, kMostSamples));
  o.seed = static_cast<std::uint32_t>(whole_within("--seed", r.seed, 0, 4294967295.0));
  o.max_bounces = static_cast<int>(whole_within("--bounces", r.bounces, 0, 1e6));
  o.threads = static_cast<int>(whole_within("--threads", r.threads, 0, 1024));
  o.has_layers = r.has_layers;
  return o;
}

const Integrator& integrator_of(const Request& r) {
  std::string names;
  std::vector<std::string_view> known;
  for (const Integrator& row : integrators()) {
    if (row.name == r.integrator) return row;
    names += (names.empty() ? "" : ", ") + std::string(row.name);
    known.push_back(row.name);
  }
  const std::string near = files::nearest_name(r.integrator, known.data(), known.size());
  throw UsageError("--integrator " + files::in_quotes(r.integrator) + " is not one of " + names +
                   (near.empty() ? "" : "; did you mean " + near + "?"));
}

bool is_forced(const std::string& force) {
  if (!force.empty() && force != "all")
    throw UsageError("--force " + files::in_quotes(force) + ": only all can be forced");
  return !force.empty();
}

std::optional<exposure::Mode> exposure_of(const Request& r) {
  if (r.expose.empty()) return std::nullopt;
  if (r.ev) throw UsageError("--ev and --expose exclude each other; give one of them");
  std::string names;
  for (const exposure::ModeRow& row : exposure::kModes) {
    if (row.needs_patch) continue;
    if (row.name == r.expose) return row.mode;
    names += (names.empty() ? "" : ", ") + std::string(row.name);
  }
  throw UsageError("--expose " + files::in_quotes(r.expose) + " is not one of " + names +
                   " (likeness expose has those that need a patch)");
}

void apply(const Request& r, scene::Scene& scene, std::size_t camera) {
  if (!r.size.empty()) resize(scene.cameras[camera], size_of(r.size));
  scene::View& view = scene.view;
  if (r.ev) view.ev = *r.ev;
  if (r.view) view.name = *r.view;
  if (r.display) view.display = *r.display;
  if (r.config) view.config = *r.config;
  if (!r.view && (r.display || r.config)) view.name.clear();  // their default view
  view = view::with_defaults(view);
}

}  // namespace likeness::render_command
