#include "realis/command.h"

#include <CLI/CLI.hpp>

#include "realis/apply_command.h"
#include "realis/bake_command.h"

namespace likeness::realis {

CLI::App& add_realis(CLI::App& program, int& exit_code) {
  CLI::App* realis = program.add_subcommand("realis", "Bake what renders lack of photographs, and give it back");
  realis->require_subcommand(1);
  add_bake(*realis, exit_code);
  add_apply(*realis, exit_code);
  return *realis;
}

}  // namespace likeness::realis
