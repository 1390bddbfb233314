#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "render/exposure/curve.h"
#include "render/image/picture.h"

// What is laid over a picture to judge its exposure: zones, parts of the live curve, and a wedge of greys. No color stands
// alone: zones and parts are hatched, zones bear their numerals, and a strip below the picture says what is what.
namespace likeness::exposure {

using DisplayColor = std::array<float, 3>;  // of a display, [0, 1]

// Display colors of the 17 zones: cold below middle grey, which is grey, warm above it; neighbors differ in lightness too.
inline constexpr std::array<std::array<std::uint8_t, 3>, 17> kZoneColors{{{22, 12, 44},
                                                                          {44, 30, 104},
                                                                          {38, 66, 150},
                                                                          {28, 108, 168},
                                                                          {52, 140, 150},
                                                                          {118, 118, 118},
                                                                          {140, 160, 84},
                                                                          {182, 172, 62},
                                                                          {222, 178, 48},
                                                                          {240, 152, 44},
                                                                          {238, 116, 52},
                                                                          {226, 80, 64},
                                                                          {202, 50, 86},
                                                                          {176, 44, 124},
                                                                          {198, 98, 174},
                                                                          {228, 164, 216},
                                                                          {255, 236, 250}}};
inline constexpr DisplayColor kToeColor{0.16f, 0.42f, 0.86f}, kShoulderColor{0.95f, 0.55f, 0.10f};

// The zone, 0 to 16, of luminance after exposure; NaN and what is not above 0 are in zone 0.
int zone_at(float exposed);

// Of luminance after exposure, at a pixel: every second zone is hatched, one way below middle grey, the other way above, and
// grey never.
DisplayColor zone_color(float exposed, int x, int y);

// Of luminance after exposure whose grey the view shows as `grey`: as it is on the line; in the toe bluish and hatched one
// way, in the shoulder orange and hatched the other.
DisplayColor curve_color(const DisplayColor& grey, float exposed, const std::array<double, 2>& limits, int x, int y);

enum class Overlay : unsigned char { kNone, kWedge, kZones, kCurve };
struct OverlayRow {
  Overlay overlay;
  std::string_view name, text;
};
inline constexpr std::array kOverlays{
    OverlayRow{Overlay::kWedge, "wedge", "below it 17 greys, a stop apart, through the same exposure and view"},
    OverlayRow{Overlay::kZones, "zones", "colored by the zone of its luminance, with numerals"},
    OverlayRow{Overlay::kCurve, "curve", "toe bluish, line grey, shoulder orange, of the view's curve"},
    OverlayRow{Overlay::kNone, "none", "the picture"},
};
// Throws files::UsageError, which begins with `option`, for a name that is none of them.
Overlay overlay_named(std::string_view option, std::string_view name);

// The picture as the view shows it, with an overlay. With one that is not none, a strip of 17 fields lies below it, and
// pictures narrower than that needs have grey at their right.
//
//   wedge  the fields are scene light of 0.18 x 2^-5 to 2^11, appended to the light before exposure, view and encoding:
//          labelled with zone and EV of that light, and the code that the display is sent
//   zones  the fields are the colors, labelled with zone and EV after exposure, and the share of the picture's pixels
//   curve  the fields are greys after exposure by their part, labelled with zone, EV and T, L or S for the part
//
// Light that is NaN counts as none. Throws as view::Shower does.
image::DisplayPicture picture_with(Overlay overlay, const image::Picture& light, const scene::View& view);

}  // namespace likeness::exposure
