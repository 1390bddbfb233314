#pragma once

namespace CLI {
class App;
}

namespace likeness::cost {

// Adds `cost evaluators`. The exit code of a run goes to `exit_code`.
void add_cost(CLI::App& program, int& exit_code);

}  // namespace likeness::cost
