#include "olat/photograph/shifts.h"

#include <limits>

#include "olat/registration/shift.h"

namespace likeness::olat_photograph {

photograph::ShiftFinder shift_finder() {
  return [](const image::Picture& first, const image::Picture& second, std::span<const float> weight) {
    const registration::Shift found = registration::shift_between(second, first, weight, 0);
    if (!found.is_measured()) return photograph::FoundShift{0, 0, std::numeric_limits<double>::infinity()};
    return photograph::FoundShift{found.x, found.y, found.sigma()};
  };
}

}  // namespace likeness::olat_photograph
