#pragma once

namespace CLI {
class App;
}

namespace likeness::realis {

// Adds `report` to `realis`. Throws files::UsageError and files::InputError.
void add_report(CLI::App& realis, int& exit_code);

}  // namespace likeness::realis
