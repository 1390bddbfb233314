#include "olat/calibrate/undistort.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include <nlohmann/json.hpp>

#include "olat/calibrate/lens.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/format.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/image/attributes.h"
#include "render/image/read.h"
#include "render/image/write.h"

namespace likeness::olat_calibrate {
namespace {

namespace fs = std::filesystem;
using capture::Capture;
using image::Picture;

void must_fit(const fs::path& file, const Picture& picture, const capture::Camera& camera) {
  if (picture.width == camera.width && picture.height == camera.height) return;
  throw files::InputError(file.string() + ": has " + std::to_string(picture.width) + " x " +
                          std::to_string(picture.height) + " pixels; its camera " + files::in_quotes(camera.id) +
                          " has " + std::to_string(camera.width) + " x " + std::to_string(camera.height));
}

// The light of a photo before primaries and gain, straightened. `full` is the light at which the sensor is.
Picture straight_photo(const Capture& capture, const capture::Frame& frame, const Straightener& straightener,
                       float full) {
  const fs::path file = capture::photo_file(capture, frame);
  Picture photo = capture::read_encoded(file);
  must_fit(file, photo, capture.cameras[frame.camera]);
  std::vector<std::uint8_t> clipped(photo.rgb.size());
  const double scale = 1 / (frame.white - frame.black);
  for (std::size_t i = 0; i < photo.rgb.size(); ++i) {
    const auto x = static_cast<float>((static_cast<double>(photo.rgb[i]) - frame.black) * scale);
    clipped[i] = x >= frame.clip ? 1 : 0;
    photo.rgb[i] = capture::linear_of(frame.transfer, x);
  }
  Picture out = straightener.smooth(photo);
  clipped = straightener.touched(clipped);
  for (std::size_t i = 0; i < clipped.size(); ++i)
    if (clipped[i] != 0 && !(out.rgb[i] >= full)) out.rgb[i] = full;
  return out;
}

// Where a frame goes: by its light, or by its kind and its place among the frames.
fs::path file_of(const Capture& capture, std::size_t at) {
  const capture::Frame& frame = capture.frames[at];
  const std::string name =
      frame.kind == capture::FrameKind::kOneLight
          ? capture.lights[frame.light].id
          : std::string(capture::kFrameKinds[static_cast<std::size_t>(frame.kind)]) + " " + std::to_string(at);
  return fs::path("photos") / capture.cameras[frame.camera].id / (name + ".exr");
}

// Mask and layers of a camera. The mask says what the photo does not show, too.
void write_layers(const Capture& capture, std::size_t camera, const Straightener& straightener, Capture& out) {
  const capture::Camera& of = capture.cameras[camera];
  const fs::path folder = fs::path("aux") / of.id;
  std::erase_if(out.layers, [&](const capture::LayerFile& layer) { return layer.camera == camera; });

  const std::vector<std::uint8_t> mask = capture::read_mask(capture, camera);
  Picture values(of.width, of.height);
  for (std::size_t i = 0; i < values.rgb.size(); ++i) values.rgb[i] = mask[i / 3];
  values = straightener.nearest(values);
  image::DisplayPicture picture(of.width, of.height);
  for (std::size_t i = 0; i < values.rgb.size(); ++i) picture.rgb[i] = values.rgb[i] > 0 ? 255 : 0;
  image::write_png(out.root / folder / "mask.png", picture);
  out.layers.push_back({camera, capture::Layer::kMask, folder / "mask.png"});

  for (const capture::LayerFile& layer : capture.layers) {
    if (layer.camera != camera || layer.layer == capture::Layer::kMask) continue;
    const fs::path file = capture.root / layer.file,
                   to = folder / (std::string(capture::kLayers[static_cast<std::size_t>(layer.layer)]) + ".exr");
    Picture from;
    // Places, directions and coordinates have no mean across an edge; what multiplies light has.
    bool is_smooth = false;
    switch (layer.layer) {
      case capture::Layer::kNormal:
        from = capture::read_normals(capture, camera);
        break;
      case capture::Layer::kAlbedo:
        from = image::read_picture(file), is_smooth = true;
        break;
      case capture::Layer::kFlatField:
        from = capture::read_encoded(file), is_smooth = true;
        break;
      case capture::Layer::kPosition:
      case capture::Layer::kUv:
      case capture::Layer::kMask:
        from = capture::read_encoded(file);
        break;
    }
    must_fit(file, from, of);
    from = is_smooth ? straightener.smooth(from) : straightener.nearest(from);
    if (layer.layer == capture::Layer::kFlatField)
      for (std::size_t i = 0; i < from.rgb.size(); ++i)
        if (straightener.inside()[i / 3] == 0) from.rgb[i] = 1;  // photos are divided by it
    image::write_exr(out.root / to, from);
    out.layers.push_back({camera, layer.layer, to});
  }
}

Undistorted::View view_of(const capture::Camera& camera, const Straightener& straightener) {
  Undistorted::View out{.camera = camera.id};
  const std::vector<std::uint8_t>& inside = straightener.inside();
  out.outside_share =
      static_cast<double>(std::count(inside.begin(), inside.end(), 0)) / static_cast<double>(inside.size());
  const glm::dmat3& k = camera.intrinsics;
  const auto width = static_cast<std::size_t>(camera.width);
  constexpr std::size_t kStep = 16;  // a lens is smooth
  for (std::size_t i = 0; i < inside.size(); i += (i % width + kStep < width ? kStep : width - i % width)) {
    if (inside[i] == 0) continue;
    const double u = static_cast<double>(i % width) + 0.5, v = static_cast<double>(i / width) + 0.5;
    const auto [x, y] = in_photo(camera, (u - k[2][0]) / k[0][0], (v - k[2][1]) / k[1][1]);
    out.farthest_px = std::max(out.farthest_px, std::hypot(x - u, y - v));
  }
  return out;
}

}  // namespace

Capture moved_to(const Capture& capture, const std::string& folder) {
  Capture out = capture;
  const fs::path from = fs::absolute(capture.root);
  out.root = folder;
  for (auto& frame : out.frames)
    if (frame.file.is_relative()) frame.file = (from / frame.file).lexically_normal();
  for (auto& layer : out.layers)
    if (layer.file.is_relative()) layer.file = (from / layer.file).lexically_normal();
  out.variants.clear();
  return out;
}

Undistorted run_undistort(const Capture& capture, const std::string& folder,
                          const std::function<bool(std::string_view what, double share)>& keep_going) {
  Undistorted result;
  Capture out = moved_to(capture, folder);
  if (!capture.variants.empty()) out.variants = {{"render", "renders/{variant}/{camera}/{light}.exr"}};
  std::error_code ignored;
  if (fs::exists(out.root / capture::kCaptureFile, ignored))
    throw files::UsageError("--out " + files::in_quotes(folder) + " has a capture already; name a new folder");
  if (std::none_of(capture.cameras.begin(), capture.cameras.end(), is_bent))
    throw files::UsageError("--undistort: no camera has distortion or skew (cameras.json: \"undistorted\": false)");
  std::size_t done = 0;
  for (std::size_t camera = 0; camera < capture.cameras.size(); ++camera) {
    if (!is_bent(capture.cameras[camera])) {
      done += static_cast<std::size_t>(std::count_if(capture.frames.begin(), capture.frames.end(),
                                                     [&](const auto& frame) { return frame.camera == camera; }));
      continue;
    }
    const Straightener straightener(capture.cameras[camera]);
    result.views.push_back(view_of(capture.cameras[camera], straightener));
    write_layers(capture, camera, straightener, out);
    for (std::size_t i = 0; i < capture.frames.size(); ++i) {
      capture::Frame& frame = out.frames[i];
      if (frame.camera != camera) continue;
      if (keep_going && !keep_going("undistort", static_cast<double>(done++) / double(capture.frames.size())))
        throw files::Interrupted{};
      if (!fs::exists(capture::photo_file(capture, capture.frames[i]), ignored)) {
        result.notes.push_back(frame.file.string() + " is not there; its frame names it still");
        continue;
      }
      const float full = capture::linear_of(frame.transfer, static_cast<float>(frame.clip));
      const fs::path file = file_of(capture, i);
      image::Attributes attributes{{"olat:camera", capture.cameras[camera].id}, {"olat:kind", "photo"}};
      if (frame.kind == capture::FrameKind::kOneLight) attributes["olat:light"] = capture.lights[frame.light].id;
      image::write_exr(out.root / file, straight_photo(capture, capture.frames[i], straightener, full), attributes);
      frame.file = file;
      frame.transfer = capture::Transfer::kLinear;
      frame.black = 0, frame.white = 1;
      frame.clip = std::isinf(frame.clip) ? frame.clip : static_cast<double>(full);
      frame.sha256.clear();
      ++result.files;
    }
    out.cameras[camera] = straightened(capture.cameras[camera]);
  }
  capture::write_capture(out);
  return result;
}

std::string text_of(const Undistorted& undistorted) {
  std::string out;
  for (const Undistorted::View& view : undistorted.views) {
    std::array<char, 96> numbers{};
    std::snprintf(numbers.data(), numbers.size(), "up to %.1f pixels straightened; the photo leaves %.1f %% open\n",
                  view.farthest_px, 100 * view.outside_share);
    out += view.camera + ": " + numbers.data();
  }
  out += std::to_string(undistorted.files) + " photographs written\n";
  for (const std::string& note : undistorted.notes) out += note + "\n";
  return out;
}

std::string json_of(const Undistorted& undistorted) {
  using Json = nlohmann::ordered_json;
  Json views = Json::array();
  for (const Undistorted::View& view : undistorted.views)
    views.push_back(
        {{"camera", view.camera}, {"farthest_px", view.farthest_px}, {"outside_share", view.outside_share}});
  return Json{{"type", "olat undistort"},
              {"version", 1},
              {"cameras", views},
              {"files", undistorted.files},
              {"notes", undistorted.notes}}
             .dump(1) +
         "\n";
}

}  // namespace likeness::olat_calibrate
