#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "render/plan/plan.h"

// How good a frame is to be: one level for each effect that can be had at several prices.
namespace likeness::runtime {

// How the light of an environment picture reaches a surface.
enum class EnvironmentLevel : std::uint8_t {
  kMaps,  // harmonics for the diffuse, filtered pictures for the specular: no shadow
  kRays1,
  kRays4,
  kRays16,
  kRays64  // directions that the surface and the picture choose, with shadow rays
};

struct Settings {
  int pixel_samples = 1;  // of the picture: points in each pixel
  int light_samples = 4;  // shadow rays to each light with an area, for each of those points
  EnvironmentLevel environment = EnvironmentLevel::kMaps;
  std::uint32_t seed = 0;
};

// A setting, its levels from the cheapest to the best, and whether a plan has what it works on: the one list that the
// command line, the quality file, the cost page and the docs are made of.
struct SettingRow {
  std::string_view name, text;
  std::span<const std::string_view> levels;
  void (*apply)(Settings& settings, std::size_t level);
  std::size_t (*level_of)(const Settings& settings);
  bool (*matters)(const plan::Plan& plan);
};

namespace detail {
inline constexpr std::array<std::string_view, 5> kCounts{"1", "4", "16", "64", "256"};
inline constexpr std::array<std::string_view, 5> kEnvironments{"maps", "rays1", "rays4", "rays16", "rays64"};
constexpr int count_of(std::size_t level) { return 1 << (2 * level); }
constexpr std::size_t level_of(int count) {
  std::size_t level = 0;
  while (level + 1 < kCounts.size() && count_of(level) < count) ++level;
  return level;
}
}  // namespace detail

inline constexpr std::array kSettings{
    SettingRow{"pixel_samples", "points in each pixel", detail::kCounts,
               [](Settings& s, std::size_t level) { s.pixel_samples = detail::count_of(level); },
               [](const Settings& s) { return detail::level_of(s.pixel_samples); },
               [](const plan::Plan&) { return true; }},
    SettingRow{"light_samples", "shadow rays to each light with an area, for each point", detail::kCounts,
               [](Settings& s, std::size_t level) { s.light_samples = detail::count_of(level); },
               [](const Settings& s) { return detail::level_of(s.light_samples); },
               [](const plan::Plan& plan) {
                 return plan.has(plan::Effect::kAreaLights) || plan.has(plan::Effect::kEmission);
               }},
    SettingRow{"environment", "light of the environment's picture: maps without shadows, or rays",
               detail::kEnvironments,
               [](Settings& s, std::size_t level) { s.environment = static_cast<EnvironmentLevel>(level); },
               [](const Settings& s) { return static_cast<std::size_t>(s.environment); },
               [](const plan::Plan& plan) { return plan.has(plan::Effect::kEnvironment); }},
};

}  // namespace likeness::runtime
