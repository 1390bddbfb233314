#include "tests/olat/planted.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace likeness::olat_test {
namespace {

struct Normal {
  double x, y, z;
  bool hit;
};
Normal normal_at(const Ball& ball, int px, int py) {
  const double x = (px + 0.5 - 0.5 * ball.size - ball.x) / ball.radius;
  const double y = -(py + 0.5 - 0.5 * ball.size - ball.y) / ball.radius;
  const double z2 = 1 - x * x - y * y;
  return {x, y, std::sqrt(std::max(0.0, z2)), z2 > 0};
}

}  // namespace

std::vector<std::array<double, 3>> ring_of_lights(int count) {
  std::vector<std::array<double, 3>> lights;
  const double s = std::sqrt(0.5);
  for (int i = 0; i + 1 < count; ++i) {
    const double phi = 2 * std::numbers::pi * i / (count - 1);
    lights.push_back({s * std::cos(phi), s * std::sin(phi), s});
  }
  lights.push_back({0, 0, 1});
  return lights;
}

image::Picture ball_under(const Ball& ball, const std::array<double, 3>& to_light, const Planted& planted) {
  image::Picture picture(ball.size, ball.size);
  std::mt19937 random(planted.seed);
  std::normal_distribution<double> normal;
  for (int y = 0; y < ball.size; ++y)
    for (int x = 0; x < ball.size; ++x) {
      const Normal n = normal_at(ball, x, y);
      double light = 0;
      if (n.hit) {
        const double cosine = n.x * to_light[0] + n.y * to_light[1] + n.z * to_light[2];
        const double pattern = 1 + ball.texture * 0.5 * (std::sin(31 * n.x + 7 * n.y) + std::sin(23 * n.y - 11 * n.x));
        light = std::max(0.0, cosine) * pattern;
        const double hx = to_light[0], hy = to_light[1], hz = to_light[2] + 1;
        const double h = (n.x * hx + n.y * hy + n.z * hz) / std::sqrt(hx * hx + hy * hy + hz * hz);
        light += ball.highlight * std::pow(std::max(0.0, h), 60);
        const double side = std::sqrt(ball.shadow * std::numbers::pi);
        if (n.x > -0.1 && n.x < side - 0.1 && n.y > -0.1 && n.y < side - 0.1) light = 0;
      }
      for (std::size_t c = 0; c < 3; ++c) {
        double v = light * ball.albedo[c] * std::exp2(planted.gain_ev + planted.channel_ev[c]);
        if (planted.exponent != 1) v = std::pow(v, planted.exponent);
        v += normal(random) * std::sqrt(planted.read_noise * planted.read_noise + planted.shot_noise * v);
        picture.at(x, y)[c] = static_cast<float>(v + planted.black);
      }
    }
  return picture;
}

std::vector<float> ball_mask(const Ball& ball) {
  std::vector<float> mask;
  for (int y = 0; y < ball.size; ++y)
    for (int x = 0; x < ball.size; ++x) mask.push_back(normal_at(ball, x, y).hit ? 1.0f : 0.0f);
  return mask;
}

image::Picture ball_normals(const Ball& ball) {
  image::Picture picture(ball.size, ball.size);
  for (int y = 0; y < ball.size; ++y)
    for (int x = 0; x < ball.size; ++x)
      if (const Normal n = normal_at(ball, x, y); n.hit) {
        picture.at(x, y)[0] = static_cast<float>(n.x);
        picture.at(x, y)[1] = static_cast<float>(n.y);
        picture.at(x, y)[2] = static_cast<float>(n.z);
      }
  return picture;
}

}  // namespace likeness::olat_test
