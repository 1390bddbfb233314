#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace likeness::view {

// AgX, the base look, for an sRGB screen: an inset of the primaries, 16.5 stops of a logarithm, a sigmoid on each
// channel, and the inset undone. What comes out is a display value: no transfer curve follows.
//
//     t = (log2(M c) - E0) / (E1 - E0),   E0 = log2(0.18) - 10,   E1 = log2(0.18) + 6.5,   limited to [0, 1]
//     s(t) = 1/2 + 2 (t - p) / (1 + a |t - p|^k)^(1/k),   p = 10 / 16.5,   k = 3 below p, 3.25 above
//     a = ((4 w)^k - 1) / w^k,   w = p below, 1 - p above:   s(0) = 0, s(p) = 1/2, s(1) = 1
//
// Source      Sobotka, AgX (github.com/sobotka/AgX, 2022): its sigmoid (slope 2, powers 3 and 3.25) and its matrix.
// Departures  the sigmoid is computed, where the original reads a table of 4096 made from it; light below 0 is black.
struct Agx {
  static constexpr float kPivot = 10 / 16.5f;
  // Of column vectors (r, g, b); rows sum to 1, so that grey stays grey.
  static constexpr std::array<std::array<float, 3>, 3> kInset{
      {{0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f},
       {0.0423282422610123f, 0.878468636469772f, 0.0791661274605434f},
       {0.0423756549057051f, 0.0784336f, 0.879142973793104f}}};
  static constexpr std::array<std::array<float, 3>, 3> kOutset{
      {{1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f},
       {-0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f},
       {-0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f}}};

  static float sigmoid(float t) {
    const bool below = t < kPivot;
    const float power = below ? 3.0f : 3.25f, reach = below ? kPivot : 1 - kPivot;
    const float scale = (std::pow(4 * reach, power) - 1) / std::pow(reach, power);
    const float d = t - kPivot;
    return 0.5f + 2 * d / std::pow(1 + scale * std::pow(std::abs(d), power), 1 / power);
  }

  // Linear Rec. 709 to display values in [0, 1]. NaN is black.
  static std::array<float, 3> eval(std::array<float, 3> c) {
    for (float& v : c) v = v > 0 ? std::min(v, 1e30f) : 0;
    std::array<float, 3> t{}, out{};
    for (std::size_t i = 0; i < 3; ++i) {
      const float inset = kInset[i][0] * c[0] + kInset[i][1] * c[1] + kInset[i][2] * c[2];
      const float stops = std::log2(std::max(inset, 1e-10f) / 0.18f);
      t[i] = sigmoid(std::clamp((stops + 10) / 16.5f, 0.0f, 1.0f));
    }
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = std::clamp(kOutset[i][0] * t[0] + kOutset[i][1] * t[1] + kOutset[i][2] * t[2], 0.0f, 1.0f);
    return out;
  }
};

}  // namespace likeness::view
