#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "render/page/html.h"
#include "render/page/svg.h"
#include "render/plan/draw.h"

namespace likeness::plan {
namespace {

using page::element;
using page::escape;
using page::svg_line;
using page::svg_text;

// Where on the way of light an effect is at home.
struct Stage {
  std::string_view name, text;
  Effect first, last;
};
constexpr std::array kStages{
    Stage{"Camera", "how rays start", Effect::kDepthOfField, Effect::kDepthOfField},
    Stage{"Surfaces", "what happens where a ray meets something", Effect::kDiffuse, Effect::kEmission},
    Stage{"Lights", "where light comes from", Effect::kPointLights, Effect::kRanges},
    Stage{"Environment", "what a ray sees that meets nothing", Effect::kEnvironment, Effect::kEnvironmentPicture},
};
constexpr std::size_t kEffectsInStages = [] {
  std::size_t count = 0;
  for (const Stage& s : kStages) count += static_cast<std::size_t>(s.last) - static_cast<std::size_t>(s.first) + 1;
  return count;
}();
static_assert(kEffectsInStages == kEffectCount, "every effect has a stage");

// Of the drawing, in its units: about pixels.
constexpr double kWidth = 1120, kRow = 26, kHead = 46, kDot = 20, kName = 38, kText = 206, kFact = 530, kBar = 880;
constexpr double kQuietSize = 12.5;
constexpr std::string_view kInk = "#1c1f23", kQuiet = "#555c66", kOn = "#0b5394", kLine = "#d5d9df";

std::string ms_text(double ms) {
  const double size = std::abs(ms);
  return (ms < 0 ? "−" : "+") + page::fixed(size, size < 10 ? 1 : 0) + " ms";
}

std::string style(std::string_view color, std::string_view more = "") {
  return " style=\"fill:" + std::string(color) + ";" + std::string(more) + "\"";
}

// At most so many characters; what is cut off is in the row's tooltip.
std::string cut(std::string_view text, std::size_t most) {
  std::size_t at = 0, count = 0;
  for (; at < text.size(); ++at) {
    if ((static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) continue;
    if (count++ == most) return std::string(text.substr(0, at)) + "…";
  }
  return std::string(text);
}

std::string dot(double y, bool is_on) {
  return "<circle cx=\"" + page::plain(kDot) + "\" cy=\"" + page::plain(y) + "\" r=\"6\" fill=\"" +
         std::string(is_on ? kOn : "#fff") + "\" stroke=\"" + std::string(is_on ? kOn : kQuiet) +
         "\" stroke-width=\"1.6\"/>";
}

// The bar's length is the median; the whisker is from quartile to quartile. A cost below zero is drawn as none.
std::string bar(double y, const Cost& cost, double scale) {
  if (!cost.is_measured) return "";
  const auto x = [&](double ms) { return kBar + std::clamp(ms, 0.0, 1e12) * scale; };
  std::string out = "<rect x=\"" + page::plain(kBar) + "\" y=\"" + page::plain(y - 6) + "\" width=\"" +
                    page::fixed(std::max(x(cost.difference_ms) - kBar, 1.0), 1) + "\" height=\"12\" fill=\"" +
                    std::string(kOn) + "\" fill-opacity=\"0.45\"/>";
  out += svg_line(x(cost.low_ms), y, x(cost.high_ms), y, "stroke=\"" + std::string(kInk) + "\" stroke-width=\"1.5\"");
  return out + svg_text(kWidth - 2, y + 4.5, "end", escape(ms_text(cost.difference_ms)), kQuietSize);
}

std::string rows_of(const Stage& stage, const Plan& plan, const Costs* costs, double scale, double& y) {
  const auto first = static_cast<std::size_t>(stage.first), last = static_cast<std::size_t>(stage.last);
  std::size_t on = 0;
  for (std::size_t i = first; i <= last; ++i) on += plan.decisions[i].is_on;
  std::string out = svg_line(0, y + 6, kWidth, y + 6, "stroke=\"" + std::string(kInk) + "\" stroke-width=\"1.5\"");
  out += svg_text(kDot - 8, y + 30, "start", escape(stage.name), 17, style(kInk, "font-weight:700"));
  out += svg_text(kText, y + 30, "start", escape(stage.text), kQuietSize, style(kQuiet));
  out += svg_text(kWidth - 2, y + 30, "end", std::to_string(on) + " of " + std::to_string(last - first + 1) + " on",
                  kQuietSize, style(kQuiet));
  y += kHead;
  const std::size_t most = costs != nullptr ? 52 : 88;
  for (std::size_t i = first; i <= last; ++i, y += kRow) {
    const Decision& d = plan.decisions[i];
    const double middle = y + kRow / 2 - 4, base = middle + 4.5;
    const std::string_view color = d.is_on ? kInk : kQuiet;
    std::string name(kEffects[i].name);
    std::replace(name.begin(), name.end(), '_', ' ');
    out += "<g>" + element("title", name + (d.is_on ? ": on, because " : ": off, because ") + d.because +
                                        ". Without it this is saved: " + std::string(kEffects[i].saves));
    out += dot(middle, d.is_on);
    out += svg_text(kName, base, "start", escape(name), 14, style(color, d.is_on ? "font-weight:700" : ""));
    out += svg_text(kText, base, "start", escape(kEffects[i].text), kQuietSize, style(color));
    out += svg_text(kFact, base, "start", escape(cut(d.because, most)), kQuietSize, style(color));
    if (costs != nullptr) out += bar(middle, (*costs)[i], scale);
    out += "</g>" + svg_line(kName, y + kRow - 4, kWidth, y + kRow - 4, "stroke=\"" + std::string(kLine) + "\"");
  }
  y += 8;
  return out;
}

std::string drawing_of(const Plan& plan, const std::string& scene, const Costs* costs) {
  double most = 0, with = 0;
  if (costs != nullptr)
    for (const Cost& cost : *costs) {
      most = std::max({most, cost.difference_ms, cost.high_ms});
      if (cost.is_measured) with = cost.with_ms;
    }
  const double scale = most > 0 ? (kWidth - 70 - kBar) / most : 0;
  double y = 34;
  std::string out = dot(16, true) + svg_text(kName, 20.5, "start", "on", kQuietSize);
  out +=
      "<g transform=\"translate(56 0)\">" + dot(16, false) + svg_text(kName, 20.5, "start", "off", kQuietSize) + "</g>";
  out += svg_text(kText, 20.5, "start", "what it is", kQuietSize, style(kQuiet));
  out += svg_text(kFact, 20.5, "start", "what in the scene decided it", kQuietSize, style(kQuiet));
  if (costs != nullptr)
    out += svg_text(kWidth - 2, 20.5, "end", "of " + page::fixed(with, 0) + " ms in all, it adds", kQuietSize,
                    style(kQuiet));
  for (const Stage& stage : kStages) out += rows_of(stage, plan, costs, scale, y);
  return page::drawing("0 0 " + page::plain(kWidth) + " " + page::fixed(y, 0), "The plan of " + scene, out);
}

std::string materials_of(const Plan& plan) {
  std::string out =
      "<div class=\"scroll\"><table>\n<thead><tr><th>material</th><th>model</th><th>its kernel computes</th>"
      "<th>and</th></tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < plan.materials.size(); ++i) {
    const MaterialPlan& m = plan.materials[i];
    out += "<tr>" + element("th", m.name.empty() ? std::to_string(i) : m.name) + element("td", m.model) +
           element("td", kernel_text(m)) + element("td", features_text(m)) + "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::string svg_of(const Plan& plan, const std::string& scene, const Costs* costs) {
  std::string out = drawing_of(plan, scene, costs);
  out.replace(0, 4,
              "<svg xmlns=\"http://www.w3.org/2000/svg\" font-family=\"system-ui,'Segoe UI',Roboto,'DejaVu "
              "Sans',sans-serif\"");
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + out + "\n";
}

std::string page_of(const Plan& plan, const std::string& scene, const Costs* costs) {
  const auto on =
      std::count_if(kEffects.begin(), kEffects.end(), [&](const EffectRow& row) { return plan.has(row.effect); });
  const std::string title = "What " + scene + " calls for";
  std::string out = page::page_head(title) + element("h1", title);
  out += "<p class=\"verdict\">" + std::to_string(on) + " of the " + std::to_string(kEffectCount) +
         " effects that the renderer knows are worked on; the others are left out.</p>\n";
  out +=
      "<p>Before it renders, Likeness looks through the scene once and decides for every effect whether anything "
      "asks for it. A filled circle means that something does, and the line says what. A hollow one means that "
      "nothing does: its work is then not done. Change the scene, and the plan changes with it.</p>\n";
  if (plan.is_forced)
    out +=
        "<p class=\"note\">Here every effect is forced to be on (<code>--force all</code>). The picture is the "
        "same; the time is what would be paid if the renderer did not look.</p>\n";
  if (costs != nullptr)
    out +=
        "<p>Bars and the number at the right say what an effect costs: the CPU time for a million samples of pixels, "
        "of this scene against the same scene edited so that it does not need the effect, in turn. Length: median. "
        "Thin line: from quartile to quartile; where it reaches the bar's left end, nothing sure was found. The number "
        "includes what follows from the edit: without an environment, rays also end sooner. So the numbers do not add "
        "up to the whole, and one may be below 0: without its diffuse a material may send more rays on.</p>\n";
  out += "<div class=\"scroll\"><div style=\"min-width:860px;padding:8px\">" + drawing_of(plan, scene, costs) +
         "</div></div>\n";
  out += element("h2", "Materials");
  out += "<p>Each material runs code that was compiled for just the parts that it needs.</p>\n" + materials_of(plan);
  return out + page::page_foot();
}

}  // namespace likeness::plan
