#include <cstdio>
#include <filesystem>
#include <string>

#include "olat/check/check.h"
#include "render/files/files.h"
#include "tests/render/scene/pages.h"

// write_olat_pages DOCS: rewrites the tables of DOCS/olat_check.md (the target olat_pages).
int main(int count, char** arguments) {
  using namespace likeness;
  if (count != 2) return std::fputs("usage: write_olat_pages DOCS\n", stderr), 2;
  const std::filesystem::path file = std::filesystem::path(arguments[1]) / "olat_check.md";
  std::string page = files::read_whole(file, 1 << 20);
  if (!scene::test::put_table(page, "rules", olat_check::rules_table()))
    return std::fputs("olat_check.md: has no \"<!-- table: rules -->\"\n", stderr), 3;
  files::write_whole(file, page);
  return 0;
}
