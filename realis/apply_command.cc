#include "realis/apply_command.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "realis/apply.h"
#include "realis/named.h"
#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/image/read.h"
#include "render/image/write.h"
#include "render/view/view.h"

namespace likeness::realis {
namespace {

using files::UsageError;

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
  if (stored.about.space == baked::Space::kTexture)
    throw UsageError(folder.string() + " is of the mesh " + files::in_quotes(stored.about.object) + " in " +
                     stored.about.scene + "; a material of the scene adds it (\"realis\": {\"bake\": FOLDER}), and " +
                     "`likeness render` shows it under any light");
  const std::size_t camera = camera_named(capture, stored.about.camera);
  const capture_fit::Fit surface = read_surface(folder, camera);
  std::vector<Beam> beams;
  // Cameras look along z with y down, in the world as cameras.json has them.
  const glm::dmat3 world_from_camera(capture.cameras[camera].world_from_camera);
  for (const std::string& light : request.lights) {
    beams.push_back(beam_of(light));
    beams.back().to_light = world_from_camera * (beams.back().to_light * glm::dvec3(1, -1, -1));
  }
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

}  // namespace

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

}  // namespace likeness::realis
