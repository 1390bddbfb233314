#include "render/exposure/overlay.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

#include "brdf/lighting/zone.h"
#include "render/exposure/histogram.h"
#include "render/exposure/measure.h"
#include "render/exposure/text.h"
#include "render/files/files.h"
#include "render/view/view.h"

namespace likeness::exposure {
namespace {

using brdf::Zones;
constexpr int kFields = Zones::kCount;
constexpr std::uint8_t kSurroundGrey = 40, kLabelGrey = 235, kRowsGrey = 150;

// Where the strip lies, [pixel]. A field is as wide as its longest label, "XVIII" or "100%", needs.
struct Strip {
  int width = 0, picture_height = 0;  // of the canvas, and of what is above the strip
  int scale = 1;                      // pixels of a label's dot
  int swatch = 0, height = 0;         // of a field, and of all of it

  Strip(int width_, int height_) : picture_height(height_) {
    constexpr int kFieldDots = 4 * kLetterStep + 3;
    scale = std::clamp(width_ / (kFields * kFieldDots), 1, 8);
    width = std::max(width_, kFields * kFieldDots);
    swatch = std::max(16 * scale, width / kFields / 2);
    height = swatch + 4 * (kLetterHeight + 3) * scale + 5 * scale;
  }
  int first(int field) const { return static_cast<int>(static_cast<long>(field) * width / kFields); }
  int field_at(int x) const {
    int field = static_cast<int>(static_cast<long>(x) * kFields / width);
    while (field + 1 < kFields && first(field + 1) <= x) ++field;
    return field;
  }
};

double light_of_zone(int zone) { return brdf::luminance_of_zone<double>(zone, Zones::kMiddleGrey, Zones::kGreyZone); }

// The picture, and the strip's fields below it, as one picture of light.
image::Picture on_canvas(const image::Picture& light, const Strip& strip, bool has_fields) {
  image::Picture out(strip.width, strip.picture_height + strip.height);
  for (int y = 0; y < light.height; ++y)
    std::copy_n(light.rgb.begin() + static_cast<std::ptrdiff_t>(3) * y * light.width, 3 * light.width,
                out.at(0, y).data());
  for (int y = strip.picture_height; has_fields && y < strip.picture_height + strip.swatch; ++y)
    for (int x = 0; x < strip.width; ++x)
      for (float& v : out.at(x, y)) v = static_cast<float>(light_of_zone(strip.field_at(x)));
  return out;
}

void fill(image::DisplayPicture& out, int x0, int y0, int x1, int y1, std::uint8_t grey) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      for (std::uint8_t& v : out.at(x, y)) v = grey;
}

void put_color(image::DisplayPicture& out, int x, int y, const DisplayColor& color) {
  for (std::size_t c = 0; c < 3; ++c)
    out.at(x, y)[c] = static_cast<std::uint8_t>(255 * std::clamp(color[c], 0.0f, 1.0f) + 0.5f);
}

// Grey beside and below the picture, and the labels of a field: what `third` says is the last of them. `rows` says what they
// are.
template <class Third>
void finish(image::DisplayPicture& out, const Strip& strip, int picture_width, std::string_view rows, Third third) {
  fill(out, picture_width, 0, strip.width, strip.picture_height, kSurroundGrey);
  fill(out, 0, strip.picture_height + strip.swatch, strip.width, out.height, kSurroundGrey);
  for (int field = 0; field < kFields; ++field) {
    char ev[8];
    const int stops = field - static_cast<int>(Zones::kGreyZone);
    std::snprintf(ev, sizeof ev, stops == 0 ? "%d" : "%+d", stops);
    const std::array<std::string, 3> lines{std::string(zone_numeral(field)), ev, third(field)};
    int y = strip.picture_height + strip.swatch + 3 * strip.scale;
    for (const std::string& line : lines) {
      const int middle = (strip.first(field) + strip.first(field + 1)) / 2;
      draw_text(out, middle - text_width(line) * strip.scale / 2, y, line, strip.scale, kLabelGrey);
      y += (kLetterHeight + 3) * strip.scale;
    }
  }
  draw_text(out, 3 * strip.scale, out.height - (kLetterHeight + 3) * strip.scale, rows, strip.scale, kRowsGrey);
}

image::DisplayPicture wedge_picture(const image::Picture& light, const view::Shower& shower) {
  const Strip strip(light.width, light.height);
  image::DisplayPicture out = shower.show(on_canvas(light, strip, true));
  std::array<int, kFields> codes{};
  for (int field = 0; field < kFields; ++field)
    codes[static_cast<std::size_t>(field)] = out.at(strip.first(field), strip.picture_height)[1];
  finish(out, strip, light.width, "rows: zone, EV of the light, display code at this exposure",
         [&](int field) { return std::to_string(codes[static_cast<std::size_t>(field)]); });
  return out;
}

float exposed_at(const image::Picture& light, int x, int y, double scale) {
  const float luminance = luminance_of(light.at(x, y));
  return std::isnan(luminance) ? 0.0f
                               : static_cast<float>(std::clamp(scale * static_cast<double>(luminance), -1e38, 1e38));
}

// Numerals over a picture of zones, on a grid, where all around is of one zone.
void write_numerals(image::DisplayPicture& out, const image::Picture& light, double scale, int dot) {
  const int cell_width = 5 * kLetterStep * dot, cell_height = 3 * kLetterHeight * dot;
  for (int y0 = 0; y0 + cell_height <= light.height; y0 += cell_height)
    for (int x0 = y0 / cell_height % 2 * cell_width / 2; x0 + cell_width <= light.width; x0 += cell_width) {
      const int zone = zone_at(exposed_at(light, x0 + cell_width / 2, y0 + cell_height / 2, scale));
      const std::string_view numeral = zone_numeral(zone);
      const int width = text_width(numeral) * dot, height = kLetterHeight * dot;
      const int left = x0 + (cell_width - width) / 2, top = y0 + (cell_height - height) / 2;
      int others = 0;
      for (int y = top - dot; y < top + height + dot; ++y)
        for (int x = left - dot; x < left + width + dot; ++x)
          others += zone_at(exposed_at(light, x, y, scale)) != zone ? 1 : 0;
      if (20 * others > (width + 2 * dot) * (height + 2 * dot)) continue;
      const auto& c = kZoneColors[static_cast<std::size_t>(zone)];
      const bool is_bright = 2126 * c[0] + 7152 * c[1] + 722 * c[2] > 1100000;
      draw_text(out, left, top, numeral, dot, is_bright ? 0 : 255);
    }
}

image::DisplayPicture zones_picture(const image::Picture& light, double scale) {
  const Strip strip(light.width, light.height);
  image::DisplayPicture out(strip.width, strip.picture_height + strip.height);
  tbb::parallel_for(tbb::blocked_range<int>(0, light.height), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < light.width; ++x) put_color(out, x, y, zone_color(exposed_at(light, x, y, scale), x, y));
  });
  write_numerals(out, light, scale, strip.scale);
  for (int y = strip.picture_height; y < strip.picture_height + strip.swatch; ++y)
    for (int x = 0; x < strip.width; ++x)
      put_color(out, x, y, zone_color(static_cast<float>(light_of_zone(strip.field_at(x))), x, y));
  Histogram histogram;
  histogram.add(light);
  const Shares shares = Meter(histogram, {}).shares(std::log2(scale));
  finish(out, strip, light.width, "rows: zone, EV after exposure, share of the pixels", [&](int field) -> std::string {
    const double share = 100 * shares.zones[static_cast<std::size_t>(field)];
    return share == 0 ? "-" : share < 0.5 ? "<1%" : std::to_string(static_cast<int>(share + 0.5)) + "%";
  });
  return out;
}

image::DisplayPicture curve_picture(const image::Picture& light, const scene::View& view) {
  const Strip strip(light.width, light.height);
  const auto limits = curve_limits(view);
  scene::View unexposed = view;
  unexposed.ev = 0;
  const view::Shower shower(unexposed);
  const double scale = std::exp2(view.ev);
  image::DisplayPicture out(strip.width, strip.picture_height + strip.height);
  tbb::parallel_for(tbb::blocked_range<int>(0, strip.picture_height + strip.swatch), [&](const auto& rows) {
    image::Picture row(strip.width, 1);
    for (int y = rows.begin(); y != rows.end(); ++y) {
      const bool is_picture = y < strip.picture_height;
      const int width = is_picture ? light.width : strip.width;
      for (int x = 0; x < width; ++x)
        for (float& v : row.at(x, 0))
          v = is_picture ? exposed_at(light, x, y, scale) : static_cast<float>(light_of_zone(strip.field_at(x)));
      std::vector<float> shown = row.rgb;
      shower.encode(shown);
      for (int x = 0; x < width; ++x) {
        const std::size_t i = 3 * static_cast<std::size_t>(x);
        put_color(out, x, y, curve_color({shown[i], shown[i + 1], shown[i + 2]}, row.at(x, 0)[0], limits, x, y));
      }
    }
  });
  finish(out, strip, light.width, "rows: zone, EV after exposure, curve: T toe, L line, S shoulder",
         [&](int field) -> std::string {
           const double exposed = light_of_zone(field);
           return exposed < limits[0] ? "T" : exposed > limits[1] ? "S" : "L";
         });
  return out;
}

// Two of eight pixels, along a diagonal.
bool on_hatch(int x, int y, bool rising) { return ((rising ? x + y : x - y) & 7) < 2; }
constexpr float kHatch = 0.7f;

}  // namespace

int zone_at(float exposed) {
  return static_cast<int>(brdf::zone_index(
      brdf::zone_of<float>(exposed, static_cast<float>(Zones::kMiddleGrey), static_cast<float>(Zones::kGreyZone))));
}

DisplayColor zone_color(float exposed, int x, int y) {
  const int zone = zone_at(exposed);
  DisplayColor out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<float>(kZoneColors[static_cast<std::size_t>(zone)][c]) / 255;
  const bool below = zone < 5;
  const bool hatched = below ? zone % 2 == 1 : zone > 5 && zone % 2 == 0;
  if (hatched && on_hatch(x, y, !below))
    for (float& v : out) v *= kHatch;
  return out;
}

DisplayColor curve_color(const DisplayColor& grey, float exposed, const std::array<double, 2>& limits, int x, int y) {
  const bool in_toe = exposed<static_cast<float>(limits[0]), in_shoulder = exposed> static_cast<float>(limits[1]);
  if (!in_toe && !in_shoulder) return grey;
  constexpr float kShare = 0.6f;
  const DisplayColor& to = in_toe ? kToeColor : kShoulderColor;
  DisplayColor out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = (grey[c] + kShare * (to[c] - grey[c])) * (on_hatch(x, y, in_shoulder) ? kHatch : 1.0f);
  return out;
}

Overlay overlay_named(std::string_view option, std::string_view name) {
  std::string list;
  std::array<std::string_view, kOverlays.size()> names;
  for (std::size_t i = 0; i < kOverlays.size(); ++i) {
    if (kOverlays[i].name == name) return kOverlays[i].overlay;
    names[i] = kOverlays[i].name;
    list += (i == 0 ? "" : ", ") + std::string(names[i]);
  }
  const std::string near = files::nearest_name(name, names.data(), names.size());
  throw files::UsageError(std::string(option) + " " + files::in_quotes(name) + " is not one of " + list +
                          (near.empty() ? "" : "; did you mean " + near + "?"));
}

image::DisplayPicture picture_with(Overlay overlay, const image::Picture& light, const scene::View& view) {
  switch (overlay) {
    case Overlay::kWedge:
      return wedge_picture(light, view::Shower(view));
    case Overlay::kZones:
      return zones_picture(light, std::exp2(view.ev));
    case Overlay::kCurve:
      return curve_picture(light, view);
    case Overlay::kNone:
      break;
  }
  return view::Shower(view).show(light);
}

}  // namespace likeness::exposure
