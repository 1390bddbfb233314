#pragma once

namespace CLI {
class App;
}

namespace likeness::expose {

// Subcommand `expose`. What it returns goes to `exit_code`.
void add_expose(CLI::App& program, int& exit_code);

}  // namespace likeness::expose
