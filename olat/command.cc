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
  likeness olat check photos.capture            what is wrong with the capture
  likeness olat calibrate photos.capture --gain light
                                                the intensity of each light; --help has color, noise and lens
  likeness olat view photos.capture             the address of a page: arrow keys go on, Space flips photograph and render
  likeness olat compare photos.capture --out errors
                                                every metric of every pair
  likeness olat report photos.capture --out report.html
                                                one page to mail
Manual: docs/capture.md and a page a command: docs/olat_import.md, olat_render.md, olat_check.md, olat_calibrate.md,
olat_view.md, olat_compare.md)");
  return *group;
}

}  // namespace likeness::olat
