#include "olat/render/command.h"

#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "olat/render/from_normals.h"
#include "olat/render/from_scene.h"
#include "olat/render/pairs.h"
#include "render/capture/files_of_capture.h"
#include "render/command/scene_digest.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/json/section.h"
#include "render/material/material_file.h"
#include "render/scene/read_scene.h"

namespace likeness::olat_render {
namespace {

using files::UsageError;

struct RenderOptions {
  std::string capture, scene, material, variant, camera, light, integrator = "reference";
  bool from_normals = false, everything = false, json = false;
  double samples = 0, seed = 0, threads = 0;
};

double whole_within(const std::string& option, double value, double low, double high) {
  if (value >= low && value <= high && value == std::floor(value)) return value;
  throw UsageError(option + " = " + files::number_text(value) + " is not a whole number from " +
                   files::number_text(low) + " to " + files::number_text(high));
}

// The variant of that name; a new one is added to the capture.
const capture::Variant& variant_of(capture::Capture& capture, const std::string& id) {
  if (!capture::is_id(id))
    throw UsageError("--variant " + files::in_quotes(id) +
                     " cannot be a name; expected 1 to 120 bytes without / and \\");
  const std::size_t at = capture::variant_of(capture, id);
  if (at != capture::kAbsent) {
    if (capture.variants[at].pattern.find("{light}") == std::string::npos)
      throw UsageError("--variant " + files::in_quotes(id) + " is a picture that no light changes (" +
                       capture.variants[at].pattern + "); renders need another name");
    return capture.variants[at];
  }
  capture.variants.push_back({id, "renders/{variant}/{camera}/{light}.exr"});
  capture::write_capture(capture);
  return capture.variants.back();
}

// What the photographs of a camera were when its colors were fitted: names, sizes and times, encodings and places.
std::string digest_of_normals(const capture::Capture& capture, const RenderOptions& options, std::size_t camera) {
  const capture::CaptureTexts texts = capture::texts_of(capture);
  std::string text =
      "from normals 1\n" + capture.cameras[camera].id + "\n" + texts.cameras + texts.lights + texts.frames;
  const auto add = [&](const std::filesystem::path& file) {
    std::error_code error;
    text += file.string() + " " + std::to_string(std::filesystem::file_size(file, error)) + " " +
            std::to_string(std::filesystem::last_write_time(file, error).time_since_epoch().count()) + "\n";
  };
  for (const capture::Frame& frame : capture.frames)
    if (frame.camera == camera) add(photo_file(capture, frame));
  for (const capture::LayerFile& layer : capture.layers)
    if (layer.camera == camera) add(capture.root / layer.file);
  if (!options.material.empty()) text += files::read_whole(options.material, material::kLargestFile);
  return files::sha256(text);
}

Done render_normals(const RenderOptions& options, const capture::Capture& capture, const capture::Variant& variant,
                    const std::vector<Pair>& pairs) {
  std::optional<brdf::AnyBrdf> material;
  if (!options.material.empty()) material = material::read_material(options.material).brdf;
  std::vector<std::string> digests(capture.cameras.size());
  const auto digest_of = [&](const Pair& pair) {
    std::string& digest = digests[pair.camera];
    if (digest.empty()) digest = digest_of_normals(capture, options, pair.camera);
    return digest;
  };
  std::optional<NormalRenderer> renderer;
  std::size_t camera = capture::kAbsent;
  return make_pairs(capture, variant, pairs, digest_of, [&](const Pair& pair, const auto& goes_on) {
    if (camera != pair.camera) {
      renderer.emplace(capture, pair.camera, material, [&](double) {
        if (!goes_on(0)) throw files::Interrupted();
      });
      camera = pair.camera;
      const std::filesystem::path colors =
          capture.root / "aux" / capture.cameras[camera].id / (variant.id + "_color.exr");
      image::write_exr(colors, renderer->colors(), {{kCameraAttribute, capture.cameras[camera].id}});
    }
    return renderer->render(pair.light);
  });
}

Done render_scene(const RenderOptions& options, const capture::Capture& capture, const capture::Variant& variant,
                  const std::vector<Pair>& pairs) {
  SceneSettings settings;
  if (options.integrator == "runtime") settings.is_runtime = true;
  else if (options.integrator != "reference")
    throw UsageError("--integrator " + files::in_quotes(options.integrator) + " is unknown (reference, runtime)");
  const double usual = settings.is_runtime ? 1 : 64;
  settings.samples = static_cast<std::uint32_t>(
      whole_within("--spp", options.samples == 0 ? usual : options.samples, 1, settings.is_runtime ? 256 : 1 << 24));
  settings.seed = static_cast<std::uint32_t>(whole_within("--seed", options.seed, 0, 4294967295.0));
  settings.threads = static_cast<int>(whole_within("--threads", options.threads, 0, 1024));
  scene::Scene scene = scene::read_scene(options.scene);
  for (const scene::Repair& repair : scene.repairs)
    std::cerr << "put right: " << repair.where << ": " << repair.what << " (" << repair.count << ")\n";
  const std::string how = (settings.is_runtime ? "runtime " : "reference ") + std::to_string(settings.samples) + " " +
                          std::to_string(settings.seed);
  // All but camera and light is the same for every pair.
  scene.cameras.resize(1);
  scene.lights.clear();
  scene.environment.reset();
  std::vector<std::string> by_camera(capture.cameras.size());
  const auto digest_of = [&](const Pair& pair) {
    scene.cameras = {camera_of(capture.cameras[pair.camera])};
    std::string& whole = by_camera[pair.camera];
    if (whole.empty()) whole = render_command::digest_of(scene, 0);
    scene::Scene lit;
    lit.cameras = scene.cameras;
    lit.lights = {light_of(capture.lights[pair.light])};
    return files::sha256("scene 1\n" + how + "\n" + whole + "\n" + render_command::digest_of(lit, 0));
  };
  const SceneRenderer renderer(scene, settings);
  return make_pairs(capture, variant, pairs, digest_of, [&](const Pair& pair, const auto& goes_on) {
    return renderer.render(capture, pair.camera, pair.light, goes_on);
  });
}

int run(const RenderOptions& options) {
  if (options.from_normals == !options.scene.empty())
    throw UsageError(
        "say what is rendered: either --scene scene.json, or --from-normals for a capture that has normals");
  if (!options.material.empty() && !options.from_normals)
    throw UsageError("--material is for --from-normals; a scene has its own materials");
  if (options.from_normals && options.everything)
    throw UsageError("--all is for --scene: without photographs there is nothing that --from-normals could fit");
  files::catch_interrupts();
  capture::Capture capture = capture::read_capture(options.capture);
  const std::vector<Pair> pairs = pairs_of(capture, options.camera, options.light, options.everything);
  if (pairs.empty())
    throw UsageError("no pair of a camera and a light has a photograph; --all renders pairs without one");
  const std::string name = !options.variant.empty() ? options.variant : options.from_normals ? "normals" : "render";
  const capture::Variant variant = variant_of(capture, name);
  const Done done = options.from_normals ? render_normals(options, capture, variant, pairs)
                                         : render_scene(options, capture, variant, pairs);
  if (options.json)
    std::cout << "{\"variant\": " << json::in_json(variant.id) << ", \"made\": " << done.made
              << ", \"kept\": " << done.kept << ", \"of\": " << pairs.size()
              << ", \"interrupted\": " << (done.is_interrupted ? "true" : "false") << "}\n";
  else
    std::cout << (capture.root / "renders" / variant.id).string() << ": " << done.made << " made, " << done.kept
              << " were there, of " << pairs.size() << '\n';
  if (!done.is_interrupted) {
    if (!options.json) std::cout << "Next: likeness olat view " << options.capture << '\n';
    return 0;
  }
  std::cerr << "likeness olat render: interrupted; the same command goes on\n";
  return 130;
}

constexpr auto kFooter =
    R"(Camera and light are those of the capture. A distant light has an irradiance of 1 on what faces it, a near one 1 W/sr:
the unit of photographs that were divided by the intensity of their light. Renders are
renders/VARIANT/CAMERA/LIGHT.exr below the capture, linear Rec. 709, with olat:camera, olat:light, olat:variant and
olat:digest in their headers. A file that is whole and has the digest of the same scene and settings is kept, so the same
command goes on after Ctrl-C and renders anew only what has changed.

--from-normals needs no scene: each pixel gets the color that explains its photographs best under the normals of the
layer. It has no cast shadows and no light from other surfaces, which the comparison then shows.

Examples
  likeness olat render diligent-cat.capture --from-normals
  likeness olat render head.capture --scene head.json --spp 256 --variant reference
  likeness olat render head.capture --scene head.json --integrator runtime --variant game
  likeness olat render head.capture --scene head.json --camera front --light l07

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 130 interrupted.
Manual: docs/olat_render.md)";

}  // namespace

void add_render(CLI::App& olat, int& exit_code) {
  CLI::App* sub = olat.add_subcommand("render", "Render every pair of a camera and a light of a capture");
  auto options = std::make_shared<RenderOptions>();
  sub->add_option("CAPTURE", options->capture, "Folder of the capture")->required();
  sub->add_option("--scene", options->scene, "scene.json or a mesh file; its lights and cameras are not used");
  sub->add_flag("--from-normals", options->from_normals,
                "Render the layer of normals with colors fitted to the photographs");
  sub->add_option("--material", options->material, "With --from-normals: a material file in the place of Lambert");
  sub->add_option("--variant", options->variant, "Name of the set of renders (render, or normals)");
  sub->add_option("--camera", options->camera, "Only this camera, by id");
  sub->add_option("--light", options->light, "Only this light, by id");
  sub->add_flag("--all", options->everything, "Pairs without a photograph too");
  sub->add_option("--integrator", options->integrator, "reference (path tracer) or runtime (as a game would)");
  sub->add_option("--spp", options->samples, "Samples a pixel (64; runtime 1)");
  sub->add_option("--seed", options->seed, "Of the samples (0)");
  sub->add_option("--threads", options->threads, "0: one a core");
  sub->add_flag("--json", options->json, "Print one JSON object in the place of the summary");
  sub->footer(kFooter);
  sub->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace likeness::olat_render
