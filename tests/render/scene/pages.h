#pragma once

#include <cstddef>
#include <string>

namespace likeness::scene::test {

// Puts a table between "<!-- table: NAME -->" and "<!-- end -->" of a page; false if the page has no such place.
inline bool put_table(std::string& page, const std::string& name, const std::string& table) {
  const std::string mark = "<!-- table: " + name + " -->\n";
  const std::size_t at = page.find(mark);
  if (at == std::string::npos) return false;
  const std::size_t begin = at + mark.size(), end = page.find("<!-- end -->", begin);
  if (end == std::string::npos) return false;
  page.replace(begin, end - begin, table);
  return true;
}

}  // namespace likeness::scene::test
