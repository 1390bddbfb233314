#include "render/photograph/brackets.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "render/files/files.h"
#include "render/image/read.h"
#include "render/photograph/tiff_tags.h"

namespace likeness::photograph {
namespace {

std::vector<std::string_view> fields_of(std::string_view line) {
  // A name may hold blanks where commas stand between fields.
  const std::string_view between = line.find(',') != line.npos ? "," : " \t";
  std::vector<std::string_view> out;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find_first_of(between, at), line.size());
    std::string_view field = line.substr(at, end - at);
    const std::size_t first = field.find_first_not_of(" \t\r");
    field = first == field.npos ? std::string_view() : field.substr(first, field.find_last_not_of(" \t\r") + 1 - first);
    if (!field.empty() || between == ",") out.push_back(field);
    at = end + 1;
  }
  return out;
}

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> seconds_of(std::string_view text) {
  const std::size_t slash = text.find('/');
  std::optional<double> above = number_of(text.substr(0, slash));
  if (slash != text.npos) {
    const std::optional<double> below = number_of(text.substr(slash + 1));
    if (!above || !below || !(*below > 0)) return std::nullopt;
    *above /= *below;
  }
  return above && *above >= 1e-9 && *above <= 1e6 ? above : std::nullopt;
}

std::vector<Bracket> brackets_of(std::string_view text, const std::string& name, const std::filesystem::path& folder) {
  std::vector<Bracket> out;
  std::set<std::string, std::less<>> seen;
  std::size_t line = 0;
  bool is_first = true;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view row = text.substr(at, end - at);
    at = end + 1;
    ++line;
    row = row.substr(0, row.find('#'));
    const std::vector<std::string_view> fields = fields_of(row);
    if (fields.empty() || (fields.size() == 1 && fields[0].empty())) continue;
    const auto refuse = [&](const std::string& what) {
      throw files::InputError(name + ":" + std::to_string(line) + ": " + what);
    };
    const bool is_header = std::exchange(is_first, false) && fields.size() == 2 && fields[1] == "seconds";
    if (is_header) continue;
    if (fields.size() != 2 && fields.size() != 6)
      refuse(std::to_string(fields.size()) +
             " fields; a line has 2 (name seconds) or 6 (name exposure 1/shutter f/stop gain nd)");
    if (fields[0].empty() || fields[0].find('\0') != fields[0].npos) refuse("a name is missing");
    if (!seen.insert(std::string(fields[0])).second) refuse(files::in_quotes(fields[0]) + " comes twice");
    Bracket bracket{folder / std::string(fields[0]), {}};
    Setting& s = bracket.setting;
    const std::optional<double> seconds = seconds_of(fields[1]);
    if (!seconds) refuse("exposure " + files::in_quotes(fields[1]) + " is no time from 1e-9 to 1e6 s (0.5 or 1/250)");
    s.seconds = *seconds;
    if (fields.size() == 6) {
      std::array<double, 4> numbers{};
      for (std::size_t i = 0; i < 4; ++i) {
        const std::optional<double> value = number_of(fields[i + 2]);
        if (!value || std::abs(*value) > 1e9) refuse(files::in_quotes(fields[i + 2]) + " is no number");
        numbers[i] = *value;
      }
      if (!(std::abs(numbers[0] * s.seconds - 1) <= 0.02))
        refuse("1/shutter " + files::number_text(numbers[0]) + " is not 1 / exposure " + files::number_text(s.seconds));
      if (!(numbers[1] > 0.1 && numbers[1] < 1e3))
        refuse("f/stop " + files::number_text(numbers[1]) + " is outside 0.1 to 1000");
      if (std::abs(numbers[2]) > 200 || !(numbers[3] >= 0 && numbers[3] < 20))
        refuse("gain [dB] beyond 200, or nd outside 0 to 20");
      s.f_number = numbers[1];
      s.gain_db = numbers[2];
      s.density = numbers[3];
    }
    out.push_back(std::move(bracket));
    if (out.size() > kMostFrames) refuse("more than " + std::to_string(kMostFrames) + " frames");
  }
  if (out.empty()) throw files::InputError(name + ": lists no frame");
  return out;
}

std::vector<Bracket> read_brackets(const std::filesystem::path& file) {
  return brackets_of(files::read_whole(file, kMostListBytes), file.string(), file.parent_path());
}

Bracket bracket_by_exif(const std::filesystem::path& file) {
  const Taken taken = taken_of(files::read_whole(file, image::kMostFileBytes), file.string());
  if (!taken.exposure_s)
    throw files::InputError(file.string() + ": does not say its exposure time; give --list or --times");
  return {file, {*taken.exposure_s, taken.f_number, taken.iso, 0, 0}};
}

std::vector<double> exposures_of(const std::vector<Bracket>& brackets) {
  std::vector<double> out;
  for (const Bracket& bracket : brackets) {
    const Setting &s = bracket.setting, &first = brackets.front().setting;
    const double f = s.f_number && first.f_number ? *first.f_number / *s.f_number : 1;
    const double iso = s.iso && first.iso ? *s.iso / *first.iso : 1;
    out.push_back(s.seconds * f * f * iso * std::exp2((s.gain_db - first.gain_db) / 3) *
                  std::pow(10, first.density - s.density));
  }
  return out;
}

}  // namespace likeness::photograph
