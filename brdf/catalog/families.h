#pragma once

#include <span>
#include <vector>

#include "brdf/catalog/catalog.h"

namespace likeness::catalog {

// What the files of a family, made by CMakeLists.txt, offer. The loops of a set that the build has not are nullptr.
struct Family {
  void (*append)(std::vector<Entry>& entries);  // its entries, without the loops over batches
  void (*baseline)(Loops<float>* out);          // one for each of its entries, in order
  void (*avx2)(Loops<float>* out);
  void (*avx512)(Loops<float>* out);
};

std::span<const Family> families();

}  // namespace likeness::catalog
