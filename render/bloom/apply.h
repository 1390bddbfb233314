#pragma once

#include <cstddef>
#include <functional>

#include "render/bloom/kernel.h"
#include "render/image/picture.h"

namespace likeness::bloom {

// What is beyond the picture's edges.
enum class Edges {
  kLose,    // darkness: light that is scattered out is lost, as in a camera whose sensor ends
  kReflect  // the picture mirrored: as much light comes in as goes out, and the sum of a channel stays
};

struct ApplyOptions {
  Edges edges = Edges::kLose;
  std::function<void(double share)> tell = {};  // how much is done; may throw to stop
};

struct Applied {
  image::Picture picture;
  std::size_t not_a_number = 0, infinite = 0;  // values of the input, taken for 0 and for the largest half (65504)
};

// The picture under the kernel: linear, each channel by itself, in double by FFT in tiles. Values below 0 are scattered as
// they are; a picture without any has none afterwards. Memory: the picture, the result, and about 64 bytes x the square of
// the tile (2048, or 3 radius) for each thread and channel's kernel.
Applied apply(const image::Picture& picture, const Kernel& kernel, const ApplyOptions& options = {});

}  // namespace likeness::bloom
