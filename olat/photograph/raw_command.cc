#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "olat/photograph/chart_greys.h"
#include "olat/photograph/command.h"
#include "render/exposure/overlay.h"
#include "render/exposure/pick.h"
#include "render/exposure/text.h"
#include "render/files/files.h"
#include "render/image/layers.h"
#include "render/image/read.h"
#include "render/image/write.h"
#include "render/photograph/raw.h"

namespace likeness::olat_photograph {
namespace {

using photograph::Balance;
using photograph::Developed;

struct RawLine {
  std::string file, out, balance = "as-shot", chart, zones;
  std::vector<std::string> corners;
  double ev = 0;
  bool camera_space = false, json = false, has_ev = false;
};

photograph::RawOptions raw_options(const RawLine& line) {
  photograph::RawOptions out;
  out.is_camera_space = line.camera_space;
  if (line.balance == "as-shot" || line.balance == "chart") return out;
  if (line.balance == "daylight") out.balance = Balance::kDaylight;
  else if (line.balance == "none") out.balance = Balance::kNone;
  else {
    out.balance = Balance::kGains;
    int used = 0;
    if (std::sscanf(line.balance.c_str(), "%lf,%lf,%lf%n", &out.gains[0], &out.gains[1], &out.gains[2], &used) != 3 ||
        used != static_cast<int>(line.balance.size()))
      throw files::UsageError("--white-balance " + files::in_quotes(line.balance) +
                              " is none of as-shot, daylight, chart, none and three gains R,G,B");
  }
  return out;
}

std::string triple_text(const std::array<double, 3>& v, const char* format) {
  std::string out;
  for (const double x : v) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), format, x);
    out += (out.empty() ? "" : " ") + std::string(text.data());
  }
  return out;
}

std::optional<double> ev100_of(const photograph::Taken& taken) {
  if (!taken.exposure_s || !taken.f_number || !taken.iso) return std::nullopt;
  return exposure::ev100(*taken.f_number, *taken.exposure_s, *taken.iso);
}

std::string facts_text(const Developed& raw) {
  const photograph::DngFacts& f = raw.facts;
  std::string out = "camera          " + f.camera + "\n" + "pixels          " + std::to_string(raw.light.width) +
                    " x " + std::to_string(raw.light.height) + ", mosaic " + photograph::pattern_name(f.pattern) +
                    "\n" + "black level     ";
  for (const auto& row : f.black)
    for (const double level : row) out += files::number_text(level) + " ";
  out += "(of the four sites of the mosaic)\nwhite level     " + files::number_text(f.white) + "\nwhite balance   " +
         triple_text(raw.gains, "%.4f") + " (gains of red, green, blue)\n";
  out += "  as shot       " + (f.as_shot ? triple_text(*f.as_shot, "%.4f") : "not in the file") + "\n  daylight      " +
         triple_text(f.daylight, "%.4f") + "\n";
  if (!f.has_matrix) out += "matrix          none in the file: the camera's own colors\n";
  else
    for (std::size_t i = 0; i < 3; ++i)
      out += (i == 0 ? "matrix          " : "                ") + triple_text(f.rec709_from_camera[i], "%9.5f") + "\n";
  const photograph::Taken& t = f.taken;
  const auto said = [](std::optional<double> v, const char* unit) {
    return v ? files::number_text(*v) + unit : std::string("not said");
  };
  out +=
      "exposure        " + said(t.exposure_s, " s") + ", f-number " + said(t.f_number, "") + ", ISO " + said(t.iso, "");
  if (const auto ev = ev100_of(t)) out += ", EV100 " + files::number_text(std::round(100 * *ev) / 100);
  out += "\nclipped         " + std::to_string(raw.clipped) + " pixels\n";
  if (f.baseline_ev != 0) out += "baseline        " + files::number_text(f.baseline_ev) + " stops, not applied\n";
  return out;
}

nlohmann::ordered_json facts_json(const Developed& raw) {
  const photograph::DngFacts& f = raw.facts;
  nlohmann::ordered_json out{{"camera", f.camera},
                             {"width", raw.light.width},
                             {"height", raw.light.height},
                             {"mosaic", photograph::pattern_name(f.pattern)},
                             {"black", f.black},
                             {"white", f.white},
                             {"gains", raw.gains},
                             {"daylight", f.daylight},
                             {"rec709_from_camera", f.rec709_from_camera},
                             {"clipped_pixels", raw.clipped},
                             {"baseline_ev", f.baseline_ev}};
  if (f.as_shot) out["as_shot"] = *f.as_shot;
  if (f.taken.exposure_s) out["exposure_s"] = *f.taken.exposure_s;
  if (f.taken.f_number) out["f_number"] = *f.taken.f_number;
  if (f.taken.iso) out["iso"] = *f.taken.iso;
  if (const auto ev = ev100_of(f.taken)) out["ev100"] = *ev;
  return out;
}

nlohmann::ordered_json chart_json(const ChartReading& reading) {
  nlohmann::ordered_json greys = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < kGreys; ++i) {
    const Grey& g = reading.greys[i];
    greys.push_back({{"patch", olat_calibrate::kFirstGrey + i + 1},
                     {"stops", g.stops},
                     {"reference_stops", g.reference_stops},
                     {"error", g.error},
                     {"limit", kGreyLimits[i]},
                     {"within", g.is_within},
                     {"zone", g.zone},
                     {"reference_zone", g.expected_zone},
                     {"shown_zone", g.shown_zone}});
  }
  return {{"corners", reading.corners}, {"patches_seen", reading.seen}, {"ev", reading.ev}, {"greys", greys}};
}

void write_light(const Developed& raw, const std::string& file, const nlohmann::ordered_json& facts) {
  image::Layers layers;
  layers.width = raw.light.width, layers.height = raw.light.height;
  layers.layers.push_back({"", {"R", "G", "B"}, raw.light.rgb});
  layers.layers.push_back({"sensor", {"clipped"}, std::vector<float>(raw.is_clipped.begin(), raw.is_clipped.end())});
  layers.metadata = facts.dump();
  image::write_layers(file, layers);
}

int run_raw(const RawLine& line) {
  if (line.chart.empty() && (!line.corners.empty() || line.balance == "chart"))
    throw files::UsageError("--corner and --white-balance chart need --chart REFERENCE.csv");
  if (line.balance == "chart" && line.camera_space && line.out.empty() && line.zones.empty())
    throw files::UsageError("--white-balance chart prints gains; say where the picture goes by --out");
  const std::string bytes = files::read_whole(line.file, image::kMostFileBytes);
  photograph::RawOptions options = raw_options(line);
  Developed raw = photograph::develop(bytes, line.file, options);
  std::optional<olat_calibrate::Reference> reference;
  std::optional<ChartReading> chart;
  if (!line.chart.empty()) {
    reference = olat_calibrate::read_reference(line.chart);
    chart = read_chart(raw.light, line.corners, *reference);
    if (line.balance == "chart") {
      options.balance = Balance::kNone;
      options.is_camera_space = true;
      const Developed plain = photograph::develop(bytes, line.file, options);
      options.gains = gains_of_greys(plain.light, chart->corners);
      options.balance = Balance::kGains;
      options.is_camera_space = line.camera_space;
      raw = photograph::develop(bytes, line.file, options);
      std::vector<std::string> corners;
      for (const auto& [x, y] : chart->corners) corners.push_back(files::number_text(x) + "," + files::number_text(y));
      const std::size_t seen = chart->seen;
      chart = read_chart(raw.light, corners, *reference);
      chart->seen = seen;
    }
  }
  nlohmann::ordered_json facts = facts_json(raw);
  if (chart) facts["chart"] = chart_json(*chart);
  if (!line.out.empty()) write_light(raw, line.out, facts);
  if (!line.zones.empty()) {
    scene::View view;
    view.ev = line.has_ev ? line.ev : chart ? chart->ev : 0;
    image::write_png(line.zones, exposure::picture_with(exposure::Overlay::kZones, raw.light, view));
  }
  if (line.json) std::cout << facts.dump(1) << "\n";
  else std::cout << facts_text(raw) << (chart ? text_of_greys(*chart) : "");
  return 0;
}

constexpr auto kRawFooter = R"(Examples
  likeness raw chart.dng                                  levels, white balance, matrix and exposure
  likeness raw chart.dng --out chart.exr                  linear Rec. 709, 1 is a full sensor; layer sensor.clipped
  likeness raw chart.dng --out chart.exr --white-balance daylight
  likeness raw chart.dng --chart colorchecker.csv --zones zones.png
                                                          the chart's six greys in stops against their reference
  likeness raw chart.dng --chart colorchecker.csv --white-balance chart --out chart.exr
                                                          white balance by the chart's greys
  likeness raw chart.dng --camera-space --white-balance none --out sensor.exr

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 4 a file cannot be written.
Manual: docs/raw.md)";

}  // namespace

void add_raw(CLI::App& program, int& exit_code) {
  const auto line = std::make_shared<RawLine>();
  CLI::App* app = program.add_subcommand("raw", "A raw photograph (DNG) to linear light, without any curve");
  app->add_option("FILE", line->file, "Camera raw, .dng, with a Bayer mosaic")->required();
  app->add_option("--out", line->out, "Linear light, .exr");
  app->add_option("--white-balance", line->balance, "as-shot, daylight, chart (by --chart), none, or gains R,G,B")
      ->capture_default_str();
  app->add_flag("--camera-space", line->camera_space, "Colors of the camera, without its matrix to Rec. 709");
  app->add_option("--chart", line->chart,
                  "Values of the chart of 24 patches in the picture, CSV (Lab or xyY, D50): prints its greys");
  app->add_option("--corner", line->corners,
                  "x,y [pixel] of the chart's corner at patch 1, then 6, 24, 19; without, it is looked for");
  app->add_option("--zones", line->zones, "A picture colored by zone, .png");
  CLI::Option* ev =
      app->add_option("--ev", line->ev, "Of --zones [stops]; without, the chart's white is at its reference");
  app->add_flag("--json", line->json, "Print all numbers as JSON");
  app->footer(kRawFooter);
  app->callback([line, ev, &exit_code] {
    line->has_ev = !ev->empty();
    exit_code = run_raw(*line);
  });
}

}  // namespace likeness::olat_photograph
