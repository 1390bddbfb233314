#include "realis/bake_command.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "realis/bake_file.h"
#include "realis/from_capture.h"
#include "realis/inputs.h"
#include "realis/layers.h"
#include "realis/named.h"
#include "realis/noticed.h"
#include "realis/summary.h"
#include "realis/surface_maps.h"
#include "realis/terminator.h"
#include "realis/texture/picture_planes.h"
#include "realis/texture/texture_bake.h"
#include "realis/texture/unwrap.h"
#include "realis/weigh.h"
#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/image/write.h"
#include "render/scene/read_scene.h"

namespace likeness::realis {
namespace {

using files::UsageError;

struct BakeRequest {
  std::string capture, camera, variant, lobes = "auto", name = "bake", out, result = "realis";
  std::string scene, object;
  int dominant = 0, mixes = 0, bits = 8, resolution = TextureBakeOptions{}.resolution;
  bool is_rgb = false, is_exact = false, is_float = false, has_layers = false, is_json = false;
  double floor = 0.4, seed = 1;
  std::vector<std::string> only, with, without;  // weights
  weight::Settings weights;
};

constexpr const char* kMakesOne =
    "`likeness olat render --variant NAME` makes one, and without --variant the renders are made here, from the "
    "photographs";

BakeOptions options_of(const BakeRequest& request) {
  BakeOptions options;
  options.channels = request.is_rgb ? Channels::kRgb : Channels::kLuminance;
  options.is_exact = request.is_exact;
  options.floor = request.floor;
  options.seed = static_cast<std::uint64_t>(request.seed);
  options.dominant = static_cast<std::size_t>(request.dominant);
  if (request.lobes != "auto") {
    char* end = nullptr;
    const double value = std::strtod(request.lobes.c_str(), &end);
    if (*end != 0 || !(value >= 1 && value <= kMostLobes) || value != std::floor(value))
      throw UsageError("--lobes " + files::in_quotes(request.lobes) + " is not `auto` or a whole number from 1 to " +
                       std::to_string(kMostLobes));
    options.lobes = static_cast<std::size_t>(value);
  }
  options.mixes = static_cast<std::size_t>(request.mixes);
  options.bits = request.bits == 4 ? baked::Bits::kFour : baked::Bits::kEight;
  if (options.mixes > 0 &&
      (request.lobes != "auto" || request.dominant > 0 || request.is_exact || !request.scene.empty()))
    throw UsageError(
        "--mixes makes its own functions of lobes, in a picture; leave --lobes, --dominant, --exact and --scene out");
  if (options.bits == baked::Bits::kFour && options.mixes == 0) throw UsageError("--bits 4 is of mixes; add --mixes 8");
  if (!(options.floor > 0 && options.floor <= 1))
    throw UsageError("--floor = " + files::number_text(options.floor) + " is outside (0, 1]");
  return options;
}

double square(double x) { return x * x; }

// Root mean square of photo - (render + residual) over samples that can be trusted, and of photo - render.
std::pair<double, double> errors_of(const Subject& s, const baked::Bake& bake) {
  double plain = 0, baked = 0;
  std::size_t count = 0;
  std::vector<Residual> residuals;
  for (const glm::dvec3& direction : s.to_lights) residuals.emplace_back(bake, direction);
  for (std::size_t texel = 0; texel < s.texels(); ++texel)
    for (std::size_t i = 0; i < s.lights.size(); ++i) {
      const std::size_t at = s.samples_of(texel) + i;
      if (!(s.weight[at] > 0)) continue;
      const auto e = residuals[i].at(texel, static_cast<double>(s.cosine[at]));
      for (std::size_t c = 0; c < 3; ++c) {
        const double difference = static_cast<double>(s.photo[at][c]) - static_cast<double>(s.render[at][c]);
        plain += difference * difference, baked += square(difference - s.irradiance_of(i) * e[c]);
      }
      count += 3;
    }
  const auto n = static_cast<double>(std::max<std::size_t>(count, 1));
  return {std::sqrt(plain / n), std::sqrt(baked / n)};
}

// Render + residual of every light, as a variant of the capture that the comparison tool shows.
void write_results(capture::Capture& capture, const Subject& subject, const baked::Bake& bake, const std::string& id) {
  if (capture::variant_of(capture, id) == capture::kAbsent) {
    capture.variants.push_back({id, "renders/{variant}/{camera}/{light}.exr"});
    capture::write_capture(capture);
  }
  const capture::Variant& variant = capture.variants[capture::variant_of(capture, id)];
  for (std::size_t i = 0; i < subject.lights.size(); ++i) {
    if (files::interrupted()) throw files::Interrupted();
    const Residual residual(bake, subject.to_lights[i]);
    image::Picture picture(subject.width, subject.height);
    for (std::size_t texel = 0; texel < subject.texels(); ++texel) {
      const std::size_t at = subject.samples_of(texel) + i;
      const auto e = residual.at(texel, static_cast<double>(subject.cosine[at]));
      for (std::size_t c = 0; c < 3; ++c)
        picture.rgb[3 * std::size_t{subject.pixels[texel]} + c] =
            static_cast<float>(std::max(static_cast<double>(subject.render[at][c]) + subject.irradiance_of(i) * e[c],
                                        static_cast<double>(subject.least_of(texel, i, c))));
    }
    image::write_exr(capture::render_file(capture, variant, subject.camera, subject.lights[i]), picture);
  }
}

std::filesystem::path folder_of(const BakeRequest& request, const capture::Capture& capture) {
  return request.out.empty() ? capture.root / "realis" / request.name : std::filesystem::path(request.out);
}

// The mesh of a scene, from all cameras.
Summary bake_mesh(const BakeRequest& request, const BakeOptions& options, const weight::Choice& choice,
                  const capture::Capture& capture, const GoesOn& goes_on) {
  if (request.has_layers) throw UsageError("--layers are of a camera's picture; without --scene they can be looked at");
  TextureBakeOptions texture;
  // What was asked for is refused, and what is on by default left out.
  for (const auto* names : {&request.only, &request.with})
    for (const std::string& name : *names)
      if (weight::weight_named(name) != weight::kNoWeight) {
        weight::Choice asked;
        asked.is_on.fill(false), asked.is_on[weight::weight_named(name)] = true;
        must_stream(asked);
      }
  std::vector<std::string> left_out;
  texture.weights = streamed(choice, left_out);
  texture.bake = options, texture.object = request.object;
  texture.resolution = request.resolution, texture.is_float = request.is_float, texture.scene_file = request.scene;
  if (!request.camera.empty()) texture.cameras = {camera_named(capture, request.camera)};
  const std::string variant = request.variant.empty() ? "render" : request.variant;
  texture.variant = variant_named(capture, variant,
                                  "`likeness olat render " + request.capture + " --scene " + request.scene +
                                      (request.variant.empty() ? "" : " --variant " + variant) + "` makes it");
  const scene::Scene scene = scene::read_scene(request.scene);
  texture.inputs = {{request.scene, files::sha256(files::read_whole(request.scene, std::size_t{1} << 32))}};
  const std::filesystem::path folder = folder_of(request, capture);
  const TextureBake made = bake_texture(capture, scene, texture, folder, goes_on);
  Summary out;
  out.space = baked::Space::kTexture, out.file = folder / "bake.json";
  out.texels = made.texels, out.lights = made.lights, out.cameras = made.cameras;
  out.lobes = made.bake.basis.lobes.size();
  out.bytes_of_texel = (request.is_float ? 4 : 1) * bytes_of_texel(made.bake);
  out.plain_rms = made.plain_rms, out.left_rms = made.left_rms;
  out.ladder = made.ladder, out.chosen = made.chosen;
  out.reading_s = made.reading_s, out.baking_s = made.solving_s, out.work_bytes = made.work_bytes;
  out.noticed = noticed(made.census);
  std::string names;
  for (const std::string& name : left_out) names += (names.empty() ? "" : ", ") + name;
  if (!names.empty())
    out.noticed.push_back("weights that need all pictures of a camera at once are not taken for a mesh: " + names);
  return out;
}

// A camera's picture.
Summary bake_picture(const BakeRequest& request, const BakeOptions& options, const weight::Choice& choice,
                     capture::Capture& capture, const GoesOn& goes_on, bool& is_written) {
  if (!request.object.empty()) throw UsageError("--object is an instance of a scene; --scene names its file");
  const std::size_t camera = camera_named(capture, request.camera);
  const auto begin = std::chrono::steady_clock::now();
  std::optional<capture_fit::Fit> fit;
  std::optional<std::size_t> variant;
  if (request.variant.empty()) fit = thin(capture_fit::fit_capture(capture, camera, {}, goes_on));
  else variant = variant_named(capture, request.variant, kMakesOne);
  const Renderer renderer = fit ? renders_of_fit(capture, *fit) : renders_of_variant(capture, camera, *variant);
  Subject subject = read_subject(capture, camera, renderer, {}, goes_on);
  if (fit && !options.is_exact) {
    face(subject, *fit);
    const Terminator terminator = terminator_of(subject);
    soften(subject, terminator);
    fit->spread = terminator.spread, fit->least = terminator.least;
  }
  const std::vector<weight::Layer> layers =
      weigh(capture, fit ? fit->normals : image::Picture(), choice, request.has_layers, subject);
  Inputs inputs = inputs_of_capture(capture, std::span(&camera, 1));
  const Inputs pictures = inputs_of_pictures(capture, camera, subject.lights, variant);
  inputs.insert(inputs.end(), pictures.begin(), pictures.end());
  const auto read = std::chrono::steady_clock::now();
  const Bake made = bake(subject, options, goes_on);
  StoredBake stored{made, {}, subject.width, subject.height, subject.pixels};
  const auto baked = std::chrono::steady_clock::now();
  const auto seconds = [](auto a, auto b) { return std::chrono::duration<double>(b - a).count(); };
  const baked::Bake seen = request.is_float ? stored.bake : quantised(stored.bake);
  const auto [plain, left] = errors_of(subject, seen);
  stored.about = {capture.name, capture.cameras[camera].id, inputs, {{"render_rms", plain}, {"realis_rms", left}}};
  if (!made.ladder.empty()) stored.about.metrics.emplace_back("held_out_rms", made.ladder[made.chosen].held_out);
  const std::filesystem::path folder = folder_of(request, capture);
  write_bake(folder, stored, request.is_float);
  if (fit) write_surface(folder, *fit);
  is_written = true;
  // The first variant is what others take if none is named: layers come last.
  if (!request.result.empty()) write_results(capture, subject, seen, request.result);
  if (request.has_layers) write_layers(capture, subject, seen, layers, std::filesystem::path("realis") / request.name);

  Summary out;
  out.file = folder / "bake.json";
  out.texels = subject.texels(), out.lights = subject.lights.size(), out.cameras = 1;
  out.lobes = seen.basis.size(), out.bytes_of_texel = (request.is_float ? 4 : 1) * bytes_of_texel(seen);
  out.plain_rms = plain, out.left_rms = left, out.ladder = made.ladder, out.chosen = made.chosen;
  out.reading_s = seconds(begin, read), out.baking_s = seconds(read, baked);
  Census census = census_of(subject, capture);
  census.lobes = out.lobes, census.is_free = options.is_exact, census.plain_rms = plain;
  out.noticed = noticed(census);
  return out;
}

int run_bake(const BakeRequest& request) {
  files::catch_interrupts();
  const BakeOptions options = options_of(request);
  weight::Choice choice = weight::choice_of(request.only, request.with, request.without, request.weights);
  if (options.is_exact) choice.is_on.fill(false);  // photographs come back, whatever is wrong with them
  capture::Capture capture = capture::read_capture(request.capture);
  if (!capture::is_id(request.name)) throw UsageError("--name " + files::in_quotes(request.name) + " cannot be a name");
  Summary summary;
  bool is_written = false;  // the bake; its pictures follow
  try {
    files::Progress progress;
    const auto goes_on = [&](double share, std::string_view what) {
      progress.tell(what, share);
      return !files::interrupted();
    };
    summary = request.scene.empty() ? bake_picture(request, options, choice, capture, goes_on, is_written)
                                    : bake_mesh(request, options, choice, capture, goes_on);
  } catch (const files::Interrupted&) {
    std::cerr
        << "likeness realis bake: interrupted"
        << (!request.scene.empty() ? "; the same command goes on with the lights and tiles that are finished\n"
            : is_written
                ? "; the bake is written, its pictures in renders/ are not all there: the same command makes them\n"
                : "; nothing was written\n");
    return 130;
  }
  std::cout << (request.is_json ? json_of(summary) : text_of(summary));
  return 0;
}

}  // namespace

void add_bake(CLI::App& realis, int& exit_code) {
  CLI::App* bake = realis.add_subcommand("bake", "Bake the difference of photographs and renders of a capture");
  auto request = std::make_shared<BakeRequest>();
  bake->add_option("CAPTURE", request->capture, "folder with capture.json (likeness olat import)")->required();
  bake->add_option("--camera", request->camera,
                   "whose picture is the texture; default: the first. With --scene: only that one");
  bake->add_option("--variant", request->variant,
                   "renders that are there (likeness olat render), instead of those of a fit of the photographs. "
                   "With --scene: `render` if none is named");
  bake->add_option("--scene", request->scene,
                   "scene.json or a mesh file: bake in the texture of a mesh, from all cameras of the capture")
      ->group("Mesh");
  bake->add_option("--object", request->object, "instance that is baked, if the scene has several")->group("Mesh");
  bake->add_option("--resolution", request->resolution, "texels a side")
      ->check(CLI::Range(1, kMostResolution))
      ->capture_default_str()
      ->group("Mesh");
  bake->add_option("--lobes", request->lobes, "auto (by held-out lights), or how many")->capture_default_str();
  bake->add_option("--mixes", request->mixes,
                   "keep coefficients of this many mixes of lobes, those that explain most; 0: of lobes")
      ->check(CLI::Range(0, static_cast<int>(kMostLobes)))
      ->capture_default_str();
  bake->add_option("--bits", request->bits, "of a coefficient of a mix: 8 or 4")
      ->check(CLI::IsMember({8, 4}))
      ->capture_default_str();
  bake->add_option("--dominant", request->dominant, "lobes that a texel keeps; 0: all")
      ->check(CLI::Range(0, static_cast<int>(kMostLobes)))
      ->capture_default_str();
  bake->add_flag("--rgb", request->is_rgb, "a residual of each color instead of luminance: three times the bytes");
  bake->add_flag("--exact", request->is_exact, "as many lobes as lights and nothing kept small: photographs come back");
  bake->add_flag("--float", request->is_float, "coefficients as floats instead of 8 bits");
  bake->add_option("--floor", request->floor, "least cosine that a residual is divided by")->capture_default_str();
  bake->add_option("--seed", request->seed, "of the texels by which lobes are chosen")->capture_default_str();
  bake->add_option("--name", request->name, "of the bake: CAPTURE/realis/NAME")->capture_default_str();
  bake->add_option("--out", request->out, "folder of the bake instead");
  bake->add_option("--result", request->result, "variant that render + realis is written to; empty: none")
      ->capture_default_str();
  bake->add_flag("--json", request->is_json, "print one JSON object in the place of the summary");
  std::string weights;
  for (const weight::Row& row : weight::kWeights) {
    weights += "\n  " + std::string(row.name) + std::string(10 - row.name.size(), ' ') +
               (row.is_default ? "on   " : "off  ") + std::string(row.text);
    for (const weight::SettingRow& setting : row.settings)
      if (!setting.name.empty())
        bake->add_option("--" + std::string(setting.name), setting.value(request->weights), std::string(setting.text))
            ->capture_default_str()
            ->group("Weights");
  }
  bake->add_option("--without", request->without, "weight that is left out; may be repeated")
      ->allow_extra_args(false)
      ->group("Weights");
  bake->add_option("--with", request->with, "weight that is off by default; may be repeated")
      ->allow_extra_args(false)
      ->group("Weights");
  bake->add_option("--only", request->only, "weight, of all the only one; may be repeated")
      ->allow_extra_args(false)
      ->group("Weights");
  bake->add_flag("--layers", request->has_layers,
                 "raw error, demodulated error, each weight and coefficient as variants, for likeness olat view");
  bake->footer("Weights of samples, and whether they are on" + weights + "\n\n" + R"(Examples
  likeness realis bake capture                      fit the photographs, bake what the fit lacks: CAPTURE/realis/bake
  likeness olat view capture                        photographs beside render + realis
  likeness realis bake head --variant path_traced   what the renders of a scene lack
  likeness realis bake capture --layers            what it was made of, to look at: docs/realis_weights.md
  likeness olat render head --scene head.json && likeness realis bake head --scene head.json --resolution 2048
                                                    a mesh, in its texture, from all cameras

With --scene, finished lights and tiles lie in BAKE/work until the bake is whole: Ctrl-C loses none of them, and the
same command goes on.

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 4 the program failed, 130 interrupted.
Manual: docs/realis.md)");
  bake->callback([request, &exit_code] { exit_code = run_bake(*request); });
}

}  // namespace likeness::realis
