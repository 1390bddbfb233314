#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "realis/weight/foreign.h"
#include "realis/weight/samples.h"
#include "realis/weight/sensor.h"
#include "realis/weight/shadow.h"
#include "realis/weight/specular.h"
#include "realis/weight/stretch.h"

namespace likeness::realis::weight {

struct Settings {
  StretchSettings stretch;
  ShadowSettings shadow;
  ClippedSettings clipped;
  BlackSettings black;
  ForeignSettings foreign;
  SpecularSettings specular;
};

// A number that a weight can be told.
struct SettingRow {
  std::string_view name;
  double& (*value)(Settings&);
  double low, high;
  std::string_view text;
};

// The only statement of the weights: command line, help, docs, layers and the ablation come from it.
struct Row {
  std::string_view name;
  Weights (*make)(const Samples&, const Settings&);  // nullptr: the reader or the solver does it
  bool is_default;
  std::array<SettingRow, 3> settings;  // those without a name are none
  std::string_view text;
};

// clang-format off
inline constexpr std::array kWeights{
    Row{"stretch", [](const Samples& s, const Settings& c) { return stretch(s, c.stretch); }, true,
        {{{"stretch-a", [](Settings& c) -> double& { return c.stretch.a; }, 0, 16, "power of the gradient"},
          {"stretch-b", [](Settings& c) -> double& { return c.stretch.b; }, 0, 1e6, "fade speed"}}},
        "what a camera sees at a slant; 1 where texture space is the picture"},
    Row{"shadow", [](const Samples& s, const Settings& c) { return shadow(s, c.shadow); }, true,
        {{{"shadow-full", [](Settings& c) -> double& { return c.shadow.full; }, 0.2, 1e3, "gap [pixel] at which nothing is trusted"},
          {"shadow-longest", [](Settings& c) -> double& { return c.shadow.longest; }, 1, 1e5, "widest gap [pixel]"}}},
        "between the contours of a shadow in photo and render"},
    Row{"clipped", [](const Samples& s, const Settings& c) { return clipped(s, c.clipped); }, true,
        {{{"clipped-at", [](Settings& c) -> double& { return c.clipped.clip; }, 1e-9, 1e30, "level that no file states [unit of the photo]"}}},
        "where the sensor was full, or the photo is not finite"},
    Row{"black", [](const Samples& s, const Settings& c) { return black(s, c.black); }, true,
        {{{"black-level", [](Settings& c) -> double& { return c.black.level; }, 0, 1, "least light that the sensor sees [unit of the photo]; 0: found"}}},
        "dead pixels, and light that a sensor has lost"},
    Row{"foreign", [](const Samples& s, const Settings& c) { return foreign(s, c.foreign); }, true,
        {{{"foreign-deviations", [](Settings& c) -> double& { return c.foreign.deviations; }, 1, 1e3, "of what a texel's lights differ by"},
          {"foreign-share", [](Settings& c) -> double& { return c.foreign.share; }, 0.01, 1e3, "of what a texel shows"},
          {"foreign-least", [](Settings& c) -> double& { return c.foreign.least; }, 1, 1e6, "pixels of an object"}}},
        "what one light shows, far off what its neighbours predict"},
    Row{"specular", [](const Samples& s, const Settings& c) { return specular(s, c.specular); }, false,
        {{{"specular-significance", [](Settings& c) -> double& { return c.specular.significance; }, 0.1, 1e3, "deviations above the rest"}}},
        "highlights that the render lacks, for bakes that other cameras see"},
    Row{"mask", nullptr, true, {}, "outside the mask there is no texel"},
    Row{"cosine", nullptr, true, {}, "max(cos, floor)^2: how much light a residual is a share of"},
};
// clang-format on
inline constexpr std::size_t kNoWeight = kWeights.size();
constexpr std::size_t weight_named(std::string_view name) {
  for (std::size_t i = 0; i < kWeights.size(); ++i)
    if (kWeights[i].name == name) return i;
  return kNoWeight;
}

struct Choice {
  std::array<bool, kWeights.size()> is_on{};
  Settings settings;
  Choice() {
    for (std::size_t i = 0; i < kWeights.size(); ++i) is_on[i] = kWeights[i].is_default;
  }
};

// A choice from names: `only` (none: those that are on by default), then `with`, then `without`. Mask and cosine stay on.
// Throws files::UsageError for a name that is none, with the nearest one, and for a setting out of its range.
Choice choice_of(std::span<const std::string> only, std::span<const std::string> with,
                 std::span<const std::string> without, const Settings& settings = {});

// One weight, and the picture that it makes of each light.
struct Layer {
  std::string_view name;
  Weights weights;
};
// The weights that are on, of a function; and their product, multiplied into `product` (of each sample). Weights are kept only if
// `keeps`: of 96 lights they are as large as the photographs.
std::vector<Layer> apply(const Samples& s, const Choice& choice, std::span<float> product, bool keeps);

}  // namespace likeness::realis::weight
