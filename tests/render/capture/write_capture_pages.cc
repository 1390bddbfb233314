#include <cstdio>
#include <filesystem>

#include "render/files/files.h"
#include "tests/render/capture/sections.h"
#include "tests/render/scene/pages.h"

// write_capture_pages DOCS: rewrites the tables of DOCS/capture.md (the target capture_pages).
int main(int count, char** arguments) {
  using namespace likeness;
  if (count != 2) return std::fputs("usage: write_capture_pages DOCS\n", stderr), 2;
  const std::filesystem::path file = std::filesystem::path(arguments[1]) / "capture.md";
  std::string page = files::read_whole(file, 1 << 20);
  int failed = 0;
  for (const json::Section* section : capture::test::kSections)
    if (!scene::test::put_table(page, std::string(section->name), json::table_text(*section))) {
      std::fprintf(stderr, "capture.md: has no \"<!-- table: %s -->\"\n", std::string(section->name).c_str());
      failed = 3;
    }
  files::write_whole(file, page);
  return failed;
}
