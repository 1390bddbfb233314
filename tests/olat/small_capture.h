#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>

#include "render/capture/capture.h"
#include "render/capture/files_of_capture.h"
#include "render/image/picture.h"
#include "render/image/write.h"

// A small capture on disk: a bump under distant lights, with light from 2^-10 to beyond white, negative noise, a mask, a
// render that is half a stop too dark at one light, and one pair without a render.
namespace likeness::test {

inline image::Picture bump(int width, int height, double phase, double gain) {
  image::Picture out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = (x + 0.5) / width, v = (y + 0.5) / height;
      const double light = std::exp2(-10 + 12.5 * u) * (0.75 + 0.25 * std::sin(9 * v + phase));
      out.at(x, y)[0] = static_cast<float>(gain * light * (0.6 + 0.4 * v));
      out.at(x, y)[1] = static_cast<float>(gain * light * (0.9 - 0.3 * v));
      out.at(x, y)[2] = static_cast<float>(gain * light * (0.5 + 0.3 * std::cos(5 * u)));
      if (x < 2) out.at(x, y)[1] = -0.002f;  // noise about black
    }
  return out;
}

struct SmallCapture {
  int cameras = 2, lights = 5, width = 64, height = 48;
  double dark_stops = 0.5;  // of the render at light 2
  double gain = 1;          // of all light
  bool with_renders = true, with_mask = true;
  bool is_repeated = false;  // the first pair's files for all: quick to make where they are large
};

inline capture::Capture write_small_capture(const std::filesystem::path& root, const SmallCapture& want = {}) {
  capture::Capture out;
  out.root = root;
  out.name = "small";
  for (int c = 0; c < want.cameras; ++c) {
    capture::Camera camera;
    camera.id = "c" + std::to_string(c);
    camera.width = want.width;
    camera.height = want.height;
    camera.intrinsics = {100, 0, 0, 0, 100, 0, want.width / 2.0, want.height / 2.0, 1};
    out.cameras.push_back(camera);
  }
  for (int l = 0; l < want.lights; ++l) {
    capture::Light light;
    light.id = "l" + std::to_string(l);
    const double angle = 2.4 * l, z = -1 + 1.6 * (l + 0.5) / want.lights, r = std::sqrt(1 - z * z);
    light.place = capture::DistantLight{{r * std::cos(angle), r * std::sin(angle), z}};
    out.lights.push_back(light);
  }
  if (want.with_renders) out.variants.push_back({"truth", "renders/truth/{camera}/{light}.exr"});
  for (int c = 0; c < want.cameras; ++c)
    for (int l = 0; l < want.lights; ++l) {
      const std::string name = "c" + std::to_string(c) + "/l" + std::to_string(l) + ".exr";
      capture::Frame frame;
      frame.camera = static_cast<std::size_t>(c);
      frame.light = static_cast<std::size_t>(l);
      frame.file = "photos/" + name;
      frame.clip = 3;
      out.frames.push_back(frame);
      const double phase = l + 0.3 * c;
      if (want.is_repeated && c + l > 0) {
        for (const char* kind : {"photos", "renders/truth"}) {
          std::filesystem::create_directories(root / kind / ("c" + std::to_string(c)));
          std::filesystem::copy_file(root / kind / "c0/l0.exr", root / kind / name);
        }
        continue;
      }
      image::write_exr(root / "photos" / name, bump(want.width, want.height, phase, want.gain));
      const bool is_absent = c == want.cameras - 1 && l == want.lights - 1;
      if (want.with_renders && !is_absent)
        image::write_exr(
            root / "renders" / "truth" / name,
            bump(want.width, want.height, phase + 0.05, want.gain * (l == 2 ? std::exp2(-want.dark_stops) : 1)));
    }
  if (want.with_mask) {
    image::Picture mask(want.width, want.height);
    for (int y = 4; y < want.height - 4; ++y)
      for (int x = 0; x < want.width; ++x)
        for (float& v : mask.at(x, y)) v = 1;
    image::write_exr(root / "aux" / "mask.exr", mask);
    out.layers.push_back({0, capture::Layer::kMask, "aux/mask.exr"});
  }
  out.noise_floor.assign(out.cameras.size(), {2e-4, 2e-4, 2e-4});
  capture::write_capture(out);
  return out;
}

}  // namespace likeness::test
