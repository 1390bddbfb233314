#include <cstdio>
#include <filesystem>

#include "render/files/files.h"
#include "render/scene/format.h"
#include "tests/render/scene/pages.h"

// write_scene_pages DOCS: rewrites the tables of DOCS/scene.md and DOCS/schema/scene.schema.json (the target
// scene_pages).
int main(int count, char** arguments) {
  using namespace likeness;
  if (count != 2) return std::fputs("usage: write_scene_pages DOCS\n", stderr), 2;
  const std::filesystem::path docs = arguments[1];
  files::write_whole(docs / "schema" / "scene.schema.json", scene::schema_text());
  std::string page = files::read_whole(docs / "scene.md", 1 << 20);
  int failed = 0;
  for (const std::string& section : scene::section_names())
    if (!scene::test::put_table(page, section, scene::table_text(section))) {
      std::fprintf(stderr, "scene.md: has no \"<!-- table: %s -->\" with an \"<!-- end -->\"\n", section.c_str());
      failed = 3;
    }
  files::write_whole(docs / "scene.md", page);
  return failed;
}
