#pragma once

#include <array>
#include <string>
#include <vector>

#include "olat/calibrate/chart.h"
#include "render/image/picture.h"
#include "render/scene/scene.h"

// The six greys of a photographed chart, against their reference in stops: whether light is linear.
namespace likeness::olat_photograph {

inline constexpr std::size_t kGreys = 6;

// How far each grey, white to black, may stand from its reference against white [stops]: what a raw photograph of a chart
// shows of glare and of how even the light is.
inline constexpr std::array<double, kGreys> kGreyLimits{0, 0.02, 0.04, 0.09, 0.17, 0.20};

struct Grey {
  double luminance = 0, reference = 0;               // Y; of the reference, white of the light is 1
  double stops = 0, reference_stops = 0, error = 0;  // log2 against the white patch, and their difference
  double zone = 0, expected_zone = 0;                // with the white patch at its reference, from light 0.18 = V
  int shown_zone = 0;                                // whose color most of the patch has in the zone picture
  double shown_share = 0;                            // of its pixels
  bool is_within = false;
};

struct ChartReading {
  olat_calibrate::Corners corners{};
  std::size_t seen = 0;  // patches that the finder saw; 24 of given corners
  std::array<Grey, kGreys> greys{};
  double ev = 0;  // that puts the white patch at its reference
  olat_calibrate::ChartFit colors;
};

// `corners` are looked for where there are none. Throws files::UsageError: no chart, several, or greys without light.
ChartReading read_chart(const image::Picture& photo, const std::vector<std::string>& corners,
                        const olat_calibrate::Reference& reference);

// Corners of texts "x,y", of patch 1, 6, 24 and 19.
olat_calibrate::Corners corners_of_texts(const std::vector<std::string>& texts);

// Gains by which the greys 20 to 23, of the camera's light, become grey, the least 1.
std::array<double, 3> gains_of_greys(const image::Picture& camera, const olat_calibrate::Corners& corners);

std::string text_of_greys(const ChartReading& reading);

}  // namespace likeness::olat_photograph
