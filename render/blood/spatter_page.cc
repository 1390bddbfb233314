#include "render/blood/spatter_page.h"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "render/image/tone_curve.h"
#include "render/image/write.h"
#include "render/page/html.h"

namespace likeness::blood {
namespace {

const SpeedRow& row_of(const SpatterOptions& options) { return kSpeeds[static_cast<std::size_t>(options.speed)]; }

std::array<int, kParts.size()> counts_of(const Spatter& spatter) {
  std::array<int, kParts.size()> out{};
  for (const Drop& drop : spatter.drops) {
    ++out[static_cast<std::size_t>(drop.part)];
    if (drop.run > 0) ++out[static_cast<std::size_t>(Part::kDrips)];
  }
  return out;
}

double covered_share(const std::vector<float>& coverage) {
  double sum = 0;
  for (const float value : coverage) sum += static_cast<double>(value);
  return sum / static_cast<double>(coverage.size());
}

}  // namespace

std::string summary_of(const SpatterOptions& options, const Spatter& spatter, const Decal& decal) {
  std::string out = std::string(row_of(options).name) + " speed, " + page::plain(options.distance) + " m, " +
                    page::plain(options.angle_deg) + " deg: " + std::to_string(spatter.drops.size()) + " of " +
                    std::to_string(spatter.thrown) + " drops arrive, " + std::to_string(decal.outside) +
                    " beyond the decal\n";
  const auto counts = counts_of(spatter);
  for (const PartRow& row : kParts)
    out += "  " + std::string(row.name) + std::string(14 - row.name.size(), ' ') +
           std::to_string(counts[static_cast<std::size_t>(row.part)]) + ", covers " +
           page::number(100 * covered_share(decal.coverage[static_cast<std::size_t>(row.part)])) + " %\n";
  return out;
}

std::string json_of(const SpatterOptions& options, const Spatter& spatter, const Decal& decal) {
  nlohmann::ordered_json out{{"format", "likeness blood spatter"},
                             {"version", 1},
                             {"speed", row_of(options).name},
                             {"distance_m", options.distance},
                             {"angle_deg", options.angle_deg},
                             {"receiver", options.is_wall ? "wall" : "floor"},
                             {"seed", options.seed},
                             {"thrown", spatter.thrown},
                             {"thrown_mist", spatter.thrown_mist},
                             {"outside", decal.outside},
                             {"size", decal.size},
                             {"extent_mm", decal.extent}};
  for (const Relation& relation : kRelations)
    out["relations"].push_back({{"what", relation.what}, {"formula", relation.formula}, {"source", relation.source}});
  out["drops"] = nlohmann::ordered_json::array();
  for (const Drop& drop : spatter.drops)
    out["drops"].push_back({{"part", kParts[static_cast<std::size_t>(drop.part)].name},
                            {"at_mm", drop.at},
                            {"width_mm", drop.width},
                            {"length_mm", drop.length},
                            {"turn_rad", drop.turn},
                            {"angle_deg", drop.angle_deg},
                            {"diameter_mm", drop.diameter},
                            {"velocity_m_s", drop.velocity},
                            {"spines", drop.spines},
                            {"run_mm", drop.run}});
  return out.dump(1) + "\n";
}

std::string page_of(const SpatterOptions& options, const Spatter& spatter, const Decal& decal,
                    const image::Picture& preview) {
  std::string out = page::page_head("Spatter");
  out += page::element("h1", "Spatter");
  out += "<p class=\"verdict\">" +
         page::escape(std::string(row_of(options).name) + " speed (" + std::string(row_of(options).cause) + "), " +
                      page::plain(options.distance) + " m, axis at " + page::plain(options.angle_deg) +
                      " degrees: " + std::to_string(spatter.drops.size()) + " of " + std::to_string(spatter.thrown) +
                      " drops arrive.") +
         "</p>\n";
  out += "<figure><img style=\"width:100%;max-width:720px\" alt=\"The stains\" src=\"" +
         page::png_data_url(image::png_bytes(image::display(preview))) + "\"><figcaption>" +
         page::escape(page::plain(decal.extent) + " mm a side; up is up.") + "</figcaption></figure>\n";
  out += page::element("h2", "Layers") +
         "<div "
         "class=\"scroll\"><table><thead><tr><th>layer</th><th>what</th><th>stains</th><th>covers</th></tr></"
         "thead><tbody>";
  const auto counts = counts_of(spatter);
  for (const PartRow& row : kParts) {
    const auto part = static_cast<std::size_t>(row.part);
    out += "<tr>" + page::element("td", row.name) + page::element("td", row.text) +
           page::element("td", std::to_string(counts[part])) +
           page::element("td", page::number(100 * covered_share(decal.coverage[part])) + " %") + "</tr>";
  }
  out += "</tbody></table></div>\n" + page::element("h2", "Relations") + "<div class=\"scroll\"><table><tbody>";
  for (const Relation& relation : kRelations)
    out += "<tr>" + page::element("th", relation.what) + page::element("td", relation.formula) +
           page::element("td", relation.source) + "</tr>";
  return out + "</tbody></table></div>\n" + page::page_foot();
}

}  // namespace likeness::blood
