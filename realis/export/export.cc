#include "realis/export/export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <system_error>
#include <utility>

#include "realis/export/pictures.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/image/write.h"

namespace likeness::realis {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kExposed = 16;  // pictures that an exposure is taken from
constexpr std::size_t kTried = 24;    // lights that planes are compared under

// Files that go away again unless all of them are there.
class Folder {
 public:
  Folder(fs::path path, bool overwrites) : path_(std::move(path)) {
    std::error_code none;
    if (fs::exists(path_, none) && !fs::is_directory(path_, none))
      throw files::UsageError("--out " + path_.string() + " is a file; name a folder");
    if (fs::is_directory(path_, none) && !fs::is_empty(path_, none) && !overwrites)
      throw files::UsageError("--out " + path_.string() + " is not empty; --overwrite writes into it");
    is_new_ = !fs::exists(path_, none);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    if (is_kept_) return;
    std::error_code none;
    for (const fs::path& file : files_) fs::remove(file, none);
    if (is_new_) fs::remove(path_, none);
  }
  void write(const std::string& name, std::string_view bytes) {
    if (files::interrupted()) throw files::Interrupted();
    files_.push_back(path_ / name);
    files::write_whole(files_.back(), bytes);
    bytes_ += bytes.size();
  }
  // What is whole from here on.
  void keep(Exported& out) {
    is_kept_ = true;
    out.files = files_, out.bytes = bytes_;
    std::reverse(out.files.begin(), out.files.end());
  }

 private:
  fs::path path_;
  std::vector<fs::path> files_;
  std::size_t bytes_ = 0;
  bool is_new_ = false, is_kept_ = false;
};

// Linear pictures with names and lights.
struct Source {
  std::vector<std::string> names;
  std::vector<glm::dvec3> to_lights;
  std::function<image::Picture(std::size_t)> picture;
};

double exposure_of_source(const Source& source) {
  std::vector<image::Picture> some;
  const std::size_t count = source.to_lights.size(), step = std::max<std::size_t>(1, count / kExposed);
  for (std::size_t i = 0; i < count && some.size() < kExposed; i += step) {
    if (files::interrupted()) throw files::Interrupted();
    some.push_back(source.picture(i));
  }
  return exposure_of(some);
}

// As RTI programs read it: a count, then a name and a direction a line.
std::string lp_text(const std::vector<std::string>& names, const std::vector<glm::dvec3>& to_lights) {
  std::string out = std::to_string(names.size()) + "\n";
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::array<char, 96> line{};
    std::snprintf(line.data(), line.size(), " %.9g %.9g %.9g\n", to_lights[i].x, to_lights[i].y, to_lights[i].z);
    out += names[i] + line.data();
  }
  return out;
}

void write_pictures(const Source& source, const std::vector<std::uint8_t>& mask, const ExportOptions& options,
                    const GoesOn& goes_on, Folder& folder, Exported& out) {
  const std::string ending = options.is_png ? ".png" : ".jpg";
  std::vector<std::string> names;
  for (std::size_t i = 0; i < source.names.size(); ++i) {
    if (!goes_on(static_cast<double>(i) / static_cast<double>(source.names.size()), "writing pictures"))
      throw files::Interrupted();
    const image::DisplayPicture shown = rounded(displayed(source.picture(i), out.ev));
    names.push_back(source.names[i] + ending);
    folder.write(names.back(), options.is_png ? image::png_bytes(shown)
                                              : image::jpeg_bytes(shown, options.quality, image::JpegColors::kYcc));
    if (i == 0 && std::ranges::find(mask, 0) != mask.end()) {
      image::DisplayPicture white(shown.width, shown.height);
      for (std::size_t k = 0; k < white.rgb.size(); ++k) white.rgb[k] = mask[k / 3] != 0 ? 255 : 0;
      folder.write("mask.png", image::png_bytes(white));
    }
  }
  folder.write("lights.lp", lp_text(names, source.to_lights));
}

// Of display values, as 8 bits would show them, over texels of the subject [dB].
double psnr_of(const Viewer& viewer, const Relightable& subject, const std::vector<glm::dvec3>& to_lights, double ev,
               const GoesOn& goes_on) {
  double sum = 0;
  std::size_t count = 0;
  for (const glm::dvec3& to_light : to_lights) {
    if (!goes_on(1, "comparing")) throw files::Interrupted();
    const image::Picture want = displayed(relit(subject, to_light), ev), got = viewer.picture(to_light);
    for (const std::uint32_t pixel : subject.stored.pixels)
      for (std::size_t c = 0; c < 3; ++c) {
        const double d = static_cast<double>(got.rgb[3 * std::size_t{pixel} + c]) -
                         static_cast<double>(want.rgb[3 * std::size_t{pixel} + c]);
        sum += d * d;
        ++count;
      }
  }
  return count == 0 ? 0 : -10 * std::log10(std::max(sum / static_cast<double>(count), 1e-12));
}

// At most kTried of them, evenly.
std::vector<glm::dvec3> some_of(const std::vector<Photographed>& all) {
  std::vector<glm::dvec3> out;
  const std::size_t step = (all.size() + kTried - 1) / kTried;
  for (std::size_t i = 0; i < all.size(); i += step)
    if (all[i].to_light.z > 0) out.push_back(all[i].to_light);
  return out;
}

// Planes of a bake, and what there is to say of them.
struct Told {
  Planes planes;
  PageFacts facts;
};

Told planes_of(const Relightable& subject, const Source& source, Format format, int quality, double ev,
               const GoesOn& goes_on) {
  Lit lit{subject.stored.width, subject.stored.height, source.to_lights, {}};
  lit.picture = [&](std::size_t light) { return displayed(source.picture(light), ev); };
  Told out{fit_planes(format, lit, quality, goes_on), {subject.capture.name, {}, {}, {}}};
  const std::vector<Photographed> seen = photographed(subject.capture, subject.camera);
  for (const Photographed& one : seen) out.facts.photographed.push_back(one.to_light);
  const Viewer viewer(out.planes);
  out.facts.psnr_disc = psnr_of(viewer, subject, on_disc(kTried + 1), ev, goes_on);
  if (const auto tried = some_of(seen); !tried.empty())
    out.facts.psnr_photographed = psnr_of(viewer, subject, tried, ev, goes_on);
  return out;
}

Source relit_on_disc(const Relightable& subject, std::size_t count) {
  Source out;
  out.to_lights = on_disc(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "light_%04zu", i);
    out.names.emplace_back(name.data());
  }
  out.picture = [&subject, lights = out.to_lights](std::size_t i) { return relit(subject, lights[i]); };
  return out;
}

void write_planes(const Told& told, Folder& folder, Exported& out) {
  const auto& [planes, facts] = told;
  out.planes = planes.count();
  out.psnr_disc = facts.psnr_disc, out.psnr_photographed = facts.psnr_photographed;
  for (std::size_t i = 0; i < planes.jpegs.size(); ++i)
    folder.write("plane_" + std::to_string(i) + ".jpg", planes.jpegs[i]);
  folder.write("info.json", info_text(planes, facts.photographed));
  folder.write("index.html", page_of(planes, facts));
}

std::size_t camera_of_photographs(const capture::Capture& capture, const std::string& id) {
  if (id.empty()) {
    if (capture.cameras.size() == 1) return 0;
    throw files::UsageError("the capture has " + std::to_string(capture.cameras.size()) +
                            " cameras and an .lp has one; say --camera ID");
  }
  const std::size_t at = capture::camera_of(capture, id);
  if (at != capture::kAbsent) return at;
  std::vector<std::string_view> ids;
  for (const capture::Camera& camera : capture.cameras) ids.push_back(camera.id);
  const std::string near = files::nearest_name(id, ids.data(), ids.size());
  throw files::UsageError("--camera " + files::in_quotes(id) + " is not in the capture" +
                          (near.empty() ? "" : "; did you mean " + files::in_quotes(near) + "?"));
}

}  // namespace

Exported export_capture(const capture::Capture& capture, const ExportOptions& options, const GoesOn& goes_on) {
  const bool is_lp = options.format == Format::kLp;
  const LightsFrom from = options.lights.value_or(is_lp ? LightsFrom::kPhotographs : LightsFrom::kDisc);
  if (!is_lp && from != LightsFrom::kDisc)
    throw files::UsageError("planes are fitted to relit pictures: --lights is a number of lights then, " +
                            std::to_string(kLeastLights) + " to " + std::to_string(kMostLights));
  const bool is_relit = from != LightsFrom::kPhotographs;
  std::optional<Relightable> subject;
  if (is_relit) subject = read_relightable(capture, options.name);
  const std::size_t camera = is_relit ? subject->camera : camera_of_photographs(capture, options.camera);
  Folder folder(options.out, options.overwrites);
  Exported out;
  Source source;
  std::vector<std::uint8_t> mask;
  if (from == LightsFrom::kDisc) source = relit_on_disc(*subject, options.count);
  const std::vector<Photographed> seen = photographed(capture, camera);
  if (from != LightsFrom::kDisc) {
    for (const Photographed& one : seen) {
      source.to_lights.push_back(one.to_light);
      source.names.push_back(capture.lights[one.light].id);
      out.near += std::holds_alternative<capture::NearLight>(capture.lights[one.light].place);
    }
    if (seen.empty())
      throw files::UsageError("camera " + files::in_quotes(capture.cameras[camera].id) +
                              " has no photograph under a light whose place is known; --lights 64 makes pictures of a "
                              "bake instead");
  }
  if (is_relit) {
    if (from == LightsFrom::kCapture)
      source.picture = [&](std::size_t i) { return relit(*subject, source.to_lights[i]); };
    mask.assign(static_cast<std::size_t>(subject->stored.width) * static_cast<std::size_t>(subject->stored.height), 0);
    for (const std::uint32_t pixel : subject->stored.pixels) mask[pixel] = 1;
  } else {
    source.picture = [&, layers = capture::read_camera_layers(capture, camera)](std::size_t i) {
      return capture::read_photo(capture, seen[i].frame, layers).light;
    };
    mask = capture::read_mask(capture, camera);
  }
  out.lights = source.to_lights.size();
  out.ev = options.ev ? *options.ev : exposure_of_source(source);
  if (is_lp) write_pictures(source, mask, options, goes_on, folder, out);
  else write_planes(planes_of(*subject, source, options.format, options.quality, out.ev, goes_on), folder, out);
  folder.keep(out);
  return out;
}

std::string relight_page(const capture::Capture& capture, const std::string& name, const GoesOn& goes_on) {
  const Relightable subject = read_relightable(capture, name);
  const ExportOptions usual;
  const Source source = relit_on_disc(subject, usual.count);
  const Told told = planes_of(subject, source, usual.format, usual.quality, exposure_of_source(source), goes_on);
  return page_of(told.planes, told.facts);
}

}  // namespace likeness::realis
