#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "brdf/lighting/gt_tonemap.h"

// What is on the screen when a photo and a render are compared, as a value. Its text is the query of the viewer's
// address, the --state of the command line and, as an object, the file view.json: whoever has the text has the picture.
namespace likeness::olat_pair {

// A word of a list, and what it means.
struct Choice {
  std::string_view word, text;
};

enum class Mode : unsigned char { kPhoto, kRender, kWipe, kSide, kOnion, kDifference };
inline constexpr std::array kModes{
    Choice{"photo", "the photograph"},
    Choice{"render", "the render"},
    Choice{"wipe", "photo left of the split, render right of it"},
    Choice{"side", "photo and render side by side"},
    Choice{"onion", "both, mixed on the display"},
    Choice{"difference", "a map of the metric"},
};

enum class Match : unsigned char { kNone, kCapture, kLight, kChannel };
inline constexpr std::array kMatches{
    Choice{"none", "the render as it is: an error of intensity stays visible"},
    Choice{"capture", "one gain for the capture: the median of at most 16 pairs"},
    Choice{"light", "one gain for each camera and light"},
    Choice{"channel", "one gain for each camera, light and color channel"},
};

enum class Channel : unsigned char { kColor, kRed, kGreen, kBlue, kLuma, kCoverage, kSigned };
inline constexpr std::array kChannels{
    Choice{"color", "all three"},
    Choice{"red", "red light as grey"},
    Choice{"green", "green light as grey"},
    Choice{"blue", "blue light as grey"},
    Choice{"luma", "luminance as grey"},
    Choice{"coverage", "white inside the mask"},
    Choice{"signed", "luminance with its sign: blue below 0, orange above; the colors end at 1 after exposure"},
};

enum class Overlay : unsigned char { kNone, kZones, kCurve };
inline constexpr std::array kOverlays{
    Choice{"none", "the picture"},
    Choice{"zones", "17 zones of one stop, colored; zone V is grey"},
    Choice{"curve", "toe blue, line grey, shoulder orange, hatched where the view's curve bends"},
};

struct State {
  std::string camera, light, variant;  // ids; empty: the first
  Mode mode = Mode::kPhoto;
  double split = 0.5;            // of wipe: share of the width
  double mix = 0.5;              // of onion: share of the render
  std::string metric = "stops";  // id of metric::kMetrics
  double range = 0;              // value at the end of the map's colors; 0: the metric's own (scale_of)
  double noise = 0;              // noise floor [light]; 0: the camera's
  double ev = 0;                 // exposure of both [stop]
  Match match = Match::kNone;
  std::string view = "gt";     // of view::kOwnViews
  brdf::GtTonemap<double> gt;  // parameters of the view gt
  Channel channel = Channel::kColor;
  Overlay overlay = Overlay::kNone;
  bool zebra = false, wedge = false;
  double zoom = 0;          // screen pixels for a picture's pixel; 0: all of it fits
  double x = 0.5, y = 0.5;  // what of the picture is in the middle, as shares of its width and height

  bool operator==(const State& other) const;  // of their texts
};

// A key of the text. Numbers are kept to four decimals, which is what their text holds.
struct Field {
  std::string_view name;
  std::variant<std::string State::*, double State::*, bool State::*, Mode State::*, Match State::*, Channel State::*,
               Overlay State::*, double brdf::GtTonemap<double>::*>
      at;
  std::string_view text;
  std::array<double, 2> range{0, 0};          // of numbers
  bool is_shared = false;                     // part of what both pictures pass through: of the pipeline's hash
  std::span<const Choice> choices{};          // of words
  std::span<const std::string_view> names{};  // of texts that are one of a list
};
std::span<const Field> fields();

// "camera=c0&light=012&mode=wipe": what differs from State{}, in the order of fields(); percent encoded (RFC 3986).
std::string text_of(const State& state);

// From such a text, with or without a leading '?', or from a JSON object (its first character is a brace) with the same
// keys, numbers and flags as such or as text. Throws files::UsageError, one line: an unknown key or word with the nearest
// one, a number outside its range, a key twice.
State state_of(std::string_view text);

// Whether the text has that key, if only with its default. Throws as state_of does.
bool has_field(std::string_view text, std::string_view name);

// The text of one field, "" for the default; what the text form and the pages hold.
std::string value_of(const State& state, const Field& field);

// What both pictures pass on their way from light to the display, as text: working space, exposure, match gain, view
// with its parameters, display curve. And eight hexadecimal digits that stand for it (FNV-1a, 32 bit): equal digits on
// both panes are equal pipelines.
std::string pipeline_of(const State& state);
std::string hash_of(std::string_view pipeline);

// The value at the end of a metric's colors.
double scale_of(std::string_view metric);

}  // namespace likeness::olat_pair
