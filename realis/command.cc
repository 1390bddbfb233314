#include "realis/command.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "realis/apply.h"
#include "realis/bake_file.h"
#include "realis/from_capture.h"
#include "realis/weigh.h"
#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/image/read.h"
#include "render/image/write.h"
#include "render/view/view.h"

namespace likeness::realis {
namespace {

using files::UsageError;

struct Request {
  std::string capture, camera, variant, lobes = "auto", name = "bake", out, result = "realis";
  int dominant = 0;
  bool is_rgb = false, is_exact = false, is_float = false, has_layers = false;
  double floor = 0.4, seed = 1;
  std::vector<std::string> only, with, without;  // weights
  weight::Settings weights;
};

std::size_t camera_of(const capture::Capture& capture, const std::string& id) {
  std::vector<std::string_view> names;
  for (const capture::Camera& camera : capture.cameras) names.push_back(camera.id);
  if (id.empty()) return 0;
  const std::size_t at = capture::camera_of(capture, id);
  if (at != capture::kAbsent) return at;
  const std::string near = files::nearest_name(id, names.data(), names.size());
  throw UsageError("--camera " + files::in_quotes(id) + " is not in the capture" +
                   (near.empty() ? "" : "; did you mean " + files::in_quotes(near) + "?"));
}

std::size_t variant_of(const capture::Capture& capture, const std::string& id) {
  const std::size_t at = capture::variant_of(capture, id);
  if (at != capture::kAbsent) return at;
  throw UsageError("--variant " + files::in_quotes(id) +
                   " is not in the capture; `likeness olat render --variant NAME` makes one, and without --variant the "
                   "renders are made here, from the photographs");
}

BakeOptions options_of(const Request& request) {
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
  if (!(options.floor > 0 && options.floor <= 1))
    throw UsageError("--floor = " + files::number_text(options.floor) + " is outside (0, 1]");
  return options;
}

std::string fixed(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
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
        picture.rgb[3 * std::size_t{subject.pixels[texel]} + c] = static_cast<float>(
            std::max(static_cast<double>(subject.render[at][c]) + subject.irradiance_of(i) * e[c], 0.0));
    }
    image::write_exr(capture::render_file(capture, variant, subject.camera, subject.lights[i]), picture);
  }
}

int run_bake(const Request& request) {
  files::catch_interrupts();
  const BakeOptions options = options_of(request);
  weight::Choice choice = weight::choice_of(request.only, request.with, request.without, request.weights);
  if (options.is_exact) choice.is_on.fill(false);  // photographs come back, whatever is wrong with them
  capture::Capture capture = capture::read_capture(request.capture);
  const std::size_t camera = camera_of(capture, request.camera);
  if (!capture::is_id(request.name)) throw UsageError("--name " + files::in_quotes(request.name) + " cannot be a name");

  files::Progress progress;
  const auto goes_on = [&](double share, std::string_view what) {
    progress.tell(what, share);
    return !files::interrupted();
  };
  const auto begin = std::chrono::steady_clock::now();
  std::optional<capture_fit::Fit> fit;
  if (request.variant.empty()) fit = thin(capture_fit::fit_capture(capture, camera, {}, goes_on));
  const Renderer renderer =
      fit ? renders_of_fit(capture, *fit) : renders_of_variant(capture, camera, variant_of(capture, request.variant));
  Subject subject = read_subject(capture, camera, renderer, {}, goes_on);
  const std::vector<weight::Layer> layers =
      weigh(capture, fit ? fit->normals : image::Picture(), choice, request.has_layers, subject);
  const auto read = std::chrono::steady_clock::now();
  const Bake made = bake(subject, options, goes_on);
  StoredBake stored{made, {}, subject.width, subject.height, subject.pixels};
  const auto baked = std::chrono::steady_clock::now();
  const auto seconds = [](auto a, auto b) { return std::chrono::duration<double>(b - a).count(); };
  const baked::Bake seen = request.is_float ? stored.bake : quantised(stored.bake);
  const auto [plain, left] = errors_of(subject, seen);
  stored.about = {capture.name, capture.cameras[camera].id, {}, {{"render_rms", plain}, {"realis_rms", left}}};
  if (!made.ladder.empty())
    stored.about.metrics.emplace_back("held_out_rms", made.ladder[made.chosen].held_out);
  const std::filesystem::path folder =
      request.out.empty() ? capture.root / "realis" / request.name : std::filesystem::path(request.out);
  write_bake(folder, stored, request.is_float);
  if (fit) write_surface(folder, *fit);
  if (request.has_layers) write_weights(capture, subject, layers, std::filesystem::path("realis") / request.name);
  if (!request.result.empty()) write_results(capture, subject, seen, request.result);

  std::cout << subject.texels() << " texels under " << subject.lights.size() << " lights: " << seen.basis.lobes.size()
            << " lobes, " << (request.is_float ? 4 : 1) * bytes_of_texel(seen) << " bytes a texel\n"
            << "photo - render            " << fixed(plain, 5) << " rms\n"
            << "photo - (render + realis) " << fixed(left, 5) << " rms\n";
  if (!made.ladder.empty()) {
    std::cout << "lobes  held out (luminance rms)\n";
    for (std::size_t i = 0; i < made.ladder.size(); ++i)
      std::cout << (made.ladder[i].basis.lobes.size() < 100 ? "  " : " ")
                << (made.ladder[i].basis.lobes.size() < 10 ? " " : "")
                << made.ladder[i].basis.lobes.size() << "  " << fixed(made.ladder[i].held_out, 6)
                << (i == made.chosen ? "  taken\n" : "\n");
  }
  std::cout << "read in " << fixed(seconds(begin, read), 1) << " s, baked in " << fixed(seconds(read, baked), 1)
            << " s: " << (folder / "bake.json").string() << "\n";
  return 0;
}

struct ApplyRequest {
  std::string capture, name = "bake", environment, out, view = "gt";
  std::vector<std::string> lights;
  double beams = 256, ev = 0;
  bool is_plain = false;
};

Beam beam_of(const std::string& text) {
  Beam beam;
  std::array<double, 3> v{};
  int read = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &v[0], &v[1], &v[2], &read) != 3 ||
      read != static_cast<int>(text.size()) || !std::isfinite(v[0] + v[1] + v[2]) ||
      !(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] > 0))
    throw UsageError(
        "--light " + files::in_quotes(text) +
        " is not a direction x,y,z (to the light; x right, y up, z towards the camera; for example 1,1,2)");
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  beam.to_light = glm::dvec3(v[0], v[1], v[2]) / length;
  return beam;
}

int run_apply(const ApplyRequest& request) {
  files::catch_interrupts();
  if (request.lights.empty() == request.environment.empty())
    throw UsageError("say what shines: either --light x,y,z (several times, if you like), or --environment FILE");
  if (!(request.beams >= 1 && request.beams <= 65536))
    throw UsageError("--beams = " + files::number_text(request.beams) + " is outside [1, 65536]");
  const capture::Capture capture = capture::read_capture(request.capture);
  const std::filesystem::path folder = capture.root / "realis" / request.name;
  const StoredBake stored = read_bake(folder);
  const std::size_t camera = camera_of(capture, stored.about.camera);
  const capture_fit::Fit surface = read_surface(folder, camera);
  std::vector<Beam> beams;
  for (const std::string& light : request.lights) beams.push_back(beam_of(light));
  if (!request.environment.empty())
    beams = beams_of(image::read_picture(request.environment), static_cast<std::size_t>(request.beams));
  const Relit relit = relight(capture, stored, surface, beams);
  const std::filesystem::path file = request.out.empty()
                                         ? folder / (request.environment.empty() ? "light.exr" : "environment.exr")
                                         : std::filesystem::path(request.out);
  const image::Picture& picture = request.is_plain ? relit.render : relit.realis;
  image::write_exr(file, picture);
  scene::View shown;
  shown.name = request.view, shown.ev = request.ev;
  std::filesystem::path display = file;
  display.replace_extension(".png");
  image::write_png(display, view::show(picture, shown));
  std::cout << beams.size() << (beams.size() == 1 ? " light: " : " lights: ") << file.string() << ", "
            << display.string() << "\n";
  return 0;
}

void add_apply(CLI::App& realis, int& exit_code) {
  CLI::App* apply = realis.add_subcommand("apply", "Relight a baked subject");
  auto request = std::make_shared<ApplyRequest>();
  apply->add_option("CAPTURE", request->capture, "capture that was baked")->required();
  apply->add_option("--light", request->lights,
                    "x,y,z to a distant light of the capture's unit strength; x right, y up, z to the camera");
  apply->add_option("--environment", request->environment,
                    "latitude-longitude picture (EXR, HDR); its middle is behind");
  apply->add_option("--beams", request->beams, "lights that stand for an environment")->capture_default_str();
  apply->add_option("--name", request->name, "of the bake")->capture_default_str();
  apply->add_flag("--plain", request->is_plain, "the render without what was baked, to compare");
  apply->add_option("--view", request->view, "of the PNG, as in likeness render")->capture_default_str();
  apply->add_option("--ev", request->ev, "exposure of the PNG [stop]")->capture_default_str();
  apply->add_option("--out", request->out, "EXR; a PNG is written beside it. Default: in the bake's folder");
  apply->footer(R"(Examples
  likeness realis apply capture --light 1,0.5,1                      a light from the right
  likeness realis apply capture --environment sky.hdr --ev 1         under a sky
  likeness realis apply capture --light 1,0.5,1 --plain --out a.exr  what the fit alone makes of it

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 4 the program failed.)");
  apply->callback([request, &exit_code] { exit_code = run_apply(*request); });
}

}  // namespace

CLI::App& add_realis(CLI::App& program, int& exit_code) {
  CLI::App* realis = program.add_subcommand("realis", "Bake what renders lack of photographs, and give it back");
  realis->require_subcommand(1);
  CLI::App* bake = realis->add_subcommand("bake", "Bake the difference of photographs and renders of a capture");
  auto request = std::make_shared<Request>();
  bake->add_option("CAPTURE", request->capture, "folder with capture.json (likeness olat import)")->required();
  bake->add_option("--camera", request->camera, "whose picture is the texture; default: the first");
  bake->add_option("--variant", request->variant,
                   "renders that are there (likeness olat render), instead of those of a fit of the photographs");
  bake->add_option("--lobes", request->lobes, "auto (by held-out lights), or how many")->capture_default_str();
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
  bake->add_flag("--layers", request->has_layers, "each weight as a variant weight_NAME, for likeness olat view")
      ->group("Weights");
  bake->footer("Weights of samples, and whether they are on" + weights + "\n\n" + R"(Examples
  likeness realis bake capture                      fit the photographs, bake what the fit lacks: CAPTURE/realis/bake
  likeness olat view capture                        photographs beside render + realis
  likeness realis bake head --variant path_traced   what the renders of a scene lack
  likeness realis bake capture --without foreign --layers   what a weight does, to look at

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 4 the program failed.)");
  bake->callback([request, &exit_code] { exit_code = run_bake(*request); });
  add_apply(*realis, exit_code);
  return *realis;
}

}  // namespace likeness::realis
