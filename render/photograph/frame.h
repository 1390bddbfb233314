#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "render/photograph/response.h"

// One photograph of a bracket.
namespace likeness::photograph {

enum class State : std::uint8_t { kSeen, kIgnored, kClipped };

struct Frame {
  int width = 0, height = 0;
  bool is_light = false;      // its values are light, which no response is asked about
  std::vector<float> codes;   // RGB, row by row: of [0, 1], or light / white; finite
  std::vector<State> states;  // of pixels. Ignored: of the ignored color, not finite, outside

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

// log2 of exposure at a code, and what it is worth, 0 to 1. Light that is not above 0 is taken as its least step, 2^-20.
inline double log2_exposure(bool is_light, std::size_t channel, double code, const Response& response) {
  return is_light ? std::log2(std::max(code, 0x1p-20)) : response.at(channel, code);
}
inline double worth(bool is_light, std::size_t channel, double code, const Response& response) {
  return is_light ? hat(code) : response.worth(channel, code);
}

using Color8 = std::array<int, 3>;  // 0 to 255

struct FrameOptions {
  std::optional<Color8> ignored;  // pixels of that color, to half a step of 8 bits, are not there
  double white = 1;               // of EXR, HDR and PFM: light at or above it is clipped
};

// Camera raw (balanced as shot, Rec. 709; raw.h), EXR, HDR and PFM are light, all else is codes. Throws files::InputError.
Frame read_frame(const std::filesystem::path& file, const FrameOptions& options);

// What is at (x + dx, y + dy) comes to (x, y), bilinear in codes; ignored outside. A pixel made of one that is full, black or
// ignored is what that is.
Frame shifted(const Frame& frame, double dx, double dy);

// A color of codes 0 and 255 only, neither black nor white, that fills a quarter of a side of the picture: the mark of a
// border without picture. Nothing if there is none.
std::optional<Color8> border_color(const Frame& frame);

}  // namespace likeness::photograph
