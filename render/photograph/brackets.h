#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Which photographs make a bracket, and how much light each let in.
namespace likeness::photograph {

inline constexpr std::size_t kMostFrames = 1000, kMostListBytes = 1 << 20;

// What a camera was set to. All finite; seconds and f-number above 0.
struct Setting {
  double seconds = 0;
  std::optional<double> f_number, iso;
  double gain_db = 0;  // doubles the exposure with each 3 dB
  double density = 0;  // optical, of filters: 10^-density of the light passes
};

struct Bracket {
  std::filesystem::path file;
  Setting setting;
};

// Lines of either form, with blanks or commas between; '#' begins a comment, a first line `name,seconds` is passed over:
//
//   name  seconds                                         seconds also as 1/250
//   name  exposure  1/shutter  f/stop  gain  nd           as Paul Debevec's image_list.txt has it: exposure in seconds, and
//                                                         1 / exposure, which must agree to 2 %
//
// Names are taken from `folder`. Throws files::InputError, one line with name and line number: another number of fields,
// what is no number or out of range, a name that comes twice, an empty list, more than kMostFrames.
std::vector<Bracket> brackets_of(std::string_view text, const std::string& name, const std::filesystem::path& folder);
std::vector<Bracket> read_brackets(const std::filesystem::path& file);

// "0.5", "1/250": above 0 and at most 1e6 seconds; nothing for another text.
std::optional<double> seconds_of(std::string_view text);

// By EXIF (tiff_tags.h). Throws files::InputError for a file that does not say its exposure time.
Bracket bracket_by_exif(const std::filesystem::path& file);

// Relative exposure of each frame: seconds, as the first frame's f-number, ISO speed, gain and filters would need them.
// Where one of two frames does not state f-number or ISO they are taken to be the same.
std::vector<double> exposures_of(const std::vector<Bracket>& brackets);

}  // namespace likeness::photograph
