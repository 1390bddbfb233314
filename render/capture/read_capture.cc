#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>

#include <glm/geometric.hpp>

#include "render/capture/files_of_capture.h"
#include "render/capture/format.h"
#include "render/files/files.h"
#include "render/json/fields.h"

namespace likeness::capture {
namespace {

using files::in_quotes;
using json::Fields;
using Places = std::unordered_map<std::string, std::size_t>;

// One of the four files: its text as a tree, checked to be what it says.
class File {
 public:
  File(const std::string& text, const std::string& name, const json::Section& section, std::string_view type)
      : name_(name), tree_(json::parse(text, name_)), fields_(name_, tree_, section, "") {
    if (fields_.text("type") != type)
      fields_.refuse("type", " is " + in_quotes(fields_.text("type")) + "; expected " + in_quotes(type));
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  const Fields& fields() const { return fields_; }

 private:
  std::string name_;
  json::Value tree_;
  Fields fields_;
};

std::string id_of(const Fields& row, Places& places, std::size_t most) {
  std::string id = row.text("id");
  if (!is_id(id))
    row.refuse("id", " = " + in_quotes(id) +
                         " cannot be an id; expected 1 to 120 bytes without / \\ and control characters, not . or ..");
  if (!places.emplace(id, places.size()).second) row.refuse("id", " = " + in_quotes(id) + " stands twice");
  if (places.size() > most) row.refuse("id", " is beyond the " + std::to_string(most) + " rows that are allowed");
  return id;
}

std::size_t place_at(const Fields& fields, std::string_view key, const std::string& id, const Places& places,
                     std::string_view list) {
  if (const auto at = places.find(id); at != places.end()) return at->second;
  std::vector<std::string_view> names;
  for (const auto& [name, place] : places) names.push_back(name);
  std::sort(names.begin(), names.end());
  fields.refuse(key, " = " + in_quotes(id) + " is not in " + std::string(list) + json::near_text(id, names));
}

std::filesystem::path file_of(const Fields& fields, std::string_view key, bool may_be_absolute) {
  std::filesystem::path file = fields.text(key);
  if (file.empty()) fields.refuse(key, " is empty; expected the name of a file");
  if (file.native().find('\0') != std::string::npos) fields.refuse(key, " holds a zero byte");
  if (file.is_absolute() && !may_be_absolute)
    fields.refuse(key, " = " + in_quotes(file.string()) + " is absolute; expected a file below the capture's folder");
  if (std::find(file.begin(), file.end(), "..") != file.end())
    fields.refuse(key, " = " + in_quotes(file.string()) + " leaves the folder by ..; " +
                           (may_be_absolute ? "an absolute path may name a file elsewhere"
                                            : "expected a file below the capture's folder"));
  return file;
}

// The word's place in the list of the key, which the words were checked against.
template <class Enum>
Enum word_of(const Fields& fields, std::string_view key) {
  const auto choices = fields.section().find(key)->choices;
  return static_cast<Enum>(std::find(choices.begin(), choices.end(), fields.text(key)) - choices.begin());
}

// What distortion means and its numbers; files of version 1 have neither fisheyes nor k4 k5 k6.
void read_lens(const Fields& row, int version, Camera& out) {
  constexpr std::size_t kTermsOfVersion1 = 5;
  out.lens = word_of<Lens>(row, "lens");
  if (version < kCamerasVersion && row.has("lens")) row.refuse("lens", " needs \"version\": 2 of cameras.json");
  if (!row.has("distortion")) return;
  const std::vector<double> terms = row.numbers("distortion");
  const std::size_t most = kLensTerms[static_cast<std::size_t>(out.lens)];
  if (terms.size() > most)
    row.refuse("distortion", " has " + std::to_string(terms.size()) + " numbers; expected at most " +
                                 (out.lens == Lens::kFisheye ? "4: k1 k2 k3 k4" : "8: k1 k2 p1 p2 k3 k4 k5 k6"));
  if (version < kCamerasVersion && terms.size() > kTermsOfVersion1)
    row.refuse("distortion",
               " has " + std::to_string(terms.size()) + " numbers; more than 5 need \"version\": 2 of cameras.json");
  std::copy(terms.begin(), terms.end(), out.distortion.begin());
}

Camera camera_at(const Fields& row, int version, Places& places) {
  Camera out;
  out.id = id_of(row, places, kMostCameras);
  out.label = row.text("label");
  out.width = row.whole("width");
  out.height = row.whole("height");
  out.is_orthographic = row.flag("orthographic");
  const glm::dvec2 focal = row.pair("focal_px");
  const glm::dvec2 center = row.has("center_px") ? row.pair("center_px") : 0.5 * glm::dvec2(out.width, out.height);
  out.intrinsics = glm::dmat3(focal.x, 0, 0, row.number("skew"), focal.y, 0, center.x, center.y, 1);
  read_lens(row, version, out);
  out.is_undistorted = row.flag("undistorted");
  out.world_from_camera = row.rigid("world_from_camera");
  if (row.has("rec709_from_camera")) {
    const std::vector<double> m = row.numbers("rec709_from_camera");
    if (m.size() != 9)
      row.refuse("rec709_from_camera", " has " + std::to_string(m.size()) + " numbers; expected 9, row by row");
    for (std::size_t i = 0; i < 9; ++i) out.rec709_from_camera[int(i % 3)][int(i / 3)] = m[i];
  }
  return out;
}

Light light_at(const Fields& row, Places& places) {
  Light out;
  out.id = id_of(row, places, kMostLights);
  out.label = row.text("label");
  row.only_one_of("direction", "position");
  if (row.has("direction")) {
    // What is unit already keeps its bits: a digest of it holds when the file is written again.
    const glm::dvec3 given = row.vector("direction");
    out.place = DistantLight{std::abs(glm::length(given) - 1) < 1e-14 ? given : row.direction("direction")};
  }
  if (row.has("position")) out.place = NearLight{row.vector("position")};
  out.intensity = row.vector("intensity");
  out.calibrated_by = row.text("calibrated_by");
  return out;
}

void read_encoding(const Fields& row, Frame& out) {
  if (row.has("transfer")) out.transfer = word_of<Transfer>(row, "transfer");
  if (row.has("primaries")) out.primaries = word_of<Primaries>(row, "primaries");
  if (row.has("black")) out.black = row.number("black");
  if (row.has("white")) out.white = row.number("white");
  if ((row.has("black") || row.has("white")) && !(out.white > out.black))
    row.refuse(row.has("white") ? "white" : "black",
               ": white = " + files::number_text(out.white) + " is not above black = " + files::number_text(out.black));
  row.only_one_of("clip", "never_clips");
  if (row.has("clip")) out.clip = row.number("clip");
  if (row.flag("never_clips")) out.clip = std::numeric_limits<double>::infinity();
  if (row.has("gain")) out.gain = row.number("gain");
  if (row.has("exposure_s")) out.exposure_s = row.number("exposure_s");
  if (row.has("iso")) out.iso = row.number("iso");
  if (row.has("f_number")) out.f_number = row.number("f_number");
}

// Where each id stands in its list.
struct Ids {
  Places cameras, lights;
};

std::vector<std::size_t> places_of(const Fields& fields, std::string_view key, const Places& places,
                                   std::string_view list) {
  std::vector<std::size_t> out;
  if (!fields.has(key))
    for (std::size_t i = 0; i < places.size(); ++i) out.push_back(i);
  for (const std::string& id : fields.texts(key)) out.push_back(place_at(fields, key, id, places, list));
  return out;
}

void read_frames(const Fields& file, const Ids& ids, Capture& capture) {
  Frame defaults;
  if (const auto fields = file.object("defaults")) read_encoding(*fields, defaults);

  // Rows come first: a pair that a row names is left out of the patterns.
  std::vector<bool> named(ids.cameras.size() * ids.lights.size());
  std::vector<Frame> rows;
  for (const Fields& row : file.list("frames")) {
    Frame out = defaults;
    out.camera = place_at(row, "camera", row.text("camera"), ids.cameras, kCamerasFile);
    out.kind = word_of<FrameKind>(row, "kind");
    if (is_of_one_light(out.kind) && !row.has("light")) row.refuse("/light is missing: a frame of one light");
    if (row.has("light")) out.light = place_at(row, "light", row.text("light"), ids.lights, kLightsFile);
    out.file = file_of(row, "file", true);
    out.sha256 = row.text("sha256");
    if (!out.sha256.empty() &&
        (out.sha256.size() != 64 || out.sha256.find_first_not_of("0123456789abcdef") != std::string::npos))
      row.refuse("sha256", " = " + in_quotes(out.sha256) + "; expected 64 hexadecimal digits in small letters");
    read_encoding(row, out);
    if (out.kind == FrameKind::kOneLight) named[out.camera * ids.lights.size() + out.light] = true;
    rows.push_back(std::move(out));
  }
  for (const Fields& pattern : file.list("patterns")) {
    Frame out = defaults;
    read_encoding(pattern, out);
    const std::string files = file_of(pattern, "file", true).string();
    const auto cameras = places_of(pattern, "cameras", ids.cameras, kCamerasFile);
    const auto lights = places_of(pattern, "lights", ids.lights, kLightsFile);
    if (cameras.size() * lights.size() + capture.frames.size() + rows.size() > kMostFrames)
      pattern.refuse("file", " makes more than " + std::to_string(kMostFrames) + " frames");
    for (const std::size_t camera : cameras)
      for (const std::size_t light : lights) {
        if (named[camera * ids.lights.size() + light]) continue;
        out.camera = camera;
        out.light = light;
        out.file = filled(files, capture.cameras[camera].id, capture.lights[light].id);
        capture.frames.push_back(out);
      }
  }
  capture.frames.insert(capture.frames.end(), std::make_move_iterator(rows.begin()),
                        std::make_move_iterator(rows.end()));
}

void read_cameras(const Fields& file, Ids& ids, Capture& capture) {
  bool has_noise = false;
  for (const Fields& row : file.list("cameras")) {
    capture.cameras.push_back(camera_at(row, file.whole("version"), ids.cameras));
    has_noise = has_noise || row.has("noise_floor");
    capture.noise_floor.push_back(row.vector("noise_floor"));
    if (const auto layers = row.object("layers"))
      for (std::size_t i = 0; i < kLayers.size(); ++i)
        if (layers->has(kLayers[i]))
          capture.layers.push_back(
              {capture.cameras.size() - 1, static_cast<Layer>(i), file_of(*layers, kLayers[i], true)});
  }
  if (!has_noise) capture.noise_floor.clear();
  if (capture.cameras.empty()) file.refuse("cameras", " is empty; expected one at least");
}

void read_lights(const Fields& file, Ids& ids, Capture& capture) {
  for (const Fields& row : file.list("lights")) capture.lights.push_back(light_at(row, ids.lights));
  if (capture.cameras.size() * capture.lights.size() > kMostPairs)
    file.refuse("lights", " and the cameras make " + std::to_string(capture.cameras.size() * capture.lights.size()) +
                              " pairs; expected at most " + std::to_string(kMostPairs));
}

void read_whole(const Fields& file, Capture& capture) {
  capture.name = file.text("name");
  capture.up = file.direction("up");
  Places variants;
  for (const Fields& row : file.list("variants")) {
    Variant& out = capture.variants.emplace_back();
    out.id = id_of(row, variants, kMostVariants);
    out.pattern = row.text("pattern");
    if (row.has("pattern")) file_of(row, "pattern", false);
    if (out.pattern.find("{camera}") == std::string::npos)
      row.refuse("pattern", " = " + in_quotes(out.pattern) +
                                " has no {camera}: cameras would share a file (for example "
                                "renders/{variant}/{camera}/{light}.exr)");
  }
  if (const auto pipeline = file.object("pipeline"))
    capture.pipeline = {pipeline->text("match_gain"), pipeline->number("ev"), pipeline->text("view")};
  if (const auto flip = file.object("flip")) {
    capture.flip_first_ev = flip->number("first_ev");
    capture.flip_last_ev = flip->number("last_ev");
    if (!(capture.flip_first_ev <= capture.flip_last_ev))
      flip->refuse("last_ev", " = " + files::number_text(capture.flip_last_ev) + " is below first_ev");
  }
  capture.license = file.text("license");
  capture.citation = file.text("citation");
  capture.source = file.text("source");
}

}  // namespace

Capture capture_of(const CaptureTexts& texts, const std::filesystem::path& root) {
  Capture out;
  out.root = root;
  Ids ids;
  const auto name = [&](std::string_view file) { return (root / file).string(); };
  {
    const File file(texts.capture, name(kCaptureFile), kCaptureSection, kCaptureType);
    read_whole(file.fields(), out);
  }
  {
    const File file(texts.cameras, name(kCamerasFile), kCamerasSection, kCamerasType);
    read_cameras(file.fields(), ids, out);
  }
  {
    const File file(texts.lights, name(kLightsFile), kLightsSection, kLightsType);
    read_lights(file.fields(), ids, out);
  }
  const File file(texts.frames, name(kFramesFile), kFramesSection, kFramesType);
  read_frames(file.fields(), ids, out);
  return out;
}

Capture read_capture(const std::filesystem::path& path) {
  std::error_code error;
  const bool is_folder = std::filesystem::is_directory(path, error);
  const std::filesystem::path root = is_folder ? path : path.parent_path();
  if (is_folder && !std::filesystem::exists(path / kCaptureFile, error))
    throw files::InputError(path.string() + ": is no capture: the folder has no capture.json (likeness olat import " +
                            "makes one from a folder of photographs)");
  const auto read = [&](std::string_view file) { return files::read_whole(root / file, kMostCaptureBytes); };
  CaptureTexts texts;
  texts.capture = files::read_whole(is_folder ? path / kCaptureFile : path, kMostCaptureBytes);
  texts.cameras = read(kCamerasFile);
  texts.lights = read(kLightsFile);
  texts.frames = read(kFramesFile);
  return capture_of(texts, root);
}

}  // namespace likeness::capture
