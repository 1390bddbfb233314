#pragma once

namespace CLI {
class App;
}

// Photographs to linear light: the subcommands raw and hdr.
namespace likeness::olat_photograph {

void add_raw(CLI::App& program, int& exit_code);
void add_hdr(CLI::App& program, int& exit_code);

}  // namespace likeness::olat_photograph
