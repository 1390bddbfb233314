#pragma once

namespace CLI {
class App;
}

namespace likeness::olat_view {

// Adds `view` and `picture` to `likeness olat`. Throw files::UsageError and files::InputError.
void add_view(CLI::App& olat, int& exit_code);

}  // namespace likeness::olat_view
