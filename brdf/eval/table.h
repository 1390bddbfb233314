#pragma once

#include <string>
#include <vector>

#include "brdf/eval/rows.h"

namespace likeness::eval {

struct TableOptions {
  std::string in;   // a file, "-" for standard input; empty for one row of defaults
  std::string out;  // a file; empty for standard output
  std::vector<Assignment> assignments;
  Precision precision = Precision::kDouble;
  double tolerance = std::numeric_limits<double>::infinity();  // of the columns of references
  int threads = 0;                                             // 0: one a core; the output does not depend on it
};

// Evaluates a table of any size in bounded memory: blocks of rows are read, evaluated side by side and written in
// order. What the table leaves open, what it exceeds and how it compares is said on standard error. Returns 0, or 1 if
// a difference exceeds the tolerance. Throws files::InputError, files::UsageError and files::Interrupted; a file that
// is not finished does not appear.
int run_table(const catalog::Entry& entry, const TableOptions& options);

}  // namespace likeness::eval
