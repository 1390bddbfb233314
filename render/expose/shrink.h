#pragma once

#include "render/image/picture.h"

namespace likeness::expose {

// A picture of at most `longest` pixels a side: each the mean of the pixels that it covers, NaN and what is infinite left out.
// Smaller ones stay as they are.
image::Picture shrunk(const image::Picture& picture, int longest);

}  // namespace likeness::expose
