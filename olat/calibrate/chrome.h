#pragma once

#include <array>
#include <optional>
#include <vector>

#include "render/capture/capture.h"
#include "render/image/picture.h"

// Where a light is, by its reflection in a mirror ball.
namespace likeness::olat_calibrate {

struct Ball {
  double x = 0, y = 0, radius = 0;  // [pixel]; pixel (0, 0) has its middle at (0.5, 0.5)
};

// The disk of the same area and middle as the mask (a byte a pixel); nothing for less than 100 pixels.
std::optional<Ball> ball_of(const std::vector<std::uint8_t>& mask, int width, int height);

// Unit, towards the light, in the world, from the brightest spot of the ball. The light is taken to be far away, and the
// camera to be far from the ball unless its focal length says otherwise. Nothing if the spot is at the rim (a light
// behind the ball), or there is none.
std::optional<std::array<double, 3>> direction_of(const image::Picture& photo, const Ball& ball,
                                                  const capture::Camera& camera);

}  // namespace likeness::olat_calibrate
