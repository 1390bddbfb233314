#pragma once

#include <span>

#include "brdf/catalog/catalog.h"
#include "brdf/eval/columns.h"
#include "fit/slice/slice.h"

namespace likeness::fit {

// The form of an evaluator that names directions by theta_h, theta_d and phi_d; nullptr if it has none, or returns no
// color or number first that could be drawn.
const catalog::Form* half_angle_form(const catalog::Entry& entry);

// The slice of an evaluator that has such a form. Throws files::UsageError for an assignment that it does not take.
SlicePicture slice_of(const catalog::Entry& entry, std::span<const eval::Assignment> assignments,
                      const SliceGrid& grid = {});

}  // namespace likeness::fit
