#pragma once

namespace CLI {
class App;
}

namespace likeness::realis {

// Adds `export` to the command `realis`. Throws files::UsageError and files::InputError.
void add_export(CLI::App& realis, int& exit_code);

}  // namespace likeness::realis
