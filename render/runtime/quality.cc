#include "render/runtime/quality.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "render/files/files.h"
#include "render/json/json.h"

namespace likeness::runtime {
namespace {

constexpr std::string_view kFormat = "likeness quality";
constexpr int kVersion = 1;
constexpr std::size_t kMostBytes = 1 << 20;
constexpr std::array<std::string_view, 6> kKeys{"format", "version", "settings", "scene", "camera", "measured"};

[[noreturn]] void refuse(const std::string& source, const json::Value& value, const std::string& what) {
  throw files::InputError(source + ":" + std::to_string(value.line) + ": " + what);
}

std::string one_of(std::span<const std::string_view> names) {
  std::string out;
  for (const std::string_view name : names) out += (out.empty() ? "" : ", ") + std::string(name);
  return out;
}

std::string did_you_mean(std::string_view wanted, std::span<const std::string_view> names) {
  const std::string near = files::nearest_name(wanted, names.data(), names.size());
  return near.empty() ? "" : "; did you mean " + near + "?";
}

bool is_count(std::string_view text) { return text.find_first_not_of("0123456789") == text.npos; }

// The level whose number is nearest in proportion.
std::string nearest_count(double wanted, std::span<const std::string_view> levels) {
  if (!(wanted > 0)) return "";
  const auto distance = [&](std::string_view level) {
    return std::abs(std::log(std::stod(std::string(level)) / wanted));
  };
  return "; the nearest is " + std::string(*std::min_element(levels.begin(), levels.end(), [&](auto a, auto b) {
           return distance(a) < distance(b);
         }));
}

void apply(const SettingRow& row, const json::Value& value, const std::string& source, Settings& settings) {
  const bool counts = is_count(row.levels.front());
  if (!value.is_text() && !(counts && value.is_number()))
    refuse(source, value,
           "/settings/" + std::string(row.name) + " is " + json::kind_text(value) + "; expected one of " +
               one_of(row.levels));
  const std::string level = value.is_text() ? value.text : files::number_text(value.number);
  for (std::size_t i = 0; i < row.levels.size(); ++i)
    if (row.levels[i] == level) return row.apply(settings, i);
  refuse(source, value,
         "/settings/" + std::string(row.name) + " has no level " + (value.is_text() ? files::in_quotes(level) : level) +
             "; expected one of " + one_of(row.levels) +
             (value.is_text() ? did_you_mean(level, row.levels) : nearest_count(value.number, row.levels)));
}

}  // namespace

Settings parse_quality(std::string_view text, const std::string& source) {
  const json::Value root = json::parse(text, source);
  constexpr std::string_view kStart = R"(a quality file begins {"format": "likeness quality", "version": 1, ...)";
  if (!root.is_object()) refuse(source, root, "the file holds " + json::kind_text(root) + "; " + std::string(kStart));
  const json::Value* format = root.find("format");
  if (format == nullptr || !format->is_text() || format->text != kFormat)
    refuse(source, format != nullptr ? *format : root, "/format is not \"likeness quality\"; " + std::string(kStart));
  const json::Value* version = root.find("version");
  if (version == nullptr || !version->is_number() || version->number != kVersion)
    refuse(source, version != nullptr ? *version : root, "/version is not 1, which is what this program reads");
  for (const json::Value& item : root.items)
    if (std::find(kKeys.begin(), kKeys.end(), item.key) == kKeys.end())
      refuse(source, item, "unknown key " + json::plain(item.key) + did_you_mean(item.key, kKeys));
  const json::Value* given = root.find("settings");
  if (given == nullptr || !given->is_object())
    refuse(
        source, given != nullptr ? *given : root,
        given == nullptr ? "/settings is missing" : "/settings is " + json::kind_text(*given) + "; expected an object");

  std::array<std::string_view, kSettings.size()> names;
  std::transform(kSettings.begin(), kSettings.end(), names.begin(), [](const SettingRow& row) { return row.name; });
  Settings settings;
  for (const json::Value& item : given->items) {
    const auto row = std::find_if(kSettings.begin(), kSettings.end(),
                                  [&](const SettingRow& r) { return r.name == std::string_view(item.key); });
    if (row == kSettings.end())
      refuse(source, item,
             "/settings/" + json::plain(item.key) + " is no setting; expected " + one_of(names) +
                 did_you_mean(item.key, names));
    apply(*row, item, source, settings);
  }
  return settings;
}

Settings read_quality(const std::filesystem::path& file) {
  return parse_quality(files::read_whole(file, kMostBytes), file.string());
}

std::string quality_text(const Settings& settings, const QualityOrigin& origin) {
  nlohmann::ordered_json out;
  out["format"] = kFormat;
  out["version"] = kVersion;
  for (const SettingRow& row : kSettings) {
    const std::string level(row.levels[row.level_of(settings)]);
    if (is_count(level)) out["settings"][std::string(row.name)] = std::stoi(level);
    else out["settings"][std::string(row.name)] = level;
  }
  if (!origin.scene.empty()) out["scene"] = origin.scene;
  if (!origin.camera.empty()) out["camera"] = origin.camera;
  for (const auto& [name, value] : origin.measured) out["measured"][name] = value;
  return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void write_quality(const std::filesystem::path& file, const Settings& settings, const QualityOrigin& origin) {
  files::write_whole(file, quality_text(settings, origin));
}

}  // namespace likeness::runtime
