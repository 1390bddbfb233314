#pragma once

namespace CLI {
class App;
}

namespace likeness::realis {

// Adds `bake` to `likeness realis`. Throws files::UsageError and files::InputError.
void add_bake(CLI::App& realis, int& exit_code);

}  // namespace likeness::realis
