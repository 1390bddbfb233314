#include "brdf/cost/ladder.h"

namespace likeness::cost {

std::vector<Family> families() { return {diffuse_family()}; }

Family diffuse_family() { return {}; }

}  // namespace likeness::cost
