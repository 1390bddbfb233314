#pragma once

#include <string_view>

namespace likeness::image::test {

// Decodes bytes as the picture and as the layers of an EXR of at most 2^16 texels. True if either was accepted; throws
// std::logic_error if a promise of render/image/read.h or layers.h does not hold.
bool feed_exr(std::string_view bytes);

}  // namespace likeness::image::test
