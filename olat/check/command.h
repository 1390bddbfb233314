#pragma once

namespace CLI {
class App;
}

namespace likeness::olat_check {

// Adds `check` to `likeness olat`. Throws files::UsageError and files::InputError.
void add_check(CLI::App& olat, int& exit_code);

}  // namespace likeness::olat_check
