#include <algorithm>
#include <map>
#include <tuple>

#include <nlohmann/json.hpp>

#include "realis/ablation/ablation.h"
#include "render/page/html.h"
#include "render/page/svg.h"

namespace likeness::realis {
namespace {

using page::element;
using page::fixed;
using page::number;

constexpr double kBar = 80;  // [%] that each weight is asked to remove

std::string percent(const Spread& s) {
  return fixed(s.median, 1) + " (" + fixed(s.least, 1) + " to " + fixed(s.most, 1) + ")";
}

// What the seeds of one fault and number of lights say, in percent.
struct Summary {
  std::size_t fault = 0, lights = 0, seeds = 0;
  Spread removed, of_lobes, best;
};
std::vector<Summary> summaries_of(const Ablation& a) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<const Trial*>> groups;
  for (const Trial& t : a.trials) groups[{t.fault, t.lights}].push_back(&t);
  std::vector<Summary> out;
  for (const auto& [key, trials] : groups) {
    const auto spread = [&](const auto& number_of) {
      std::vector<double> values;
      for (const Trial* t : trials) values.push_back(100 * number_of(*t));
      return spread_of(values);
    };
    out.push_back(
        {key.first, key.second, trials.size(), spread([](const Trial& t) { return t.removed(); }),
         spread([](const Trial& t) { return t.false_of_lobes > 0 ? 1 - t.left_of_lobes / t.false_of_lobes : 0; }),
         spread([](const Trial& t) { return t.false_residual > 0 ? 1 - t.best / t.false_residual : 0; })});
  }
  return out;
}

struct CostSummary {
  std::string_view weight;
  std::size_t lights = 0;
  Spread changed, noise, held_out;
};
std::vector<CostSummary> cost_summaries_of(const Ablation& a) {
  std::map<std::pair<std::string_view, std::size_t>, std::vector<const Cost*>> groups;
  for (const Cost& c : a.costs) groups[{c.weight, c.lights}].push_back(&c);
  std::vector<CostSummary> out;
  for (const auto& [key, costs] : groups) {
    std::vector<double> changed, noise, held_out;
    for (const Cost* c : costs) {
      changed.push_back(100 * c->changed), noise.push_back(100 * c->noise);
      held_out.push_back(c->held_out_without > 0 ? 100 * (c->held_out_with / c->held_out_without - 1) : 0);
    }
    out.push_back({key.first, key.second, spread_of(changed), spread_of(noise), spread_of(held_out)});
  }
  return out;
}

std::string padded(std::string text, std::size_t width) {
  return text + std::string(text.size() < width ? width - text.size() : 1, ' ');
}

// A row of dots a fault: the seeds' medians and ends, what is possible, and the bar.
std::string plot_of(const std::vector<Summary>& rows) {
  constexpr double kLeft = 190, kWidth = 480, kStep = 20, kTop = 30;
  const auto x = [&](double value) { return kLeft + kWidth * std::clamp(value, 0.0, 100.0) / 100; };
  const double height = kTop + kStep * static_cast<double>(rows.size());
  std::string out;
  for (const int tick : {0, 20, 40, 60, 80, 100})
    out += page::svg_line(
               x(tick), kTop - 8, x(tick), height,
               tick == static_cast<int>(kBar) ? "stroke=\"#0b5394\" stroke-dasharray=\"4 3\"" : "stroke=\"#d5d9df\"") +
           page::svg_text(x(tick), 14, "middle", std::to_string(tick) + " %", 11);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Summary& r = rows[i];
    const double y = kTop + kStep * (static_cast<double>(i) + 0.5);
    out += page::svg_text(kLeft - 8, y + 4, "end",
                          page::escape(kFaults[r.fault].name) + ", " + std::to_string(r.lights) + " lights", 11);
    out += page::svg_line(x(r.removed.least), y, x(r.removed.most), y, "stroke=\"#0b5394\" stroke-width=\"2\"");
    out += page::svg_line(x(r.best.median), y - 6, x(r.best.median), y + 6, "stroke=\"#b35806\" stroke-width=\"2\"");
    out += "<circle cx=\"" + fixed(x(r.removed.median), 1) + "\" cy=\"" + fixed(y, 1) + "\" r=\"4\" fill=\"" +
           (kFaults[r.fault].weight.empty() ? "#fff" : "#0b5394") + "\" stroke=\"#0b5394\"/>";
  }
  return page::drawing("0 0 700 " + fixed(height + 8, 0), "What weights remove of a fault's false residual", out);
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {values.front(), values[values.size() / 2], values.back()};
}

std::string table_of(const Ablation& a) {
  std::string out = "removed of the false residual [%], median (least to most of the seeds)\n" + padded("fault", 18) +
                    padded("weight", 10) + padded("lights", 8) + padded("removed", 26) + padded("with lobes held", 26) +
                    "at best\n";
  for (const Summary& r : summaries_of(a))
    out += padded(std::string(kFaults[r.fault].name), 18) +
           padded(kFaults[r.fault].weight.empty() ? "default" : std::string(kFaults[r.fault].weight), 10) +
           padded(std::to_string(r.lights), 8) + padded(percent(r.removed), 26) + padded(percent(r.of_lobes), 26) +
           percent(r.best) + "\n";
  out += "\nwithout a fault: change of the bake [%], and what noise changes\n" + padded("weight", 10) +
         padded("lights", 8) + padded("changed", 26) + padded("noise", 26) + "error of held-out lights [%]\n";
  for (const CostSummary& r : cost_summaries_of(a))
    out += padded(std::string(r.weight), 10) + padded(std::to_string(r.lights), 8) + padded(percent(r.changed), 26) +
           padded(percent(r.noise), 26) + percent(r.held_out) + "\n";
  return out;
}

std::string csv_of(const Ablation& a) {
  std::string out =
      "fault,weight,lights,seed,touched,false_residual,left,removed,removed_lobes_held,left_at_best,held_out_clean,"
      "held_out_without,held_out_with\n";
  for (const Trial& t : a.trials) {
    const Fault& f = kFaults[t.fault];
    out += std::string(f.name) + "," + std::string(f.weight) + "," + std::to_string(t.lights) + "," +
           std::to_string(t.seed);
    for (const double x : {t.touched, t.false_residual, t.left, t.removed(),
                           t.false_of_lobes > 0 ? 1 - t.left_of_lobes / t.false_of_lobes : 0.0, t.best,
                           t.held_out_clean, t.held_out_without, t.held_out_with})
      out += "," + page::plain(x);
    out += "\n";
  }
  return out;
}

std::string json_of(const Ablation& a) {
  using Json = nlohmann::ordered_json;
  Json trials = Json::array(), costs = Json::array();
  for (const Trial& t : a.trials)
    trials.push_back({{"fault", kFaults[t.fault].name},
                      {"weight", kFaults[t.fault].weight},
                      {"lights", t.lights},
                      {"seed", t.seed},
                      {"touched", t.touched},
                      {"false_residual", t.false_residual},
                      {"left", t.left},
                      {"removed", t.removed()},
                      {"left_at_best", t.best},
                      {"false_lobes_held", t.false_of_lobes},
                      {"left_lobes_held", t.left_of_lobes},
                      {"held_out_clean", t.held_out_clean},
                      {"held_out_without", t.held_out_without},
                      {"held_out_with", t.held_out_with}});
  for (const Cost& c : a.costs)
    costs.push_back({{"weight", c.weight},
                     {"lights", c.lights},
                     {"seed", c.seed},
                     {"size", c.size},
                     {"changed", c.changed},
                     {"noise", c.noise},
                     {"touched", c.touched},
                     {"held_out_without", c.held_out_without},
                     {"held_out_with", c.held_out_with}});
  return Json{{"type", "realis ablation"}, {"version", 1}, {"trials", trials}, {"costs", costs}}.dump(1) + "\n";
}

std::string page_of(const Ablation& a, const AblationOptions& options) {
  std::string out = page::page_head("What each weight is worth");
  out += element("h1", "What each weight is worth");
  out += element(
      "p", "Synthetic captures of " + std::to_string(options.side) + " x " + std::to_string(options.side) +
               " pixels, with a fault and without; noise of a full well of " + number(options.full_well) +
               " electrons; " + std::to_string(options.seeds) +
               " seeds, each with faults of another size. Removed: 1 - left / false residual, both against the bake of "
               "the same capture without the fault, over the texels that the fault touches and the directions of "
               "all lights and between them.");
  out += "<figure>" + plot_of(summaries_of(a)) +
         element("figcaption",
                 "Disc: median; line: all seeds; orange: the median of what a weight removes that knows the truth; "
                 "dashed: 80 %. Hollow: no weight is there for the fault, those of the default are on. What is "
                 "below 0 (weights that add to the error) is drawn at 0 and stands in the table.") +
         "</figure>";
  out += "<div class=\"scroll\"><table><thead><tr>";
  for (const char* head : {"fault", "what", "weight", "lights", "removed [%]", "with lobes held [%]", "at best [%]"})
    out += element("th", head);
  out += "</tr></thead><tbody>";
  for (const Summary& r : summaries_of(a)) {
    const Fault& f = kFaults[r.fault];
    out += "<tr>" + element("th", f.name) + element("td", f.text) +
           element("td", f.weight.empty() ? "default" : std::string(f.weight)) +
           element("td", std::to_string(r.lights)) + element("td", percent(r.removed)) +
           element("td", percent(r.of_lobes)) + element("td", percent(r.best)) + "</tr>";
  }
  out += "</tbody></table></div>" + element("h2", "What a capture without faults pays") +
         "<div class=\"scroll\"><table><thead><tr>";
  for (const char* head :
       {"weight", "lights", "bake changed [%]", "by noise alone [%]", "error of held-out lights, change [%]"})
    out += element("th", head);
  out += "</tr></thead><tbody>";
  for (const CostSummary& r : cost_summaries_of(a))
    out += "<tr>" + element("th", r.weight) + element("td", std::to_string(r.lights)) +
           element("td", percent(r.changed)) + element("td", percent(r.noise)) + element("td", percent(r.held_out)) +
           "</tr>";
  return out + "</tbody></table></div>" + page::page_foot();
}

}  // namespace likeness::realis
