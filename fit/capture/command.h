#pragma once

namespace CLI {
class App;
}

namespace likeness::capture_fit {

// Adds `likeness fit capture`: a normal and a base color of each pixel and one material, from photographs under one light
// at a time. The exit code of a run goes to `exit_code`.
void add_capture(CLI::App& fit, int& exit_code);

}  // namespace likeness::capture_fit
