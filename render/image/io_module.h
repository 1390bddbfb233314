#pragma once

#include <stddef.h>

// What the program and likeness_image_io.so agree on: C only, so that neither sees the other's C++ library. Each
// function returns 0, or 1 with a message of at most error_size - 1 characters in `error`, and throws nothing.
extern "C" {

// Gives the memory for width x height pixels of interleaved channels, floats or else bytes, or null with a reason in
// `error`. Called at most once.
typedef void* (*likeness_pixels_place)(void* state, int width, int height, int channels, int is_float, char* error,
                                       size_t error_size);

// Decodes `size` bytes of a file of the named OpenImageIO format, top row first. "mosaic" is camera raw as the sensor
// counted it, one channel, a count of 65535 being 1.
typedef int (*likeness_decode_function)(const char* format, const void* bytes, size_t size, likeness_pixels_place place,
                                        void* state, char* error, size_t error_size);
}

namespace likeness::image {
inline constexpr const char* kIoModuleFile = "likeness_image_io.so";
inline constexpr const char* kDecodeName = "likeness_decode_1";  // the digit is the version of the agreement
}  // namespace likeness::image
