#include <algorithm>
#include <cmath>
#include <span>

#include <nlohmann/json.hpp>

#include "realis/report/leave_one_out.h"
#include "render/image/write.h"
#include "render/page/html.h"
#include "render/page/pareto_plot.h"
#include "render/page/svg.h"
#include "render/view/view.h"

namespace likeness::realis {
namespace {

using page::element;
using page::escape;
using page::fixed;
using page::number;

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.insert(0, width - text.size(), ' ');
  return text;
}

std::string foreword(const Study& s) {
  return std::to_string(s.light_ids.size()) + " lights, each left out once; " + std::to_string(s.subject.texels()) +
         " of " + std::to_string(s.texels_of_all) + " texels (every " + std::to_string(s.stride) + ". pixel of every " +
         std::to_string(s.stride) + ". line); PSNR of a peak of " + number(s.peak) +
         " (99.9th percentile of the photographs), stops above " + number(s.noise) +
         (s.is_noise_measured ? " (the capture's noise floor)" : " (1/1000 of the peak)");
}

std::vector<const Row*> of(const Study& s, Family family) {
  std::vector<const Row*> out;
  for (const Row& row : s.rows)
    if (row.family == family) out.push_back(&row);
  std::stable_sort(out.begin(), out.end(), [](const Row* a, const Row* b) { return a->bytes < b->bytes; });
  return out;
}

std::string verdict(const Study& s, const Row& baseline) {
  const Row* winner = winner_over(s, baseline);
  return winner == nullptr ? "not beaten"
                           : "beaten by " + winner->name + " (" + std::to_string(winner->bytes) +
                                 " B): " + fixed(winner->errors.psnr - baseline.errors.psnr, 2) + " dB more, " +
                                 fixed(baseline.errors.stops_95 - winner->errors.stops_95, 3) + " stops less";
}

std::string pareto(const Study& s, bool is_psnr) {
  page::ParetoPlot p;
  p.title = is_psnr ? "Error of light against bytes" : "Stops against bytes";
  p.corner = is_psnr ? "relative RMS error" : "stops, 95 %";
  p.time_axis = "bytes a texel";
  p.error_axis = is_psnr ? "RMS error over the peak, down is better" : "95th percentile [stop], down is better";
  p.least_time = 1, p.least_error = 1e-6;
  p.time_text = [](double bytes) { return number(bytes) + " B"; };
  const auto error = [&](const Row& row) {
    return is_psnr ? std::pow(10, -row.errors.psnr / 20) : row.errors.stops_95;
  };
  for (const Row& row : s.rows) {
    const bool is_ours = row.family == Family::kRealis;
    const bool is_out = std::any_of(s.rows.begin(), s.rows.end(), [&](const Row& other) {
      return other.family == row.family && other.bytes <= row.bytes && error(other) < error(row);
    });
    p.points.push_back({row.name, static_cast<double>(row.bytes), error(row),
                        is_ours ? page::ParetoMark::kDisc : page::ParetoMark::kDiamond, is_out && is_ours,
                        is_ours ? std::vector<std::string>{} : std::vector{row.name}});
  }
  return "<figure>" + drawing_of(p) + "</figure>";
}

// Seen from the camera: a light on the rim shines from the side. Areas of discs: stops of its light.
std::string sphere(const Study& s, const Row& row) {
  constexpr double kSize = 300, kMiddle = kSize / 2, kRadius = 130;
  std::string out = "<circle cx=\"150\" cy=\"150\" r=\"130\" fill=\"#f4f5f7\" stroke=\"#555\"/>";
  for (const Lobe& lobe : s.basis.lobes) {
    // Where it has fallen to a half.
    const double half = std::acos(std::clamp(1 - std::log(2.0) / std::max(lobe.sharpness, 1e-6), -1.0, 1.0));
    out += "<circle cx=\"" + fixed(kMiddle + kRadius * lobe.axis.x, 1) + "\" cy=\"" +
           fixed(kMiddle - kRadius * lobe.axis.y, 1) + "\" r=\"" + fixed(kRadius * std::sin(std::min(half, 1.5)), 1) +
           "\" fill=\"none\" stroke=\"#0b5394\" stroke-opacity=\"0.25\"/>" +
           page::svg_text(kMiddle + kRadius * lobe.axis.x, kMiddle - kRadius * lobe.axis.y + 3, "middle", "+");
  }
  double most = 1e-9;
  for (const Errors& e : row.by_light) most = std::max(most, e.stops_95);
  for (std::size_t i = 0; i < row.by_light.size(); ++i) {
    const glm::dvec3& d = s.subject.to_lights[i];
    out += "<circle cx=\"" + fixed(kMiddle + kRadius * d.x, 1) + "\" cy=\"" + fixed(kMiddle - kRadius * d.y, 1) +
           "\" r=\"" + fixed(1 + 6 * std::sqrt(row.by_light[i].stops_95 / most), 1) +
           "\" fill=\"#b35806\" fill-opacity=\"0.7\"><title>" + escape(s.light_ids[i]) + ": " +
           fixed(row.by_light[i].stops_95, 3) + " stops</title></circle>";
  }
  return "<figure>" + page::drawing("0 0 300 300", "Lights and lobes", out) + "<figcaption>" + escape(row.name) +
         ": a disc is a light where the camera sees it come from (world x right, y up); its area is the 95th "
         "percentile "
         "of stops when it was left out, at most " +
         fixed(most, 3) + ". Crosses and rings: axes of an example of " + std::to_string(s.basis.lobes.size()) +
         " lobes, and where they have fallen to a half.</figcaption></figure>";
}

std::string picture(const Study& s, std::span<const std::array<float, 3>> colors, const std::string& caption) {
  const int width = (s.subject.width + s.stride - 1) / s.stride, height = (s.subject.height + s.stride - 1) / s.stride;
  image::Picture out(width, height);
  for (std::size_t t = 0; t < colors.size(); ++t) {
    const int x = static_cast<int>(s.subject.pixels[t]) % s.subject.width / s.stride,
              y = static_cast<int>(s.subject.pixels[t]) / s.subject.width / s.stride;
    for (std::size_t c = 0; c < 3; ++c)
      out.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) + c] =
          static_cast<float>(static_cast<double>(colors[t][c]) / s.peak);
  }
  scene::View view;
  view.name = "srgb";
  return "<figure><img class=\"pixels\" style=\"width:100%\" alt=\"" + escape(caption) + "\" src=\"" +
         page::png_data_url(image::png_bytes(view::show(out, view))) + "\"><figcaption>" + escape(caption) +
         "</figcaption></figure>";
}

std::string worst_lights(const Study& s, const Row& ours, const Row* baseline) {
  std::vector<std::size_t> order(ours.by_light.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return ours.by_light[a].stops_95 > ours.by_light[b].stops_95; });
  std::string out;
  for (std::size_t n = 0; n < std::min<std::size_t>(3, order.size()); ++n) {
    const std::size_t i = order[n];
    std::vector<std::array<float, 3>> photo;
    for (std::size_t t = 0; t < s.subject.texels(); ++t) photo.push_back(s.subject.photo[s.subject.samples_of(t) + i]);
    const auto told = [&](const Row& row) {
      return row.name + ": " + fixed(row.by_light[i].psnr, 1) + " dB, " + fixed(row.by_light[i].stops_95, 3) + " stops";
    };
    out += "<h3>" + escape(s.light_ids[i]) + "</h3><div class=\"cards\">" + picture(s, photo, "photograph") +
           picture(s, s.rows.front().predicted[i], told(s.rows.front())) + picture(s, ours.predicted[i], told(ours));
    if (baseline != nullptr) out += picture(s, baseline->predicted[i], told(*baseline));
    out += "</div>\n";
  }
  return out;
}

const Row* best_of(const std::vector<const Row*>& rows) {
  const auto at = std::min_element(rows.begin(), rows.end(),
                                   [](const Row* a, const Row* b) { return a->errors.stops_95 < b->errors.stops_95; });
  return at == rows.end() ? nullptr : *at;
}

}  // namespace

std::string table_of(const Study& s) {
  std::string out = s.capture + ", " + s.camera + ": " + foreword(s) + "\n";
  out += padded("", 34) + "  bytes  PSNR [dB]  stops 50 %  stops 95 %   bake [s]  add up [ns]\n";
  for (const Family family : {Family::kRender, Family::kBaseline, Family::kRealis})
    for (const Row* row : of(s, family)) {
      std::string name = row->name;
      name.resize(std::max<std::size_t>(34, name.size()), ' ');
      out += name + padded(std::to_string(row->bytes), 7) + padded(fixed(row->errors.psnr, 2), 11) +
             padded(fixed(row->errors.stops_median, 3), 12) + padded(fixed(row->errors.stops_95, 3), 12) +
             padded(fixed(row->bake_seconds, 2), 11) + padded(fixed(row->ns, 1), 13) + "\n";
    }
  for (const Row* row : of(s, Family::kBaseline))
    out += row->name + " (" + std::to_string(row->bytes) + " B): " + verdict(s, *row) + "\n";
  if (!s.is_complete) out += "interrupted: rows are missing\n";
  return out;
}

std::string csv_of(const Study& s) {
  std::string out = "name,family,bytes,psnr_db,stops_median,stops_95,exact_psnr_db,exact_stops_95,bake_seconds,ns\n";
  for (const Row& row : s.rows)
    out += row.name + "," + std::string(kFamilies[static_cast<std::size_t>(row.family)]) + "," +
           std::to_string(row.bytes) + "," + fixed(row.errors.psnr, 4) + "," + fixed(row.errors.stops_median, 5) + "," +
           fixed(row.errors.stops_95, 5) + "," + (row.exact ? fixed(row.exact->psnr, 4) : "") + "," +
           (row.exact ? fixed(row.exact->stops_95, 5) : "") + "," + fixed(row.bake_seconds, 4) + "," +
           fixed(row.ns, 2) + "\n";
  return out;
}

std::string json_of(const Study& s) {
  using Json = nlohmann::ordered_json;
  const auto errors = [](const Errors& e) {
    return Json{{"psnr_db", e.psnr}, {"stops_median", e.stops_median}, {"stops_95", e.stops_95}};
  };
  Json rows = Json::array();
  for (const Row& row : s.rows) {
    Json r{{"name", row.name},
           {"family", kFamilies[static_cast<std::size_t>(row.family)]},
           {"bytes", row.bytes},
           {"errors", errors(row.errors)},
           {"bake_seconds", row.bake_seconds},
           {"ns", row.ns}};
    if (row.exact) r["exact"] = errors(*row.exact);
    if (!row.bake_words.empty()) r["bake_words"] = row.bake_words;
    for (std::size_t i = 0; i < row.by_light.size(); ++i) r["by_light"][s.light_ids[i]] = errors(row.by_light[i]);
    if (row.family == Family::kBaseline) {
      const Row* winner = winner_over(s, row);
      r["beaten_by"] = winner == nullptr ? Json(nullptr) : Json(winner->name);
    }
    rows.push_back(std::move(r));
  }
  const Json out{{"capture", s.capture},
                 {"camera", s.camera},
                 {"lights", s.light_ids.size()},
                 {"texels", s.subject.texels()},
                 {"texels_of_all", s.texels_of_all},
                 {"folds", s.folds},
                 {"peak", s.peak},
                 {"noise", s.noise},
                 {"is_noise_measured", s.is_noise_measured},
                 {"is_complete", s.is_complete},
                 {"rows", rows}};
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string page_of(const Study& s, const std::string& relight) {
  const std::string title = "Light that nobody photographed: " + s.capture;
  std::string out = page::page_head(title) + element("h1", title) + element("p", foreword(s) + ".");
  if (!relight.empty())
    out += "<p><a href=\"" + escape(relight) +
           "\">Move the light over the subject yourself</a>: the bake of all lights.</p>";
  if (!s.is_complete) out += "<p class=\"note\">The study was interrupted: rows are missing.</p>";
  if (s.rows.empty()) return out + page::page_foot();
  out +=
      element(
          "p",
          "Blue discs: render + residual, 8 bit as it is stored, 5 bytes of color and normal included. Diamonds: the "
          "render alone, and other ways to relight, with coefficients that are not rounded. Colors, material, "
          "estimated normals and lobes are found in " +
              std::to_string(s.folds) + " folds of lights, coefficients without each light.") +
      "<div class=\"plots\">" + pareto(s, true) + pareto(s, false) + "</div>\n";
  out +=
      "<h2>Compared</h2><div class=\"scroll\"><table class=\"metrics\"><thead><tr><th>way</th><th>bytes a "
      "texel</th><th>PSNR [dB]</th><th>stops, median</th><th>stops, 95 %</th><th>not rounded: PSNR, stops</th>"
      "<th>bake [s]</th><th>add up [ns a texel]</th></tr></thead><tbody>\n";
  const auto cell = [](const std::string& text) { return "<td class=\"n\">" + escape(text) + "</td>"; };
  for (const Family family : {Family::kRender, Family::kBaseline, Family::kRealis})
    for (const Row* row : of(s, family))
      out += "<tr><th scope=\"row\">" + escape(row->name) +
             (family == Family::kBaseline ? "<small>" + escape(verdict(s, *row)) + "</small>" : "") +
             (row->bake_words.empty() ? "" : "<small>" + escape(row->bake_words) + "</small>") + "</th>" +
             cell(std::to_string(row->bytes)) + cell(fixed(row->errors.psnr, 2)) +
             cell(fixed(row->errors.stops_median, 3)) + cell(fixed(row->errors.stops_95, 3)) +
             cell(row->exact ? fixed(row->exact->psnr, 2) + ", " + fixed(row->exact->stops_95, 3) : "") +
             cell(fixed(row->bake_seconds, 2)) + cell(fixed(row->ns, 1)) + "</tr>\n";
  out +=
      "</tbody></table></div><p class=\"quiet\">bake: of all texels, from the time of those on the grid, choosing "
      "lobes included, reading and fitting not. add up: the stored numbers of a texel with the values of a light, on "
      "one core; the render is not in it. Under a residual's name: the words of likeness realis bake that make it of "
      "all "
      "lights.</p>\n";
  const std::vector<const Row*> realis = of(s, Family::kRealis);
  if (const Row* ours = best_of(realis)) {
    out += "<h2>By light</h2><div class=\"plots\">" + sphere(s, s.rows.front()) + sphere(s, *ours) + "</div>\n";
    out += "<h2>Worst lights</h2>" + worst_lights(s, *ours, best_of(of(s, Family::kBaseline)));
  }
  return out + page::page_foot();
}

}  // namespace likeness::realis
