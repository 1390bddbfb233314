#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "render/image/picture.h"

// How far the light of a render is from that of a reference, channel by channel. Both pictures have the same size, and
// the mask, where there is one, a byte for each pixel (0: left out), else std::invalid_argument. Pixels that are not
// finite in either picture are left out and counted.
namespace likeness::image {

using Mask = std::span<const std::uint8_t>;  // empty: every pixel

struct RelativeMse {
  double value = 0;            // 0 where no pixel counts
  std::size_t pixels = 0;      // that count
  std::size_t not_finite = 0;  // inside the mask
};

// relMSE: the mean of (render - reference)^2 / (reference^2 + epsilon). The usual epsilon of 0.01 is in the square of
// the pictures' unit, so it suits pictures whose white is about 1. Above 0, else std::invalid_argument.
RelativeMse relative_mse(const Picture& reference, const Picture& render, double epsilon = 0.01, Mask mask = {});

struct StopsError {
  double median = 0,
         p95 = 0;    // |log2(render / reference)|; half, and 95 % of the values, are at most that (nearest rank)
  double floor = 0;  // that was used
  std::size_t pixels = 0, not_finite = 0;
};

// What is below the floor is lifted to it before the ratio, so that black equals black. The floor is `floor_share`, in
// (0, 1], of the reference's mean over the pixels that count.
StopsError error_in_stops(const Picture& reference, const Picture& render, double floor_share = 1e-3, Mask mask = {});

}  // namespace likeness::image
