#include "realis/inputs.h"

#include <algorithm>
#include <filesystem>

#include <tbb/parallel_for.h>

#include "render/capture/format.h"
#include "render/files/files.h"
#include "render/image/read.h"

namespace likeness::realis {
namespace {

struct File {
  std::filesystem::path named, file;
};

Inputs hashed(const std::vector<File>& files) {
  Inputs out(files.size());
  tbb::parallel_for(std::size_t{0}, files.size(), [&](std::size_t i) {
    out[i] = {files[i].named.generic_string(), files::sha256(files::read_whole(files[i].file, image::kMostFileBytes))};
  });
  return out;
}

}  // namespace

Inputs inputs_of_capture(const capture::Capture& capture, std::span<const std::size_t> cameras) {
  std::vector<File> files;
  for (const std::string_view name :
       {capture::kCaptureFile, capture::kCamerasFile, capture::kLightsFile, capture::kFramesFile})
    files.push_back({name, capture.root / name});
  for (const capture::LayerFile& layer : capture.layers)
    if (std::find(cameras.begin(), cameras.end(), layer.camera) != cameras.end())
      files.push_back({layer.file, capture::layer_file(capture, layer.camera, layer.layer)});
  return hashed(files);
}

Inputs inputs_of_pictures(const capture::Capture& capture, std::size_t camera, std::span<const std::size_t> lights,
                          std::optional<std::size_t> variant) {
  const capture::FrameTable frames(capture);
  std::vector<File> files;
  for (const std::size_t light : lights) {
    const std::size_t frame = frames.frame(camera, light);
    if (frame == capture::kAbsent) continue;
    files.push_back({capture.frames[frame].file, capture::photo_file(capture, capture.frames[frame])});
    if (!variant) continue;
    const capture::Variant& v = capture.variants[*variant];
    files.push_back({capture::filled(v.pattern, capture.cameras[camera].id, capture.lights[light].id, v.id),
                     capture::render_file(capture, v, camera, light)});
  }
  return hashed(files);
}

}  // namespace likeness::realis
