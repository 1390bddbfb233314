#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/image/cie_lab.h"

namespace likeness::image {

// Delta E 2000, the color difference of the CIE: 1 is about what an eye can just tell. kL = kC = kH = 1.
//
// Source      Sharma, Wu and Dalal, "The CIEDE2000 Color-Difference Formula: Implementation Notes, Supplementary Test
//             Data, and Mathematical Observations", Color Research and Application 30(1), 2005, eq. 2 to 22.
// Holds       symmetric; 0 for equal colors; jumps where hues are opposite, as the formula does.
inline double delta_e_2000(const Lab& p, const Lab& q) {
  constexpr double kPi = std::numbers::pi, kRadian = kPi / 180;
  const auto power7 = [](double x) { return x * x * x * x * x * x * x; };
  const auto share = [&](double chroma) { return std::sqrt(power7(chroma) / (power7(chroma) + power7(25.0))); };

  const double g = 0.5 * (1 - share(0.5 * (std::hypot(p.a, p.b) + std::hypot(q.a, q.b))));
  const double ap = (1 + g) * p.a, aq = (1 + g) * q.a;
  const double cp = std::hypot(ap, p.b), cq = std::hypot(aq, q.b);
  const auto hue = [](double a, double b) {  // in [0, 2 pi)
    const double h = std::atan2(b, a);
    return h < 0 ? h + 2 * kPi : h;
  };
  const double hp = hue(ap, p.b), hq = hue(aq, q.b);
  const bool is_grey = cp * cq == 0;  // one has no hue

  const double dl = q.l - p.l, dc = cq - cp;
  double dh = is_grey ? 0 : hq - hp;
  dh += dh > kPi ? -2 * kPi : dh < -kPi ? 2 * kPi : 0;
  const double dhue = 2 * std::sqrt(cp * cq) * std::sin(0.5 * dh);

  const double l = 0.5 * (p.l + q.l), c = 0.5 * (cp + cq);
  double h = hp + hq;
  if (!is_grey) h = 0.5 * (std::abs(hp - hq) <= kPi ? h : h < 2 * kPi ? h + 2 * kPi : h - 2 * kPi);

  const double t = 1 - 0.17 * std::cos(h - 30 * kRadian) + 0.24 * std::cos(2 * h) +
                   0.32 * std::cos(3 * h + 6 * kRadian) - 0.20 * std::cos(4 * h - 63 * kRadian);
  const double bell = (h / kRadian - 275) / 25, turn = 60 * kRadian * std::exp(-bell * bell);
  const double l50 = (l - 50) * (l - 50);
  const double sl = 1 + 0.015 * l50 / std::sqrt(20 + l50), sc = 1 + 0.045 * c, sh = 1 + 0.015 * c * t;
  const double rt = -std::sin(turn) * 2 * share(c);
  const double x = dl / sl, y = dc / sc, z = dhue / sh;
  return std::sqrt(std::max(0.0, x * x + y * y + z * z + rt * y * z));
}

}  // namespace likeness::image
