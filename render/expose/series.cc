#include "render/expose/series.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "render/capture/capture.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "render/command/camera_choice.h"
#include "render/exposure/histogram.h"
#include "render/exposure/pick.h"
#include "render/files/files.h"
#include "render/image/read.h"
#include "render/photograph/tiff_tags.h"
#include "render/plan/plan.h"
#include "render/runtime/pipeline.h"
#include "render/scene/read_scene.h"
#include "render/world/world.h"

namespace likeness::expose {
namespace {

namespace fs = std::filesystem;
using files::in_quotes;
using files::UsageError;

enum class Kind { kImage, kCapture, kScene };

Kind kind_of(const fs::path& input) {
  std::error_code ignored;
  if (fs::is_directory(input, ignored) || input.filename() == "capture.json") return Kind::kCapture;
  for (const char* ending : {".json", ".glb", ".gltf", ".obj", ".ply"})
    if (input.extension() == ending) return Kind::kScene;
  return Kind::kImage;
}

std::vector<float> weights_of(const std::string& mask, int width, int height, const std::string& of) {
  if (mask.empty()) return {};
  const image::Texels texels = image::read_texels(mask);
  if (texels.width != width || texels.height != height)
    throw files::InputError(mask + ": is " + std::to_string(texels.width) + " x " + std::to_string(texels.height) +
                            ", but " + of + " is " + std::to_string(width) + " x " + std::to_string(height));
  std::vector<float> out(texels.count());
  const auto channels = static_cast<std::size_t>(texels.channels);
  const std::size_t green = channels < 3 ? 0 : 1;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = texels.bytes.empty() ? texels.floats[i * channels + green]
                                  : static_cast<float>(texels.bytes[i * channels + green]) / 255;
  return out;
}

Shot read_image(const fs::path& file, const Request& request, float floor) {
  Shot out;
  out.floor = floor;
  {
    const std::string bytes = files::read_whole(file, image::kMostFileBytes);
    const photograph::Taken taken = photograph::taken_of(bytes, file.string());
    out.taken = {taken.f_number, taken.exposure_s, taken.iso};
    out.light = image::picture_of(image::decode_texels(bytes, file.string(), {.layer = request.layer}));
  }
  out.weights = weights_of(request.mask, out.light.width, out.light.height, file.string());
  return out;
}

Series images(const Request& request, const Options& options) {
  Series out;
  const auto floor = static_cast<float>(options.floor.value_or(0));
  for (const std::string& input : request.inputs) {
    const fs::path file = input;
    out.frames.push_back({file.filename().string(), file.stem().string(),
                          [file, request, floor] { return read_image(file, request, floor); }});
  }
  out.name = out.frames[0].name;
  if (out.frames.size() > 1) out.name += " to " + out.frames.back().name;
  return out;
}

std::size_t camera_of_capture(const capture::Capture& capture, const std::string& wanted) {
  if (wanted.empty()) return 0;
  const std::size_t found = capture::camera_of(capture, wanted);
  if (found != capture::kAbsent) return found;
  std::vector<std::string_view> ids;
  for (const capture::Camera& camera : capture.cameras) ids.push_back(camera.id);
  const std::string near = files::nearest_name(wanted, ids.data(), ids.size());
  throw UsageError("--camera " + in_quotes(wanted) + ": the capture has no such camera" +
                   (near.empty() ? "; its first is " + in_quotes(ids[0]) : "; did you mean " + near + "?"));
}

// Where nobody measured the noise: a fifth of a step of 11 bits, as in the comparison of photographs and renders.
constexpr double kUnknownNoise = 1e-4;

Series lights_of_capture(const Request& request, const Options& options) {
  auto capture = std::make_shared<const capture::Capture>(capture::read_capture(request.inputs[0]));
  if (capture->cameras.empty()) throw files::InputError(request.inputs[0] + ": the capture has no cameras");
  const std::size_t camera = camera_of_capture(*capture, request.camera);
  auto layers = std::make_shared<const capture::CameraLayers>(capture::read_camera_layers(*capture, camera));
  double floor = kUnknownNoise;
  if (!capture->noise_floor.empty()) {
    const glm::dvec3& noise = capture->noise_floor[camera];
    const double luminance = 0.2126 * noise.r + 0.7152 * noise.g + 0.0722 * noise.b;
    if (luminance > 0) floor = luminance;
  }
  const auto least = static_cast<float>(options.floor.value_or(floor));

  Series out;
  const std::string& id = capture->cameras[camera].id;
  out.name = (capture->name.empty() ? capture->root.filename().string() : capture->name) + ", camera " + id;
  out.view.name = capture->pipeline.view;
  for (std::size_t i = 0; i < capture->frames.size(); ++i) {
    const capture::Frame& frame = capture->frames[i];
    if (frame.camera != camera || frame.kind != capture::FrameKind::kOneLight) continue;
    const std::string& light = capture->lights[frame.light].id;
    out.frames.push_back({id + ", light " + light, id + "_" + light, [capture, layers, i, least] {
                            capture::Photo photo = capture::read_photo(*capture, i, *layers);
                            const capture::Frame& f = capture->frames[i];
                            Shot shot{std::move(photo.light), {}, least, {f.f_number, f.exposure_s, f.iso}};
                            constexpr unsigned kUnusable = capture::kMasked | capture::kNotFinite;
                            shot.weights.reserve(photo.flaws.size());
                            for (const std::uint8_t flaw : photo.flaws)
                              shot.weights.push_back((flaw & kUnusable) != 0 ? 0.0f : 1.0f);
                            return shot;
                          }});
  }
  if (out.frames.empty())
    throw files::InputError(request.inputs[0] + ": camera " + in_quotes(id) + " has no frame of one light");
  return out;
}

Series look_at_scene(const Request& request, const Options& options) {
  scene::Scene scene = scene::read_scene(request.inputs[0]);
  const std::size_t index = render_command::camera_of(scene, request.camera);
  scene::Camera& camera = scene.cameras[index];
  constexpr double kLongest = 480;
  const double share = std::min(1.0, kLongest / std::max(camera.width, camera.height));
  render_command::resize(camera, {std::max(1, static_cast<int>(share * camera.width)),
                                  std::max(1, static_cast<int>(share * camera.height))});
  const plan::Plan plan = plan::plan_of(scene, index, false);
  const world::World world(scene, plan);
  auto light = std::make_shared<const image::Picture>(runtime::Pipeline(world).frame(index, runtime::Settings{}));

  const fs::path file = request.inputs[0];
  Series out;
  // Most are called scene.json, and their folder says which it is.
  const fs::path folder = file.parent_path().filename();
  out.name = (file.filename() == "scene.json" && !folder.empty() ? folder / file.filename() : file.filename()).string();
  out.view = scene.view;
  const auto floor = static_cast<float>(options.floor.value_or(0));
  const std::string mask = request.mask, name = out.name;
  out.frames.push_back({out.name, file.stem().string(), [light, floor, mask, name] {
                          return Shot{*light, weights_of(mask, light->width, light->height, name), floor, {}};
                        }});
  return out;
}

}  // namespace

std::optional<double> Taken::ev100() const {
  if (!f_number || !seconds || !iso || !(*f_number > 0) || !(*seconds > 0) || !(*iso > 0)) return std::nullopt;
  return exposure::ev100(*f_number, *seconds, *iso);
}

Series series_of(const Request& request, const Options& options) {
  const Kind kind = kind_of(request.inputs[0]);
  for (const std::string& input : request.inputs)
    if (request.inputs.size() > 1 && kind_of(input) != Kind::kImage)
      throw UsageError(in_quotes(input) + " is a capture or a scene, and stands alone; several inputs are pictures");
  if (kind == Kind::kImage && !request.camera.empty())
    throw UsageError("--camera is of captures and scenes; " + in_quotes(request.inputs[0]) + " is a picture");
  if (kind != Kind::kImage && !request.layer.empty())
    throw UsageError("--layer is of pictures; " + in_quotes(request.inputs[0]) + " is none");
  if (kind == Kind::kCapture && !request.mask.empty())
    throw UsageError("--mask: a capture has masks of its own, a layer of each camera (docs/capture.md)");
  return kind == Kind::kCapture ? lights_of_capture(request, options)
         : kind == Kind::kScene ? look_at_scene(request, options)
                                : images(request, options);
}

}  // namespace likeness::expose
