#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/image/picture.h"
#include "render/photograph/brackets.h"
#include "render/photograph/frame.h"
#include "render/photograph/judge.h"
#include "render/photograph/response.h"

// Bracketed photographs to one picture of linear light.
//
// Frames are read one after the other, twice: once for a sample of 8192 pixels, from which the response, the times and the
// noise are found, and once to merge. In memory are the sums of 48 bytes a pixel, and one frame (13 bytes a pixel and its
// file; with alignment two).
namespace likeness::photograph {

// How frames are weighed where several show a pixel.
enum class Weighting : unsigned char {
  kDebevec,  // mean of log light, by the hat of the code (Debevec and Malik 1997, eq. 6)
  kNoise  // mean of light, by hat x exposure: least noise where photons are what is noisy; keeps the mean of dark noise
};
struct WeightingRow {
  Weighting weighting;
  std::string_view name, text;
};
inline constexpr std::array kWeightings{
    WeightingRow{Weighting::kDebevec, "debevec", "mean of log light by a hat over the code, as published"},
    WeightingRow{Weighting::kNoise, "noise", "mean of light by hat x exposure: the least photon noise"},
};

// What is at (x, y) of the first picture is at (x + dx, y + dy) of the second; sigma [pixel], infinite if not found.
struct FoundShift {
  double dx = 0, dy = 0, sigma = 0;
};
// Pictures of linear light, of one size; weight 0 where one of them shows nothing. Exposure may differ.
using ShiftFinder =
    std::function<FoundShift(const image::Picture& first, const image::Picture& second, std::span<const float> weight)>;

struct MergeOptions {
  std::vector<Bracket> brackets;
  // Nothing: recovered where frames are codes of different exposures, else sRGB; unused where all frames are light.
  std::optional<Response> response;
  bool recovers = false;               // recovered, or an error
  std::optional<Weighting> weighting;  // nothing: noise where all frames are light, else debevec
  FrameOptions frame;
  bool aligns = false, deghosts = false;
  double ghost_sigmas = 5;
  ShiftFinder shift_of;  // may be empty: shifts are not looked for
  // What is being done, and the share of it that is done; returns false to stop, then files::Interrupted is thrown.
  std::function<bool(std::string_view, double)> keep_going;
};

struct FrameReport {
  Bracket bracket;
  double exposure = 0;  // relative [s]
  bool is_light = false;
  std::array<std::array<std::uint64_t, 64>, 3> histogram{};      // of codes
  double well_exposed = 0, clipped = 0, black = 0, ignored = 0;  // shares of pixels
  std::optional<FoundShift> shift;                               // against the frame before
  double moved_x = 0, moved_y = 0;                               // by --align
};

enum class Bound : std::int8_t { kUpper = -1, kNone = 0, kLower = 1 };

struct Merged {
  image::Picture light;  // 1 is code 1 of a frame of 1 s; never NaN
  // Of the channel that is known worst, the hat of the frame that shows it best: 1 in the middle of the codes, 0 where
  // every frame is clipped or black.
  std::vector<float> confidence;
  std::vector<std::uint16_t> frames;  // that show all channels
  // Lower: a channel is clipped in every frame, and its light is that or more; upper: black in all, that or less.
  std::vector<Bound> bound;
  std::vector<std::uint8_t> ghost;  // 1: frames disagree beyond noise; 2: and the reference frame's light was taken
  Response response;
  std::optional<Recovered> recovered;
  Weighting weighting = Weighting::kDebevec;
  Judgement judgement;
  std::vector<FrameReport> reports;  // by exposure, shortest first
  std::size_t reference = 0;         // the report of the frame with the most pixels well exposed
  std::size_t unknown = 0;           // pixels that every frame ignores: black, confidence 0
  std::size_t clipped_in_all = 0, black_in_all = 0, ghosts = 0, taken_from_reference = 0;
  std::optional<Color8> suggested_ignored;
  std::vector<std::string> warnings;
};

// Throws files::InputError (a frame that is absent, damaged, or of another size than the first), files::UsageError, and
// files::Interrupted.
Merged merge(const MergeOptions& options);

// Relative times that differ more than this from what frames show are warned of [stops].
inline constexpr double kTimeWarning = 0.1;
// Shifts are warned of beyond [pixel], if they are beyond three sigmas.
inline constexpr double kShiftWarning = 0.5;

}  // namespace likeness::photograph
