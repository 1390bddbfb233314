#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "realis/export/planes.h"

namespace likeness::realis {

std::string info_text(const Planes& planes, std::span<const glm::dvec3> photographed) {
  using Json = nlohmann::ordered_json;
  const FormatRow& row = row_of(planes.format);
  Json out{{"width", planes.width}, {"height", planes.height}, {"format", "jpg"}, {"type", row.name}};
  if (planes.format == Format::kBilinear) out["resolution"] = kGrid;
  out["colorspace"] = row.has_components ? "mrgb" : "rgb";
  const std::vector<glm::dvec3> own = nodes();
  if (planes.format == Format::kRbf) {
    out["sigma"] = node_width();
    photographed = own;
  }
  Json lights = Json::array();
  for (const glm::dvec3& light : photographed)
    for (int k = 0; k < 3; ++k) lights.push_back(std::round(1000 * light[k]) / 1000);
  out["lights"] = lights;
  out["nplanes"] = planes.count();
  out["quality"] = planes.quality;
  if (row.has_components) out["basis"] = planes.basis;
  Json material;
  if (row.has_components) material["range"] = planes.range;
  material["scale"] = planes.scale, material["bias"] = planes.bias;
  out["materials"] = Json::array({material});
  return out.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace likeness::realis
