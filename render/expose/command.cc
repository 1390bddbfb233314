#include "render/expose/command.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "render/expose/expose.h"
#include "render/expose/page.h"
#include "render/expose/request.h"
#include "render/expose/series.h"
#include "render/expose/summary.h"
#include "render/exposure/overlay.h"
#include "render/exposure/pick.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/image/write.h"
#include "render/view/view_list.h"

namespace likeness::expose {
namespace {

namespace fs = std::filesystem;

// One picture goes into the file that is named, several into the folder.
void write_pictures(const Series& series, const Exposed& exposed, const Options& options, const fs::path& out) {
  if (series.frames.size() == 1) {
    image::write_png(out, exposure::picture_with(options.overlay, exposed.first.light, exposed.view));
    return;
  }
  for (const Frame& frame : series.frames) {
    if (files::interrupted()) throw files::Interrupted{};
    image::write_png(out / (frame.stem + ".png"),
                     exposure::picture_with(options.overlay, frame.read().light, exposed.view));
  }
}

int run(const Request& request) {
  if (request.lists) {
    std::cout << view::list_text(request.config);
    return 0;
  }
  const Options options = options_of(request);
  files::catch_interrupts();
  const Series series = series_of(request, options);
  if (series.frames.size() > 1 && fs::path(request.out).extension() == ".png")
    throw files::UsageError("--out " + files::in_quotes(request.out) + ": there are " +
                            std::to_string(series.frames.size()) + " pictures; name a folder for them");
  if (series.frames.size() == 1 && !request.out.empty()) files::WholeFile probe(request.out);
  if (!request.page.empty()) files::WholeFile probe(request.page);

  const Exposed exposed = run_expose(series, options, {request.aperture, request.shutter, request.iso});
  if (!request.out.empty()) write_pictures(series, exposed, options, request.out);
  if (!request.page.empty()) files::write_whole(request.page, page_of(exposed));
  std::cout << (request.json ? summary_json(exposed) : summary_text(exposed));
  return 0;
}

constexpr auto kFooter = R"(Examples
  likeness expose church.exr                              an EV, what it shows and hides, and what every other mode would
  likeness expose church.exr --page why.html              the same as a page: histogram, curve, zones, alternatives
  likeness expose church.exr --overlay zones --out z.png  the picture colored by zone, with numerals
  likeness expose chart.exr --mode card --patch 400,220,30,30  an 18 % grey card is there
  likeness expose face.exr --mode patch --patch 90,60,20,20 --zone VI
  likeness expose frame.*.exr                             one EV for all frames of a shot
  likeness expose capture --camera c0                     one EV for all lights of a camera
  likeness expose room.json                               of a quick look at a scene
  likeness expose --list --ocio studio.ocio               every display and view

EV is in stops: light is multiplied by 2^EV before the view; likeness render --ev takes it.

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 4 a file cannot be written, 130 interrupted.
Manual: docs/expose.md)";

}  // namespace

void add_expose(CLI::App& program, int& exit_code) {
  const auto r = std::make_shared<Request>();
  CLI::App* app = program.add_subcommand("expose", "Choose an exposure, and show in zones and on the curve why");
  app->add_option("INPUT", r->inputs,
                  "Pictures (.exr, .hdr, .dng, .png ...), which share one EV; or one capture; or one scene");
  app->add_flag("--json", r->json, "Print all numbers as JSON");

  const std::string how = "How it is chosen";
  std::string modes;
  for (const exposure::ModeRow& row : exposure::kModes)
    modes += (modes.empty() ? "" : "; ") + std::string(row.name) + ": " + std::string(row.text);
  app->add_option("--mode", r->mode, modes + " (default average)")->group(how);
  app->add_option("--ev", r->ev, "By hand [stops]: measures only")->group(how);
  app->add_option("--patch", r->patch, "X,Y,WIDTH,HEIGHT in pixels from the top left, of the first picture")
      ->group(how);
  app->add_option("--zone", r->zone, "Of patch (default V) and percentile: 0, I, ... XVI, or a number as 6.5")
      ->group(how);
  app->add_option("--percentile", r->percentile, "Of luminance [%] (default 99)")->group(how);
  app->add_option("--most-clipped", r->most_clipped, "Of linear: share of pixels that may clip [%]")
      ->capture_default_str()
      ->group(how);
  app->add_option("--most-crushed", r->most_crushed,
                  "Of linear: share of pixels with light that may be shown black [%]")
      ->capture_default_str()
      ->group(how);

  const std::string what = "What is looked at";
  app->add_option("--mask", r->mask, "A picture of the same size: white counts, black does not, grey in part")
      ->group(what);
  app->add_option("--floor", r->floor,
                  "Luminance at or below it is no light (default 0; of a capture, the camera's noise)")
      ->group(what);
  app->add_option("--layer", r->layer, "Of an EXR with layers")->group(what);
  app->add_option("--camera", r->camera, "Of a capture or a scene (default: the first)")->group(what);
  app->add_option("--shutter", r->shutter, "Exposure time [s], for EV100, instead of what the files say")->group(what);
  app->add_option("--aperture", r->aperture, "f-number, likewise")->group(what);
  app->add_option("--iso", r->iso, "ISO speed, likewise")->group(what);

  const std::string shown = "The view, whose curve decides";
  app->add_option(
         "--view", r->view,
         "srgb, gt, khronos, agx, aces, or a view of the OpenColorIO config (default: what the scene or the capture "
         "says, else the config's, else gt)")
      ->group(shown);
  app->add_option("--display", r->display, "A display of the config")->group(shown);
  app->add_option("--ocio", r->config, "An OpenColorIO config (default: $OCIO)")->group(shown);
  app->add_flag("--list", r->lists, "Print every display and view, and end")->group(shown);

  const std::string files = "Files";
  app->add_option("--out", r->out, "The picture, .png; of several pictures, a folder")->group(files);
  std::string overlays;
  for (const exposure::OverlayRow& row : exposure::kOverlays)
    overlays += (overlays.empty() ? "" : "; ") + std::string(row.name) + ": " + std::string(row.text);
  app->add_option("--overlay", r->overlay, "Of --out. " + overlays)->capture_default_str()->group(files);
  app->add_option("--page", r->page, "A page that shows why, .html")->group(files);
  app->footer(kFooter);
  app->callback([r, &exit_code] {
    if (r->inputs.empty() && !r->lists) throw CLI::RequiredError("INPUT");
    exit_code = run(*r);
  });
}

}  // namespace likeness::expose
