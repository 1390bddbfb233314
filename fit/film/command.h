#pragma once

namespace CLI {
class App;
}

namespace likeness::film {

// Adds `likeness film`. The subcommand runs when it is parsed, and sets exit_code to what the program shall end with.
// Throws files::UsageError and files::InputError. exit_code outlives program.
void add_film(CLI::App& program, int& exit_code);

}  // namespace likeness::film
