#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/brdf/model_table.h"

// Rewrites the tables in the pages of docs/models and the index in its README.md (the target docs_tables). Argument:
// that folder.
int main(int count, char** arguments) {
  using namespace likeness;
  namespace fs = std::filesystem;
  if (count != 2) return std::fputs("usage: write_model_pages FOLDER\n", stderr), 2;
  int failed = 0;
  std::map<std::string, std::string> page_of;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(arguments[1]))
    if (entry.path().extension() == ".md") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  const auto read = [](const fs::path& file) {
    std::ifstream in(file);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  const auto put = [&](const fs::path& file, std::string& page, const std::string& name, const std::string& table) {
    const brdf::Span span = brdf::table_span(page, name);
    if (span.first == 0) {
      std::fprintf(stderr, "%s: no line \"<!-- end -->\" after \"<!-- table: %s -->\"\n", file.c_str(), name.c_str());
      failed = 3;
    } else if (page.substr(span.first, span.count) != table) {
      page.replace(span.first, span.count, table);
      std::ofstream(file) << page;
    }
  };
  for (const fs::path& file : files) {
    std::string page = read(file);
    for (const std::string& name : brdf::tables_in(page)) {
      if (name == brdf::kIndex) continue;
      if (const catalog::Entry* entry = catalog::find(name)) {
        page_of[name] = file.filename().string();
        put(file, page, name, brdf::markdown_table(*entry));
      } else {
        std::fprintf(stderr, "%s: there is no model %s\n", file.c_str(), name.c_str());
        failed = 3;
      }
    }
  }
  for (const fs::path& file : files) {
    std::string page = read(file);
    for (const std::string& name : brdf::tables_in(page))
      if (name == brdf::kIndex) put(file, page, name, brdf::model_index(page_of));
  }
  for (const catalog::Entry& entry : catalog::entries())
    if (!page_of.contains(std::string(entry.name)))
      std::fprintf(stderr, "%s: no page has \"<!-- table: %s -->\"\n", arguments[1], entry.name.data());
  return failed;
}
