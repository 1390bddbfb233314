#pragma once

#include <stddef.h>

// What the program and likeness_opencv.so agree on: C only, so that neither sees the other's C++ library. Each function
// returns 0, or 1 with a message of at most error_size - 1 characters in `error`, and throws nothing. Pixels have their
// middles at whole numbers here, as OpenCV has it.
extern "C" {

typedef struct likeness_lens {
  double focal_x, focal_y, center_x, center_y;  // [pixel]
  int is_fisheye, terms;                        // terms: 4, 5 or 8
  const double* distortion;
} likeness_lens;

// Where each of width x height pixels of a pinhole with the same focal lengths and center lies in the lens's photo.
typedef int (*likeness_lens_map_function)(const likeness_lens* lens, int width, int height, float* x, float* y,
                                          char* error, size_t error_size);

// Where points (x / z, y / z) of the camera lie in the photo; 2 numbers a point, in place.
typedef int (*likeness_bend_function)(const likeness_lens* lens, double* points, int count, char* error,
                                      size_t error_size);

// Quadrangles of one tone in a grey picture, of an area within [least, largest] pixels: 10 numbers each (x y of the
// corners, clockwise in the picture, and of the middle of the area), at most `most`; `count` says how many.
typedef int (*likeness_quads_function)(const unsigned char* grey, int width, int height, double least, double largest,
                                       double* quads, int most, int* count, char* error, size_t error_size);
}

namespace likeness::olat_calibrate {
inline constexpr int kQuadNumbers = 10;
inline constexpr const char* kOpenCvFile = "likeness_opencv.so";
// The digit is the version of the agreement.
inline constexpr const char *kLensMapName = "likeness_lens_map_1", *kBendName = "likeness_bend_1",
                            *kQuadsName = "likeness_quads_1";
}  // namespace likeness::olat_calibrate
