#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "render/plan/plan.h"
#include "render/texture/levels.h"

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

// The diffuse of surfaces with bumps that are too small to be seen, in materials of Callisto's.
enum class DistantDiffuse : std::uint8_t {
  kLambert,  // as if the surface were as smooth as it looks
  kProxima   // of facets as rough as the bumps are
};

struct Settings {
  int pixel_samples = 1;  // of the picture: points in each pixel
  int light_samples = 4;  // shadow rays to each light with an area, for each of those points
  EnvironmentLevel environment = EnvironmentLevel::kMaps;
  texture::Filter textures = texture::Filter::kAnisotropic;
  DistantDiffuse distant_diffuse = DistantDiffuse::kProxima;
  std::uint32_t seed = 0;
};

// A setting, its levels from the cheapest to the best, and whether a plan has what it works on: the one list that the
// command line, the quality file, the cost page and the docs are made of.
struct SettingRow {
  std::string_view name, text;
  std::string_view label;  // of a level in a line of several: "4 pts", "env maps"
  std::string_view pass;   // on whose time for a point it tells most; empty: on none's, or on how often all of them run
  std::span<const std::string_view> levels;
  int (*work)(std::size_t level);  // what it is a number of (rays, points); 0: it is no number, or none
  void (*apply)(Settings& settings, std::size_t level);
  std::size_t (*level_of)(const Settings& settings);
  bool (*matters)(const plan::Plan& plan);
};

namespace detail {
inline constexpr std::array<std::string_view, 5> kCounts{"1", "4", "16", "64", "256"};
inline constexpr std::array<std::string_view, 5> kEnvironments{"maps", "rays1", "rays4", "rays16", "rays64"};
inline constexpr std::array<std::string_view, 4> kFilters{"full", "nearest", "trilinear", "anisotropic"};
inline constexpr std::array<std::string_view, 2> kDistantDiffuses{"lambert", "proxima"};
constexpr int count_of(std::size_t level) { return 1 << (2 * level); }
constexpr int no_number(std::size_t) { return 0; }
constexpr std::size_t level_of(int count) {
  std::size_t level = 0;
  while (level + 1 < kCounts.size() && count_of(level) < count) ++level;
  return level;
}
}  // namespace detail

inline constexpr std::array kSettings{
    SettingRow{"pixel_samples", "points in each pixel", "pts", "", detail::kCounts, detail::count_of,
               [](Settings& s, std::size_t level) { s.pixel_samples = detail::count_of(level); },
               [](const Settings& s) { return detail::level_of(s.pixel_samples); },
               [](const plan::Plan&) { return true; }},
    SettingRow{"light_samples", "shadow rays to each light with an area, for each point", "shadow", "direct",
               detail::kCounts, detail::count_of,
               [](Settings& s, std::size_t level) { s.light_samples = detail::count_of(level); },
               [](const Settings& s) { return detail::level_of(s.light_samples); },
               [](const plan::Plan& plan) {
                 return plan.has(plan::Effect::kAreaLights) || plan.has(plan::Effect::kEmission);
               }},
    SettingRow{"environment", "light of the environment's picture: maps without shadows, or rays", "env", "environment",
               detail::kEnvironments, [](std::size_t level) { return level == 0 ? 0 : detail::count_of(level - 1); },
               [](Settings& s, std::size_t level) { s.environment = static_cast<EnvironmentLevel>(level); },
               [](const Settings& s) { return static_cast<std::size_t>(s.environment); },
               [](const plan::Plan& plan) { return plan.has(plan::Effect::kEnvironment); }},
    SettingRow{"textures", "textures where a pixel covers more than a texel: full size, or levels", "tex", "textures",
               detail::kFilters, detail::no_number,
               [](Settings& s, std::size_t level) { s.textures = static_cast<texture::Filter>(level); },
               [](const Settings& s) { return static_cast<std::size_t>(s.textures); },
               [](const plan::Plan& plan) { return plan.has(plan::Effect::kTextureLevels); }},
    SettingRow{"distant_diffuse", "diffuse of bumps that are too small to be seen; with levels of textures", "far", "",
               detail::kDistantDiffuses, detail::no_number,
               [](Settings& s, std::size_t level) { s.distant_diffuse = static_cast<DistantDiffuse>(level); },
               [](const Settings& s) { return static_cast<std::size_t>(s.distant_diffuse); },
               [](const plan::Plan& plan) { return plan.has(plan::Effect::kProxima); }},
};

}  // namespace likeness::runtime
