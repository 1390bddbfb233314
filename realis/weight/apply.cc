#include <cmath>

#include "realis/weight/table.h"
#include "render/files/files.h"

namespace likeness::realis::weight {
namespace {

std::size_t known(const char* option, const std::string& name) {
  const std::size_t at = weight_named(name);
  if (at != kNoWeight) return at;
  std::array<std::string_view, kWeights.size()> names;
  std::string all;
  for (std::size_t i = 0; i < names.size(); ++i)
    names[i] = kWeights[i].name, all += (i == 0 ? "" : ", ") + std::string(names[i]);
  const std::string near = files::nearest_name(name, names.data(), names.size());
  throw files::UsageError(std::string(option) + " " + files::in_quotes(name) + " is no weight" +
                          (near.empty() ? "" : "; did you mean " + near + "?") + " (" + all + ")");
}

}  // namespace

Choice choice_of(std::span<const std::string> only, std::span<const std::string> with,
                 std::span<const std::string> without, const Settings& settings) {
  Choice out;
  out.settings = settings;
  if (!only.empty()) out.is_on.fill(false);
  for (const std::string& name : only) out.is_on[known("--only", name)] = true;
  for (const std::string& name : with) out.is_on[known("--with", name)] = true;
  for (const std::string& name : without) {
    const std::size_t at = known("--without", name);
    if (kWeights[at].make == nullptr)
      throw files::UsageError("--without " + name + ": it is always on (" + std::string(kWeights[at].text) + ")");
    out.is_on[at] = false;
  }
  for (std::size_t i = 0; i < kWeights.size(); ++i)
    if (kWeights[i].make == nullptr) out.is_on[i] = true;
  for (const Row& row : kWeights)
    for (const SettingRow& setting : row.settings) {
      if (setting.name.empty()) continue;
      const double value = setting.value(out.settings);
      if (!(value >= setting.low && value <= setting.high))
        throw files::UsageError("--" + std::string(setting.name) + " = " + files::number_text(value) + " is outside [" +
                                files::number_text(setting.low) + ", " + files::number_text(setting.high) + "]");
    }
  return out;
}

std::vector<Layer> apply(const Samples& s, const Choice& choice, std::span<float> product, bool keeps) {
  std::vector<Layer> out;
  for (std::size_t i = 0; i < kWeights.size(); ++i) {
    if (!choice.is_on[i] || kWeights[i].make == nullptr) continue;
    Weights weights = kWeights[i].make(s, choice.settings);
    for (std::size_t at = 0; at < weights.size(); ++at) product[at] *= weights[at];
    if (keeps) out.push_back({kWeights[i].name, std::move(weights)});
  }
  return out;
}

}  // namespace likeness::realis::weight
