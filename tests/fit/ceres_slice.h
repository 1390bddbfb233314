#pragma once

namespace likeness::fit::test {

// One search on the coarse slice of a known material, full tier of Callisto, from a drawn start.
struct Search {
  double loss = 0;      // at the end
  int evaluations = 0;  // of the residuals, with or without their Jacobian
};
Search searched_by_likeness(int start);
Search searched_by_ceres(int start);

}  // namespace likeness::fit::test
