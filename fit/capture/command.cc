#include "fit/capture/command.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "fit/capture/report.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/image/write.h"
#include "render/material/material_file.h"

namespace likeness::capture_fit {
namespace {

using files::UsageError;

struct CommandOptions {
  std::string capture, camera, normals, out;
  double seed = 1, megabytes = 1024;
  bool is_registered = false, json = false;
};

constexpr double kMostSeed = 4294967295.0, kLeastMegabytes = 1, kMostMegabytes = 1 << 20;

std::size_t camera_of(const capture::Capture& capture, const std::string& id) {
  std::vector<std::string_view> ids;
  for (const capture::Camera& camera : capture.cameras) ids.push_back(camera.id);
  if (ids.empty()) throw files::InputError(capture.root.string() + ": has no camera");
  if (id.empty() && ids.size() == 1) return 0;
  std::string all;
  for (const std::string_view one : ids) all += (all.empty() ? "" : ", ") + std::string(one);
  if (id.empty()) throw UsageError("the capture has several cameras; name one by --camera (" + all + ")");
  const std::size_t at = capture::camera_of(capture, id);
  if (at != capture::kAbsent) return at;
  const std::string near = files::nearest_name(id, ids.data(), ids.size());
  throw UsageError("--camera " + files::in_quotes(id) + " is not in the capture" +
                   (near.empty() ? "" : "; did you mean " + near + "?") + " (" + all + ")");
}

Options options_of(const CommandOptions& command) {
  Options out;
  if (!command.normals.empty()) {
    const auto at = std::ranges::find(kNormalSources, command.normals);
    if (at == kNormalSources.end())
      throw UsageError("--normals " + files::in_quotes(command.normals) + " is unknown (given, estimate)");
    out.normals = static_cast<NormalSource>(at - kNormalSources.begin());
  }
  if (!(command.seed >= 0 && command.seed <= kMostSeed && command.seed == std::floor(command.seed)))
    throw UsageError("--seed = " + files::number_text(command.seed) + " is not a whole number from 0 to 4294967295");
  out.seed = static_cast<std::uint64_t>(command.seed);
  if (!(command.megabytes >= kLeastMegabytes && command.megabytes <= kMostMegabytes))
    throw UsageError("--memory-mb = " + files::number_text(command.megabytes) + " is outside [1, 1048576]");
  out.bytes = static_cast<std::size_t>(command.megabytes * (1 << 20));
  return out;
}

// Three lights that differ: from the left, most frontal, from the right of the picture.
std::vector<std::size_t> lights_to_show(const capture::Capture& capture, const Fit& fit) {
  const capture::FrameTable frames(capture);
  const glm::dmat3 turn(capture.cameras[fit.camera].world_from_camera);
  std::vector<std::pair<double, std::size_t>> across;
  for (std::size_t light = 0; light < capture.lights.size(); ++light) {
    if (frames.frame(fit.camera, light) == capture::kAbsent || !capture::has_place(capture.lights[light])) continue;
    const glm::dvec3 to = capture::shine_of(capture.lights[light], glm::dvec3(0)).to_light;
    across.emplace_back(glm::dot(to, turn[0]), light);
  }
  std::sort(across.begin(), across.end());
  std::vector<std::size_t> out;
  for (const std::size_t at : {std::size_t{0}, across.size() / 2, across.size() - 1})
    if (std::ranges::find(out, across[at].second) == out.end()) out.push_back(across[at].second);
  return out;
}

std::string command_line(const CommandOptions& o, const Fit& fit, const capture::Capture& capture) {
  return "likeness fit capture " + o.capture + " --camera " + capture.cameras[fit.camera].id + " --normals " +
         std::string(kNormalSources[static_cast<std::size_t>(fit.normals_from)]) + " --seed " +
         files::number_text(o.seed) + (o.is_registered ? " --register" : "");
}

void write_results(const capture::Capture& capture, const Fit& fit, const CommandOptions& o, const Options& options,
                   const std::filesystem::path& out) {
  const Relighting relighting(capture, fit);
  const capture::FrameTable frames(capture);
  const std::vector<std::uint8_t> mask = capture::read_mask(capture, fit.camera);
  std::vector<Shown> shown;
  for (const std::size_t light : lights_to_show(capture, fit)) {
    Shown s{light, capture::read_photo(capture, frames.frame(fit.camera, light)).light, relighting.render(light)};
    for (std::size_t k = 0; k < s.photo.rgb.size(); ++k)
      if (mask[k / 3] == 0) s.photo.rgb[k] = 0;
    shown.push_back(std::move(s));
  }
  const Asked asked{o.capture, command_line(o, fit, capture), options};
  image::write_exr(out / "normal.exr", fit.normals);
  image::write_exr(out / "base_color.exr", fit.base_colors);
  image::write_exr(out / "confidence.exr", fit.confidence);
  material::write_material(out / "material.json", {capture.name, fit.material});
  files::write_whole(out / "report.html", report_html(capture, fit, shown, asked));
  files::write_whole(out / "fit.json", fit_json(capture, fit, asked));  // last: who finds it finds the others
}

// Names the maps as layers of the camera, in the place of those it had.
void register_layers(capture::Capture& capture, std::size_t camera, const std::filesystem::path& out) {
  namespace fs = std::filesystem;
  const auto name = [&](capture::Layer layer, const char* file) {
    fs::path at = fs::absolute(out / file).lexically_normal();
    const fs::path below = at.lexically_relative(fs::absolute(capture.root).lexically_normal());
    if (!below.empty() && *below.begin() != "..") at = below;
    std::erase_if(capture.layers, [&](const capture::LayerFile& l) { return l.camera == camera && l.layer == layer; });
    capture.layers.push_back({camera, layer, at});
  };
  name(capture::Layer::kNormal, "normal.exr");
  name(capture::Layer::kAlbedo, "base_color.exr");
  capture::write_capture(capture);
}

void print(const capture::Capture& capture, const Fit& fit, const CommandOptions& o, const std::filesystem::path& out) {
  const Counts& c = fit.counts;
  std::cout << (capture.name.empty() ? o.capture : capture.name) << ", camera " << capture.cameras[fit.camera].id
            << ": " << c.pixels << " pixels under " << c.lights << " lights, normals "
            << kNormalSources[static_cast<std::size_t>(fit.normals_from)] << "\n  without a normal " << c.without_normal
            << ", without a color " << c.without_color << "; weighted RMS "
            << std::round(1000 * fit.residuals.callisto_rms) / 10 << " % of a pixel's level (Lambert "
            << std::round(1000 * fit.residuals.lambert_rms) / 10 << " %)\n";
  for (const fit::Estimate& e : fit.estimates)
    if (e.fitted && e.channel < 0)
      std::cout << "  " << e.name << " " << std::round(1e4 * e.value) / 1e4
                << (std::isfinite(e.sigma) ? " +- " + files::number_text(std::round(1e4 * e.sigma) / 1e4)
                                           : std::string(e.at_bound ? " (at its bound)" : ""))
                << "\n";
  for (const std::string& note : fit.notes) std::cout << "  Note: " << note << "\n";
  std::cout << "  report    " << (out / "report.html").string() << "\n  material  " << (out / "material.json").string()
            << "\n  numbers   " << (out / "fit.json").string() << "\n";
  if (o.is_registered) std::cout << "Next: likeness olat render " << o.capture << " --from-normals\n";
}

int run_capture(const CommandOptions& o) {
  const Options options = options_of(o);
  files::catch_interrupts();
  capture::Capture capture = capture::read_capture(o.capture);
  const std::size_t camera = camera_of(capture, o.camera);
  const std::filesystem::path out =
      o.out.empty() ? capture.root / "aux" / capture.cameras[camera].id / "fit" : std::filesystem::path(o.out);
  try {
    Fit fit;
    {
      files::Progress progress;
      fit = fit_capture(capture, camera, options, [&](double share, std::string_view what) {
        progress.tell(what, share);
        return !files::interrupted();
      });
    }
    write_results(capture, fit, o, options, out);
    if (o.is_registered) register_layers(capture, camera, out);
    if (o.json) std::cout << fit_json(capture, fit, {o.capture, command_line(o, fit, capture), options});
    else print(capture, fit, o, out);
  } catch (const files::Interrupted&) {
    std::cerr << "likeness fit capture: interrupted; nothing was written\n";
    return 130;
  }
  return 0;
}

constexpr auto kFooter =
    R"(Writes into --out, or aux/CAMERA/fit below the capture:
  normal.exr       unit vectors in the world, (0, 0, 0) where the photographs do not say
  base_color.exr   reflectance of the diffuse part, linear Rec. 709
  confidence.exr   red: share of the lights that agree; green: trust in the normal; blue: trust in the color
  material.json    the Callisto material that all pixels share, for `likeness olat render --from-normals --material`
  report.html      pictures, parameters with their uncertainty, what was seen and what was not
  fit.json         the same numbers for programs

Examples
  likeness olat import ../shared/data/captures/diligent-cat
  likeness fit capture diligent-cat.capture --normals estimate --out out/cat
  likeness fit capture photos.capture --register
  likeness olat render photos.capture --from-normals --material photos.capture/aux/camera/fit/material.json

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 130 interrupted.
Manual: docs/fit_capture.md)";

}  // namespace

void add_capture(CLI::App& fit, int& exit_code) {
  CLI::App* sub =
      fit.add_subcommand("capture", "Find normals, base colors and one material in photographs of a capture");
  const auto o = std::make_shared<CommandOptions>();
  sub->add_option("CAPTURE", o->capture, "Folder of the capture")->required();
  sub->add_option("--camera", o->camera, "Whose photographs, by id; needed where there are several");
  sub->add_option(
      "--normals", o->normals,
      "given (the layer of the capture) or estimate (from the photographs); default: given where there are");
  sub->add_option("--out", o->out, "Folder for what is written");
  sub->add_option("--seed", o->seed, "Of the pixels that the shared parameters are searched on (1)");
  sub->add_option("--memory-mb", o->megabytes, "Photographs held at a time; larger captures are read in bands (1024)");
  sub->add_flag("--register", o->is_registered, "Name the maps as layers normal and albedo in cameras.json");
  sub->add_flag("--json", o->json, "Print fit.json in the place of the summary");
  sub->footer(kFooter);
  sub->callback([o, &exit_code] { exit_code = run_capture(*o); });
}

}  // namespace likeness::capture_fit
