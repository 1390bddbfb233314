#pragma once

namespace likeness::image {

// A function of likeness_image_io.so by its name in io_module.h. Loads the module at the first call; write.h says where
// it is looked for. Throws std::runtime_error, one line.
void* io_function(const char* name);

}  // namespace likeness::image
