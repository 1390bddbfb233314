#pragma once

namespace likeness::fit {

// Thrown out of a fit that was asked to stop: nothing of it is kept.
struct Interrupted {};

}  // namespace likeness::fit
