#include "realis/texture/texture_bake.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

#include "realis/texture/baking.h"
#include "realis/texture/unwrap.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/sight.h"
#include "render/command/scene_digest.h"
#include "render/files/files.h"
#include "render/surface/residual.h"

namespace likeness::realis {
namespace {

// Of a picture of floats, which is written from memory.
constexpr std::uintmax_t kMostFloatBytes = std::uintmax_t{1} << 31;

scene::Index instance_of(const scene::Scene& scene, const std::string& name) {
  std::vector<std::string_view> names;
  std::string all;
  for (const scene::Instance& instance : scene.instances) {
    names.push_back(instance.name);
    all += (all.empty() ? "" : ", ") + files::in_quotes(instance.name);
  }
  if (name.empty() && names.size() == 1) return 0;
  if (name.empty()) throw files::UsageError("--object says which one is baked; the scene has " + all);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<scene::Index>(found - names.begin());
  const std::string near = files::nearest_name(name, names.data(), names.size());
  throw files::UsageError("--object " + files::in_quotes(name) + " is not in the scene, which has " + all +
                          (near.empty() ? "" : "; did you mean " + files::in_quotes(near) + "?"));
}

// What cameras see of the scene: lights are the capture's, and bakes, this one's last result perhaps, are left out.
scene::Scene unlit(scene::Scene scene) {
  scene.lights.clear(), scene.environment.reset();
  scene.cameras.assign(1, scene::Camera());
  scene.bakes.clear();
  for (scene::Material& material : scene.materials) material.residual.reset();
  return scene;
}

}  // namespace

Baking::Baking(const capture::Capture& capture, const scene::Scene& scene, const TextureBakeOptions& options,
               const std::filesystem::path& folder, const GoesOn& goes_on)
    : capture_(capture),
      options_(options),
      folder_(folder),
      work_(folder / "work"),
      goes_on_(goes_on),
      frames_(capture),
      scene_(unlit(scene)),
      world_(scene_, plan::plan_of(scene_, 0)),
      instance_(instance_of(scene_, options.object)) {}

std::string Baking::mesh_digest() const {
  const scene::Mesh& mesh = scene_.meshes[object().mesh];
  std::string bytes;
  const auto add = [&](const auto& values) {
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
  };
  add(mesh.positions), add(mesh.uvs), add(mesh.triangles);
  return files::sha256(bytes);
}

std::filesystem::path Baking::work_file(const char* name, std::size_t index) const {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%s_%05zu", name, index);
  return work_ / text.data();
}

glm::dmat3 Baking::model_from_world() const {
  return glm::dmat3(surface::model_from_world(glm::mat3(object().world_from_object)));
}

void Baking::find_cameras_and_lights() {
  for (std::size_t camera = 0; camera < capture_.cameras.size(); ++camera) {
    if (!options_.cameras.empty() &&
        std::find(options_.cameras.begin(), options_.cameras.end(), camera) == options_.cameras.end())
      continue;
    for (std::size_t light = 0; light < capture_.lights.size(); ++light)
      if (has_frame(camera, light) && capture::has_place(capture_.lights[light])) {
        cameras_.push_back(camera);
        break;
      }
  }
  for (std::size_t light = 0; light < capture_.lights.size(); ++light)
    if (capture::has_place(capture_.lights[light]) &&
        std::any_of(cameras_.begin(), cameras_.end(), [&](std::size_t camera) { return has_frame(camera, light); }))
      lights_.push_back(light);
  if (lights_.empty())
    throw files::UsageError(
        "no camera has a photograph under a light whose direction is known; `likeness olat calibrate` finds "
        "directions, "
        "`likeness olat check` says what is missing");
  for (const std::size_t camera : cameras_)
    for (const std::size_t light : lights_)
      if (has_frame(camera, light) &&
          !std::filesystem::exists(capture::render_file(capture_, variant(), camera, light)))
        throw files::UsageError("variant " + files::in_quotes(variant().id) + " has no render of camera " +
                                files::in_quotes(capture_.cameras[camera].id) + " under light " +
                                files::in_quotes(capture_.lights[light].id) + "; `likeness olat render " +
                                capture_.root.string() + " --scene " + options_.scene_file + " --variant " +
                                variant().id + "` makes it");
}

// Of all that decides a light's samples and a tile's coefficients. Photographs by name, size and time: their bytes are
// hashed when they are read.
std::string Baking::digest() const {
  const capture::CaptureTexts texts = capture::texts_of(capture_);
  std::string text = "texture bake 1\n" + texts.cameras + texts.lights + texts.frames + variant().pattern + "\n";
  const auto add = [&](const std::filesystem::path& file) {
    if (file.empty()) return;
    std::error_code error;
    text += file.string() + " " + std::to_string(std::filesystem::file_size(file, error)) + " " +
            std::to_string(std::filesystem::last_write_time(file, error).time_since_epoch().count()) + "\n";
  };
  const auto put = [&](double value) { text += files::number_text(value) + "\n"; };
  for (const std::size_t camera : cameras_) {
    for (const capture::Layer layer : {capture::Layer::kMask, capture::Layer::kFlatField})
      add(capture::layer_file(capture_, camera, layer));
    for (const std::size_t light : lights_)
      if (has_frame(camera, light)) {
        add(capture::photo_file(capture_, capture_.frames[frames_.frame(camera, light)]));
        add(capture::render_file(capture_, variant(), camera, light));
      }
  }
  text += render_command::digest_of(scene_, 0) + "\n" + mesh_digest() + "\n";
  const BakeOptions& b = options_.bake;
  for (const double value :
       {static_cast<double>(instance_), static_cast<double>(options_.resolution), static_cast<double>(b.channels),
        static_cast<double>(b.lobes), static_cast<double>(b.most_lobes), static_cast<double>(b.dominant),
        b.is_exact ? 1.0 : 0.0, b.floor, static_cast<double>(b.seed)})
    put(value);
  weight::Settings settings = options_.weights.settings;
  for (std::size_t i = 0; i < weight::kWeights.size(); ++i) {
    put(options_.weights.is_on[i] ? 1 : 0);
    for (const weight::SettingRow& row : weight::kWeights[i].settings)
      if (!row.name.empty()) put(row.value(settings));
  }
  return files::sha256(text);
}

TextureBake Baking::run() {
  must_stream(options_.weights);
  find_cameras_and_lights();
  find_sights();
  digest_ = digest();
  out_.texels = texels(), out_.lights = lights_.size(), out_.cameras = cameras_.size();
  // A tile's file has at most as many lobes as the search may end with.
  const std::size_t most = options_.bake.is_exact    ? lights_.size()
                           : options_.bake.lobes > 0 ? options_.bake.lobes
                                                     : std::min(options_.bake.most_lobes, 4 * lights_.size());
  const std::size_t kept = options_.bake.dominant > 0 ? std::min(options_.bake.dominant, most) : most;
  const std::uintmax_t side = static_cast<std::uintmax_t>(options_.resolution);
  if (options_.is_float && 4 * channels() * most * side * side > kMostFloatBytes)
    throw files::UsageError("--float needs up to " + std::to_string(channels() * most) + " planes of " +
                            std::to_string(side) + " x " + std::to_string(side) +
                            " floats in memory; leave it out, or ask for fewer lobes or texels");
  out_.work_bytes = lights_.size() * bytes_of_light(texels(), channels(), candidates_.size()) +
                    texels() * (1 + kept * (1 + 4 * channels()));
  std::filesystem::create_directories(work_);
  std::uintmax_t there = 0;
  for (const auto& entry : std::filesystem::directory_iterator(work_)) there += entry.file_size();
  const std::uintmax_t pictures = static_cast<std::uintmax_t>(texels()) * channels() * kept * 2;
  must_have_room(folder_, out_.work_bytes + pictures, std::filesystem::space(work_).available + there);
  const auto begin = std::chrono::steady_clock::now();
  find_samples();
  out_.reading_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  solve(choose());
  return std::move(out_);
}

void must_have_room(const std::filesystem::path& folder, std::uintmax_t needed, std::uintmax_t free) {
  if (free >= needed) return;
  const auto text = [](std::uintmax_t bytes) {
    std::array<char, 32> out{};
    std::snprintf(out.data(), out.size(), "%.1f GB", static_cast<double>(bytes) / 1e9);
    return std::string(out.data());
  };
  throw files::UsageError(folder.string() + ": the bake needs " + text(needed) + " there while it lasts, and " +
                          text(free) + " are free; --out names another disk, --resolution fewer texels");
}

TextureBake bake_texture(const capture::Capture& capture, const scene::Scene& scene, const TextureBakeOptions& options,
                         const std::filesystem::path& folder, const GoesOn& goes_on) {
  if (options.resolution < 1 || options.resolution > kMostResolution)
    throw files::UsageError("--resolution = " + std::to_string(options.resolution) + " is outside [1, " +
                            std::to_string(kMostResolution) + "]");
  return Baking(capture, scene, options, folder, goes_on).run();
}

}  // namespace likeness::realis
