#pragma once

#include <limits>

#include "render/capture/files_of_capture.h"

namespace likeness::capture::test {

// Two cameras, three lights of every kind, a frame of every kind, and a value in every field.
inline Capture small_capture(const std::filesystem::path& root) {
  Capture out;
  out.root = root;
  out.name = "two views";
  out.up = {0, 0, 1};
  Camera front;
  front.id = "front";
  front.label = "in front";
  front.width = 4;
  front.height = 3;
  front.intrinsics = glm::dmat3(5, 0, 0, 0.25, 6, 0, 2.5, 1.5, 1);
  front.distortion = {0.1, -0.2, 1e-3, 2e-3, 0.3};
  front.is_undistorted = false;
  front.world_from_camera = glm::dmat4(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0.1, 0.2, 3, 1);
  front.rec709_from_camera = glm::dmat3(2, -0.5, 0, -1, 1.75, 0.125, 0, -0.25, 0.875);
  Camera side = front;
  side.id = "side view";
  side.label = "";
  side.is_orthographic = true;
  side.distortion = {};
  side.is_undistorted = true;
  side.rec709_from_camera = glm::dmat3(1);
  out.cameras = {front, side};
  out.lights = {{"l1", "key", DistantLight{{0.6, 0, 0.8}}, {1, 2, 3}, "lights.csv"},
                {"l2", "", NearLight{{0.1, -2, 3}}, {0.5, 0.5, 0.5}, ""},
                {"l3", "", {}, {1, 1, 1}, ""}};
  for (std::size_t camera = 0; camera < 2; ++camera)
    for (std::size_t light = 0; light < 3; ++light) {
      Frame& frame = out.frames.emplace_back();
      frame.camera = camera;
      frame.light = light;
      frame.file = "photos/" + out.cameras[camera].id + "/" + out.lights[light].id + ".exr";
    }
  Frame& odd = out.frames[1];
  odd.transfer = Transfer::kSrgb;
  odd.primaries = Primaries::kCamera;
  odd.black = 0.125;
  odd.white = 0.75;
  odd.clip = std::numeric_limits<double>::infinity();
  odd.gain = 2;
  odd.exposure_s = 0.01;
  odd.iso = 100;
  odd.f_number = 5.6;
  odd.sha256 = std::string(64, 'a');
  odd.file = "/elsewhere/l2.png";
  out.frames[2].clip = 0.9;
  out.frames.push_back({.camera = 1, .kind = FrameKind::kAmbient, .file = "photos/dark.exr"});
  out.frames.push_back({.camera = 1, .kind = FrameKind::kFull, .file = "photos/full.exr"});
  out.layers = {{0, Layer::kMask, "aux/front/mask.png"}, {1, Layer::kNormal, "/elsewhere/normal.pfm"}};
  out.variants = {{"plain", "renders/{variant}/{camera}/{light}.exr"}, {"truth", "truth/{camera}_{light}.exr"}};
  out.pipeline = {"light", -1.5, "agx"};
  out.noise_floor = {{1e-4, 2e-4, 3e-4}, {0, 0, 0}};
  out.flip_first_ev = -2;
  out.flip_last_ev = 1;
  out.license = "CC0";
  out.citation = "nobody \"quoted\"";
  out.source = "made here";
  return out;
}

// Its four files, as tests/fuzz parts them.
inline std::string small_texts() {
  const CaptureTexts texts = texts_of(small_capture("/c"));
  const std::string part = "\n====\n";
  return texts.capture + part + texts.cameras + part + texts.lights + part + texts.frames;
}

}  // namespace likeness::capture::test
