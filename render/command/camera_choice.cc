#include "render/command/camera_choice.h"

#include <unistd.h>

#include <charconv>
#include <string_view>
#include <vector>

#include "render/files/files.h"
#include "render/scene/loading.h"

namespace likeness::render_command {
namespace {

using files::UsageError;

// A whole number that is all of the text.
bool number_of(std::string_view text, std::size_t& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc{} && end == text.data() + text.size();
}

std::string gigabytes(std::size_t bytes) {
  return files::number_text(static_cast<double>(bytes / 100'000'000) / 10) + " GB";
}

}  // namespace

std::size_t camera_of(const scene::Scene& scene, const std::string& wanted) {
  if (wanted.empty()) return 0;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i)
    if (scene.cameras[i].name == wanted) return i;
  std::size_t index = 0;
  if (number_of(wanted, index) && index < scene.cameras.size()) return index;

  constexpr std::size_t kMostNames = 12;  // that a line holds
  std::string names;
  std::vector<std::string_view> known;
  for (const scene::Camera& camera : scene.cameras) {
    if (camera.name.empty()) continue;
    if (known.size() < kMostNames) names += (names.empty() ? "" : ", ") + files::in_quotes(camera.name);
    known.push_back(camera.name);
  }
  if (known.size() > kMostNames) names += ", ...";
  const std::size_t last = scene.cameras.size() - 1;
  const std::string numbers = last == 0 ? "0" : "0 to " + std::to_string(last);
  const std::string near = files::nearest_name(wanted, known.data(), known.size());
  throw UsageError("--camera " + files::in_quotes(wanted) + ": the scene has " +
                   (names.empty() ? "cameras " + numbers : names + " (or by number, " + numbers + ")") +
                   (near.empty() ? "" : "; did you mean " + near + "?"));
}

Size size_of(const std::string& text) {
  const std::size_t x = text.find_first_of("xX");
  std::size_t width = 0, height = 0;
  if (x == text.npos || !number_of(std::string_view(text).substr(0, x), width) ||
      !number_of(std::string_view(text).substr(x + 1), height) || width == 0 || height == 0)
    throw UsageError("--size " + files::in_quotes(text) + " is no size; expected WIDTHxHEIGHT, as 640x360");
  constexpr std::size_t kLongest = 65536;
  if (width > kLongest || height > kLongest || width * height > scene::kMostPixels)
    throw UsageError("--size " + files::in_quotes(text) + " is too large: at most 65536 on a side and " +
                     std::to_string(scene::kMostPixels >> 20) + " million pixels (16384x16384)");
  return {static_cast<int>(width), static_cast<int>(height)};
}

void resize(scene::Camera& camera, const Size& size) {
  const double scale = static_cast<double>(size.height) / camera.height;
  camera.center_x = (camera.center_x - 0.5 * camera.width) * scale + 0.5 * size.width;
  camera.center_y *= scale;
  camera.focal_x *= scale, camera.focal_y *= scale;
  camera.width = size.width, camera.height = size.height;
}

std::size_t picture_bytes(const scene::Camera& camera, bool has_layers, std::size_t light_layers) {
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  // An interrupted render has at once: the film, its layers, its state, and the file of that in a memory that grew to it.
  const std::size_t film = has_layers ? 184 : 64, written = has_layers ? 144 : 24, state = has_layers ? 200 : 80;
  return pixels * (film + written + 3 * state + 2 * 16 * light_layers + 32);
}

void check_memory(const scene::Camera& camera, bool has_layers, std::size_t light_layers, std::size_t available) {
  const std::size_t needed = picture_bytes(camera, has_layers, light_layers);
  if (needed <= available) return;
  throw UsageError("--size " + std::to_string(camera.width) + "x" + std::to_string(camera.height) + " needs up to " +
                   gigabytes(needed) + " of memory, and this machine has " + gigabytes(available) +
                   "; choose a smaller one" +
                   (has_layers || light_layers > 0 ? ", or leave --layers and --light-layers out" : ""));
}

std::size_t memory_of_machine() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && size > 0 ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(size)
                               : ~static_cast<std::size_t>(0);
}

}  // namespace likeness::render_command
