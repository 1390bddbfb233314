#pragma once

namespace CLI {
class App;
}

namespace likeness::olat_view {

// Adds `view`, `picture` and `report` to `likeness olat`. Throw files::UsageError and files::InputError.
void add_view(CLI::App& olat, int& exit_code);

}  // namespace likeness::olat_view
