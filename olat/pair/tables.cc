#include "olat/pair/tables.h"

#include <nlohmann/json.hpp>

#include "brdf/lighting/zone.h"
#include "olat/metric/metric.h"
#include "olat/pair/actions.h"
#include "olat/pair/exposure.h"
#include "olat/pair/picture.h"
#include "olat/pair/state.h"
#include "render/exposure/overlay.h"
#include "render/image/flip.h"
#include "render/view/color_config.h"
#include "render/view/view.h"

namespace likeness::olat_pair {
namespace {

using Json = nlohmann::ordered_json;

std::string text(std::string_view view) { return std::string(view); }

Json field_json(const Field& field) {
  static const State kDefault;
  Json out{{"name", text(field.name)}, {"text", text(field.text)}, {"shared", field.is_shared}};
  const State& d = kDefault;
  std::visit(
      [&](auto at) {
        using At = decltype(at);
        if constexpr (std::is_same_v<At, std::string State::*>) {
          out["kind"] = field.names.empty() ? "text" : "word";
          out["initial"] = d.*at;
          for (const std::string_view name : field.names) out["words"].push_back(text(name));
        } else if constexpr (std::is_same_v<At, double State::*>) {
          out["kind"] = "number";
          out["initial"] = d.*at;
        } else if constexpr (std::is_same_v<At, double brdf::GtTonemap<double>::*>) {
          out["kind"] = "number";
          out["initial"] = d.gt.*at;
          out["view"] = "gt";
        } else if constexpr (std::is_same_v<At, bool State::*>) {
          out["kind"] = "flag";
          out["initial"] = d.*at;
        } else {
          out["kind"] = "word";
          out["initial"] = text(field.choices[static_cast<std::size_t>(d.*at)].word);
          for (const Choice& c : field.choices) {
            out["words"].push_back(text(c.word));
            out["texts"].push_back(text(c.text));
          }
        }
      },
      field.at);
  if (out["kind"] == "number") out["range"] = {field.range[0], field.range[1]};
  return out;
}

}  // namespace

std::string tables_json() {
  Json out;
  for (const Field& field : fields()) out["fields"].push_back(field_json(field));
  for (const metric::MetricRow& row : metric::kMetrics)
    out["metrics"].push_back({{"id", text(row.id)},
                              {"unit", text(row.unit)},
                              {"text", text(row.text)},
                              {"signed", row.is_signed},
                              {"scale", scale_of(row.id)}});
  for (const std::string_view name : view::kOwnViews) {
    State state;
    state.view = text(name);
    const auto limits = curve_limits(state);
    out["views"].push_back({{"name", text(name)}, {"toe", limits[0]}, {"shoulder", limits[1]}});
  }
  for (const Action& a : kActions)
    out["actions"].push_back(
        {{"id", text(a.id)}, {"group", text(a.group)}, {"keys", text(a.keys)}, {"text", text(a.text)}});
  for (const ExposureRow& row : kExposures)
    out["exposures"][text(row.id)] = {{"word", text(row.word)}, {"text", text(row.text)}};
  out["zones"] = exposure::kZoneColors;
  out["grey"] = brdf::Zones::kMiddleGrey;
  out["grey_zone"] = brdf::Zones::kGreyZone;
  out["signed_colors"] = kSignedColors;
  constexpr int kMagma = 18;
  image::ErrorMap ramp{kMagma, 1, {}, 0};
  for (int i = 0; i < kMagma; ++i) ramp.error.push_back(static_cast<float>(i) / (kMagma - 1));
  const image::DisplayPicture magma = image::error_picture(ramp);
  for (int i = 0; i < kMagma; ++i) {
    const auto c = magma.at(i, 0);
    out["magma"].push_back({c[0] / 255.0, c[1] / 255.0, c[2] / 255.0});
  }
  out["toe_color"] = exposure::kToeColor;
  out["shoulder_color"] = exposure::kShoulderColor;
  out["sensor_stripe"] = kSensorStripe;
  out["display_stripe"] = kDisplayStripe;
  out["surround"] = kSurround;
  out["aces"] = view::aces_shader_text();
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string keys_table() {
  std::string out = "| Keys | What they do |\n| --- | --- |\n";
  std::string_view group;
  for (const Action& a : kActions) {
    if (a.group != group) out += "| **" + text(a.group) + "** | |\n";
    group = a.group;
    std::string keys;
    for (std::string_view rest = a.keys; !rest.empty();) {
      const std::string_view key = rest.substr(0, rest.find(' '));
      rest.remove_prefix(std::min(rest.size(), key.size() + 1));
      keys += (keys.empty() ? "`" : " `") + text(key) + "`";
    }
    out += "| " + keys + " | " + text(a.text) + " |\n";
  }
  return out;
}

}  // namespace likeness::olat_pair
