#pragma once

namespace CLI {
class App;
}

namespace likeness::olat_calibrate {

// Adds `calibrate` to `likeness olat`. Throws files::UsageError and files::InputError.
void add_calibrate(CLI::App& olat, int& exit_code);

}  // namespace likeness::olat_calibrate
