#include "realis/export/pictures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/files/files.h"
#include "render/image/tone_curve.h"

namespace likeness::realis {
namespace {

// Cameras look along z with y down; pictures are lit with z towards the camera and y up.
constexpr glm::dvec3 kTurned{1, -1, -1};

glm::dmat3 world_from_camera(const capture::Capture& capture, std::size_t camera) {
  return glm::dmat3(capture.cameras[camera].world_from_camera);
}

}  // namespace

Relightable read_relightable(const capture::Capture& capture, const std::string& name) {
  if (!capture::is_id(name)) throw files::UsageError("--name " + files::in_quotes(name) + " cannot be a name");
  const std::filesystem::path folder = capture.root / "realis" / name;
  if (!std::filesystem::exists(folder / "bake.json"))
    throw files::UsageError("there is no bake " + files::in_quotes(name) + " in " + (capture.root / "realis").string() +
                            "; `likeness realis bake " + capture.root.string() +
                            (name == "bake" ? "" : " --name " + name) + "` makes it");
  Relightable out{capture, 0, read_bake(folder), {}};
  if (out.stored.about.space == baked::Space::kTexture)
    throw files::UsageError("the bake " + files::in_quotes(name) +
                            " is of a mesh in its texture; exported are bakes of a camera's picture (without --scene)");
  if (!std::filesystem::exists(folder / "surface.json"))
    throw files::UsageError(
        "the bake " + files::in_quotes(name) +
        " is over renders of a variant, which cannot be made for other lights; bake without --variant");
  out.camera = capture::camera_of(capture, out.stored.about.camera);
  if (out.camera == capture::kAbsent)
    throw files::InputError((folder / "bake.json").string() + ": camera " + files::in_quotes(out.stored.about.camera) +
                            " is not in the capture any more");
  out.surface = read_surface(folder, out.camera);
  return out;
}

image::Picture relit(const Relightable& subject, const glm::dvec3& to_light) {
  Beam beam;
  beam.to_light = world_from_camera(subject.capture, subject.camera) * (to_light * kTurned);
  return relight(subject.capture, subject.stored, subject.surface, std::span(&beam, 1)).realis;
}

std::vector<Photographed> photographed(const capture::Capture& capture, std::size_t camera) {
  std::vector<Photographed> out;
  const capture::FrameTable table(capture);
  const glm::dmat3 camera_from_world = glm::transpose(world_from_camera(capture, camera));
  for (std::size_t l = 0; l < capture.lights.size(); ++l) {
    const auto* distant = std::get_if<capture::DistantLight>(&capture.lights[l].place);
    const auto* near = std::get_if<capture::NearLight>(&capture.lights[l].place);
    const glm::dvec3 to_light = distant ? distant->to_light : near ? near->position : glm::dvec3(0);
    const std::size_t frame = table.frame(camera, l);
    if (frame == capture::kAbsent || !(glm::length(to_light) > 1e-9)) continue;
    out.push_back({l, frame, camera_from_world * glm::normalize(to_light) * kTurned});
  }
  return out;
}

double exposure_of(std::span<const image::Picture> pictures) {
  constexpr double kShare = 0.99, kMostStops = 30;
  std::vector<double> light;
  for (const image::Picture& picture : pictures)
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
      const double y = 0.2126 * static_cast<double>(picture.rgb[i]) + 0.7152 * static_cast<double>(picture.rgb[i + 1]) +
                       0.0722 * static_cast<double>(picture.rgb[i + 2]);
      if (std::isfinite(y) && y > 0) light.push_back(y);
    }
  if (light.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(kShare * static_cast<double>(light.size()))) - 1;
  std::nth_element(light.begin(), light.begin() + rank, light.end());
  const double stops = std::clamp(-std::log2(light[static_cast<std::size_t>(rank)]), -kMostStops, kMostStops);
  return std::floor(10 * stops + 0.5) / 10 + 0.0;  // never -0
}

image::Picture displayed(image::Picture picture, double ev) {
  const double scale = std::exp2(ev);
  for (float& value : picture.rgb) {
    const double light = std::isfinite(value) ? std::clamp(static_cast<double>(value) * scale, 0.0, 1.0) : 0;
    value = static_cast<float>(image::srgb_encode(light));
  }
  return picture;
}

image::DisplayPicture rounded(const image::Picture& display_values) {
  image::DisplayPicture out(display_values.width, display_values.height);
  for (std::size_t i = 0; i < out.rgb.size(); ++i)
    out.rgb[i] = static_cast<std::uint8_t>(std::lround(255 * display_values.rgb[i]));
  return out;
}

}  // namespace likeness::realis
