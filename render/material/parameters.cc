#include "render/material/parameters.h"

#include <cmath>

#include "render/files/files.h"

namespace likeness::material {
namespace {

constexpr std::size_t kLongestQuote = 60;  // characters of a user's text that a message repeats
constexpr std::array<std::string_view, 3> kChannelNames{"red", "green", "blue"};

std::string did_you_mean(std::string_view wanted, std::span<const std::string_view> names) {
  if (wanted.size() > kLongestQuote) return "";
  const std::string near = files::nearest_name(wanted, names.data(), names.size());
  return near.empty() ? "" : "; did you mean \"" + near + "\"?";
}

std::string list_of(std::span<const std::string_view> names) {
  std::string out;
  for (const std::string_view name : names) {
    if (!out.empty()) out += ", ";
    out += name;
  }
  return out;
}

// Empty, or why these channels do not fit the row.
std::string misfit(const brdf::Parameter& row, std::span<const double> channels) {
  const auto wanted = static_cast<std::size_t>(row.channels);
  const std::string name(row.name);
  if (channels.size() != wanted)
    return name + " has " + std::to_string(channels.size()) + (channels.size() == 1 ? " number" : " numbers") +
           "; it takes " + (wanted == 3 ? "3: red, green, blue" : "1") + " (" + std::string(row.text) + ")";
  for (std::size_t c = 0; c < wanted; ++c) {
    if (channels[c] >= row.range.low && channels[c] <= row.range.high) continue;  // false for NaN
    return name + (wanted == 3 ? "/" + std::to_string(c) + " (" + std::string(kChannelNames[c]) + ")" : "") + " = " +
           number_text(channels[c]) + " is outside [" + number_text(row.range.low) + ", " +
           number_text(row.range.high) + "] (" + std::string(row.text) + ")";
  }
  return "";
}

}  // namespace

std::string_view model_name(const brdf::AnyBrdf& brdf) {
  return std::visit([]<class M>(const M&) { return M::kName; }, brdf);
}

std::vector<Entry> entries(const brdf::AnyBrdf& brdf) {
  std::vector<Entry> out;
  const auto add = [&]<class V>(const brdf::Parameter& row, const V& value) {
    if constexpr (std::is_same_v<V, brdf::Rgb<double>>) {
      out.push_back({row, {value.r, value.g, value.b}});
    } else {
      out.push_back({row, {value, 0, 0}});
    }
  };
  std::visit([&](const auto& model) { brdf::for_each_parameter(model, add); }, brdf);
  return out;
}

std::string assign(brdf::AnyBrdf& brdf, std::string_view name, std::span<const double> channels) {
  bool found = false;
  std::string wrong;
  std::vector<std::string_view> names;
  const auto try_one = [&]<class V>(const brdf::Parameter& row, V& value) {
    names.push_back(row.name);
    if (row.name != name) return;
    found = true;
    wrong = misfit(row, channels);
    if (!wrong.empty()) return;
    if constexpr (std::is_same_v<V, brdf::Rgb<double>>) {
      value = V{channels[0], channels[1], channels[2]};
    } else {
      value = channels[0];
    }
  };
  std::visit([&](auto& model) { brdf::for_each_parameter(model, try_one); }, brdf);
  if (found) return wrong;
  const std::string near = did_you_mean(name, names);
  return in_quotes(name) + " is not a parameter of model \"" + std::string(model_name(brdf)) + "\"" +
         (near.empty() ? "; it has: " + list_of(names) : near);
}

std::string complaint(const brdf::AnyBrdf& brdf) {
  for (const Entry& entry : entries(brdf)) {
    const std::string wrong =
        misfit(entry.row, std::span(entry.value).first(static_cast<std::size_t>(entry.row.channels)));
    if (!wrong.empty()) return wrong;
  }
  return "";
}

std::string no_such_model(std::string_view name) {
  return "no model " + in_quotes(name) + did_you_mean(name, brdf::kModelNames) +
         " (models: " + list_of(brdf::kModelNames) + ")";
}

}  // namespace likeness::material
