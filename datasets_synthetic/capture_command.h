#pragma once

namespace CLI {
class App;
}

namespace likeness::datasets_synthetic {

// Adds `capture` to `likeness make`. Throws files::UsageError and files::InputError.
void add_make_capture(CLI::App& make, int& exit_code);

}  // namespace likeness::datasets_synthetic
