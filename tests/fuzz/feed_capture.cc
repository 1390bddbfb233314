#include "tests/fuzz/feed_capture.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "olat/import/colmap.h"
#include "olat/import/light_lists.h"
#include "render/capture/files_of_capture.h"
#include "render/files/files.h"

namespace likeness::capture::test {
namespace {

void must(bool promise, const std::string& text) {
  if (!promise) throw std::logic_error(text);
}

template <std::size_t N>
std::array<std::string_view, N> parts_of(std::string_view bytes) {
  std::array<std::string_view, N> out;
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t at = i + 1 < N ? bytes.find(kPart) : bytes.npos;
    out[i] = bytes.substr(0, at);
    bytes = at == bytes.npos ? std::string_view() : bytes.substr(at + kPart.size());
  }
  return out;
}

void check_capture(const Capture& capture) {
  const FrameTable table(capture);
  for (const Frame& frame : capture.frames) {
    must(frame.camera < capture.cameras.size(), "a frame has a camera");
    must(!is_of_one_light(frame.kind) || frame.light < capture.lights.size(), "a frame of one light has it");
    must(frame.white > frame.black && frame.gain > 0, "a frame can be decoded");
    for (const auto& part : frame.file) must(part != "..", "no file is above the folder by ..");
  }
  for (const Variant& variant : capture.variants)
    for (const auto& part : std::filesystem::path(variant.pattern)) must(part != "..", "no render is above the folder");
  for (const Camera& camera : capture.cameras)
    must(std::abs(glm::determinant(glm::dmat3(camera.world_from_camera)) - 1) < 1e-9, "a camera is turned and moved");
  must(texts_of(capture_of(texts_of(capture), "/fuzz")).frames == texts_of(capture).frames,
       "what was read is written and read again");
}

void check_lights(const olat_import::LightList& list) {
  must(!list.lights.empty(), "a list has lights");
  for (const auto& one : list.lights) {
    if (const auto* distant = std::get_if<DistantLight>(&one.light.place))
      must(std::abs(glm::length(distant->to_light) - 1) < 1e-9, "a direction is unit");
    for (int c = 0; c < 3; ++c) must(one.light.intensity[c] > 0, "an intensity is above 0");
  }
}

void check_cameras(const std::vector<olat_import::PosedPicture>& pictures) {
  for (const auto& one : pictures) {
    must(!one.file.empty() && one.camera.intrinsics[0][0] > 0, "a picture has a name and a lens");
    must(std::abs(glm::determinant(glm::dmat3(one.camera.world_from_camera)) - 1) < 1e-6, "a camera is turned");
  }
}

}  // namespace

bool feed_capture(std::string_view format, std::string_view bytes) {
  try {
    if (format == "capture") {
      const auto parts = parts_of<4>(bytes);
      check_capture(capture_of(
          {std::string(parts[0]), std::string(parts[1]), std::string(parts[2]), std::string(parts[3])}, "/fuzz"));
    } else if (format == "lights_csv") {
      check_lights(olat_import::read_lights_csv(bytes, "fuzz"));
    } else if (format == "lp") {
      check_lights(olat_import::read_lp(bytes, "fuzz"));
    } else if (format == "dome") {
      check_lights(olat_import::read_dome(bytes, "fuzz", 0.01));
    } else {
      const auto parts = parts_of<2>(bytes);
      check_cameras(format == "colmap" ? olat_import::read_colmap_text(parts[0], parts[1], "fuzz", "fuzz", 1)
                                       : olat_import::read_colmap_binary(parts[0], parts[1], "fuzz", "fuzz", 1));
    }
  } catch (const files::InputError& error) {
    const std::string_view message = error.what();
    must(message.find('\n') == message.npos, "a message is one line");
    must(message.find(": ") != message.npos, "a message names the place");
    return false;
  }
  return true;
}

}  // namespace likeness::capture::test
