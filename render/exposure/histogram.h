#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/image/picture.h"
#include "render/image/plane.h"

// The light of a picture, or of a series of them, as two histograms: of luminance, and of the brightest channel. All that
// is asked of an exposure (shares, percentiles, averages, the best of many) is answered from them, so a picture is looked at
// once, and a series need not fit into memory.
//
// Bins        1024 an octave (a doubling of light), equal steps of light within it: their widths are 1/1420 to 1/710 stop.
//             They reach from 2^-64 to 2^64; what is outside is in the first or the last. Light times 2 is in the bin 1024
//             further, exactly.
// Sums        whole numbers: the same whatever the number of threads and the order of pictures.
// Luminance   0.2126 r + 0.7152 g + 0.0722 b of linear Rec. 709, in float.
namespace likeness::exposure {

// Weight in a bin, and the weighted sum of where in the bin its pixels are, 0 to 8191. Their quotient places the bin: a
// picture of one grey is where that grey is, not at the border of its bin.
struct Bin {
  std::uint64_t weight = 0, place = 0;
};

// Pixels, each counted once whatever its weight.
struct Counts {
  std::uint64_t all = 0;         // also those that follow
  std::uint64_t masked = 0;      // weight 0: nothing else is asked of them
  std::uint64_t not_number = 0;  // a channel is NaN: left out
  std::uint64_t infinite = 0;    // a channel is infinite, none NaN: the brightest, or the darkest, that there is
  std::uint64_t negative = 0;    // a channel is below 0: counts as it is
  std::uint64_t denormal = 0;    // luminance above 0 and below 2^-126: in the first bin
};

class Histogram {
 public:
  static constexpr int kFirstOctave = -64, kOctaves = 128, kStepsAnOctave = 1024;
  static constexpr std::size_t kBins = static_cast<std::size_t>(kOctaves) * kStepsAnOctave;
  // Weights are kept to 1 / 65536; 2^40 pixels do not overflow.
  static constexpr std::uint64_t kWhole = 65536;

  Histogram();  // 4 MB, of which a page is touched when a bin of it is

  // Adds a picture. `weights`: one a pixel, limited to [0, 1], NaN is 0; or none, which are all 1. Luminance at or below
  // `floor`, which is at least 0, is no light (black). Takes 4 MB for each thread at work. Throws std::invalid_argument for
  // another number of weights than of pixels.
  void add(const image::Picture& picture, std::span<const float> weights = {}, float floor = 0);
  void add(const Histogram& other);

  const Counts& counts() const { return counts_; }
  std::uint64_t weight() const { return weight_; }       // of all that is counted: black and lit
  std::uint64_t black_weight() const { return black_; }  // of pixels without light, which no exposure shows
  std::span<const Bin> luminance() const { return luminance_; }
  std::span<const Bin> brightest() const { return brightest_; }

  // The light that a bin stands for: of its place, or of its lower border where it is empty.
  static double light_of(std::size_t bin, const Bin& content = {});
  static std::size_t bin_of(float light);  // of light above 0

 private:
  class Counter;
  Counts counts_;
  std::uint64_t weight_ = 0, black_ = 0;
  image::Plane<Bin> luminance_, brightest_;
};

// Luminance as the histogram has it.
inline float luminance_of(std::span<const float, 3> rgb) {
  return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

}  // namespace likeness::exposure
