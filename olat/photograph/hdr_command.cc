#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "olat/photograph/command.h"
#include "olat/photograph/hdr.h"
#include "olat/photograph/shifts.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/image/layers.h"
#include "render/photograph/merge.h"

namespace likeness::olat_photograph {
namespace {

struct MergeLine {
  std::vector<std::string> frames;
  std::string list, times, response, response_out, weights, ignore, out, page;
  double white = 1, ghost_sigmas = 5;
  bool align = false, deghost = false, no_shifts = false, json = false;
};

std::vector<photograph::Bracket> brackets_of_line(const MergeLine& line) {
  if (line.list.empty() == line.frames.empty())
    throw files::UsageError("give the frames, or a list of them by --list; not both");
  if (!line.list.empty()) {
    if (!line.times.empty()) throw files::UsageError("--times is for frames; --list has times of its own");
    return photograph::read_brackets(line.list);
  }
  std::vector<photograph::Bracket> out;
  if (line.times.empty()) {
    for (const std::string& file : line.frames) out.push_back(photograph::bracket_by_exif(file));
    return out;
  }
  std::vector<std::string> times;
  for (std::size_t at = 0; at <= line.times.size();) {
    const std::size_t end = std::min(line.times.find(',', at), line.times.size());
    times.push_back(line.times.substr(at, end - at));
    at = end + 1;
  }
  if (times.size() != line.frames.size())
    throw files::UsageError("--times has " + std::to_string(times.size()) + " times for " +
                            std::to_string(line.frames.size()) + " frames");
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto seconds = photograph::seconds_of(times[i]);
    if (!seconds)
      throw files::UsageError("--times: " + files::in_quotes(times[i]) +
                              " is no time from 1e-9 to 1e6 s (0.5 or 1/250)");
    out.push_back({line.frames[i], {*seconds, {}, {}, 0, 0}});
  }
  return out;
}

photograph::MergeOptions merge_options(const MergeLine& line) {
  photograph::MergeOptions out;
  out.brackets = brackets_of_line(line);
  if (line.response == "linear") out.response = photograph::linear_response();
  else if (line.response == "srgb") out.response = photograph::srgb_response();
  else if (line.response == "recover") out.recovers = true;
  else if (!line.response.empty())
    out.response = photograph::response_of(files::read_whole(line.response, 1 << 20), line.response);
  for (const auto& row : photograph::kWeightings)
    if (line.weights == row.name) out.weighting = row.weighting;
  if (!line.weights.empty() && !out.weighting)
    throw files::UsageError("--weights " + files::in_quotes(line.weights) + " is neither debevec nor noise");
  if (!line.ignore.empty()) {
    photograph::Color8 color{};
    int used = 0;
    if (std::sscanf(line.ignore.c_str(), "%d,%d,%d%n", &color[0], &color[1], &color[2], &used) != 3 ||
        used != static_cast<int>(line.ignore.size()))
      throw files::UsageError("--ignore-color " + files::in_quotes(line.ignore) + " is no R,G,B from 0 to 255");
    for (const int v : color)
      if (v < 0 || v > 255) throw files::UsageError("--ignore-color: " + std::to_string(v) + " is outside 0 to 255");
    out.frame.ignored = color;
  }
  if (!(line.ghost_sigmas >= 1 && line.ghost_sigmas <= 100))
    throw files::UsageError("--ghost-sigmas " + files::number_text(line.ghost_sigmas) + " is outside 1 to 100");
  out.frame.white = line.white;
  out.ghost_sigmas = line.ghost_sigmas;
  out.aligns = line.align;
  out.deghosts = line.deghost;
  if (line.align && line.no_shifts) throw files::UsageError("--align needs the shifts that --no-shifts leaves out");
  if (!line.no_shifts) out.shift_of = shift_finder();
  return out;
}

void write_merged(photograph::Merged& merged, const std::string& file) {
  image::Layers layers;
  layers.width = merged.light.width, layers.height = merged.light.height;
  std::vector<float> more;
  more.reserve(4 * merged.confidence.size());
  for (std::size_t i = 0; i < merged.confidence.size(); ++i)
    more.insert(more.end(), {static_cast<float>(merged.bound[i]), merged.confidence[i],
                             static_cast<float>(merged.frames[i]), static_cast<float>(merged.ghost[i])});
  layers.layers.push_back({"", {"R", "G", "B"}, merged.light.rgb});
  layers.layers.push_back({"merge", {"bound", "confidence", "frames", "ghost"}, std::move(more)});
  layers.metadata = json_of(merged);
  image::write_layers(file, layers);
}

int run_hdr_merge(const MergeLine& line) {
  photograph::MergeOptions options = merge_options(line);
  files::catch_interrupts();
  for (const std::string& file : {line.out, line.page, line.response_out})
    if (!file.empty()) files::WholeFile probe(file);
  photograph::Merged merged;
  {
    files::Progress progress;
    options.keep_going = [&](std::string_view what, double share) {
      progress.tell(what, share);
      return !files::interrupted();
    };
    merged = photograph::merge(options);
  }
  if (!line.out.empty()) write_merged(merged, line.out);
  if (!line.response_out.empty()) files::write_whole(line.response_out, photograph::csv_of(merged.response));
  if (!line.page.empty()) files::write_whole(line.page, page_of(merged));
  std::cout << (line.json ? json_of(merged) : text_of(merged));
  return 0;
}

constexpr auto kMergeFooter = R"(Examples
  likeness hdr merge --list image_list.txt --out church.exr --page church.html
                                                          names and times from a list
  likeness hdr merge --list image_list.txt --ignore-color 0,0,255 --out church.exr --response-out film.csv
                                                          without a blue border; keeps the response
  likeness hdr merge a.jpg b.jpg c.jpg --out room.exr     times from EXIF
  likeness hdr merge a.png b.png --times 1/250,1/30 --response film.csv --out room.exr
  likeness hdr merge *.dng --align --deghost --out yard.exr

The EXR holds linear light (R, G, B; code 255 of a frame of 1 s is 1 for linear and srgb) and the layer merge:
confidence 0 to 1, frames used, bound (1: the light is that or more, -1: that or less, 0: known), ghost.

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 4 a file cannot be written, 130 interrupted.
Manual: docs/hdr_merge.md)";

}  // namespace

void add_hdr(CLI::App& program, int& exit_code) {
  CLI::App* hdr = program.add_subcommand("hdr", "Bracketed photographs to linear light");
  hdr->require_subcommand(1);
  const auto line = std::make_shared<MergeLine>();
  CLI::App* app = hdr->add_subcommand("merge", "Merge frames of different exposures to one picture of linear light");
  app->add_option("FRAMES", line->frames, "Photographs: .png, .jpg, .tif, .exr, .hdr, .dng");
  app->add_option("--list", line->list,
                  "Their names and times: lines of name seconds, or of name exposure 1/shutter f/stop gain nd");
  app->add_option("--times", line->times,
                  "Exposure times [s] of FRAMES, 1/250,1/60,...; without, from EXIF (with f-number and ISO)");
  app->add_option("--response", line->response,
                  "linear, srgb, recover, or a CSV of --response-out (default: recovered where codes of several "
                  "exposures show it)");
  app->add_option("--response-out", line->response_out, "The response, .csv");
  std::string weights;
  for (const auto& row : photograph::kWeightings)
    weights += (weights.empty() ? "" : "; ") + std::string(row.name) + ": " + std::string(row.text);
  app->add_option("--weights", line->weights, weights + " (default: noise where all frames are light, else debevec)");
  app->add_option("--ignore-color", line->ignore, "R,G,B, 0 to 255: pixels of that color are not there");
  app->add_option("--white", line->white, "Of EXR and HDR frames: light at or above it is clipped")
      ->capture_default_str();
  app->add_flag("--align", line->align, "Move frames onto the reference frame");
  app->add_flag("--no-shifts", line->no_shifts, "Do not look for shifts");
  app->add_flag("--deghost", line->deghost, "Where frames disagree, take the light of the reference frame");
  app->add_option("--ghost-sigmas", line->ghost_sigmas, "Noise that frames may disagree by, each")
      ->capture_default_str();
  app->add_option("--out", line->out, "Linear light, .exr");
  app->add_option("--page", line->page, "A page with response, frames, ghosts and confidence, .html");
  app->add_flag("--json", line->json, "Print all numbers as JSON");
  app->footer(kMergeFooter);
  app->callback([line, &exit_code] { exit_code = run_hdr_merge(*line); });
}

}  // namespace likeness::olat_photograph
