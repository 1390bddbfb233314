#pragma once

#include <string>
#include <string_view>

#include "render/image/read.h"

namespace likeness::image {

bool is_exr(std::string_view bytes);

// decode_texels() of an EXR. Throws as that does.
Texels decode_exr(std::string_view bytes, const std::string& name, const ReadOptions& options);

}  // namespace likeness::image
