#pragma once

namespace CLI {
class App;
}

namespace likeness::realis {

// likeness realis ablate
void add_ablate(CLI::App& realis, int& exit_code);

}  // namespace likeness::realis
