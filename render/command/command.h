#pragma once

namespace CLI {
class App;
}

namespace likeness::render_command {

// Subcommands `render` and `plan`. What they return goes to `exit_code`.
void add_render(CLI::App& program, int& exit_code);
void add_plan(CLI::App& program, int& exit_code);

}  // namespace likeness::render_command
