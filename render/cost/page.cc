#include <algorithm>
#include <cmath>

#include "render/cost/study.h"
#include "render/page/html.h"
#include "render/page/pareto_plot.h"

namespace likeness::scene_cost {
namespace {

using page::element;
using page::escape;
using page::number;

constexpr double kLeastError = 1e-6;

std::string time_text(double ms) { return ms < 1e3 ? number(ms) + " ms" : number(ms / 1e3) + " s"; }

enum class Metric { kFlip, kRelmse };
double value_of(const Errors& e, Metric metric) { return metric == Metric::kFlip ? e.flip : e.relmse; }

// What a plot says of a row where the pointer is on it, and what it may write beside it.
struct Naming {
  std::function<std::string(const Row&)> name;
  std::function<std::vector<std::string>(const Row&, bool is_beaten)> labels;
};

struct Pages {
  const Study& study;
  bool by_cpu = study.options.counts_cpu;
  std::string unit = by_cpu ? "ms of CPU" : "ms";

  double ms(const Row& row) const { return row.timing(by_cpu).median; }

  std::string plot(Metric metric, const std::string& title, const std::vector<const Row*>& rows,
                   const Naming& naming) const {
    page::ParetoPlot p;
    const bool is_flip = metric == Metric::kFlip;
    p.title = title + (is_flip ? ": FLIP against time" : ": relMSE against time");
    p.corner = is_flip ? "FLIP" : "relMSE";
    p.time_axis = unit + " a frame";
    p.error_axis = is_flip ? "FLIP: seen difference, down is better" : "relMSE, down is better";
    p.least_time = 1e-3, p.least_error = kLeastError, p.time_text = time_text, p.joins_diamonds = true;
    double least = HUGE_VAL;
    for (const Row* row : rows) least = std::min(least, value_of(row->errors, metric));
    // Noise far below all that is drawn would only squeeze it.
    constexpr double kFarBelow = 0.2;
    if (study.reference.noise && value_of(*study.reference.noise, metric) > kFarBelow * least)
      p.noise = value_of(*study.reference.noise, metric);
    if (study.direct_only) p.levels.push_back({value_of(*study.direct_only, metric), "direct light alone, exact"});
    for (const Row* row : rows) {
      const double error = value_of(row->errors, metric);
      const bool is_out = !row->is_path_tracer && std::any_of(rows.begin(), rows.end(), [&](const Row* other) {
        return !other->is_path_tracer && value_of(other->errors, metric) <= error && ms(*other) < ms(*row);
      });
      p.points.push_back({naming.name(*row), ms(*row), error,
                          row->is_path_tracer ? page::ParetoMark::kDiamond : page::ParetoMark::kDisc, is_out,
                          naming.labels(*row, is_out)});
    }
    return "<figure>" + drawing_of(p) + "</figure>";
  }

  std::string plots(const std::string& title, const std::vector<const Row*>& rows, const Naming& naming) const {
    return "<div class=\"plots\">" + plot(Metric::kFlip, title, rows, naming) +
           plot(Metric::kRelmse, title, rows, naming) + "</div>\n";
  }

  static std::string image(const std::string& png, const std::string& text) {
    return "<img src=\"" + page::png_data_url(png) + "\" alt=\"" + escape(text) + "\">";
  }

  // A picture, its map of errors, and what they are.
  static std::string card(const std::string& title, const std::string& shown, const std::string& map,
                          const std::string& text) {
    return "<figure class=\"pair\"><figcaption><b>" + escape(title) + "</b></figcaption><div>" +
           image(shown, title + ", as the screen shows it") + image(map, title + ", where it differs (FLIP)") +
           "</div><figcaption>" + escape(text) + "</figcaption></figure>\n";
  }
  std::string card(const std::string& title, const Row& row) const {
    return card(
        title, row.shown_png, row.map_png,
        time_text(ms(row)) + ", FLIP " + number(row.errors.flip, 2) + ", relMSE " + number(row.errors.relmse, 2));
  }

  static std::string reading(const Row& row, bool of_cpu) {
    const Row::Timing t = row.timing(of_cpu);
    return "<td class=\"n\">" + number(t.median) + "\n<small>" + number(t.low) + " to " + number(t.high) +
           "</small></td>";
  }

  static std::string errors(const Errors& e) {
    return "<td class=\"n\">" + number(e.flip, 3) + "</td><td class=\"n\">" + number(e.relmse, 3) +
           "</td><td class=\"n\">" + number(e.stops_median, 2) + "</td><td class=\"n\">" + number(e.stops_p95, 2) +
           "</td>";
  }
};

std::vector<const Row*> ladder_of(const Study& study, std::size_t setting) {
  std::vector<const Row*> rows;
  for (const Row& row : study.rows)
    if (row.in_ladder[setting] && !row.is_path_tracer) rows.push_back(&row);
  std::sort(rows.begin(), rows.end(),
            [&](const Row* a, const Row* b) { return a->levels[setting] < b->levels[setting]; });
  return rows;
}

std::vector<const Row*> by_time(const Pages& pages, bool path_tracer) {
  std::vector<const Row*> rows;
  for (const Row& row : pages.study.rows)
    if (row.is_path_tracer == path_tracer) rows.push_back(&row);
  std::sort(rows.begin(), rows.end(), [&](const Row* a, const Row* b) { return pages.ms(*a) < pages.ms(*b); });
  return rows;
}

// The frames as the table has them: of the pipeline, then of the path tracer, each in the order of their time.
std::vector<const Row*> in_order(const Pages& pages) {
  std::vector<const Row*> rows = by_time(pages, false);
  const std::vector<const Row*> traced = by_time(pages, true);
  rows.insert(rows.end(), traced.begin(), traced.end());
  return rows;
}

// The level of each setting that most of the frames have that nothing beats: what labels can leave out.
Levels usual_of(const Study& study) {
  Levels usual{};
  for (std::size_t i = 0; i < kSettingCount; ++i) {
    std::vector<std::size_t> counts(runtime::kSettings[i].levels.size());
    for (const Row& row : study.rows)
      if (!row.is_path_tracer && row.dominated_by.empty()) ++counts[row.levels[i]];
    usual[i] = static_cast<Levels::value_type>(std::max_element(counts.begin(), counts.end()) - counts.begin());
  }
  return usual;
}

// By less, a frame may be nearer to the reference than exact direct light by its noise alone.
constexpr double kNearer = 0.95;

std::string verdict_of(const Pages& pages) {
  const std::vector<const Row*> rows = by_time(pages, false);
  if (rows.empty()) return "";
  const Row& fastest = *rows.front();
  const Row& best = **std::min_element(rows.begin(), rows.end(),
                                       [](const Row* a, const Row* b) { return a->errors.flip < b->errors.flip; });
  const auto text = [&](const Row& row) {
    return time_text(pages.ms(row)) + " (" + name_of(pages.study, row) + ") at FLIP " + number(row.errors.flip, 2);
  };
  std::string out = "A frame of the run-time pipeline costs from " + text(fastest) + " to " + text(best) + ".";
  if (pages.study.direct_only)
    out += " Light of later bounces is in none of them: an exact picture of direct light alone has FLIP " +
           number(pages.study.direct_only->flip, 2) +
           (best.errors.flip < kNearer * pages.study.direct_only->flip
                ? ", and what is nearer owes it to errors that happen to make up for that."
                : ".");
  return "<p class=\"verdict\">" + escape(out) + "</p>\n";
}

std::string facts_of(const Study& study) {
  const auto row = [](const std::string& name, const std::string& text) {
    return element("dt", name) + element("dd", text);
  };
  const Options& o = study.options;
  std::string out = "<dl>";
  out += row("Machine", study.machine.processor + ", " + std::to_string(study.machine.cores) + " cores; " +
                            (o.threads > 0 ? std::to_string(o.threads) + (o.threads == 1 ? " thread" : " threads")
                                           : "a thread on each"));
  out += row("Picture", std::to_string(study.width) + " x " + std::to_string(study.height) + " pixels" +
                            (study.camera.empty() ? "" : ", camera " + study.camera) + ", shown by the view " +
                            study.view + "; " + number(100 * study.share_of_surfaces, 2) +
                            " % of it is surfaces, the rest background");
  out += row("Reference", study.reference.source + (study.reference.noise
                                                        ? ". What it is off by itself, from its two halves: FLIP " +
                                                              number(study.reference.noise->flip, 2) + ", relMSE " +
                                                              number(study.reference.noise->relmse, 2) +
                                                              ". Smaller errors cannot be told from 0."
                                                        : ". How exact it is, is not known here."));
  out += row("Time", std::string(o.counts_cpu ? "CPU time of all threads" : "wall clock") + ": median of up to " +
                         std::to_string(o.repeats) + (o.repeats == 1 ? " reading" : " readings") +
                         ", all kinds of frames in an order drawn anew for "
                         "each round. Small numbers are quartiles. What is made once for a scene is not in it.");
  out += row("Errors",
             "FLIP: the difference that an observer sees who alternates between the pictures, 0 to 1, of what "
             "the screen shows. relMSE: mean of (difference)^2 / (reference^2 + 0.01) of the light at the "
             "scene's exposure. Stops: |log2(picture / reference)| where there is a surface; half of the "
             "values, and 95 % of them, are below. All of one frame: its noise has a fixed seed.");
  out += row("Settings",
             "pixel_samples: points in each pixel (pts). light_samples: shadow rays to each light with an area, "
             "for each point (shadow). environment: maps without shadows, or rays for each point (env). spp: samples a "
             "pixel.");
  return out + "</dl>\n";
}

std::string setting_section(const Pages& pages, std::size_t setting) {
  const Study& study = pages.study;
  const runtime::SettingRow& row = runtime::kSettings[setting];
  const std::vector<const Row*> rows = ladder_of(study, setting);
  if (rows.empty()) return "";
  std::string rest;
  for (std::size_t i = 0; i < kSettingCount; ++i)
    if (i != setting && study.matters[i])
      rest += (rest.empty() ? "" : ", ") + std::string(runtime::kSettings[i].name) + " " +
              std::string(runtime::kSettings[i].levels[study.best[i]]);
  const auto name = [&](const Row& r) { return std::string(row.levels[r.levels[setting]]); };
  std::string out =
      "<h2 id=\"" + std::string(row.name) + "\">" + std::string(row.name) + "</h2>\n" +
      element("p", "One at a time: " + std::string(row.text) + "." +
                       (rest.empty() ? ""
                                     : " The rest as high as " + time_text(study.options.longest_ms) +
                                           " of CPU a frame allow: " + rest + ".")) +
      pages.plots(std::string(row.name), rows, {name, [&](const Row& r, bool) { return std::vector{name(r)}; }}) +
      "<div class=\"cards\">\n";
  for (const Row* r : rows) out += pages.card(std::string(row.name) + " " + name(*r), *r);
  return out + "</div>\n";
}

std::string unrepaired_section(const Pages& pages) {
  const Study& study = pages.study;
  const std::vector<const Row*> rows = by_time(pages, false);
  std::string out =
      "<h2 id=\"left\">What no level repairs</h2>\n"
      "<p>The pipeline lights surfaces directly: light that went by way of another surface first is missing. What it "
      "is "
      "worth is the difference between two pictures of the path tracer, with one bounce and with all. The "
      "rest of the most exact frame's error is its own: samples that are still too few, and approximations (maps), "
      "which "
      "may add to the first or make up for it.</p>\n"
      "<div class=\"scroll\"><table class=\"metrics\"><thead><tr><th>against the full reference</th><th>FLIP</th>"
      "<th>relMSE</th><th>stops, median</th><th>stops, 95 %</th></tr></thead><tbody>\n";
  const auto line = [&](const std::string& name, const Errors& e) {
    out += "<tr><th scope=\"row\">" + escape(name) + "</th>" + Pages::errors(e) + "</tr>\n";
  };
  if (!rows.empty()) {
    const Row& best = **std::min_element(rows.begin(), rows.end(),
                                         [](const Row* a, const Row* b) { return a->errors.flip < b->errors.flip; });
    line("Most exact frame: " + name_of(study, best), best.errors);
  }
  if (study.direct_only) line("Direct light alone, by the path tracer", *study.direct_only);
  if (study.reference.noise) line("Noise of the reference", *study.reference.noise);
  out += "</tbody></table></div>\n";
  if (study.direct_only && study.options.max_bounces > 1)
    out +=
        "<p>Where this is most of the error, every level looks alike. With <code>--bounces 1</code> the reference has "
        "direct light alone, and shows what the settings change.</p>\n";
  if (!study.direct_map_png.empty())
    out += "<div class=\"cards\">" +
           Pages::card("Direct light alone", study.direct_png, study.direct_map_png,
                       "the map shows where light of later bounces is missing") +
           "</div>\n";
  return out;
}

std::string prediction_section(const Study& study) {
  std::string out =
      "<h2 id=\"model\">What a frame will take</h2>\n"
      "<p>time = frame + pixel_samples × (sum of passes), each pass at its level, from the frames of the one-at-a-time "
      "ladders. Frames of one point a pixel are a little cheaper and have costs of their own, which are not "
      "shown.</p>\n<div class=\"scroll\"><table class=\"metrics\"><thead><tr><th>pass</th><th>level: ms of CPU for "
      "one "
      "point in each pixel</th></tr></thead><tbody>\n<tr><th scope=\"row\">frame, once</th><td>" +
      number(study.frame_ms) + "</td></tr>\n";
  for (const TimeModel::Part& part : study.parts) {
    out += "<tr><th scope=\"row\">" + escape(part.pass) + "</th><td>";
    if (part.setting == kSettingCount) {
      out += number(part.ms.front());
    } else if (!study.matters[part.setting]) {
      out += number(part.ms[study.cheapest[part.setting]]);
    } else {
      for (std::size_t i = 0; i < part.ms.size(); ++i)
        if (!std::isnan(part.ms[i]))
          out += std::string(i > 0 ? ", " : "") + std::string(runtime::kSettings[part.setting].levels[i]) + ": " +
                 number(part.ms[i]);
    }
    out += "</td></tr>\n";
  }
  out += "</tbody></table></div>\n";
  if (const auto a = agreement_of(study))
    out +=
        element("p", "Of " + std::to_string(a->rows) + " frames that the sum was " + (a->is_of_others ? "not " : "") +
                         "made from, the predicted CPU time is off by " + number(100 * a->median, 2) +
                         " % in the middle and " + number(100 * a->worst, 2) + " % at most.");
  return out;
}

std::string table_section(const Pages& pages) {
  const Study& study = pages.study;
  std::string out =
      "<h2 id=\"all\">All frames</h2>\n<p>In the order of their time. Grey and ○: another combination is faster by "
      "more "
      "than the quartiles of both, and no less exact by FLIP.";
  if (study.left_out > 0)
    out += " " + std::to_string(study.left_out) + " combinations would take more than " +
           time_text(study.options.longest_ms) + " of CPU a frame (--longest-ms) and were left out.";
  if (study.not_promising > 0)
    out += " " + std::to_string(study.not_promising) +
           " more were not measured: by what was known of their passes and errors, others are as exact in less time.";
  out +=
      "</p>\n<div class=\"scroll\"><table class=\"metrics\"><thead><tr><th>no.</th><th>frame</th><th>ms</th><th>CPU "
      "ms</th>"
      "<th>predicted CPU ms</th><th>FLIP</th><th>relMSE</th><th>stops, median</th><th>stops, 95 %</th></tr></thead>"
      "<tbody>\n";
  int number_of_row = 0;
  for (const Row* row : in_order(pages)) {
    const double cpu = row->timing(true).median;
    out += std::string("<tr") + (row->dominated_by.empty() ? "" : " class=\"fixed\"") + "><td class=\"n\">" +
           std::to_string(++number_of_row) + "</td><th scope=\"row\">" + (row->dominated_by.empty() ? "" : "○ ") +
           escape(name_of(study, *row)) + (row->is_path_tracer ? " <span class=\"badge\">all bounces</span>" : "") +
           (row->dominated_by.empty() ? "" : "<small>beaten by " + escape(row->dominated_by) + "</small>") + "</th>" +
           Pages::reading(*row, false) + Pages::reading(*row, true);
    if (row->is_path_tracer) out += "<td></td>";
    else {
      const double off = 100 * (row->predicted_cpu_ms / cpu - 1);
      out += "<td class=\"n\">" + number(row->predicted_cpu_ms) + "\n<small>" + (off >= 0 ? "+" : "") +
             page::fixed(off, 1) + " %" + (row->feeds_model ? ", known" : "") + "</small></td>";
    }
    out += Pages::errors(row->errors) + "</tr>\n";
  }
  return out +
         "</tbody></table></div>\n<p class=\"quiet\">known: its passes are among those that predictions are made "
         "from.</p>\n";
}

std::string whole_plots(const Pages& pages) {
  const Study& study = pages.study;
  const std::vector<const Row*> all = in_order(pages);
  const Levels usual = usual_of(study);
  const auto number_of = [&](const Row& row) {
    return std::to_string(1 + (std::find(all.begin(), all.end(), &row) - all.begin()));
  };
  const auto labels = [&](const Row& row, bool is_beaten) {
    const std::string no = number_of(row), rest = name_of(study, row, &usual);
    if (row.is_path_tracer) return std::vector{std::to_string(row.samples) + " spp"};
    if (is_beaten) return std::vector<std::string>{};
    return std::vector{no + ": " + (rest.empty() ? "as usual" : rest), no};
  };
  const auto name = [&](const Row& row) { return "no. " + number_of(row) + ": " + name_of(study, row); };
  Row as_usual;
  as_usual.levels = usual;
  return pages.plots("Whole frame", all, {name, labels}) +
         element("p",
                 "Numbers are those of the table \"All frames\"; the name of a dot is where the pointer is on it. "
                 "Labels say what differs from " +
                     name_of(study, as_usual) + ".");
}

constexpr std::string_view kStyle =
    ".plots{grid-template-columns:repeat(auto-fit,minmax(min(100%,520px),1fr))}.plots figure{max-width:760px}"
    ".cards{grid-template-columns:repeat(auto-fill,minmax(min(100%,350px),1fr));margin-top:14px}"
    ".cards .pair b{color:inherit;text-decoration:none}.pair div{display:grid;grid-template-columns:1fr "
    "1fr;gap:3px}.pair img{display:block;width:100%;height:auto}"
    ".first{display:grid;grid-template-columns:minmax(0,400px) minmax(0,1fr);gap:24px;align-items:start}"
    ".first img{display:block;width:100%;max-width:400px;height:auto}.first dl{margin:0}"
    ".metrics thead th{min-width:5rem}.metrics td,.metrics th{padding:5px 8px}"
    ".ramp{display:inline-block;width:9em;height:.8em;vertical-align:-.1em;background:linear-gradient(90deg,#000004,#"
    "641a80,"
    "#ca3e72,#fd9969,#fcfdbf);-webkit-print-color-adjust:exact;print-color-adjust:exact}"
    ".plots figure{overflow-x:auto}.plots svg{min-width:500px}"
    "@media (max-width:1000px){.first{grid-template-columns:minmax(0,1fr)}}\n";

}  // namespace

std::string page_of(const Study& study) {
  const Pages pages{study};
  const std::string title = "What accuracy costs in time: " + (study.scene.empty() ? "a scene" : study.scene);
  std::string out = page::page_head(title);
  out.insert(out.find("</style>"), kStyle);
  out += element("h1", title) + "\n";
  if (!study.is_complete)
    out +=
        "<p class=\"note\">The measurement was interrupted: some frames have fewer readings, some were not "
        "measured.</p>\n";
  out += verdict_of(pages) + "<nav><a href=\"#whole\">Whole frame</a>";
  for (std::size_t i = 0; i < kSettingCount; ++i)
    if (!ladder_of(study, i).empty())
      out += "<a href=\"#" + std::string(runtime::kSettings[i].name) + "\">" + std::string(runtime::kSettings[i].name) +
             "</a>";
  out +=
      "<a href=\"#tracer\">Path tracer</a><a href=\"#left\">What no level repairs</a><a href=\"#model\">What a frame "
      "will take</a><a href=\"#all\">All frames</a></nav>\n";
  out += "<div class=\"first\"><figure>" + Pages::image(study.reference_png, "The reference") +
         "<figcaption>The reference, as the screen shows it</figcaption></figure>" + facts_of(study) + "</div>\n";

  out +=
      "<h2 id=\"whole\">Whole frame</h2>\n<p>Every combination that was measured. Blue discs are worth their time: no "
      "other combination is both faster and more exact; hollow ones are not. Orange: the path tracer, which follows "
      "all bounces.";
  if (study.direct_only)
    out +=
        std::string(
            " The green line is an exact picture of direct light alone, which is all that the pipeline renders.") +
        (study.matters[kEnvironment]
             ? " A frame well below it owes that to an error that happens to make up for the missing bounces: maps of "
               "the environment without shadows are brighter just where later bounces are missing."
             : "");
  out += "</p>\n";
  out += whole_plots(pages);
  out +=
      "<p class=\"quiet\">Below, on the left what the screen shows, on the right where it differs from the reference: "
      "FLIP from 0 <span class=\"ramp\"></span> to 1.</p>\n";
  for (std::size_t i = 0; i < kSettingCount; ++i) out += setting_section(pages, i);

  out += "<h2 id=\"tracer\">Path tracer</h2>\n<div class=\"cards\">\n";
  for (const Row* row : by_time(pages, true))
    out +=
        pages.card(std::to_string(row->samples) + (row->samples == 1 ? " sample a pixel" : " samples a pixel"), *row);
  out += "</div>\n" + unrepaired_section(pages) + prediction_section(study) + table_section(pages);
  return out + page::page_foot();
}

}  // namespace likeness::scene_cost
