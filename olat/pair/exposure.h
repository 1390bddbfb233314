#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "render/image/picture.h"

// Exposures for a photo that nobody has chosen one for. The viewer, the report and the tests ask here.
namespace likeness::olat_pair {

struct Exposures {
  double percentile = 0;  // puts the 99th percentile of luminance on 1, the reference white [stop]
  double average = 0;     // puts the mean of log luminance on middle grey, 0.18 [stop]
};

// What the page says of them.
struct ExposureRow {
  std::string_view id, word, text;
};
inline constexpr std::array kExposures{
    ExposureRow{"percentile", "auto", "99 % of the photo's lit pixels are at most at the reference white"},
    ExposureRow{"average", "auto, log average", "the photo's mean of log luminance is at middle grey"},
};

// Of linear Rec. 709 and its pixels' bits of capture::Flaw (or none), to a tenth of a stop, within [-30, 30]. Pixels count
// that are finite, not masked, and brighter than the noise floor, so that a black background does not; where none is, all
// above 0. Nothing where there are none of these either. Read from the histogram that `likeness expose` reads
// (render/exposure/histogram.h), so both name the same exposures.
std::optional<Exposures> exposures_of(const image::Picture& photo, std::span<const std::uint8_t> flaws, double noise);

}  // namespace likeness::olat_pair
