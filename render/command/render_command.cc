#include "render/command/command.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <system_error>

#include <CLI/CLI.hpp>
#include <tbb/global_control.h>

#include "render/command/camera_choice.h"
#include "render/command/integrators.h"
#include "render/command/request.h"
#include "render/command/scene_digest.h"
#include "render/command/summary.h"
#include "render/exposure/overlay.h"
#include "render/exposure/pick.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/image/write.h"
#include "render/plan/plan.h"
#include "render/runtime/quality.h"
#include "render/scene/read_scene.h"
#include "render/view/view.h"
#include "render/view/view_list.h"

namespace likeness::render_command {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void tell_repairs(const scene::Scene& scene) {
  for (const scene::Repair& repair : scene.repairs)
    std::cerr << "put right: " << repair.where << ": " << repair.what << " (" << repair.count << ")\n";
}

// Before any work: whatever cannot be written afterwards. Leaves nothing but the folder.
void check_writable(const Paths& paths) {
  for (const fs::path* file : {&paths.picture, &paths.png, &paths.preview})
    if (!file->empty()) files::WholeFile probe(*file);
}

// What is written must not be the scene that is read.
void check_apart(const Request& request, const Paths& paths) {
  for (const fs::path* file : {&paths.picture, &paths.png, &paths.preview, &paths.state}) {
    std::error_code ignored;
    if (!file->empty() && fs::equivalent(*file, request.scene, ignored))
      throw files::UsageError("output " + files::in_quotes(file->string()) +
                              " is the scene itself; choose another name");
  }
}

image::Picture picture_of(const image::Layers& layers) {
  image::Picture out;
  out.width = layers.width, out.height = layers.height;
  out.rgb = layers.find("")->data;
  return out;
}

// The exposure of a picture that a mode picks; 0 where no pixel has light.
double picked_ev(exposure::Mode mode, const image::Picture& light, const scene::View& view) {
  exposure::Histogram histogram;
  histogram.add(light);
  const exposure::Meter meter(histogram, exposure::curve_of(view));
  const auto pick = mode == exposure::Mode::kLinear    ? exposure::pick_linear(meter)
                    : mode == exposure::Mode::kAverage ? exposure::pick_average(meter)
                                                       : exposure::pick_percentile(meter, 0.99, exposure::white_zone());
  return pick ? pick->ev : 0;
}

std::string full_key(const Request& request, const scene::Scene& scene, const reference::Options& options,
                     bool is_forced) {
  return reference::key_of(options, digest_of(scene, options.camera)) + " integrator " + request.integrator +
         (is_forced ? " forced" : "");
}

int run(const Request& request) {
  if (request.lists_views) {
    std::cout << view::list_text(request.config.value_or(""));
    return 0;
  }
  const auto start = Clock::now();
  const exposure::Overlay overlay = exposure::overlay_named("--overlay", request.overlay);
  const std::optional<exposure::Mode> mode = exposure_of(request);
  reference::Options options = options_of(request);
  const Integrator& integrator = integrator_of(request);
  const bool force = is_forced(request.force);
  const Paths paths = paths_of(request);
  if (!request.size.empty()) size_of(request.size);
  if (request.resumes && !integrator.can_resume)
    throw files::UsageError("--resume: --integrator " + request.integrator + " makes its picture in one go");
  runtime::Settings settings;
  if (!request.quality.empty()) {
    if (request.integrator != "runtime")
      throw files::UsageError("--quality is of the run-time pipeline; --integrator " + request.integrator +
                              " has no use for it");
    settings = runtime::read_quality(request.quality);
  }
  settings.seed = options.seed;
  files::catch_interrupts();
  std::optional<tbb::global_control> as_many;
  if (options.threads > 0)
    as_many.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));

  scene::Scene scene = scene::read_scene(request.scene);
  options.camera = camera_of(scene, request.camera);
  apply(request, scene, options.camera);
  check_memory(scene.cameras[options.camera], options.has_layers, request.has_light_layers ? scene.lights.size() : 0,
               memory_of_machine());
  const view::Shower shower(scene.view);
  check_apart(request, paths);
  check_writable(paths);
  tell_repairs(scene);

  const plan::Plan plan = plan::plan_of(scene, options.camera, force);
  const world::World world(scene, plan);
  Job job{world, options, request.has_light_layers, settings, {}, {}, {}};
  std::error_code ignored;
  if (fs::exists(paths.state, ignored) && integrator.can_resume) {
    if (request.resumes) job.state = paths.state, job.key = full_key(request, scene, options, force);
    else
      std::cerr << paths.state.string() << " is left of an interrupted render; --resume would go on from it. "
                << "This one begins anew\n";
  } else if (request.resumes) {
    std::cerr << paths.state.string() << " is not there: nothing to resume, the render begins anew\n";
  }
  if (!paths.preview.empty())
    job.preview = [&](const image::Picture& picture) { image::write_png(paths.preview, shower.show(picture)); };

  Times times;
  const double cpu_before = cpu_seconds();
  const auto began = Clock::now();
  Rendered rendered = integrator.render(job);
  times.seconds = seconds_since(began), times.cpu_seconds = cpu_seconds() - cpu_before;

  if (rendered.is_interrupted && rendered.samples == 0 && rendered.samples_before == 0 && !rendered.state) {
    std::cerr << "likeness render: interrupted before there was a picture; nothing is written\n";
    return 130;
  }
  if (rendered.is_interrupted && rendered.state) {
    image::write_layers(paths.state, rendered.state(full_key(request, scene, options, force)));
    rendered.state = nullptr;  // gives back the film
  }
  const std::string metadata =
      metadata_of(fs::path(request.scene).filename().string(), scene, plan, options, request.integrator, rendered);
  rendered.layers.metadata = metadata;
  image::write_layers(paths.picture, rendered.layers);
  if (!rendered.is_interrupted) fs::remove(paths.state, ignored);
  if (!paths.png.empty()) {
    const image::Picture light = picture_of(rendered.layers);
    if (mode) scene.view.ev = picked_ev(*mode, light, scene.view);
    image::write_png(paths.png, exposure::picture_with(overlay, light, scene.view));
  }
  times.seconds_all = seconds_since(start), times.cpu_seconds_all = cpu_seconds();

  std::cout << (request.json ? summary_json(metadata, scene.view, paths, rendered, times)
                             : summary_text(scene, options, paths, rendered, times));
  if (!rendered.is_interrupted) return 0;
  std::cerr << "likeness render: interrupted; " << paths.state.string()
            << " holds what is needed to go on: the same command with --resume\n";
  return 130;
}

constexpr auto kFooter = R"(Examples
  likeness render room.json                              room.exr (linear light) and room.png, 64 samples a pixel
  likeness render room.json --spp 1 --size 320x180       a first look
  likeness render room.json --time 60 --preview now.png  one minute; now.png shows how far it is
  likeness render room.json --error 1e-3 --layers        until the noise is that small; with depth, normals, lobes ...
  likeness render head.glb --ev 1 --view gt              a mesh file alone, a stop brighter, tonemapped
  likeness render room.json --expose average --overlay zones  exposed for the curve, colored by zone
  likeness render room.json --quality game.json          as a game would, at the quality that likeness cost chose
  likeness render room.json --resume                     goes on after Ctrl-C; the picture is the same

Ctrl-C writes the picture as far as it is, and OUT.state.exr beside it. Files are whole or absent. The picture does not
depend on --threads, nor on interruptions, but on --seed.

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 4 the pictures cannot be written, 130 interrupted.
Manual: docs/render.md)";

}  // namespace

void add_render(CLI::App& program, int& exit_code) {
  const auto r = std::make_shared<Request>();
  CLI::App* app = program.add_subcommand("render", "Make a picture of a scene, by following light");
  app->add_option("SCENE", r->scene, "scene.json, or a mesh file alone: .glb, .gltf, .obj, .ply");

  const std::string files = "Files";
  app->add_option("--out", r->out, "The picture as linear light, .exr (default: the scene's name, in this folder)")
      ->group(files);
  app->add_option("--png", r->png, "The picture as a screen shows it, .png (default: beside the EXR)")->group(files);
  app->add_flag("--no-png", r->no_png, "Without it")->group(files);
  app->add_option("--preview", r->preview, "A .png that is rewritten every few seconds while the render runs")
      ->group(files);
  app->add_flag("--layers", r->has_layers,
                "In the EXR also depth, position, normals, UV, base color; emitted, direct, indirect, diffuse and "
                "specular light")
      ->group(files);
  app->add_flag("--light-layers", r->has_light_layers,
                "In the EXR also, for each light, its visibility and what it would send if nothing hid it")
      ->group(files);
  app->add_flag("--json", r->json, "Print numbers about the render as JSON")->group(files);

  const std::string seen = "What is seen";
  app->add_option("--camera", r->camera, "Name of a camera of the scene, or its number from 0 (default 0)")
      ->group(seen);
  app->add_option("--size", r->size,
                  "WIDTHxHEIGHT in pixels, instead of the camera's; the vertical field of view stays")
      ->group(seen);

  const std::string quality = "How exact, how long: the first that is reached ends it";
  app->add_option("--spp", r->samples, "Samples a pixel, at most (default 64; with --time or --error 65536)")
      ->group(quality);
  app->add_option("--time", r->seconds, "Seconds of rendering")->group(quality);
  app->add_option("--error", r->relative_error, "Expected relative mean squared error (relMSE) from noise")
      ->group(quality);
  app->add_flag("--resume", r->resumes, "Go on from the state that an interrupted render left beside its picture")
      ->group(quality);

  const std::string how = "How it is made";
  std::string names;
  for (const Integrator& row : integrators())
    names += (names.empty() ? "" : "; ") + std::string(row.name) + ": " + std::string(row.text);
  app->add_option("--integrator", r->integrator, names)->capture_default_str()->group(how);
  app->add_option("--quality", r->quality,
                  "A file of likeness cost --quality: the picture by the run-time pipeline with these settings")
      ->group(how);
  app->add_option("--bounces", r->bounces, "Of light between camera and source, at most; 1: direct light only")
      ->capture_default_str()
      ->group(how);
  app->add_option("--seed", r->seed, "Of the noise")->capture_default_str()->group(how);
  app->add_option("--threads", r->threads, "0: one a core. The picture does not depend on it")
      ->capture_default_str()
      ->group(how);
  app->add_option("--force", r->force,
                  "all: work on every effect, needed or not; the picture is the same, the time is not")
      ->group(how);

  const std::string shown = "How the PNG shows it, instead of what the scene says";
  app->add_option("--ev", r->ev, "Exposure [stops]")->group(shown);
  app->add_option("--view", r->view, "srgb, gt, khronos, agx, aces, or a view of the OpenColorIO config")->group(shown);
  app->add_option("--display", r->display, "A display of the config")->group(shown);
  app->add_option("--ocio", r->config, "An OpenColorIO config (default: the scene's, else $OCIO)")->group(shown);
  app->add_flag("--list-views", r->lists_views, "Print every display and view, and end")->group(shown);
  app->add_option("--expose", r->expose,
                  "linear, average or percentile: the PNG at the exposure that likeness expose picks (docs/expose.md)")
      ->group(shown);
  std::string overlays;
  for (const exposure::OverlayRow& row : exposure::kOverlays)
    overlays += (overlays.empty() ? "" : "; ") + std::string(row.name) + ": " + std::string(row.text);
  app->add_option("--overlay", r->overlay, "Of the PNG. " + overlays)->capture_default_str()->group(shown);
  app->footer(kFooter);
  app->callback([r, app, &exit_code] {
    if (r->scene.empty() && !r->lists_views) throw CLI::RequiredError("SCENE");
    if (!r->quality.empty() && app->count("--integrator") == 0) r->integrator = "runtime";
    if (r->integrator == "runtime")
      for (const char* stranger :
           {"--spp", "--time", "--error", "--bounces", "--layers", "--light-layers", "--preview"})
        if (app->count(stranger) > 0)
          throw files::UsageError(std::string(stranger) +
                                  " is of the path tracer; with --integrator runtime a --quality " +
                                  "file says how good the picture is (docs/scene_cost.md)");
    exit_code = run(*r);
  });
}

}  // namespace likeness::render_command
