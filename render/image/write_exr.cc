#include "render/image/attributes.h"
#include "render/image/write.h"

namespace likeness::image {

void write_exr(const std::filesystem::path& file, const Picture& picture) { write_exr(file, picture, Attributes{}); }

}  // namespace likeness::image
