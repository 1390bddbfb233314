#pragma once

#include <array>
#include <string>
#include <vector>

#include "render/plan/plan.h"

// A plan as people and programs read it.
namespace likeness::plan {

// What an effect costs where it was measured: CPU milliseconds for a million samples of pixels, of the scene as it is and
// without the effect; medians, with the quartiles of their difference.
struct Cost {
  double with_ms = 0, without_ms = 0;
  double low_ms = 0, high_ms = 0;  // quartiles of with - without, one for each pair of readings
  double difference_ms = 0;        // their median
  bool is_measured = false;
};
using Costs = std::array<Cost, kEffectCount>;

// Part i of Callisto's kernels (bit i of MaterialPlan::callisto_parts) is effect i.
inline constexpr std::size_t kCallistoParts = 6;

// The effects of a material's kernel, in words: "diffuse, second_lobe"; of other models their name.
std::string kernel_text(const MaterialPlan& material);

// What a material has besides: "textures, normal map".
std::string features_text(const MaterialPlan& material);

// Tables for a terminal. `costs` may be null.
std::string text_of(const Plan& plan, const Costs* costs);
std::string json_of(const Plan& plan, const std::string& scene, const Costs* costs);

// One self-contained page, and its drawing alone.
std::string page_of(const Plan& plan, const std::string& scene, const Costs* costs);
std::string svg_of(const Plan& plan, const std::string& scene, const Costs* costs);

// A SHA-256 of what is worked on: effects and kernels, not names nor reasons. Scenes of one digest run the same code.
std::string digest_of(const Plan& plan);

}  // namespace likeness::plan
