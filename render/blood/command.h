#pragma once

namespace CLI {
class App;
}

namespace likeness::blood {

// Adds `likeness blood` with palette, example and spatter. They run when they are parsed; throw files::UsageError and
// files::InputError.
void add_blood(CLI::App& program);

}  // namespace likeness::blood
