#include "olat/import/colmap.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/scene/words.h"

namespace likeness::olat_import {
namespace {

using capture::Camera;
using files::in_quotes;
using files::InputError;

struct Model {
  std::string_view name;
  int number;          // in binary files
  std::size_t params;  // how many
  std::size_t focals;  // 1: f, or 2: fx fy
  capture::Lens lens = capture::Lens::kBrownConrady;
};
constexpr std::array kModels{
    Model{"SIMPLE_PINHOLE", 0, 3, 1}, Model{"PINHOLE", 1, 4, 2},
    Model{"SIMPLE_RADIAL", 2, 4, 1},  Model{"RADIAL", 3, 5, 1},
    Model{"OPENCV", 4, 8, 2},         Model{"OPENCV_FISHEYE", 5, 8, 2, capture::Lens::kFisheye},
    Model{"FULL_OPENCV", 6, 12, 2},
};
constexpr const char* kNotRead =
    " is not read (SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV and OPENCV_FISHEYE are); "
    "undistort "
    "the pictures with COLMAP's image_undistorter, which makes PINHOLE";
constexpr std::size_t kMostFileBytes = std::size_t{1} << 30;

using Lenses = std::map<std::int64_t, Camera>;

Camera lens_of(const Model& model, double width, double height, const std::array<double, 12>& p,
               const std::string& place) {
  if (!(width >= 1 && width <= 65536 && height >= 1 && height <= 65536))
    throw InputError(place + ": a picture of " + files::number_text(width) + " x " + files::number_text(height) +
                     " pixels; expected 1 to 65536 a side");
  for (std::size_t i = 0; i < model.params; ++i)
    if (!(std::abs(p[i]) < 1e9)) throw InputError(place + ": a parameter of the lens is not finite or above 1e9");
  Camera out;
  out.width = static_cast<int>(width);
  out.height = static_cast<int>(height);
  const double fx = p[0], fy = p[model.focals - 1];
  if (!(fx > 0 && fy > 0)) throw InputError(place + ": the focal length is not above 0");
  const std::size_t at = model.focals;
  out.intrinsics = glm::dmat3(fx, 0, 0, 0, fy, 0, p[at], p[at + 1], 1);
  for (std::size_t i = at + 2; i < model.params; ++i) out.distortion[i - at - 2] = p[i];
  out.lens = model.lens;
  // A fisheye whose numbers are all 0 is no pinhole.
  out.is_undistorted = out.lens == capture::Lens::kBrownConrady && out.distortion == decltype(out.distortion){};
  return out;
}

// World from camera, of COLMAP's camera from world.
glm::dmat4 place_of(const std::array<double, 7>& v, double meters, const std::string& place) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
  if (!(length > 1e-6 && length < 1e6)) throw InputError(place + ": the rotation is no quaternion");
  const glm::dquat turn(v[0] / length, v[1] / length, v[2] / length, v[3] / length);
  const glm::dmat3 world_from_camera = glm::transpose(glm::mat3_cast(turn));
  const glm::dvec3 position = -(world_from_camera * glm::dvec3(v[4], v[5], v[6])) * meters;
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(position[c]) < 1e9)) throw InputError(place + ": the position is not finite or above 1e9 m");
  glm::dmat4 out(world_from_camera);
  out[3] = glm::dvec4(position, 1);
  return out;
}

void add(std::vector<PosedPicture>& out, const Lenses& lenses, std::int64_t lens, const std::array<double, 7>& v,
         std::string file, double meters, const std::string& place) {
  const auto at = lenses.find(lens);
  if (at == lenses.end()) throw InputError(place + ": camera " + std::to_string(lens) + " is not among the cameras");
  if (file.empty()) throw InputError(place + ": a picture without a name");
  PosedPicture& one = out.emplace_back();
  one.file = std::move(file);
  one.camera = at->second;
  one.camera.world_from_camera = place_of(v, meters, place);
  if (out.size() > capture::kMostCameras)
    throw InputError(place + ": more than " + std::to_string(capture::kMostCameras) + " pictures");
}

// Little-endian numbers of a binary file.
class Bytes {
 public:
  Bytes(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}
  template <class T>
  T take() {
    T out;
    std::memcpy(&out, block(sizeof out).data(), sizeof out);
    return out;
  }
  std::string_view block(std::size_t size) {
    if (size > bytes_.size() - at_) throw InputError(place() + ": the file ends too early");
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }
  std::string text() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == bytes_.npos) throw InputError(place() + ": a name does not end");
    const std::string out(block(end - at_));
    ++at_;
    return out;
  }
  std::string place() const { return name_ + ": byte " + std::to_string(at_); }

 private:
  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

std::string at_line(const std::string& name, const scene::Words& words) {
  return name + ":" + std::to_string(words.line());
}

// To the next line that is neither empty nor a comment; false at the end.
bool next_row(scene::Words& words) {
  while (true) {
    words.skip_blank_lines();
    if (words.is_at_end()) return false;
    scene::Words ahead = words;
    if (!ahead.next().starts_with('#')) return true;
    words.skip_line();
  }
}

Lenses lenses_of_text(std::string_view text, const std::string& name) {
  Lenses out;
  for (scene::Words words(text); next_row(words); words.skip_line()) {
    std::int64_t id = 0;
    double width = 0, height = 0;
    const std::string place = at_line(name, words);
    if (!words.number(id)) throw InputError(place + ": expected CAMERA_ID MODEL WIDTH HEIGHT PARAMS");
    const std::string_view model_name = words.next();
    const Model* model = nullptr;
    for (const Model& one : kModels)
      if (one.name == model_name) model = &one;
    if (!model) throw InputError(place + ": the lens model " + in_quotes(model_name) + kNotRead);
    std::array<double, 12> params{};
    bool fits = words.number(width) && words.number(height);
    for (std::size_t i = 0; i < model->params; ++i) fits = fits && words.number(params[i]);
    if (!fits || !words.rest().empty())
      throw InputError(place + ": " + std::string(model_name) + " has a width, a height and " +
                       std::to_string(model->params) + " numbers");
    if (!out.emplace(id, lens_of(*model, width, height, params, place)).second)
      throw InputError(place + ": camera " + std::to_string(id) + " stands twice");
  }
  return out;
}

}  // namespace

std::vector<PosedPicture> read_colmap_text(std::string_view cameras, std::string_view images,
                                           const std::string& cameras_name, const std::string& images_name,
                                           double meters) {
  const Lenses lenses = lenses_of_text(cameras, cameras_name);
  std::vector<PosedPicture> out;
  for (scene::Words words(images); next_row(words);) {
    const std::string place = at_line(images_name, words);
    std::int64_t id = 0, lens = 0;
    std::array<double, 7> v{};
    bool fits = words.number(id);
    for (double& number : v) fits = fits && words.number(number);
    if (!fits || !words.number(lens))
      throw InputError(place + ": expected IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME");
    add(out, lenses, lens, v, std::string(words.rest()), meters, place);
    words.skip_line();
    words.skip_line();  // its points
  }
  if (out.empty()) throw InputError(images_name + ": has no pictures");
  return out;
}

std::vector<PosedPicture> read_colmap_binary(std::string_view cameras, std::string_view images,
                                             const std::string& cameras_name, const std::string& images_name,
                                             double meters) {
  Lenses lenses;
  Bytes lens_bytes(cameras, cameras_name);
  for (std::uint64_t left = lens_bytes.take<std::uint64_t>(); left > 0; --left) {
    const std::string place = lens_bytes.place();
    const auto id = lens_bytes.take<std::int32_t>();
    const auto number = lens_bytes.take<std::int32_t>();
    const Model* model = nullptr;
    for (const Model& one : kModels)
      if (one.number == number) model = &one;
    if (!model) throw InputError(place + ": the lens model " + std::to_string(number) + kNotRead);
    const auto width = static_cast<double>(lens_bytes.take<std::uint64_t>());
    const auto height = static_cast<double>(lens_bytes.take<std::uint64_t>());
    std::array<double, 12> params{};
    for (std::size_t i = 0; i < model->params; ++i) params[i] = lens_bytes.take<double>();
    if (!lenses.emplace(id, lens_of(*model, width, height, params, place)).second)
      throw InputError(place + ": camera " + std::to_string(id) + " stands twice");
  }
  std::vector<PosedPicture> out;
  Bytes bytes(images, images_name);
  for (std::uint64_t left = bytes.take<std::uint64_t>(); left > 0; --left) {
    const std::string place = bytes.place();
    bytes.take<std::int32_t>();  // its id
    std::array<double, 7> v{};
    for (double& number : v) number = bytes.take<double>();
    const auto lens = bytes.take<std::int32_t>();
    std::string file = bytes.text();
    const auto points = bytes.take<std::uint64_t>();
    constexpr std::size_t kPoint = 24;
    if (points > images.size() / kPoint) throw InputError(place + ": more points than the file has bytes for");
    bytes.block(points * kPoint);
    add(out, lenses, lens, v, std::move(file), meters, place);
  }
  if (out.empty()) throw InputError(images_name + ": has no pictures");
  return out;
}

std::filesystem::path colmap_folder(const std::filesystem::path& folder) {
  std::error_code error;
  for (const char* inner : {"", "sparse/0", "sparse", "0"})
    for (const char* ending : {".txt", ".bin"}) {
      const std::filesystem::path at = *inner ? folder / inner : folder;
      if (std::filesystem::exists(at / (std::string("cameras") + ending), error) &&
          std::filesystem::exists(at / (std::string("images") + ending), error))
        return at;
    }
  return {};
}

std::vector<PosedPicture> read_colmap(const std::filesystem::path& folder, double meters) {
  const std::filesystem::path at = colmap_folder(folder);
  if (at.empty())
    throw InputError(folder.string() +
                     ": has neither cameras.txt and images.txt nor cameras.bin and images.bin of COLMAP");
  std::error_code error;
  const bool is_text = std::filesystem::exists(at / "cameras.txt", error);
  const std::filesystem::path cameras = at / (is_text ? "cameras.txt" : "cameras.bin");
  const std::filesystem::path images = at / (is_text ? "images.txt" : "images.bin");
  const std::string a = files::read_whole(cameras, kMostFileBytes), b = files::read_whole(images, kMostFileBytes);
  return (is_text ? read_colmap_text : read_colmap_binary)(a, b, cameras.string(), images.string(), meters);
}

}  // namespace likeness::olat_import
