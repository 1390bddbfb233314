#pragma once

namespace CLI {
class App;
}

namespace likeness::olat_import {

// Add `import` and `export` to `likeness olat`. Throw files::UsageError and files::InputError.
void add_import(CLI::App& olat, int& exit_code);
void add_export(CLI::App& olat, int& exit_code);

}  // namespace likeness::olat_import
