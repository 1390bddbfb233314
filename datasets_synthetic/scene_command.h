#pragma once

namespace CLI {
class App;
}

namespace likeness::datasets_synthetic {

// Adds `scene` to `likeness make`.
void add_make_scene(CLI::App& make, int& exit_code);

}  // namespace likeness::datasets_synthetic
