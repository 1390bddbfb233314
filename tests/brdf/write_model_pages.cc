#include <cstdio>
#include <fstream>
#include <iterator>

#include "tests/brdf/model_table.h"

// Rewrites the parameter table in each page of docs/models (the target docs_tables). Argument: that folder.
int main(int count, char** arguments) {
  using namespace likeness::brdf;
  if (count != 2) return std::fputs("usage: write_model_pages FOLDER\n", stderr), 2;
  int failed = 0;
  for_each_model([&]<class M>(const M&) {
    const std::string path = std::string(arguments[1]) + "/" + std::string(M::kName) + ".md";
    std::ifstream in(path);
    std::string page{std::istreambuf_iterator<char>(in), {}};
    const Span span = table_span(page, M::kName);
    if (span.first == 0) {
      std::fprintf(stderr, "%s: no line \"<!-- table: %s -->\" followed by \"<!-- end -->\"; add both\n", path.c_str(),
                   M::kName.data());
      failed = 3;
      return;
    }
    page.replace(span.first, span.count, markdown_table<M>());
    std::ofstream(path) << page;
  });
  return failed;
}
