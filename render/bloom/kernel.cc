#include "render/bloom/kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "render/files/files.h"
#include "render/json/fields.h"
#include "render/json/json.h"

namespace likeness::bloom {
namespace {

constexpr std::size_t kLargestKernelFile = 1 << 20;

const json::Value& member(const json::Value& object, std::string_view key, const std::string& source) {
  if (!object.is_object())
    json::refuse_at(source, object.line, "an object is expected, with \"" + std::string(key) + "\"");
  const json::Value* found = object.find(key);
  if (found == nullptr) json::refuse_at(source, object.line, "\"" + std::string(key) + "\" is missing");
  return *found;
}

double number_within(const json::Value& object, std::string_view key, double low, double high,
                     const std::string& source) {
  const json::Value& value = member(object, key, source);
  if (!value.is_number() || !(value.number >= low && value.number <= high))
    json::refuse_at(source, value.line,
                    "\"" + std::string(key) + "\" is " + json::kind_text(value) + "; a number in [" +
                        files::number_text(low) + ", " + files::number_text(high) + "] is expected");
  return value.number;
}

std::array<double, 3> weights_of(const json::Value& object, std::string_view key, const std::string& source) {
  const json::Value& list = member(object, key, source);
  std::array<double, 3> out{};
  bool fits = list.is_list() && list.items.size() == 3;
  for (std::size_t c = 0; fits && c < 3; ++c) {
    out[c] = list.items[c].number;
    fits = list.items[c].is_number() && out[c] >= 0 && out[c] <= 1;
  }
  if (!fits)
    json::refuse_at(source, list.line, "\"" + std::string(key) + "\" needs three numbers in [0, 1]: red, green, blue");
  return out;
}

Family family_of(const json::Value& object, const std::string& source) {
  const json::Value& value = member(object, "family", source);
  for (const FamilyRow& row : kFamilies)
    if (value.is_text() && value.text == row.name) return row.family;
  json::refuse_at(source, value.line, "no family " + files::in_quotes(value.text) + "; there are gaussian, cauchy");
}

}  // namespace

double density(Family family, double scale, double r) {
  const double t = r / scale, unit = 1 / (2 * std::numbers::pi * scale * scale);
  if (family == Family::kGaussian) return unit * std::exp(-0.5 * t * t);
  return unit / std::pow(1 + t * t, 1.5);
}

std::vector<double> sampled(Family family, double scale, int radius) {
  const int side = 2 * radius + 1;
  std::vector<double> out(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0);
  const auto at = [&](int x, int y) -> double& {
    return out[static_cast<std::size_t>(y + radius) * static_cast<std::size_t>(side) +
               static_cast<std::size_t>(x + radius)];
  };
  // One octant; the others are its mirror images.
  for (int y = 0; y <= radius; ++y)
    for (int x = y; x <= radius; ++x) {
      if (static_cast<double>(x) * x + static_cast<double>(y) * y > static_cast<double>(radius) * radius) break;
      // Where the density bends within a pixel, its mean over the pixel.
      const bool is_near = std::hypot(x, y) < 3 + 6 * scale && scale < 8;
      const int fine = is_near ? std::clamp(static_cast<int>(std::ceil(8 / scale)), 1, 33) : 1;
      double sum = 0;
      for (int j = 0; j < fine; ++j)
        for (int i = 0; i < fine; ++i)
          sum += density(family, scale, std::hypot(x + (i + 0.5) / fine - 0.5, y + (j + 0.5) / fine - 0.5));
      sum /= fine * fine;
      for (const int sx : {-x, x})
        for (const int sy : {-y, y}) at(sx, sy) = at(sy, sx) = sum;
    }
  double total = 0;
  for (const double value : out) total += value;
  for (double& value : out) value /= total;
  return out;
}

std::string text_of(const Kernel& kernel) {
  nlohmann::ordered_json out{
      {"format", "likeness bloom"}, {"version", 1}, {"radius", kernel.radius}, {"direct", kernel.direct}};
  out["components"] = nlohmann::ordered_json::array();
  for (const Component& component : kernel.components) {
    const auto row = std::find_if(kFamilies.begin(), kFamilies.end(),
                                  [&](const FamilyRow& r) { return r.family == component.family; });
    nlohmann::ordered_json entry{{"family", row->name}, {"scale", component.scale}, {"weight", component.weight}};
    if (component.scale_error > 0)
      entry["scale_error"] = component.scale_error, entry["weight_error"] = component.weight_error;
    out["components"].push_back(entry);
  }
  return out.dump(2) + "\n";
}

Kernel kernel_of(std::string_view text, const std::string& source) {
  const json::Value root = json::parse(text, source, {.values = 10'000, .depth = 8});
  const json::Value& format = member(root, "format", source);
  if (!format.is_text() || format.text != "likeness bloom")
    json::refuse_at(source, format.line,
                    "\"format\" is " + json::kind_text(format) + "; a kernel says \"likeness bloom\"");
  number_within(root, "version", 1, 1, source);
  Kernel kernel;
  kernel.radius = static_cast<int>(number_within(root, "radius", 1, kMostRadius, source));
  kernel.direct = weights_of(root, "direct", source);
  const json::Value& components = member(root, "components", source);
  if (!components.is_list() || components.items.size() > kMostComponents)
    json::refuse_at(source, components.line,
                    "\"components\" needs a list of at most " + std::to_string(kMostComponents));
  std::array<double, 3> total = kernel.direct;
  for (const json::Value& item : components.items) {
    Component component;
    component.family = family_of(item, source);
    component.scale = number_within(item, "scale", 0.1, 1e5, source);
    component.weight = weights_of(item, "weight", source);
    if (item.find("scale_error") != nullptr)
      component.scale_error = number_within(item, "scale_error", 0, 1e300, source);
    for (std::size_t c = 0; c < 3; ++c) total[c] += component.weight[c];
    kernel.components.push_back(component);
  }
  for (const double sum : total)
    if (std::abs(sum - 1) > 1e-6)
      json::refuse_at(
          source, root.line,
          "direct and weights of a channel add up to " + files::number_text(sum) + "; no light is lost if it is 1");
  return kernel;
}

Kernel read_kernel(const std::filesystem::path& file) {
  return kernel_of(files::read_whole(file, kLargestKernelFile), file.string());
}

}  // namespace likeness::bloom
