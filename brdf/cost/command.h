#pragma once

namespace CLI {
class App;
}

namespace likeness::cost {

// Adds `cost` with its subcommand `evaluators`, and returns it: other rooms may add to it. The exit code of a run goes to
// `exit_code`.
CLI::App& add_cost(CLI::App& program, int& exit_code);

}  // namespace likeness::cost
