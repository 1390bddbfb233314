#pragma once

namespace CLI {
class App;
}

namespace likeness::olat {

// Adds the group `likeness olat` to the program. Each room of olat adds its own subcommand to what is returned, by a
// function `void add_NAME(CLI::App& olat, int& exit_code)` of its command.h, which main calls.
CLI::App& add_olat(CLI::App& program);

}  // namespace likeness::olat
