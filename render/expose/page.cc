#include "render/expose/page.h"

#include <cmath>

#include "brdf/lighting/zone.h"
#include "render/expose/plot.h"
#include "render/expose/shrink.h"
#include "render/expose/summary.h"
#include "render/exposure/overlay.h"
#include "render/exposure/text.h"
#include "render/image/write.h"
#include "render/page/html.h"
#include "render/view/view_list.h"

namespace likeness::expose {
namespace {

constexpr int kThumb = 220, kLarge = 560;

// Of a picture with an overlay; the width is said, so that the page does not jump.
std::string picture(const image::DisplayPicture& shown, const std::string& text) {
  return "<img src=\"" + page::png_data_url(image::png_bytes(shown)) + "\" width=\"" + std::to_string(shown.width) +
         "\" height=\"" + std::to_string(shown.height) + "\" style=\"max-width:100%;height:auto\" alt=\"" +
         page::escape(text) + "\">";
}

std::string cell(const std::string& text, bool is_warning = false) {
  return "<td class=\"n" + std::string(is_warning ? " warn" : "") + "\">" + page::escape(text) + "</td>";
}

std::string alternatives(const Exposed& e, const image::Picture& thumb) {
  std::string out = "<div class=\"scroll\"><table><thead><tr><th>mode</th><th>EV</th><th>" +
                    std::string(e.frames > 1 ? "the first picture" : "picture") +
                    "</th><th>toe</th>"
                    "<th>linear</th><th>shoulder</th><th>clipped</th><th>crushed</th></tr></thead><tbody>\n";
  for (const Alternative& a : e.alternatives) {
    scene::View view = e.view;
    view.ev = a.ev;
    const exposure::Shares& s = a.shares;
    out += "<tr" + std::string(a.is_chosen ? " style=\"background:#e3f1e3\"" : "") + "><th>" + page::escape(a.name) +
           (a.is_chosen ? " <span class=\"badge\">chosen</span>" : "") + "<small>" + page::escape(a.text) +
           (a.is_over_limits ? "; the limits cannot be kept" : "") + "</small></th>" + cell(stops_text(a.ev)) + "<td>" +
           picture(exposure::picture_with(exposure::Overlay::kNone, thumb, view), "at EV " + stops_text(a.ev)) +
           "</td>" + cell(percent_text(s.toe) + " %") + cell(percent_text(s.linear) + " %") +
           cell(percent_text(s.shoulder) + " %") + cell(percent_text(s.clipped) + " %", s.clipped > e.limits.clipped) +
           cell(percent_text(s.crushed) + " %", s.crushed > e.limits.crushed) + "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string zones_table(const exposure::Shares& shares) {
  std::string zones, stops, rows;
  for (int i = 0; i < brdf::Zones::kCount; ++i) {
    const int ev = i - static_cast<int>(brdf::Zones::kGreyZone);
    zones += "<th style=\"min-width:0\">" + std::string(exposure::zone_numeral(i)) + "</th>";
    stops += cell((ev > 0 ? "+" : "") + std::to_string(ev));
    rows += cell(percent_text(shares.zones[static_cast<std::size_t>(i)]));
  }
  return "<div class=\"scroll\"><table><tbody><tr><th>zone</th>" + zones + "</tr><tr><th>stops</th>" + stops +
         "</tr><tr><th>pixels, %</th>" + rows + "</tr></tbody></table></div>\n";
}

std::string figure(const Exposed& e, const image::Picture& light, exposure::Overlay overlay, const std::string& text) {
  return "<figure>" + picture(exposure::picture_with(overlay, light, e.view), text) + "<figcaption>" +
         page::escape(text) + "</figcaption></figure>\n";
}

}  // namespace

std::string page_of(const Exposed& e) {
  const Alternative& chosen = e.chosen();
  const image::Picture thumb = shrunk(e.first.light, kThumb), large = shrunk(e.first.light, kLarge);
  std::string out = page::page_head("Exposure of " + e.name);
  out += page::element("h1", "Exposure of " + e.name);
  out += "<p class=\"verdict\"><b>EV " + page::escape(stops_text(chosen.ev)) + "</b>: light times " +
         page::number(std::exp2(chosen.ev)) + ". " + percent_text(chosen.shares.linear) +
         " % of the pixels are in the linear part of the curve, " + percent_text(chosen.shares.clipped) +
         " % are clipped, " + percent_text(chosen.shares.crushed) + " % crushed.</p>\n";
  out += page::element("p", reason_text(e));
  std::string facts = "View " + view::origin_text(e.view) + ".";
  if (e.frames > 1) facts += " One EV for " + std::to_string(e.frames) + " pictures; all shares are of all of them.";
  if (const auto ev100 = e.ev100())
    facts += " EV100 " + page::fixed(*ev100, 2) + " as taken; a camera set to " + page::fixed(*ev100 - chosen.ev, 2) +
             " would have had it right.";
  out += page::element("p", facts);
  for (std::string odd = oddities_text(e); !odd.empty(); odd.erase(0, odd.find('\n') + 1))
    out += "<p class=\"note\">" + page::escape(odd.substr(0, odd.find('\n'))) + "</p>\n";

  out += page::element("h2", "Light under the curve");
  out += "<figure>" + plot_of(e) +
         "<figcaption>Grey bars: share of the pixels in each quarter stop of luminance, at the chosen exposure. Red: "
         "the code "
         "that the view sends for a grey of that light. Another EV moves the bars, not the curve. Clipped pixels are "
         "those "
         "whose brightest channel is at code 255, so there may be more of them than bars show.</figcaption></figure>\n";
  out += zones_table(chosen.shares);

  out += page::element("h2", "Alternatives");
  out += "<p>What each mode would choose for the same light. A share beyond the limits (" +
         percent_text(e.limits.clipped) + " % clipped, " + percent_text(e.limits.crushed) +
         " % crushed) is brown. Clipped: a channel at code 255. Crushed: has light, and is shown as code 0.</p>\n";
  out += alternatives(e, thumb);

  out += page::element("h2", e.frames > 1 ? "The first picture at this exposure" : "The picture at this exposure");
  out += "<div class=\"plots\" style=\"grid-template-columns:repeat(auto-fit,minmax(min(100%,500px),1fr))\">\n";
  out += figure(
      e, large, exposure::Overlay::kWedge,
      "As the view shows it. Below: 17 greys a stop apart, added to the light before exposure and view; zone and "
      "stops of that light, and the code it is sent as.");
  out += figure(
      e, large, exposure::Overlay::kZones,
      "By zone, after exposure. Every second zone is hatched: falling below middle grey, rising above it. Below: "
      "zone, stops, share of the pixels of this picture, made smaller.");
  out += figure(
      e, large, exposure::Overlay::kCurve,
      "By part of the curve, after exposure: T toe (bluish, hatched falling), L linear (grey), S shoulder (orange, "
      "hatched rising).");
  out += "</div>\n" + page::page_foot();
  return out;
}

}  // namespace likeness::expose
