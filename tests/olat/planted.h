#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/image/picture.h"

// A ball under one light, as a formula: what is planted in it is exact, since no picture is resampled.
namespace likeness::olat_test {

struct Ball {
  int size = 160;        // of the square picture [pixel]
  double radius = 65;    // [pixel]
  double x = 0, y = 0;   // of its middle, from that of the picture [pixel]
  double texture = 0.4;  // contrast of the albedo; 0: smooth
  double highlight = 0;  // of a lobe about the mirror direction
  std::array<double, 3> albedo{0.5, 0.4, 0.3};
  // A block of the ball that a neighbour shades, as a share of its area.
  double shadow = 0;
};

struct Planted {
  double gain_ev = 0;                     // [stop]
  std::array<double, 3> channel_ev{};     // [stop], on top of it
  double read_noise = 0, shot_noise = 0;  // sigma^2 = read^2 + shot * light
  double black = 0;                       // is added
  double exponent = 1;                    // light^exponent, before noise
  unsigned seed = 1;
};

// Unit, from the subject: lights on a ring 45 degrees about the view (z), and one on the axis (the last).
std::vector<std::array<double, 3>> ring_of_lights(int count);

image::Picture ball_under(const Ball& ball, const std::array<double, 3>& to_light, const Planted& planted = {});
std::vector<float> ball_mask(const Ball& ball);
image::Picture ball_normals(const Ball& ball);  // x right, y up, z to the viewer

}  // namespace likeness::olat_test
