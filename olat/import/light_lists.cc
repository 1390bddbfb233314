#include "olat/import/light_lists.h"

#include <array>
#include <charconv>
#include <cmath>

#include <glm/geometric.hpp>

#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/json/fields.h"
#include "render/json/json.h"

namespace likeness::olat_import {
namespace {

using files::in_quotes;
using json::refuse_at;

// The lines of a text, without their ends.
class Lines {
 public:
  explicit Lines(std::string_view text) : left_(text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text) {}

  bool next(std::string_view& line) {
    if (left_.empty()) return false;
    const std::size_t end = left_.find('\n');
    line = left_.substr(0, end);
    left_ = end == left_.npos ? std::string_view() : left_.substr(end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number_;
    return true;
  }
  std::size_t number() const { return number_; }

 private:
  std::string_view left_;
  std::size_t number_ = 0;
};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

bool number_of(std::string_view text, double& out) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(out);
}

// A direction to a light, of any length but 0.
glm::dvec3 direction_of(const glm::dvec3& v, const std::string& source, std::size_t line) {
  const double length = glm::length(v);
  if (!(length > 1e-9) || !std::isfinite(length))
    refuse_at(source, line, "the direction to the light has no length that is finite and above 0");
  return v / length;
}

void must_have_room(std::size_t count, const std::string& source, std::size_t line) {
  if (count > capture::kMostLights)
    refuse_at(source, line, "more than " + std::to_string(capture::kMostLights) + " lights");
}

void must_have_lights(const LightList& list, const std::string& source) {
  if (list.lights.empty()) throw files::InputError(source + ": has no lights; expected a row for each photograph");
}

constexpr std::array<std::string_view, 7> kColumns{"file", "lx", "ly", "lz", "ir", "ig", "ib"};
constexpr const char* kHeader = "file,lx,ly,lz,ir,ig,ib";

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t comma = line.find(',');
    out.push_back(trimmed(line.substr(0, comma)));
    if (comma == line.npos) return out;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

LightList read_lights_csv(std::string_view text, const std::string& source) {
  LightList out;
  Lines lines(text);
  std::size_t columns = 0;
  for (std::string_view line; lines.next(line);) {
    if (trimmed(line).empty()) continue;
    if (line.starts_with('#')) {
      out.remarks += (out.remarks.empty() ? "" : "; ") + std::string(trimmed(line.substr(1)));
      continue;
    }
    const std::vector<std::string_view> cells = cells_of(line);
    if (columns == 0) {
      columns = cells.size();
      const bool fits = (columns == 4 || columns == 7) && std::equal(cells.begin(), cells.end(), kColumns.begin());
      if (!fits) refuse_at(source, lines.number(), "the header is " + in_quotes(line) + "; expected " + kHeader);
      continue;
    }
    if (cells.size() != columns)
      refuse_at(source, lines.number(),
                "has " + std::to_string(cells.size()) + " columns; the header has " + std::to_string(columns));
    if (cells[0].empty()) refuse_at(source, lines.number(), "names no file");
    std::array<double, 6> numbers{0, 0, 0, 1, 1, 1};
    for (std::size_t i = 1; i < columns; ++i)
      if (!number_of(cells[i], numbers[i - 1]))
        refuse_at(source, lines.number(),
                  std::string(kColumns[i]) + " = " + in_quotes(cells[i]) + "; expected a finite number");
    for (std::size_t i = 3; i < 6; ++i)
      if (!(numbers[i] > 0) || numbers[i] > 1e9)
        refuse_at(source, lines.number(),
                  std::string(kColumns[i + 1]) + " = " + files::number_text(numbers[i]) +
                      " is outside (0, 1e9] (intensity that pixels are divided by)");
    ListedLight& one = out.lights.emplace_back();
    one.file = cells[0];
    one.light.place = capture::DistantLight{direction_of({numbers[0], numbers[1], numbers[2]}, source, lines.number())};
    one.light.intensity = {numbers[3], numbers[4], numbers[5]};
    must_have_room(out.lights.size(), source, lines.number());
  }
  if (columns == 0) throw files::InputError(source + ": has no header; expected " + kHeader);
  must_have_lights(out, source);
  return out;
}

LightList read_lp(std::string_view text, const std::string& source) {
  LightList out;
  Lines lines(text);
  double count = -1;
  for (std::string_view line; lines.next(line);) {
    line = trimmed(line);
    if (line.empty()) continue;
    if (count < 0) {
      if (!number_of(line, count) || count != std::floor(count) || count < 1)
        refuse_at(source, lines.number(), in_quotes(line) + "; expected the number of lights");
      continue;
    }
    std::array<double, 3> numbers{};
    std::string_view rest = line;
    for (std::size_t i = 3; i-- > 0;) {
      const std::size_t blank = rest.find_last_of(" \t");
      if (blank == rest.npos || !number_of(rest.substr(blank + 1), numbers[i]))
        refuse_at(source, lines.number(),
                  in_quotes(line) + "; expected a file and three numbers: photo.png 0.1 0.2 0.97");
      rest = trimmed(rest.substr(0, blank));
    }
    if (rest.empty()) refuse_at(source, lines.number(), "names no file");
    ListedLight& one = out.lights.emplace_back();
    one.file = rest;
    one.light.place = capture::DistantLight{direction_of({numbers[0], numbers[1], numbers[2]}, source, lines.number())};
    must_have_room(out.lights.size(), source, lines.number());
  }
  if (count < 0) throw files::InputError(source + ": is empty; expected the number of lights, then \"file x y z\"");
  if (static_cast<double>(out.lights.size()) != count)
    throw files::InputError(source + ": has " + std::to_string(out.lights.size()) + " lights; its first line says " +
                            files::number_text(count));
  return out;
}

namespace {

// Three numbers of {"x": 1, ...} or [1, 2, 3].
glm::dvec3 triple_of(const json::Value& value, const std::array<const char*, 3>& names, const std::string& source) {
  glm::dvec3 out(0);
  for (std::size_t i = 0; i < 3; ++i) {
    const json::Value* one = value.is_list() && value.items.size() == 3 ? &value.items[i] : value.find(names[i]);
    if (!one || !one->is_number() || !(std::abs(one->number) < 1e9))
      refuse_at(source, value.line, "expected three numbers, {\"" + std::string(names[0]) + "\": ...} or a list");
    out[static_cast<int>(i)] = one->number;
  }
  return out;
}

constexpr std::array<const char*, 3> kXyz{"x", "y", "z"}, kRgb{"r", "g", "b"};

// What linear pixels are divided by: brighter LEDs have a larger one.
void read_calibration(const json::Value& row, const std::string& source, capture::Light& light) {
  if (!row.is_object()) refuse_at(source, row.line, "a calibration of a light is an object");
  if (const json::Value* white = row.find("whiteBalance")) light.intensity = triple_of(*white, kRgb, source);
  if (const json::Value* intensity = row.find("intensity")) {
    if (!intensity->is_number()) refuse_at(source, intensity->line, "intensity is no number");
    light.intensity *= intensity->number;
  }
  if (row.find("spatialCalibration"))
    light.label = "its spatialCalibration is left out: falls off with the square of the distance";
}

void must_be_positive(const capture::Light& light, const std::string& source, std::size_t line) {
  for (int c = 0; c < 3; ++c)
    if (!(light.intensity[c] > 0 && light.intensity[c] < 1e9))
      refuse_at(source, line, "intensity " + files::number_text(light.intensity[c]) + " is outside (0, 1e9)");
}

}  // namespace

LightList read_dome(std::string_view text, const std::string& source, double meters) {
  const json::Value tree = json::parse(text, source);
  if (!tree.is_object()) refuse_at(source, tree.line, "is no object; expected a dome of RelightLab");
  const json::Value* chosen = nullptr;
  bool is_near = false;
  const json::Value* configuration = tree.find("lightConfiguration");
  const std::string kind = configuration ? configuration->text : "";
  const auto take = [&](const char* key, bool near) {
    const json::Value* list = tree.find(key);
    if (chosen || !list || !list->is_list() || list->items.empty()) return;
    chosen = list;
    is_near = near;
  };
  if (kind == "spherical") take("positionsSphere", true);
  else if (kind == "lights3d") take("positions3d", true);
  else if (kind == "directional") take("directions", false);
  else if (configuration)
    refuse_at(source, configuration->line,
              "lightConfiguration = " + in_quotes(kind) + "; expected directional, spherical or lights3d");
  take("positions", true);
  take("directions", false);
  if (!chosen) throw files::InputError(source + ": has neither directions nor positions of lights");
  if (is_near && !(meters > 0))
    throw files::InputError(
        source + ": has positions of lights and does not state their unit; say --unit-m 0.01 (cm) or 0.001 (mm)");

  LightList out;
  must_have_room(chosen->items.size(), source, chosen->line);
  for (const json::Value& row : chosen->items) {
    ListedLight& one = out.lights.emplace_back();
    const glm::dvec3 v = triple_of(row, kXyz, source);
    if (is_near) one.light.place = capture::NearLight{v * meters};
    else one.light.place = capture::DistantLight{direction_of(v, source, row.line)};
  }
  for (const char* key : {"lightsCalibration", "ledAdjust"}) {
    const json::Value* list = tree.find(key);
    if (!list || !list->is_list() || list->items.empty()) continue;
    if (list->items.size() != out.lights.size())
      refuse_at(source, list->line,
                std::string(key) + " has " + std::to_string(list->items.size()) + " rows for " +
                    std::to_string(out.lights.size()) + " lights");
    for (std::size_t i = 0; i < out.lights.size(); ++i) {
      capture::Light& light = out.lights[i].light;
      if (key == std::string_view("ledAdjust")) light.intensity = triple_of(list->items[i], kRgb, source);
      else read_calibration(list->items[i], source, light);
      must_be_positive(light, source, list->items[i].line);
    }
    break;
  }
  if (const json::Value* label = tree.find("label")) out.remarks = label->text;
  return out;
}

std::string lp_text(const std::vector<ListedLight>& lights) {
  std::string out = std::to_string(lights.size()) + "\n";
  for (const ListedLight& one : lights) {
    const glm::dvec3 to_light = std::get<capture::DistantLight>(one.light.place).to_light;
    out += one.file;
    for (int c = 0; c < 3; ++c) out += " " + files::number_text(to_light[c]);
    out += "\n";
  }
  return out;
}

}  // namespace likeness::olat_import
