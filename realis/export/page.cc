#include <algorithm>
#include <array>
#include <cstdio>

#include "realis/export/export.h"
#include "realis/export/page_parts.h"
#include "render/page/html.h"

namespace likeness::realis {
namespace {

std::string in_decibels(double value) { return page::fixed(value, 1) + " dB"; }

// The disc: where the photographs' lights were, and the light that is moved.
std::string pad_of(const std::vector<glm::dvec3>& photographed) {
  std::string out =
      R"(<svg id="pad" viewBox="-110 -110 220 220" tabindex="0" role="img" aria-label="Direction of the light: drag, or press the arrow keys">)"
      R"(<circle r="100" fill="#f4f5f7" stroke="#555c66"/><path d="M-100 0H100M0-100V100" stroke="#d5d9df"/>)";
  for (const glm::dvec3& light : photographed) {
    std::array<char, 128> ring{};
    std::snprintf(ring.data(), ring.size(), R"(<circle cx="%.1f" cy="%.1f" r="3.5" fill="none" stroke="#0b5394"/>)",
                  100 * light.x, -100 * light.y);
    if (light.z > 0) out += ring.data();
  }
  return out + R"(<g id="bulb"><circle r="9" fill="#ffd54a" stroke="#1c1f23" stroke-width="2"/></g></svg>)";
}

std::string rings_said(const std::vector<glm::dvec3>& photographed) {
  const auto count = std::ranges::count_if(photographed, [](const glm::dvec3& light) { return light.z > 0; });
  const auto behind = static_cast<std::ptrdiff_t>(photographed.size()) - count;
  return "Rings: lights that photographs were taken under, " + std::to_string(count) +
         (behind > 0 ? "; " + std::to_string(behind) + " more shone from behind the plane of the picture." : ".");
}

// Of a script: no text in it may end the script's element.
std::string in_script(std::string text) {
  for (std::size_t at = 0; (at = text.find("</", at)) != text.npos; at += 3) text.insert(at + 1, "\\");
  return text;
}

}  // namespace

std::string page_of(const Planes& planes, const PageFacts& facts) {
  const std::string title = facts.capture + ": move the light";
  std::string head = page::page_head(title);
  head.insert(head.find("</style>"), kPageLook);
  std::string out =
      head + page::element("h1", title) +
      "<p>Drag on the picture or on the disc. The light comes from where you point, as seen from the middle; "
      "the rim is light that grazes.</p>"
      "<p class=\"note\" id=\"fault\" hidden></p><noscript><p class=\"note\">This page needs JavaScript.</p>"
      "</noscript><div class=\"stage\"><canvas id=\"picture\" role=\"img\" aria-label=\"The subject under "
      "the light\"></canvas><div>" +
      pad_of(facts.photographed) + "<p id=\"said\" aria-live=\"polite\"></p>" +
      page::element("p", rings_said(facts.photographed)) + "</div></div><h2>What this is</h2>";
  out += page::element(
      "p",
      "Not photographs: a render of what was fitted to them, and what it lacks of them, baked over the direction of "
      "the "
      "light (likeness realis). Near the rings it is held to photographs. Far from them it is the render, mostly: what "
      "casts a shadow there nobody has seen.");
  std::string loss = "The picture is blended from " + std::to_string(planes.count()) + " planes of 8 bits (" +
                     std::string(row_of(planes.format).name) + ", quality " + std::to_string(planes.quality) +
                     "), which smooth shadows and highlights.";
  if (facts.psnr_disc)
    loss += " Against what likeness realis apply makes of the same light it has " + in_decibels(*facts.psnr_disc) +
            " over the whole disc" +
            (facts.psnr_photographed ? ", " + in_decibels(*facts.psnr_photographed) + " at the rings" : "") +
            " (PSNR of display values).";
  out += page::element("p", loss);
  out += "<script>\n\"use strict\";\nconst planes = [";
  for (const std::string& jpeg : planes.jpegs) out += "\"data:image/jpeg;base64," + page::base64(jpeg) + "\",\n";
  out += "];\nconst rings = [";
  for (const glm::dvec3& light : facts.photographed)
    out += "[" + page::fixed(light.x, 4) + "," + page::fixed(light.y, 4) + "," + page::fixed(light.z, 4) + "],";
  out += "];\nconst info = " + in_script(info_text(planes, facts.photographed)) + ";" + std::string(kPageScript) +
         "</script>\n";
  return out + page::page_foot();
}

}  // namespace likeness::realis
