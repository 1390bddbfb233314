#pragma once

namespace CLI {
class App;
}

namespace likeness::scene_cost {

// Makes `cost`, a subcommand that has subcommands of its own, take a scene too: `cost SCENE`. The exit code of a run goes
// to `exit_code`.
void add_scene(CLI::App& cost, int& exit_code);

}  // namespace likeness::scene_cost
