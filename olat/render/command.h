#pragma once

namespace CLI {
class App;
}

namespace likeness::olat_render {

// Adds `render` to `likeness olat`. Throws files::UsageError and files::InputError.
void add_render(CLI::App& olat, int& exit_code);

}  // namespace likeness::olat_render
