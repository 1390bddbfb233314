#pragma once

namespace CLI {
class App;
}

namespace likeness::bloom {

// Adds `likeness bloom` with fit and apply. They run when they are parsed; throw files::UsageError and files::InputError.
void add_bloom(CLI::App& program);

}  // namespace likeness::bloom
