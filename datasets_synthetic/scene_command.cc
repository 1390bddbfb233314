#include "datasets_synthetic/scene_command.h"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>
#include <CLI/CLI.hpp>

#include "datasets_synthetic/scene.h"
#include "datasets_synthetic/scene_files.h"
#include "render/files/files.h"

namespace likeness::datasets_synthetic {
namespace {

using files::in_quotes;
using files::UsageError;

struct SceneCommand {
  std::string kind, out;
  bool list = false;
  SceneOptions options;
  std::optional<int> width, height, lights, frames;
  std::optional<double> light_deg;
};

const SceneKind& kind_asked(const std::string& name) {
  std::vector<std::string_view> names;
  std::string list;
  for (const SceneKind& kind : kSceneKinds) {
    if (kind.name == name) return kind;
    names.push_back(kind.name);
    list += (list.empty() ? "" : ", ") + std::string(kind.name);
  }
  if (name.empty()) throw UsageError("no kind of scene is named; there are " + list);
  const std::string near = files::nearest_name(name, names.data(), names.size());
  throw UsageError("there is no scene " + in_quotes(name) + (near.empty() ? "" : "; did you mean " + near + "?") +
                   " (kinds: " + list + ")");
}

int within(const char* option, const std::optional<int>& asked, int usual, int low, int high) {
  const int value = asked.value_or(usual);
  if (asked && (value < low || value > high))
    throw UsageError("--" + std::string(option) + " = " + std::to_string(value) + " is outside [" +
                     std::to_string(low) + ", " + std::to_string(high) + "]");
  return value;
}

void only_for(std::string_view kind, const char* option, bool is_asked, std::string_view of) {
  if (is_asked && kind != of)
    throw UsageError("--" + std::string(option) + " is for the scene " + std::string(of) + ", not for " +
                     std::string(kind));
}

// A folder that this command may write to: one without a scene, or with one that it made.
void require_own_folder(const std::filesystem::path& folder) {
  std::error_code error;
  const bool exists = std::filesystem::exists(folder, error);
  if (exists && !std::filesystem::is_directory(folder, error))
    throw UsageError("--out " + in_quotes(folder.string()) + " is a file; a scene is a folder");
  const std::filesystem::path file = folder / "scene.json";
  if (!std::filesystem::exists(file, error)) return;
  constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  if (files::read_whole(file, kMostBytes).find(kMadeBy) == std::string::npos)
    throw UsageError(file.string() + " was not made by this command and is not overwritten; choose another folder");
}

void run(const SceneCommand& asked, std::ostream& out) {
  if (asked.list) {
    for (const SceneKind& kind : kSceneKinds) {
      std::string name(kind.name);
      name.resize(16, ' ');
      out << name << kind.text << '\n';
    }
    return;
  }
  const SceneKind& kind = kind_asked(asked.kind);
  if (asked.out.empty()) throw UsageError("--out is missing: a folder for the scene");
  only_for(kind.name, "lights", asked.lights.has_value(), "corridor");
  only_for(kind.name, "light-deg", asked.light_deg.has_value(), "spheres");
  only_for(kind.name, "frames", asked.frames.has_value(), "spheres");
  SceneOptions options = asked.options;
  options.folder = asked.out;
  constexpr int kLongestSide = 16384;
  options.width = within("width", asked.width, 0, 1, kLongestSide);
  options.height = within("height", asked.height, 0, 1, kLongestSide);
  options.lights = within("lights", asked.lights, options.lights, 1, 10'000);
  options.frames = within("frames", asked.frames, options.frames, 1, 360);
  options.light_deg = asked.light_deg.value_or(options.light_deg);
  if (!(std::abs(options.light_deg) <= 360))
    throw UsageError("--light-deg = " + files::number_text(options.light_deg) + " is outside [-360, 360]");
  require_own_folder(options.folder);
  for (const std::filesystem::path& scene : write_scene(kind, options)) out << scene.string() << '\n';
}

constexpr auto kSceneFooter =
    R"(A scene is a folder: scene.json (docs/scene.md), and the meshes and textures that it names. All of it is
computed; the same options give the same bytes.

Examples
  likeness make scene cornell --out cornell           then: likeness render cornell/scene.json
  likeness make scene corridor --lights 500 --out corridor
  likeness make scene spheres --frames 36 --out turn  36 scene files, the light going once around
  likeness make scene --list
Manual: docs/make_scene.md)";

}  // namespace

void add_make_scene(CLI::App& make, int& exit_code) {
  CLI::App* sub = make.add_subcommand("scene", "Write a small scene: scene.json with its meshes and textures");
  auto asked = std::make_shared<SceneCommand>();
  std::string kinds;
  for (const SceneKind& kind : kSceneKinds) kinds += (kinds.empty() ? "" : ", ") + std::string(kind.name);
  sub->add_option("KIND", asked->kind, "One of: " + kinds);
  sub->add_flag("--list", asked->list, "Say what each kind is and make nothing");
  sub->add_option("--out", asked->out, "A folder; a scene that this command made there is replaced");
  sub->add_option("--seed", asked->options.seed, "Of what is scattered by chance (default 0)");
  const std::string pictures = "Pictures";
  sub->add_option("--width", asked->width, "Of its cameras [pixels] (default: the kind's own)")->group(pictures);
  sub->add_option("--height", asked->height, "The same")->group(pictures);
  const std::string lights = "Lights";
  const SceneOptions usual;
  sub->add_option("--lights", asked->lights,
                  "corridor: how many, 1 to 10000 (default " + std::to_string(usual.lights) + ")")
      ->group(lights);
  sub->add_option("--light-deg", asked->light_deg,
                  "spheres: angle of the light, 0 behind the camera, 90 at its right, 180 opposite (default " +
                      files::number_text(usual.light_deg) + ")")
      ->group(lights);
  sub->add_option("--frames", asked->frames,
                  "spheres: that many scene files, the light going once around from --light-deg (default 1)")
      ->group(lights);
  sub->footer(kSceneFooter);
  sub->callback([asked, &exit_code] {
    run(*asked, std::cout);
    exit_code = 0;
  });
}

}  // namespace likeness::datasets_synthetic
