#include "olat/calibrate/command.h"

#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "olat/calibrate/calibrate.h"
#include "olat/calibrate/undistort.h"
#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"

namespace likeness::olat_calibrate {
namespace {

struct CommandLine {
  std::string capture, gain, grey, chrome, out;
  std::vector<std::string> corners;
  Options options;
  bool json = false, dry = false, undistort = false;
};

Corners corners_of(const std::vector<std::string>& texts) {
  if (texts.size() != 4)
    throw files::UsageError(
        "--chart needs four --corner x,y (of patch 1, 6, 24 and 19), or none: then it is looked for");
  Corners out{};
  for (std::size_t i = 0; i < 4; ++i) {
    int used = 0;
    if (std::sscanf(texts[i].c_str(), "%lf,%lf%n", &out[i][0], &out[i][1], &used) != 2 ||
        used != static_cast<int>(texts[i].size()))
      throw files::UsageError("--corner " + files::in_quotes(texts[i]) + " is no x,y in pixels");
  }
  return out;
}

int undistort(const CommandLine& line, const capture::Capture& capture) {
  files::catch_interrupts();
  try {
    files::Progress progress;
    const Undistorted result = run_undistort(capture, line.out, [&](std::string_view what, double share) {
      progress.tell(what, share);
      return !files::interrupted();
    });
    std::cout << (line.json ? json_of(result) : text_of(result));
    std::cerr << "written: " << line.out << "/capture.json\n";
    return 0;
  } catch (const files::Interrupted&) {
    std::cerr << "likeness olat calibrate: interrupted; " << line.out << " is no capture yet\n";
    return 130;
  }
}

int run(CommandLine line) {
  Options& options = line.options;
  if (!line.gain.empty()) {
    if (line.gain != "light" && line.gain != "channel")
      throw files::UsageError("--gain " + files::in_quotes(line.gain) + " is neither light nor channel");
    options.gain = line.gain == "light" ? GainOf::kLight : GainOf::kChannel;
  }
  if (!line.grey.empty() && options.gain == GainOf::kNothing)
    throw files::UsageError("--grey is for --gain light or --gain channel");
  if (!options.chart.empty() && !line.corners.empty()) options.corners = corners_of(line.corners);
  const bool measures = options.gain != GainOf::kNothing || !line.chrome.empty() || options.noise ||
                        !options.chart.empty() || !options.flat.empty();
  if (line.undistort && (measures || line.out.empty() || line.dry))
    throw files::UsageError(line.out.empty() ? "--undistort writes new photographs; say where by --out FOLDER"
                                             : "--undistort stands alone; calibrate the capture that it writes");
  if (!measures && !line.undistort)
    throw files::UsageError("nothing to calibrate; there are --gain, --chrome, --noise, --chart, --flat, --undistort");
  const capture::Capture capture = capture::read_capture(line.capture);
  if (line.undistort) return undistort(line, capture);
  capture::Capture grey, chrome;
  if (!line.grey.empty()) grey = capture::read_capture(line.grey), options.grey = &grey;
  if (!line.chrome.empty()) chrome = capture::read_capture(line.chrome), options.chrome = &chrome;
  files::catch_interrupts();
  Result result;
  try {
    files::Progress progress;
    options.keep_going = [&](std::string_view what, double share) {
      progress.tell(what, share);
      return !files::interrupted();
    };
    result = run_calibrate(capture, options);
  } catch (const files::Interrupted&) {
    std::cerr << "likeness olat calibrate: interrupted; nothing is changed\n";
    return 130;
  }
  std::cout << (line.json ? json_of(result) : text_of(result));
  if (line.dry) std::cerr << "--dry-run: nothing is written\n";
  else if (!result.changes.empty())
    for (const std::string& text : write_result(result, line.out)) std::cerr << text << "\n";
  return 0;
}

constexpr auto kFooter = R"(Examples
  likeness olat calibrate capture --gain light            intensities, from the renders; relative to the median light
  likeness olat calibrate capture --gain channel --grey greycard.capture
                                                          intensities and white balance, from photos of a grey card
  likeness olat calibrate capture --chrome ball.capture   directions of lights, from photos of a mirror ball
  likeness olat calibrate capture --noise                 the noise floor of each camera
  likeness olat calibrate capture --chart chart.dng --reference chart.csv
                                                          colors of the camera, with Delta E at three stages
  likeness olat calibrate capture --chart chart.dng --reference chart.csv \
      --corner 120,80 --corner 900,90 --corner 890,610 --corner 115,600
                                                          the same, where the chart is not found or not alone
  likeness olat calibrate capture --camera c1 --flat white.exr
                                                          what lens and sensor darken
  likeness olat calibrate capture --undistort --out straight.capture
                                                          pictures as pinholes would have taken them
  likeness olat calibrate capture --gain light --dry-run  what would change

Without --out the files of the capture change, and what they were is kept beside them as lights.1.json and so on.

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 130 interrupted: nothing is changed.
Manual: docs/olat_calibrate.md)";

}  // namespace

void add_calibrate(CLI::App& olat, int& exit_code) {
  const auto line = std::make_shared<CommandLine>();
  CLI::App* app =
      olat.add_subcommand("calibrate", "Measures lights, colors and noise of a capture and writes them into it");
  app->add_option("CAPTURE", line->capture, "Folder with capture.json, or that file")->required();
  app->add_option("--gain", line->gain, "Intensity of each light: light (one number) or channel (with white balance)");
  app->add_option("--grey", line->grey, "Capture of a grey or white card under the same lights, instead of renders");
  app->add_option("--variant", line->options.variant,
                  "Renders that --gain uses; without it, the first of capture.json");
  app->add_flag("--absolute", line->options.is_absolute, "Gains as they are, not relative to the median light");
  app->add_option("--chrome", line->chrome,
                  "Capture of a mirror ball under the same lights; its mask says where it is");
  app->add_flag("--noise", line->options.noise, "Noise floor of each camera");
  app->add_option("--chart", line->options.chart, "Photo of a chart of 24 patches");
  app->add_option("--corner", line->corners,
                  "x,y [pixel] of the chart's corner at patch 1, then 6, 24, 19; without, it is looked for");
  app->add_option("--reference", line->options.reference, "Its values: CSV of patch, and Lab or xyY for D50");
  app->add_option("--flat", line->options.flat, "Photo of an even surface in even light");
  app->add_option("--camera", line->options.camera, "Camera of --chart and --flat; without it, all");
  app->add_flag("--undistort", line->undistort, "Pictures of pinholes from those of the lenses, into --out");
  app->add_option("--out", line->out, "Folder for a new capture, instead of changing this one");
  app->add_flag("--dry-run", line->dry, "Print the changes, and write nothing");
  app->add_flag("--json", line->json, "Print the changes as JSON");
  app->footer(kFooter);
  app->callback([line, &exit_code] { exit_code = run(*line); });
}

}  // namespace likeness::olat_calibrate
