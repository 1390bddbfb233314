#pragma once

namespace CLI {
class App;
}

namespace likeness::olat_compare {

// Adds `compare` to `likeness olat`. Throws files::UsageError.
void add_compare(CLI::App& olat, int& exit_code);

}  // namespace likeness::olat_compare
