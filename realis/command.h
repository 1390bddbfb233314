#pragma once

namespace CLI {
class App;
}

namespace likeness::realis {

// Adds `realis` to the program. Throws files::UsageError and files::InputError.
void add_realis(CLI::App& program, int& exit_code);

}  // namespace likeness::realis
