#include "olat/command.h"

#include <CLI/CLI.hpp>

namespace likeness::olat {

CLI::App& add_olat(CLI::App& program) {
  CLI::App* group = program.add_subcommand(
      "olat", "Photographs against renders, one light at a time: import, render, check, compare, look");
  group->require_subcommand(1);
  group->footer(R"(From photographs to a comparison
  likeness olat import photos/                  a capture: four small files beside your photographs, which stay as they are
  likeness olat render photos.capture --from-normals
                                                a render for each photograph (or --scene scene.json)
Manual: docs/capture.md, docs/olat_import.md, docs/olat_render.md)");
  return *group;
}

}  // namespace likeness::olat
