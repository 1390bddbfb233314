#pragma once

namespace CLI {
class App;
}

namespace likeness::fit {

// Adds `likeness fit` to the program: the subcommand, its options and its help. The subcommand runs when it is
// parsed, and sets exit_code to what the program shall end with (0 done, 1 the check said no). Throws
// files::UsageError and files::InputError, which main turns into exit codes 2 and 3. exit_code outlives program. Returns
// the subcommand, to which fits of other things than measured materials are added.
CLI::App& add_fit(CLI::App& program, int& exit_code);

}  // namespace likeness::fit
