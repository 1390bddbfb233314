#pragma once

#include <stddef.h>

// What the program and likeness_image_io.so agree on: C only, so that neither sees the other's C++ library.
extern "C" {

// Takes `size` bytes of the encoded file; called once.
typedef void (*likeness_bytes_sink)(void* state, const void* bytes, size_t size);

// Encodes width x height pixels of interleaved 8-bit RGB, top row first, as PNG. Returns 0, or 1 with a message
// of at most error_size - 1 characters in `error`. Throws nothing.
typedef int (*likeness_encode_png_function)(const unsigned char* rgb, int width, int height, likeness_bytes_sink sink,
                                            void* state, char* error, size_t error_size);
}

namespace likeness::image {
inline constexpr const char* kIoModuleFile = "likeness_image_io.so";
inline constexpr const char* kEncodePngName = "likeness_encode_png_1";  // the digit is the version of the agreement
}  // namespace likeness::image
