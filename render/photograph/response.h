#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// From the codes of a photograph to the light that made them.
namespace likeness::photograph {

inline constexpr std::size_t kCodes = 256;  // nodes over [0, 1]: the codes of 8 bits

// How much a code is worth: 1 in the middle, 0 at both ends, a hat. (Debevec and Malik 1997, eq. 4.) NaN is worth nothing.
inline double hat(double code) { return code > 0 && code < 1 ? 2 * (code < 0.5 ? code : 1 - code) : 0; }

// log2 of exposure (light x time) at each code, rising, for red, green and blue. Between the nodes it is a line.
struct Response {
  std::array<std::array<double, kCodes>, 3> log2_exposure{};
  // Codes at or below it are black: the base of a film, or what a scan adds. A curve that begins level is black there.
  std::array<double, 3> black{};
  std::string name;  // "linear", "srgb", "recovered", or the file

  // hat() over what is above black.
  double worth(std::size_t channel, double code) const { return hat((code - black[channel]) / (1 - black[channel])); }
  double at(std::size_t channel, double code) const;  // code clamped to [0, 1]
};

// 1 at code 1. Code 0 is taken as half a step.
Response linear_response();
Response srgb_response();

// The CSV that a recovered response is kept as: code, red, green, blue, 256 rows. Throws files::InputError for another
// table, and for curves that fall.
std::string csv_of(const Response& response);
Response response_of(std::string_view text, const std::string& name);

// The codes of some pixels in each frame, [pixel][frame][channel]; NaN where a frame does not show the pixel.
struct Samples {
  std::size_t pixels = 0, frames = 0;
  std::vector<float> codes;

  float at(std::size_t pixel, std::size_t frame, std::size_t channel) const {
    return codes[(pixel * frames + frame) * 3 + channel];
  }
};

struct Recovered {
  Response response;
  std::size_t used = 0;               // pixels that at least two frames show well
  std::array<int, 3> flattened{};     // steps of each curve that would have fallen, and were made level
  std::array<double, 3> rms_stops{};  // weighted, of what the curve leaves unexplained
};

// The highest code of each channel that does not grow by a tenth where a frame has a stop more light: what is there
// without light. 0 where nothing says so.
std::array<double, 3> black_of(const Samples& samples, std::span<const double> exposures);

// The curve that makes all frames agree: least squares of hat(z) (g(z) - ln E - ln t) over pixels and frames, and of
// smoothness hat(z) g''(z). Each pixel's ln E is eliminated exactly, so 256 unknowns remain whatever the number of pixels.
// Code 128 of each channel is what sRGB has there, 0.216: a scale that the frames cannot say; the white balance is that
// of code 128.
//
// Source  Debevec and Malik, "Recovering High Dynamic Range Radiance Maps from Photographs", SIGGRAPH 1997, eq. 3.
// Departs codes that light does not change (black_of) are left out; a step below 0 is made level (pool adjacent violators), for light cannot fall as codes rise.
//
// `exposures` are above 0. Throws files::UsageError if they do not differ by 0.1 stop, or if no pixel is shown well twice.
Recovered recover_response(const Samples& samples, std::span<const double> exposures);

}  // namespace likeness::photograph
