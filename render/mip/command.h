#pragma once

namespace CLI {
class App;
}

namespace likeness::mip {

// Adds `likeness mip` to the program: levels of a normal map whose lost bumps become roughness. Throws files::UsageError
// and files::InputError.
void add_mip(CLI::App& program, int& exit_code);

}  // namespace likeness::mip
