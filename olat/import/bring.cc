#include "olat/import/bring.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "olat/import/colmap.h"
#include "olat/import/color_space.h"
#include "olat/import/light_lists.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/format.h"
#include "render/files/files.h"
#include "render/image/read.h"

namespace likeness::olat_import {
namespace {

namespace fs = std::filesystem;
using capture::Camera;
using capture::Capture;
using capture::Frame;
using files::in_quotes;
using files::InputError;
using files::UsageError;

// What PATH holds.
struct Found {
  fs::path folder, lights, cameras;  // lights and cameras: empty if there are none
};

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; at != end; at.increment(error)) {
    if (error) break;
    if (at->is_regular_file(error)) out.push_back(at->path());
  }
  if (error) throw InputError(folder.string() + ": cannot be listed (" + error.message() + ")");
  std::sort(out.begin(), out.end());
  return out;
}

// The only file with that ending; empty if there is none.
fs::path only_one(const std::vector<fs::path>& files, std::string_view ending) {
  fs::path out;
  for (const fs::path& file : files) {
    if (lower(file.extension().string()) != ending) continue;
    if (!out.empty())
      throw UsageError("both " + out.filename().string() + " and " + file.filename().string() +
                       " list lights; name one of them as PATH");
    out = file;
  }
  return out;
}

Found find(const ImportOptions& options) {
  Found out;
  const fs::path path = options.path;
  std::error_code error;
  if (!fs::exists(path, error)) throw InputError(path.string() + ": is not there");
  if (fs::is_directory(path, error)) {
    out.folder = path;
    const std::vector<fs::path> files = files_in(path);
    if (fs::exists(path / "lights.csv", error)) out.lights = path / "lights.csv";
    for (const char* ending : {".lp", ".dome"})
      if (out.lights.empty()) out.lights = only_one(files, ending);
  } else {
    out.folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    out.lights = path;
  }
  if (!options.lights.empty()) out.lights = options.lights;
  out.cameras = options.cameras.empty() ? colmap_folder(out.folder) : fs::path(options.cameras);
  if (out.lights.empty() && out.cameras.empty())
    throw InputError(
        path.string() +
        ": has no list of lights (lights.csv, one .lp or one .dome) and no cameras of COLMAP; expected one");
  return out;
}

LightList list_of(const fs::path& file, double unit_m) {
  const std::string text = files::read_whole(file, kMostListBytes), ending = lower(file.extension().string());
  if (ending == ".csv") return read_lights_csv(text, file.string());
  if (ending == ".lp") return read_lp(text, file.string());
  if (ending == ".dome" || ending == ".json") return read_dome(text, file.string(), unit_m);
  throw UsageError(in_quotes(file.string()) + " is no list of lights that is known (lights.csv, .lp, .dome)");
}

// Numbers within names are ordered as numbers: photo2 before photo10.
bool is_before(const std::string& a, const std::string& b) {
  std::size_t i = 0, k = 0;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  while (i < a.size() && k < b.size()) {
    if (is_digit(a[i]) && is_digit(b[k])) {
      const auto run = [&](const std::string& s, std::size_t& at) {
        while (at < s.size() && s[at] == '0') ++at;
        const std::size_t begin = at;
        while (at < s.size() && is_digit(s[at])) ++at;
        return s.substr(begin, at - begin);
      };
      const std::string m = run(a, i), n = run(b, k);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else if (a[i] != b[k]) {
      return a[i] < b[k];
    } else {
      ++i, ++k;
    }
  }
  return a.size() - i < b.size() - k;
}

bool is_layer(const fs::path& file, std::initializer_list<const char*> names) {
  const std::string stem = lower(file.stem().string());
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return stem == name || stem.ends_with("." + name) || stem.ends_with("_" + name) || stem.ends_with("-" + name);
  });
}
bool is_mask(const fs::path& file) { return is_photograph(file) && is_layer(file, {"mask"}); }
bool is_normals(const fs::path& file) {
  return is_photograph(file) && is_layer(file, {"normal", "normals", "normal_gt"});
}

// A .dome names no files: the folder's photographs in the order of their names.
void name_files(LightList& list, const fs::path& folder, const fs::path& source) {
  if (!list.lights[0].file.empty()) return;
  std::vector<std::string> names;
  for (const fs::path& file : files_in(folder))
    if (is_photograph(file) && !is_mask(file) && !is_normals(file)) names.push_back(file.filename().string());
  std::sort(names.begin(), names.end(), is_before);
  if (names.size() != list.lights.size())
    throw InputError(source.string() + ": has " + std::to_string(list.lights.size()) + " lights; " + folder.string() +
                     " has " + std::to_string(names.size()) + " photographs (mask and normals left out)");
  for (std::size_t i = 0; i < names.size(); ++i) list.lights[i].file = names[i];
}

// Ids from names: their stems if those differ, or else the names themselves.
std::vector<std::string> ids_of(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  std::set<std::string> seen;
  for (const std::string& name : names) out.push_back(fs::path(name).stem().string());
  for (const std::string& id : out)
    if (!seen.insert(id).second) {
      out = names;
      break;
    }
  for (std::string& id : out) {
    std::replace(id.begin(), id.end(), '/', '_');
    std::replace(id.begin(), id.end(), '\\', '_');
    if (id.size() > 120) id = id.substr(id.size() - 120);
  }
  return out;
}

// A list written on another machine may name folders that are not here: then the file beside the list.
fs::path photograph_of(const fs::path& folder, const std::string& name) {
  std::error_code error;
  if (fs::exists(folder / name, error)) return folder / name;
  const std::size_t slash = name.find_last_of("/\\");
  const fs::path beside = folder / (slash == name.npos ? name : name.substr(slash + 1));
  return fs::exists(beside, error) ? beside : fs::path();
}

fs::path whole_path(const fs::path& file) {
  std::error_code error;
  const fs::path out = fs::weakly_canonical(file, error);
  return error ? fs::absolute(file) : out;
}

// What the numbers of one file mean, or one line that says which option to give.
Frame encoding_of(const ImportOptions& options, const fs::path& file, const std::optional<Known>& by_list,
                  std::map<std::string, std::size_t>& reasons) {
  Frame out;
  const std::optional<Known> by_format = known_by_format(file);
  const std::string ending = lower(file.extension().string());
  Known known;
  if (!options.color_space.empty()) known = {&color_space_named(options.color_space), "--color-space says so"};
  else if (by_format) known = *by_format;
  else if (by_list) known = *by_list;
  else
    throw UsageError(file.filename().string() + ": its format does not say what its numbers mean; add --color-space " +
                     "linear, or srgb for usual " + ending + " files (--help lists all)");
  if (ending == ".dng" && known.space != &kColorSpaces[0])
    throw UsageError("--color-space " + std::string(known.space->name) + " is not for " + file.filename().string() +
                     ": a DNG is linear Rec. 709 when it is read");
  ++reasons[std::string(known.space->name) + " (" + known.reason + ")"];
  out.transfer = known.space->transfer;
  out.primaries = known.space->primaries;
  out.black = options.black.value_or(0);
  out.white = options.white.value_or(1);
  if (!(out.white > out.black))
    throw UsageError("--white " + files::number_text(out.white) + " is not above --black " +
                     files::number_text(out.black));
  // Files of floats have no largest number; demosaicing a full sensor leaves values a little below it.
  const bool has_floats = ending == ".exr" || ending == ".pfm" || ending == ".hdr";
  out.clip = options.clip.value_or(has_floats         ? std::numeric_limits<double>::infinity()
                                   : ending == ".dng" ? 0.99
                                                      : 1.0);
  return out;
}

class Bringer {
 public:
  explicit Bringer(const ImportOptions& options) : options_(options), found_(find(options)) {}

  Import run() {
    Capture& capture = out_.capture;
    const std::string name = whole_path(found_.folder).filename().string();
    capture.name = name;
    capture.root = options_.out.empty() ? fs::path(name + ".capture") : fs::path(options_.out);
    std::error_code error;
    if (fs::exists(capture.root / capture::kCaptureFile, error) && !options_.overwrites)
      throw UsageError((capture.root / capture::kCaptureFile).string() +
                       " is there already; --overwrite writes it anew, --out names another folder");
    if (!found_.lights.empty()) {
      list_ = list_of(found_.lights, options_.unit_m);
      by_list_ = known_by_remark(list_.remarks, found_.lights.filename().string());
      capture.source = list_.remarks;
    }
    if (found_.cameras.empty()) one_camera();
    else posed_cameras();
    for (const auto& [text, count] : reasons_)
      out_.notes.push_back("color space: " + text +
                           (reasons_.size() > 1 ? ", " + std::to_string(count) + " files" : ""));
    if (capture.frames.empty())
      throw InputError(found_.folder.string() + ": none of the photographs is there; the first would be " +
                       in_quotes(out_.missing.empty() ? "" : out_.missing[0]));
    if (options_.hashes || options_.copies) take_files();
    capture.variants = {{"render", "renders/{variant}/{camera}/{light}.exr"}};
    capture::write_capture(capture);
    return std::move(out_);
  }

 private:
  void say(const std::string& text) { out_.notes.push_back(text); }
  void assume(const std::string& text) {
    out_.capture.source += (out_.capture.source.empty() ? "" : "; ") + text;
    say(text);
  }

  void add_lights() {
    std::vector<std::string> names;
    for (const ListedLight& one : list_.lights) names.push_back(one.file);
    const std::vector<std::string> ids = ids_of(names);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      capture::Light& light = out_.capture.lights.emplace_back(list_.lights[i].light);
      light.id = ids[i];
      light.calibrated_by = found_.lights.filename().string();
    }
  }

  void add_frame(Frame frame, std::size_t camera, std::size_t light, const fs::path& file) {
    frame.camera = camera;
    frame.light = light;
    frame.file = whole_path(file);
    out_.capture.frames.push_back(std::move(frame));
  }

  void one_camera() {
    name_files(list_, found_.folder, found_.lights);
    add_lights();
    Camera camera;
    camera.id = "camera";
    camera.is_orthographic = true;
    // x right, y up, z towards the camera is the world: the camera's y and z are turned round.
    camera.world_from_camera = glm::dmat4(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
    for (std::size_t i = 0; i < list_.lights.size(); ++i) {
      const fs::path file = photograph_of(found_.folder, list_.lights[i].file);
      if (file.empty()) {
        out_.missing.push_back(list_.lights[i].file);
        continue;
      }
      if (camera.width == 0) measure(file, camera);
      add_frame(encoding_of(options_, file, by_list_, reasons_), 0, i, file);
    }
    camera.intrinsics =
        glm::dmat3(camera.width / options_.picture_width_m, 0, 0, 0, camera.width / options_.picture_width_m, 0,
                   0.5 * camera.width, 0.5 * camera.height, 1);
    out_.capture.cameras = {camera};
    assume("one orthographic camera; its picture is taken as " + files::number_text(options_.picture_width_m) +
           " m wide");
    add_layers();
  }

  void measure(const fs::path& file, Camera& camera) const {
    const image::Texels texels = image::read_texels(file);
    camera.width = texels.width;
    camera.height = texels.height;
  }

  // Mask and normals of the only camera.
  void add_layers() {
    const auto add = [&](const std::string& asked, capture::Layer layer, bool (*is_it)(const fs::path&)) {
      fs::path file = asked;
      std::error_code error;
      if (!asked.empty() && !fs::exists(file, error)) throw InputError(asked + ": is not there");
      if (asked.empty())
        for (const fs::path& one : files_in(found_.folder))
          if (file.empty() && is_it(one)) file = one;
      if (file.empty()) return;
      out_.capture.layers.push_back({0, layer, whole_path(file)});
      say(std::string(capture::kLayers[static_cast<std::size_t>(layer)]) + ": " + file.filename().string());
    };
    add(options_.mask, capture::Layer::kMask, is_mask);
    add(options_.normals, capture::Layer::kNormal, is_normals);
  }

  void posed_cameras() {
    const double meters = options_.unit_m > 0 ? options_.unit_m : 1;
    if (options_.unit_m <= 0) assume("the unit of COLMAP's reconstruction is taken as 1 m (--unit-m says otherwise)");
    const std::vector<PosedPicture> pictures = read_colmap(found_.cameras, meters);
    std::vector<std::string> names, folders;
    for (const PosedPicture& one : pictures) {
      names.push_back(one.file);
      folders.push_back(fs::path(one.file).parent_path().filename().string());
    }
    // Pictures that lie in a folder of their own each are called by it.
    const bool has_folders = names.size() > 1 &&
                             std::set<std::string>(folders.begin(), folders.end()).size() == names.size() &&
                             std::find(folders.begin(), folders.end(), "") == folders.end();
    std::vector<std::string> ids = ids_of(names);
    for (std::size_t i = 0; i < ids.size() && has_folders; ++i) ids[i] = folders[i];
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      Camera& camera = out_.capture.cameras.emplace_back(pictures[i].camera);
      camera.id = ids[i];
      camera.label = names[i];
    }
    if (found_.lights.empty()) return full_frames(names);
    if (options_.photos.find("{camera}") == std::string::npos || options_.photos.find("{light}") == std::string::npos)
      throw UsageError(
          "cameras of COLMAP and a list of lights need --photos, for example --photos photos/{camera}/{light}.png");
    add_lights();
    for (std::size_t c = 0; c < out_.capture.cameras.size(); ++c)
      for (std::size_t l = 0; l < out_.capture.lights.size(); ++l) {
        const std::string name =
            capture::filled(options_.photos, out_.capture.cameras[c].id, out_.capture.lights[l].id);
        std::error_code error;
        if (!fs::exists(found_.folder / name, error)) out_.missing.push_back(name);
        else add_frame(encoding_of(options_, name, by_list_, reasons_), c, l, found_.folder / name);
      }
  }

  // Pictures of a reconstruction without lights: all of them shone.
  void full_frames(const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      fs::path file = photograph_of(found_.folder, names[i]);
      if (file.empty()) file = photograph_of(found_.folder / "images", names[i]);
      if (file.empty()) {
        out_.missing.push_back(names[i]);
        continue;
      }
      Frame frame = encoding_of(options_, file, by_list_, reasons_);
      frame.kind = capture::FrameKind::kFull;
      add_frame(std::move(frame), i, 0, file);
    }
    say("no list of lights: the pictures are taken as lit by all of them");
  }

  // Hashes, and copies beside the capture.
  void take_files() {
    for (Frame& frame : out_.capture.frames) {
      const std::string bytes = files::read_whole(frame.file, image::kMostFileBytes);
      if (options_.hashes) frame.sha256 = files::sha256(bytes);
      if (!options_.copies) continue;
      const std::string light =
          frame.kind == capture::FrameKind::kOneLight ? out_.capture.lights[frame.light].id : "full";
      const fs::path to =
          fs::path("photos") / out_.capture.cameras[frame.camera].id / (light + lower(frame.file.extension().string()));
      files::write_whole(out_.capture.root / to, bytes);
      frame.file = to;
    }
    for (capture::LayerFile& one : out_.capture.layers) {
      if (!options_.copies) break;
      const fs::path to =
          fs::path("aux") / out_.capture.cameras[one.camera].id /
          (std::string(capture::kLayers[static_cast<std::size_t>(one.layer)]) + lower(one.file.extension().string()));
      files::write_whole(out_.capture.root / to, files::read_whole(one.file, image::kMostFileBytes));
      one.file = to;
    }
  }

  const ImportOptions& options_;
  Found found_;
  LightList list_;
  std::optional<Known> by_list_;
  std::map<std::string, std::size_t> reasons_;  // color space and why, to how many files
  Import out_;
};

}  // namespace

Import bring(const ImportOptions& options) {
  if (!(options.picture_width_m > 0 && options.picture_width_m <= 1e6))
    throw UsageError("--picture-width-m = " + files::number_text(options.picture_width_m) + " is outside (0, 1e6]");
  if (!(options.unit_m >= 0 && options.unit_m <= 1e6))
    throw UsageError("--unit-m = " + files::number_text(options.unit_m) + " is outside (0, 1e6]");
  return Bringer(options).run();
}

}  // namespace likeness::olat_import
