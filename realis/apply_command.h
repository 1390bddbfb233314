#pragma once

namespace CLI {
class App;
}

namespace likeness::realis {

// Adds `apply` to `likeness realis`. Throws files::UsageError and files::InputError.
void add_apply(CLI::App& realis, int& exit_code);

}  // namespace likeness::realis
