#pragma once

namespace CLI {
class App;
}

namespace likeness::eval {

// Adds `likeness eval` to the program: the subcommand, its options and its help. The subcommand runs when it is
// parsed, and sets exit_code to what the program shall end with. Throws files::UsageError and files::InputError, which
// main turns into exit codes 2 and 3. exit_code outlives program.
void add_eval(CLI::App& program, int& exit_code);

}  // namespace likeness::eval
