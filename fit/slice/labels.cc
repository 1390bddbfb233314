#include "fit/slice/labels.h"

#include <algorithm>
#include <vector>

namespace likeness::fit {
namespace {

constexpr int kWidth = 5, kHeight = 7, kPitch = 6;

// Seven rows of five bits, the highest bit to the left.
struct Glyph {
  char character;
  std::array<std::uint8_t, kHeight> rows;
};
// clang-format off
constexpr std::array kGlyphs{
    Glyph{'0', {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}}, Glyph{'1', {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    Glyph{'2', {0x0e, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1f}}, Glyph{'3', {0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e}},
    Glyph{'4', {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}}, Glyph{'5', {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e}},
    Glyph{'6', {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}}, Glyph{'7', {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}},
    Glyph{'8', {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}}, Glyph{'9', {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c}},
    Glyph{'A', {0x0e, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11}}, Glyph{'B', {0x1e, 0x11, 0x11, 0x1e, 0x11, 0x11, 0x1e}},
    Glyph{'C', {0x0e, 0x11, 0x10, 0x10, 0x10, 0x11, 0x0e}}, Glyph{'D', {0x1c, 0x12, 0x11, 0x11, 0x11, 0x12, 0x1c}},
    Glyph{'E', {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x1f}}, Glyph{'F', {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x10}},
    Glyph{'G', {0x0e, 0x11, 0x10, 0x17, 0x11, 0x11, 0x0f}}, Glyph{'H', {0x11, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11}},
    Glyph{'I', {0x0e, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e}}, Glyph{'J', {0x07, 0x02, 0x02, 0x02, 0x02, 0x12, 0x0c}},
    Glyph{'K', {0x11, 0x12, 0x14, 0x18, 0x14, 0x12, 0x11}}, Glyph{'L', {0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x1f}},
    Glyph{'M', {0x11, 0x1b, 0x15, 0x15, 0x11, 0x11, 0x11}}, Glyph{'N', {0x11, 0x19, 0x19, 0x15, 0x13, 0x13, 0x11}},
    Glyph{'O', {0x0e, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0e}}, Glyph{'P', {0x1e, 0x11, 0x11, 0x1e, 0x10, 0x10, 0x10}},
    Glyph{'Q', {0x0e, 0x11, 0x11, 0x11, 0x15, 0x12, 0x0d}}, Glyph{'R', {0x1e, 0x11, 0x11, 0x1e, 0x14, 0x12, 0x11}},
    Glyph{'S', {0x0f, 0x10, 0x10, 0x0e, 0x01, 0x01, 0x1e}}, Glyph{'T', {0x1f, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04}},
    Glyph{'U', {0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0e}}, Glyph{'V', {0x11, 0x11, 0x11, 0x11, 0x11, 0x0a, 0x04}},
    Glyph{'W', {0x11, 0x11, 0x11, 0x15, 0x15, 0x1b, 0x11}}, Glyph{'X', {0x11, 0x11, 0x0a, 0x04, 0x0a, 0x11, 0x11}},
    Glyph{'Y', {0x11, 0x11, 0x0a, 0x04, 0x04, 0x04, 0x04}}, Glyph{'Z', {0x1f, 0x01, 0x02, 0x04, 0x08, 0x10, 0x1f}},
    Glyph{'.', {0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c}}, Glyph{',', {0x00, 0x00, 0x00, 0x00, 0x0c, 0x04, 0x08}},
    Glyph{'+', {0x00, 0x04, 0x04, 0x1f, 0x04, 0x04, 0x00}}, Glyph{'-', {0x00, 0x00, 0x00, 0x1f, 0x00, 0x00, 0x00}},
    Glyph{'=', {0x00, 0x00, 0x1f, 0x00, 0x1f, 0x00, 0x00}}, Glyph{'_', {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x1f}},
    Glyph{'/', {0x01, 0x01, 0x02, 0x04, 0x08, 0x10, 0x10}}, Glyph{'(', {0x02, 0x04, 0x08, 0x08, 0x08, 0x04, 0x02}},
    Glyph{')', {0x08, 0x04, 0x02, 0x02, 0x02, 0x04, 0x08}},
};
// clang-format on

const Glyph* glyph_of(char c) {
  if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  const auto at = std::find_if(kGlyphs.begin(), kGlyphs.end(), [&](const Glyph& g) { return g.character == c; });
  return at == kGlyphs.end() ? nullptr : &*at;
}

void paint_inside(image::DisplayPicture& picture, int x, int y, const std::array<std::uint8_t, 3>& color) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
  std::copy(color.begin(), color.end(), picture.at(x, y).begin());
}

// Calls visit(dx, dy) for every pixel of the text, from its origin: the upper left corner of its first letter.
template <class F>
void for_each_pixel(std::string_view text, const Lettering& lettering, F&& visit) {
  const int s = lettering.scale;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const Glyph* glyph = glyph_of(text[i]);
    if (glyph == nullptr) continue;
    for (int row = 0; row < kHeight * s; ++row)
      for (int column = 0; column < kWidth * s; ++column) {
        if ((glyph->rows[static_cast<std::size_t>(row / s)] >> (kWidth - 1 - column / s) & 1) == 0) continue;
        const int along = static_cast<int>(i) * kPitch * s + column;
        if (lettering.upwards) visit(row, -along);
        else visit(along, row);
      }
  }
}

}  // namespace

int text_width(std::string_view text, int scale) {
  return text.empty() ? 0 : (static_cast<int>(text.size()) * kPitch - (kPitch - kWidth)) * scale;
}

void write_text(image::DisplayPicture& picture, int x, int y, std::string_view text, const Lettering& lettering) {
  if (lettering.outlined)
    for_each_pixel(text, lettering, [&](int dx, int dy) {
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j) paint_inside(picture, x + dx + i, y + dy + j, {0, 0, 0});
    });
  for_each_pixel(text, lettering, [&](int dx, int dy) { paint_inside(picture, x + dx, y + dy, lettering.color); });
}

image::DisplayPicture with_axes(const image::DisplayPicture& slice, const std::string& title) {
  const int size = slice.width, scale = std::max(1, size / 256), letter = kHeight * scale, gap = 4 * scale;
  const int left = 2 * letter + 5 * gap, top = letter + 2 * gap, bottom = 2 * letter + 5 * gap, right = 2 * letter;
  const Lettering ink{{40, 40, 40}, scale, false, false};
  image::DisplayPicture out(std::max(left + size + right, left + text_width(title, scale) + gap), top + size + bottom);
  std::fill(out.rgb.begin(), out.rgb.end(), std::uint8_t{255});
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto from = slice.at(x, y);
      std::copy(from.begin(), from.end(), out.at(left + x, top + y).begin());
    }
  for (int i = -1; i <= size; ++i)  // a frame of one pixel
    for (const auto& [x, y] : {std::pair{i, -1}, {i, size}, {-1, i}, {size, i}})
      paint_inside(out, left + x, top + y, ink.color);

  for (const int degrees : {0, 30, 60, 90}) {
    const std::string number = std::to_string(degrees);
    const int along = degrees * size / 90, half = text_width(number, scale) / 2;
    for (int i = 0; i < gap; ++i) {
      paint_inside(out, left + std::min(along, size), top + size + i, ink.color);
      paint_inside(out, left - 1 - i, top + size - std::max(along, 1), ink.color);
    }
    write_text(out, left + along - half, top + size + gap + scale, number, ink);
    write_text(out, left - gap - 2 * scale - text_width(number, scale),
               std::clamp(top + size - along - letter / 2, 0, top + size - letter), number, ink);
  }
  const std::string across = "theta_h (deg)", up = "theta_d (deg)";
  write_text(out, left + (size - text_width(across, scale)) / 2, top + size + 3 * gap + letter, across, ink);
  Lettering upwards = ink;
  upwards.upwards = true;
  write_text(out, gap / 2, top + (size + text_width(up, scale)) / 2, up, upwards);
  write_text(out, left, gap, title, ink);

  // What lies where (docs/conventions.md).
  const Lettering over{{255, 255, 255}, scale, false, true};
  Lettering over_upwards = over;
  over_upwards.upwards = true;
  const auto middle = [&](std::string_view text) { return (size - text_width(text, scale)) / 2; };
  write_text(out, left + middle("Fresnel peak"), top + gap, "Fresnel peak", over);
  write_text(out, left + middle("diffuse"), top + size / 2, "diffuse", over);
  write_text(out, left + gap, top + size - middle("specular peak"), "specular peak", over_upwards);
  write_text(out, left + size - letter - gap, top + size - middle("retroreflection"), "retroreflection", over_upwards);
  return out;
}

}  // namespace likeness::fit
