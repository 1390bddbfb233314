#include "render/plan/draw.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "render/files/files.h"

namespace likeness::plan {
namespace {

using Json = nlohmann::ordered_json;
using C = brdf::Callisto<double>;

static_assert(C::kDiffuse == 1u << static_cast<unsigned>(Effect::kDiffuse) &&
              C::kRise == 1u << static_cast<unsigned>(Effect::kDiffuseFresnel) &&
              C::kRetro == 1u << static_cast<unsigned>(Effect::kRetroreflection) &&
              C::kTerminator == 1u << static_cast<unsigned>(Effect::kSmoothTerminator) &&
              C::kFalloff == 1u << static_cast<unsigned>(Effect::kSpecularFalloff) &&
              C::kSecondLobe == 1u << static_cast<unsigned>(Effect::kSecondLobe) &&
              C::kAllParts == (1u << kCallistoParts) - 1);

std::vector<std::string_view> parts_of(const MaterialPlan& m) {
  std::vector<std::string_view> out;
  for (std::size_t i = 0; i < kCallistoParts; ++i)
    if ((m.callisto_parts >> i & 1) != 0) out.push_back(kEffects[i].name);
  return out;
}

std::vector<std::string_view> features_of(const MaterialPlan& m) {
  std::vector<std::string_view> out;
  if (m.has_textures) out.push_back("textures");
  if (m.has_normal_map) out.push_back("normal map");
  if (m.has_dual_normals) out.push_back("dual normals");
  if (m.is_cut_out) out.push_back("cut-out");
  if (m.emits) out.push_back("emission");
  return out;
}

std::string joined(const std::vector<std::string_view>& words) {
  std::string out;
  for (const std::string_view word : words) out += (out.empty() ? "" : ", ") + std::string(word);
  return out;
}

std::string padded(std::string text, std::size_t width) {
  // Columns count characters, not bytes: names may be UTF-8.
  std::size_t characters = 0;
  for (const char c : text) characters += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  if (characters < width) text.append(width - characters, ' ');
  return text;
}

std::string milliseconds(double ms) {
  char out[48];
  std::snprintf(out, sizeof out, "%+.0f", ms);
  return out;
}

}  // namespace

std::string kernel_text(const MaterialPlan& material) {
  if (material.model != C::kName) return "its own";
  const std::string parts = joined(parts_of(material));
  return parts.empty() ? "first specular lobe" : "first specular lobe, " + parts;
}

std::string features_text(const MaterialPlan& material) { return joined(features_of(material)); }

std::string text_of(const Plan& plan, const Costs* costs) {
  std::string out = "Effects that are on: ";
  const auto on =
      std::count_if(kEffects.begin(), kEffects.end(), [&](const auto& row) { return plan.has(row.effect); });
  out += std::to_string(on) + " of " + std::to_string(kEffectCount) +
         (plan.is_forced ? " (all are forced; the picture is the same without)" : "") + "\n\n";
  for (const EffectRow& row : kEffects) {
    const auto i = static_cast<std::size_t>(row.effect);
    const Decision& d = plan.decisions[i];
    out += (d.is_on ? "  on   " : "  off  ") + padded(std::string(row.name), 21);
    if (costs != nullptr) {
      const Cost& cost = (*costs)[i];
      out += padded(cost.is_measured ? milliseconds(cost.difference_ms) + " ms [" + milliseconds(cost.low_ms) + ", " +
                                           milliseconds(cost.high_ms) + "]"
                                     : "",
                    26);
    }
    out += d.because + "\n";
  }
  if (costs != nullptr)
    out += "\n  ms: CPU time for a million samples of pixels that the effect adds; median, and [quartiles]\n";
  out += "\nMaterials: " + std::to_string(plan.materials.size()) + "\n\n";
  std::size_t widest = 8;
  for (const MaterialPlan& m : plan.materials) widest = std::max(widest, std::min<std::size_t>(m.name.size(), 30));
  for (std::size_t i = 0; i < plan.materials.size(); ++i) {
    const MaterialPlan& m = plan.materials[i];
    out += "  " + padded(m.name.empty() ? std::to_string(i) : m.name, widest + 2) + padded(m.model, 18) +
           "kernel: " + kernel_text(m);
    if (const std::string features = features_text(m); !features.empty()) out += "; " + features;
    out += "\n";
  }
  return out;
}

std::string json_of(const Plan& plan, const std::string& scene, const Costs* costs) {
  Json out;
  out["scene"] = scene;
  out["digest"] = digest_of(plan);
  out["forced"] = plan.is_forced;
  out["effects"] = Json::array();
  for (const EffectRow& row : kEffects) {
    const auto i = static_cast<std::size_t>(row.effect);
    Json one;
    one["name"] = row.name;
    one["on"] = plan.decisions[i].is_on;
    one["because"] = plan.decisions[i].because;
    if (costs != nullptr && (*costs)[i].is_measured) {
      const Cost& cost = (*costs)[i];
      one["ms_per_million_samples"] = {{"with", cost.with_ms},
                                       {"without", cost.without_ms},
                                       {"difference", cost.difference_ms},
                                       {"quartiles", {cost.low_ms, cost.high_ms}}};
    }
    out["effects"].push_back(one);
  }
  out["materials"] = Json::array();
  for (const MaterialPlan& m : plan.materials)
    out["materials"].push_back(
        {{"name", m.name}, {"model", m.model}, {"kernel", parts_of(m)}, {"features", features_of(m)}});
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string digest_of(const Plan& plan) {
  std::string text = plan.is_forced ? "forced " : "";
  for (const EffectRow& row : kEffects)
    if (plan.has(row.effect)) text += std::string(row.name) + " ";
  for (const MaterialPlan& m : plan.materials)
    text += m.model + " " + std::to_string(m.callisto_parts) + " " + features_text(m) + ";";
  return files::sha256(text);
}

}  // namespace likeness::plan
