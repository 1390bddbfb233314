#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "render/command/integrators.h"
#include "render/exposure/pick.h"
#include "render/scene/scene.h"

namespace likeness::render_command {

// The command line of `likeness render`, as it was written.
struct Request {
  std::string scene, out, png, preview;
  bool no_png = false, json = false, resumes = false;
  std::string camera, size;
  std::optional<double> samples, ev;
  double seconds = 0, relative_error = 0, seed = 0, bounces = 64, threads = 0;
  bool has_layers = false, has_light_layers = false;
  std::string integrator = "reference", force;
  std::string quality;  // a file: of the run-time pipeline
  std::optional<std::string> view, display, config;
  std::string overlay = "none", expose;
  bool lists_views = false;
};

// The files of a render; empty: not wanted.
struct Paths {
  std::filesystem::path picture, png, state, preview;
};

// All throw files::UsageError, one line: option, value, what is allowed.
Paths paths_of(const Request& request);
reference::Options options_of(const Request& request);
const Integrator& integrator_of(const Request& request);
bool is_forced(const std::string& force);
// Of --expose; nothing: it is not given. Those that need a patch are of `likeness expose`.
std::optional<exposure::Mode> exposure_of(const Request& request);

// Where the command line says something of the view or the size, that.
void apply(const Request& request, scene::Scene& scene, std::size_t camera);

}  // namespace likeness::render_command
