#pragma once

namespace CLI {
class App;
}

namespace likeness::realis {

// Adds `realis` to the program, and returns it: rooms above add their own commands. Throws files::UsageError and
// files::InputError.
CLI::App& add_realis(CLI::App& program, int& exit_code);

}  // namespace likeness::realis
