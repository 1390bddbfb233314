#pragma once

#include <string>

#include "render/command/integrators.h"
#include "render/command/request.h"
#include "render/plan/plan.h"
#include "render/scene/scene.h"

namespace likeness::render_command {

struct Times {
  double seconds = 0, cpu_seconds = 0;          // of the integrator
  double seconds_all = 0, cpu_seconds_all = 0;  // of the program until now
};

// What was made of what, and by what: the same for the same command on the same files. JSON, for the EXR.
std::string metadata_of(const std::string& file, const scene::Scene& scene, const plan::Plan& plan,
                        const reference::Options& options, const std::string& integrator, const Rendered& rendered);

// The same with times, memory and files. JSON, for --json.
std::string summary_json(const std::string& metadata, const scene::View& view, const Paths& paths,
                         const Rendered& rendered, const Times& times);

// For people: a line a file.
std::string summary_text(const scene::Scene& scene, const reference::Options& options, const Paths& paths,
                         const Rendered& rendered, const Times& times);

// CPU time of this process until now [s], and the most memory that it had at once [bytes].
double cpu_seconds();
std::size_t peak_memory();

}  // namespace likeness::render_command
