#include "render/exposure/text.h"

#include <array>
#include <cctype>
#include <charconv>
#include <cstddef>

namespace likeness::exposure {
namespace {

struct Glyph {
  char c;
  std::array<const char*, kLetterHeight> rows;
};
// clang-format off
constexpr std::array kGlyphs{
    Glyph{'0', {" ### ", "#   #", "#  ##", "# # #", "##  #", "#   #", " ### "}},
    Glyph{'1', {"  #  ", " ##  ", "  #  ", "  #  ", "  #  ", "  #  ", " ### "}},
    Glyph{'2', {" ### ", "#   #", "    #", "   # ", "  #  ", " #   ", "#####"}},
    Glyph{'3', {"#####", "   # ", "  #  ", "   # ", "    #", "#   #", " ### "}},
    Glyph{'4', {"   # ", "  ## ", " # # ", "#  # ", "#####", "   # ", "   # "}},
    Glyph{'5', {"#####", "#    ", "#### ", "    #", "    #", "#   #", " ### "}},
    Glyph{'6', {"  ## ", " #   ", "#    ", "#### ", "#   #", "#   #", " ### "}},
    Glyph{'7', {"#####", "    #", "   # ", "  #  ", " #   ", " #   ", " #   "}},
    Glyph{'8', {" ### ", "#   #", "#   #", " ### ", "#   #", "#   #", " ### "}},
    Glyph{'9', {" ### ", "#   #", "#   #", " ####", "    #", "   # ", " ##  "}},
    Glyph{'A', {" ### ", "#   #", "#   #", "#####", "#   #", "#   #", "#   #"}},
    Glyph{'B', {"#### ", "#   #", "#   #", "#### ", "#   #", "#   #", "#### "}},
    Glyph{'C', {" ### ", "#   #", "#    ", "#    ", "#    ", "#   #", " ### "}},
    Glyph{'D', {"#### ", "#   #", "#   #", "#   #", "#   #", "#   #", "#### "}},
    Glyph{'E', {"#####", "#    ", "#    ", "#### ", "#    ", "#    ", "#####"}},
    Glyph{'F', {"#####", "#    ", "#    ", "#### ", "#    ", "#    ", "#    "}},
    Glyph{'G', {" ### ", "#   #", "#    ", "# ###", "#   #", "#   #", " ####"}},
    Glyph{'H', {"#   #", "#   #", "#   #", "#####", "#   #", "#   #", "#   #"}},
    Glyph{'I', {" ### ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", " ### "}},
    Glyph{'J', {"  ###", "   # ", "   # ", "   # ", "   # ", "#  # ", " ##  "}},
    Glyph{'K', {"#   #", "#  # ", "# #  ", "##   ", "# #  ", "#  # ", "#   #"}},
    Glyph{'L', {"#    ", "#    ", "#    ", "#    ", "#    ", "#    ", "#####"}},
    Glyph{'M', {"#   #", "## ##", "# # #", "# # #", "#   #", "#   #", "#   #"}},
    Glyph{'N', {"#   #", "##  #", "# # #", "#  ##", "#   #", "#   #", "#   #"}},
    Glyph{'O', {" ### ", "#   #", "#   #", "#   #", "#   #", "#   #", " ### "}},
    Glyph{'P', {"#### ", "#   #", "#   #", "#### ", "#    ", "#    ", "#    "}},
    Glyph{'Q', {" ### ", "#   #", "#   #", "#   #", "# # #", "#  # ", " ## #"}},
    Glyph{'R', {"#### ", "#   #", "#   #", "#### ", "# #  ", "#  # ", "#   #"}},
    Glyph{'S', {" ####", "#    ", "#    ", " ### ", "    #", "    #", "#### "}},
    Glyph{'T', {"#####", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  "}},
    Glyph{'U', {"#   #", "#   #", "#   #", "#   #", "#   #", "#   #", " ### "}},
    Glyph{'V', {"#   #", "#   #", "#   #", "#   #", "#   #", " # # ", "  #  "}},
    Glyph{'W', {"#   #", "#   #", "#   #", "# # #", "# # #", "# # #", " # # "}},
    Glyph{'X', {"#   #", "#   #", " # # ", "  #  ", " # # ", "#   #", "#   #"}},
    Glyph{'Y', {"#   #", "#   #", " # # ", "  #  ", "  #  ", "  #  ", "  #  "}},
    Glyph{'Z', {"#####", "    #", "   # ", "  #  ", " #   ", "#    ", "#####"}},
    Glyph{' ', {"     ", "     ", "     ", "     ", "     ", "     ", "     "}},
    Glyph{'+', {"     ", "  #  ", "  #  ", "#####", "  #  ", "  #  ", "     "}},
    Glyph{'-', {"     ", "     ", "     ", "#####", "     ", "     ", "     "}},
    Glyph{'.', {"     ", "     ", "     ", "     ", "     ", " ##  ", " ##  "}},
    Glyph{',', {"     ", "     ", "     ", "     ", " ##  ", "  #  ", " #   "}},
    Glyph{':', {"     ", " ##  ", " ##  ", "     ", " ##  ", " ##  ", "     "}},
    Glyph{'%', {"##   ", "##  #", "   # ", "  #  ", " #   ", "#  ##", "   ##"}},
    Glyph{'<', {"   # ", "  #  ", " #   ", "#    ", " #   ", "  #  ", "   # "}},
};
// clang-format on

constexpr std::uint64_t dots_of(const std::array<const char*, kLetterHeight>& rows) {
  std::uint64_t out = 0;
  for (const char* row : rows)
    for (int x = 0; x < kLetterWidth; ++x) out = out << 1 | (row[x] == '#' ? 1u : 0u);
  return out;
}
constexpr std::uint64_t kBox = dots_of({"#####", "#   #", "#   #", "#   #", "#   #", "#   #", "#####"});

constexpr std::array<std::string_view, 17> kNumerals{"0",  "I", "II", "III", "IV",   "V",   "VI", "VII", "VIII",
                                                     "IX", "X", "XI", "XII", "XIII", "XIV", "XV", "XVI"};

}  // namespace

std::uint64_t letter(char c) {
  const char capital = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const Glyph& glyph : kGlyphs)
    if (glyph.c == capital) return dots_of(glyph.rows);
  return kBox;
}

void draw_text(image::DisplayPicture& picture, int x, int y, std::string_view text, int scale, std::uint8_t grey) {
  for (const char c : text) {
    const std::uint64_t dots = letter(c);
    for (int row = 0; row < kLetterHeight * scale; ++row)
      for (int column = 0; column < kLetterWidth * scale; ++column) {
        const int bit = kLetterWidth * kLetterHeight - 1 - (row / scale * kLetterWidth + column / scale);
        const int px = x + column, py = y + row;
        if ((dots >> bit & 1) == 0 || px < 0 || py < 0 || px >= picture.width || py >= picture.height) continue;
        for (std::uint8_t& v : picture.at(px, py)) v = grey;
      }
    x += kLetterStep * scale;
  }
}

std::string_view zone_numeral(int zone) { return kNumerals[static_cast<std::size_t>(zone)]; }

double zone_named(std::string_view text) {
  std::string capitals;
  for (const char c : text) capitals += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (std::size_t i = 0; i < kNumerals.size(); ++i)
    if (kNumerals[i] == capitals) return static_cast<double>(i);
  double value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= 0 && value <= 16)) return -1;
  return value;
}

}  // namespace likeness::exposure
