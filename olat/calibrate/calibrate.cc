#include "olat/calibrate/calibrate.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "olat/calibrate/chrome.h"
#include "olat/calibrate/find_chart.h"
#include "olat/registration/gain.h"
#include "olat/registration/noise.h"
#include "olat/registration/plane.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"

namespace likeness::olat_calibrate {
namespace {

namespace fs = std::filesystem;
using capture::Capture;
using capture::kAbsent;

constexpr std::size_t kNoisePhotos = 9;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string text_of_vector(const glm::dvec3& v) {
  const auto four = [](double x) { return files::number_text(std::round(1e4 * x) / 1e4); };
  return four(v.x) + " " + four(v.y) + " " + four(v.z);
}

struct Run {
  const Capture& capture;
  const Options& options;
  Result& result;

  void tell(const char* what, double share) const {
    if (options.keep_going && !options.keep_going(what, share)) throw files::Interrupted{};
  }
  void note(const std::string& text) const { result.notes.push_back(text); }
};

// The light of `own` that each light of another capture is: by id, or else, if there are as many, in order.
std::vector<std::size_t> matched(const Run& run, const Capture& other, const char* what) {
  const Capture& own = run.capture;
  std::vector<std::size_t> out;
  std::size_t found = 0;
  for (const auto& light : other.lights) {
    out.push_back(capture::light_of(own, light.id));
    found += out.back() != kAbsent ? 1 : 0;
  }
  if (found == other.lights.size() && found > 0) return out;
  if (found > 0 || other.lights.size() != own.lights.size())
    throw files::UsageError(std::string(what) + " has " + std::to_string(other.lights.size()) + " lights, of which " +
                            std::to_string(found) + " are in the capture by their id; it has " +
                            std::to_string(own.lights.size()) +
                            ". Give them the same ids, or the same number of lights");
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = i;
  run.note(std::string("lights of ") + what + " were matched by their order: no id is the same (" +
           files::in_quotes(other.lights[0].id) + " is " + files::in_quotes(own.lights[0].id) + ")");
  return out;
}

// Color of each light: the median over its photos.
using Colors = std::vector<std::array<std::vector<double>, 3>>;

void apply_intensity(const Run& run, std::size_t light, const glm::dvec3& intensity, const std::string& by) {
  capture::Light& of = run.result.capture.lights[light];
  const std::string before = text_of_vector(of.intensity), after = text_of_vector(intensity);
  if (before == after) return;
  run.result.changes.push_back({"lights.json", of.id, "intensity", before, after});
  of.intensity = intensity;
  of.calibrated_by += (of.calibrated_by.empty() ? "" : "; ") + by;
}

void gains_from_renders(const Run& run) {
  const Capture& capture = run.capture;
  std::size_t at = 0;
  if (!run.options.variant.empty()) at = capture::variant_of(capture, run.options.variant);
  if (at >= capture.variants.size())
    throw files::UsageError(capture.variants.empty()
                                ? std::string("--gain needs renders, or photos of a grey card (--grey CAPTURE)")
                                : "the capture has no variant " + files::in_quotes(run.options.variant));
  const capture::Variant& variant = capture.variants[at];
  Colors stops(capture.lights.size());
  for (std::size_t i = 0; i < capture.frames.size(); ++i) {
    const capture::Frame& frame = capture.frames[i];
    run.tell("gains", static_cast<double>(i) / static_cast<double>(capture.frames.size()));
    if (frame.kind != capture::FrameKind::kOneLight) continue;
    std::error_code ignored;
    if (!fs::exists(capture::render_file(capture, variant, frame.camera, frame.light), ignored)) continue;
    const capture::Photo photo = capture::read_photo(capture, i);
    std::vector<float> weight;
    for (const auto flaw : photo.flaws)
      weight.push_back((flaw & (capture::kMasked | capture::kClipped | capture::kNotFinite)) != 0 ? 0.0f : 1.0f);
    const registration::Gain gain =
        registration::gain_between(photo.light, capture::read_render(capture, variant, frame.camera, frame.light),
                                   weight, registration::darkness_of(photo.light).noise);
    if (gain.pixels == 0) continue;
    for (std::size_t c = 0; c < 3; ++c)
      stops[frame.light][c].push_back(run.options.gain == GainOf::kChannel ? gain.stops[c] : gain.all);
  }
  glm::dvec3 middle(0);
  if (!run.options.is_absolute)
    for (int c = 0; c < 3; ++c) {
      std::vector<double> all;
      for (const auto& light : stops)
        if (!light[static_cast<std::size_t>(c)].empty()) all.push_back(median(light[static_cast<std::size_t>(c)]));
      if (!all.empty()) middle[c] = median(all);
    }
  for (std::size_t light = 0; light < stops.size(); ++light) {
    if (stops[light][0].empty()) {
      run.note("light " + capture.lights[light].id + " keeps its intensity: no pair of it shows a gain");
      continue;
    }
    glm::dvec3 intensity = capture.lights[light].intensity;
    for (int c = 0; c < 3; ++c)
      intensity[c] *= std::exp2(median(stops[light][static_cast<std::size_t>(c)]) - middle[c]);
    apply_intensity(run, light, intensity, "likeness olat calibrate --gain, variant " + variant.id);
  }
}

void gains_from_grey(const Run& run) {
  Capture grey = *run.options.grey;
  const std::vector<std::size_t> own = matched(run, grey, "--grey");
  for (auto& light : grey.lights) light.intensity = {1, 1, 1};
  Colors seen(run.capture.lights.size());
  for (std::size_t i = 0; i < grey.frames.size(); ++i) {
    run.tell("grey", static_cast<double>(i) / static_cast<double>(grey.frames.size()));
    if (grey.frames[i].kind != capture::FrameKind::kOneLight) continue;
    const capture::Photo photo = capture::read_photo(grey, i);
    std::array<std::vector<double>, 3> values;
    for (std::size_t k = 0; k < photo.flaws.size(); ++k)
      if ((photo.flaws[k] & (capture::kMasked | capture::kClipped | capture::kNotFinite)) == 0)
        for (std::size_t c = 0; c < 3; ++c) values[c].push_back(static_cast<double>(photo.light.rgb[3 * k + c]));
    if (values[0].empty()) continue;
    std::array<double, 3> color{median(values[0]), median(values[1]), median(values[2])};
    if (run.options.gain == GainOf::kLight) color.fill(0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]);
    if (!(std::ranges::min(color) > 0)) continue;
    for (std::size_t c = 0; c < 3; ++c) seen[own[grey.frames[i].light]][c].push_back(color[c]);
  }
  // The median light keeps its green: the capture's unit light stays what it was.
  std::vector<double> greens, present;
  for (std::size_t light = 0; light < seen.size(); ++light)
    if (!seen[light][1].empty()) {
      greens.push_back(median(seen[light][1]));
      present.push_back(run.capture.lights[light].intensity.y);
    }
  if (greens.empty()) throw files::UsageError("--grey: no photo shows light");
  const double scale = run.options.is_absolute ? 1 : median(present) / median(greens);
  for (std::size_t light = 0; light < seen.size(); ++light) {
    if (seen[light][1].empty()) {
      run.note("light " + run.capture.lights[light].id + " keeps its intensity: --grey does not show it");
      continue;
    }
    const glm::dvec3 color(median(seen[light][0]), median(seen[light][1]), median(seen[light][2]));
    apply_intensity(run, light, scale * color, "likeness olat calibrate --grey");
  }
}

void directions(const Run& run) {
  const Capture& chrome = *run.options.chrome;
  const std::vector<std::size_t> own = matched(run, chrome, "--chrome");
  std::vector<glm::dvec3> sums(run.capture.lights.size(), glm::dvec3(0));
  std::vector<std::optional<Ball>> balls;
  for (std::size_t camera = 0; camera < chrome.cameras.size(); ++camera) {
    if (capture::layer_file(chrome, camera, capture::Layer::kMask).empty())
      throw files::UsageError("--chrome: camera " + files::in_quotes(chrome.cameras[camera].id) +
                              " has no mask; it says where the ball is");
    const capture::Camera& of = chrome.cameras[camera];
    balls.push_back(ball_of(capture::read_mask(chrome, camera), of.width, of.height));
    if (!balls.back()) throw files::UsageError("--chrome: the mask of camera " + files::in_quotes(of.id) + " is empty");
  }
  for (std::size_t i = 0; i < chrome.frames.size(); ++i) {
    const capture::Frame& frame = chrome.frames[i];
    run.tell("chrome ball", static_cast<double>(i) / static_cast<double>(chrome.frames.size()));
    if (frame.kind != capture::FrameKind::kOneLight) continue;
    const auto found =
        direction_of(capture::read_photo(chrome, i).light, *balls[frame.camera], chrome.cameras[frame.camera]);
    if (found) sums[own[frame.light]] += glm::dvec3((*found)[0], (*found)[1], (*found)[2]);
  }
  std::vector<double> turns;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    capture::Light& light = run.result.capture.lights[i];
    if (!(glm::length(sums[i]) > 0)) {
      run.note("light " + light.id + " keeps its place: its reflection was not found");
      continue;
    }
    const glm::dvec3 to_light = glm::normalize(sums[i]);
    std::string before = "not known";
    if (const auto* distant = std::get_if<capture::DistantLight>(&light.place)) {
      before = text_of_vector(distant->to_light);
      turns.push_back(glm::degrees(std::acos(std::clamp(glm::dot(distant->to_light, to_light), -1.0, 1.0))));
    } else if (const auto* near = std::get_if<capture::NearLight>(&light.place)) {
      before = "position " + text_of_vector(near->position);
    }
    run.result.changes.push_back({"lights.json", light.id, "direction", before, text_of_vector(to_light)});
    light.place = capture::DistantLight{to_light};
    light.calibrated_by = "likeness olat calibrate --chrome " + chrome.name;
  }
  if (!turns.empty())
    run.note("the new directions are " + files::number_text(std::round(100 * median(turns)) / 100) +
             " degrees from the old ones in the median, " +
             files::number_text(std::round(100 * std::ranges::max(turns)) / 100) + " at most");
}

void noise_floors(const Run& run) {
  Capture& out = run.result.capture;
  out.noise_floor.resize(out.cameras.size(), glm::dvec3(0));
  for (std::size_t camera = 0; camera < out.cameras.size(); ++camera) {
    std::vector<std::size_t> frames;
    for (std::size_t i = 0; i < out.frames.size(); ++i)
      if (out.frames[i].camera == camera && out.frames[i].kind == capture::FrameKind::kOneLight) frames.push_back(i);
    std::array<std::vector<double>, 3> all;
    const std::size_t count = std::min(frames.size(), kNoisePhotos);
    for (std::size_t k = 0; k < count; ++k) {
      run.tell("noise", static_cast<double>(camera) / static_cast<double>(out.cameras.size()));
      const auto dark = registration::darkness_of(capture::read_photo(out, frames[k * frames.size() / count]).light);
      for (std::size_t c = 0; c < 3; ++c) all[c].push_back(dark.noise[c]);
    }
    if (count == 0) continue;
    const glm::dvec3 noise(median(all[0]), median(all[1]), median(all[2])), before = out.noise_floor[camera];
    if (!(glm::length(noise) > 0)) {
      run.note("camera " + out.cameras[camera].id + ": the dark parts show no noise; nothing is written");
      continue;
    }
    const auto text = [](const glm::dvec3& v) {
      const auto three = [](double x) {
        char number[32];
        std::snprintf(number, sizeof number, "%.3g", x);
        return std::string(number);
      };
      return glm::length(v) > 0 ? three(v.x) + " " + three(v.y) + " " + three(v.z) : std::string("not measured");
    };
    run.result.changes.push_back({"cameras.json", out.cameras[camera].id, "noise_floor", text(before), text(noise)});
    out.noise_floor[camera] = noise;
  }
}

std::set<std::size_t> cameras_of(const Run& run) {
  std::set<std::size_t> out;
  if (run.options.camera.empty())
    for (std::size_t i = 0; i < run.capture.cameras.size(); ++i) out.insert(i);
  else if (const std::size_t at = capture::camera_of(run.capture, run.options.camera); at != kAbsent) out.insert(at);
  else throw files::UsageError("the capture has no camera " + files::in_quotes(run.options.camera));
  return out;
}

// A photo that is no frame: light as it is in formats that hold light, else by the encoding of the camera's first frame.
image::Picture read_as(const Run& run, const std::string& file, std::size_t camera) {
  image::Picture picture = capture::read_encoded(file);
  std::string ending = fs::path(file).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const char* light : {".exr", ".pfm", ".hdr", ".dng"})
    if (ending == light) return picture;
  for (const capture::Frame& frame : run.capture.frames)
    if (frame.camera == camera) {
      for (float& v : picture.rgb)
        v = capture::linear_of(
            frame.transfer, static_cast<float>((static_cast<double>(v) - frame.black) / (frame.white - frame.black)));
      return picture;
    }
  throw files::UsageError(file + ": camera " + files::in_quotes(run.capture.cameras[camera].id) +
                          " has no photo that would say what its numbers mean");
}

// As the command line takes them.
std::string text_of_corners(const Corners& corners) {
  std::string out;
  for (const auto& [x, y] : corners)
    out += (out.empty() ? "--corner " : " --corner ") + files::number_text(std::round(10 * x) / 10) + "," +
           files::number_text(std::round(10 * y) / 10);
  return out;
}

// The only chart of the photo.
Corners found_in(const Run& run, const image::Picture& photo, const Reference& reference) {
  run.tell("chart", 0);
  const std::vector<FoundChart> found = find_charts(photo, reference);
  if (found.empty())
    throw files::UsageError(run.options.chart +
                            ": no chart of 24 patches was found; say where it is by four --corner x,y (of patch 1, 6, "
                            "24 and 19)");
  if (found.size() > 1)
    throw files::UsageError(run.options.chart + ": shows " + std::to_string(found.size()) + " charts; say which: " +
                            text_of_corners(found[0].corners) + ", or " + text_of_corners(found[1].corners));
  run.note("the chart was found at " + text_of_corners(found[0].corners) + " (" + std::to_string(found[0].patches) +
           " of 24 patches seen)");
  return found[0].corners;
}

void chart(const Run& run) {
  if (run.options.reference.empty()) throw files::UsageError("--chart needs --reference, the chart's measured values");
  const Reference reference = read_reference(run.options.reference);
  run.result.chart_space = reference.space;
  const std::set<std::size_t> cameras = cameras_of(run);
  if (cameras.empty()) throw files::UsageError("the capture has no cameras");
  const image::Picture photo = read_as(run, run.options.chart, *cameras.begin());
  const Corners corners = run.options.corners ? *run.options.corners : found_in(run, photo, reference);
  run.result.chart = fit_chart(patches_of(photo, corners), reference);
  Capture& out = run.result.capture;
  for (const std::size_t camera : cameras) {
    for (capture::Frame& frame : out.frames) {
      if (frame.camera != camera) continue;
      if (frame.primaries == capture::Primaries::kAcesCg)
        throw files::UsageError("camera " + files::in_quotes(out.cameras[camera].id) +
                                " has photos in ACEScg, which are no colors of a camera");
      frame.primaries = capture::Primaries::kCamera;
    }
    out.cameras[camera].rec709_from_camera = run.result.chart->matrix;
    run.result.changes.push_back({"cameras.json", out.cameras[camera].id, "rec709_from_camera", "", "by the chart"});
    run.result.changes.push_back({"frames.json", out.cameras[camera].id, "primaries", "", "camera"});
  }
}

void flat_field(const Run& run) {
  const std::set<std::size_t> cameras = cameras_of(run);
  if (cameras.size() != 1) throw files::UsageError("--flat is of one camera; say which by --camera");
  const std::size_t camera = *cameras.begin();
  const capture::Camera& of = run.capture.cameras[camera];
  const image::Picture photo = read_as(run, run.options.flat, camera);
  if (photo.width != of.width || photo.height != of.height)
    throw files::UsageError(run.options.flat + ": has " + std::to_string(photo.width) + " x " +
                            std::to_string(photo.height) + " pixels; camera " + files::in_quotes(of.id) + " has " +
                            std::to_string(of.width) + " x " + std::to_string(of.height));
  image::Picture flat(photo.width, photo.height);
  // What a lens does is smooth; dust and noise are not.
  const float sigma = std::max(1.0f, static_cast<float>(std::max(photo.width, photo.height)) / 100);
  for (std::size_t c = 0; c < 3; ++c) {
    registration::Plane plane(photo.width, photo.height);
    for (std::size_t i = 0; i < plane.values.size(); ++i) plane.values[i] = photo.rgb[3 * i + c];
    plane = registration::blurred(plane, sigma);
    const double mean = registration::weighted_mean(plane, {});
    for (std::size_t i = 0; i < plane.values.size(); ++i) {
      const double share = static_cast<double>(plane.values[i]) / mean;
      if (!(share > 0.01 && std::isfinite(share)))
        throw files::InputError(
            run.options.flat + ": is black at " + std::to_string(i % static_cast<std::size_t>(photo.width)) + "," +
            std::to_string(i / static_cast<std::size_t>(photo.width)) + "; a flat field is lit everywhere");
      flat.rgb[3 * i + c] = static_cast<float>(share);
    }
  }
  const auto [low, high] = std::ranges::minmax_element(flat.rgb);
  const auto three = [](float v) { return files::number_text(std::round(1e3 * static_cast<double>(v)) / 1e3); };
  run.result.changes.push_back(
      {"cameras.json", of.id, "flat_field", "", "from " + three(*low) + " to " + three(*high) + " of the mean"});
  Capture& out = run.result.capture;
  std::erase_if(out.layers, [&](const capture::LayerFile& layer) {
    return layer.camera == camera && layer.layer == capture::Layer::kFlatField;
  });
  out.layers.push_back({camera, capture::Layer::kFlatField, "aux/" + of.id + "/flat_field.exr"});
  run.result.flat = std::move(flat);
}

}  // namespace

Result run_calibrate(const Capture& capture, const Options& options) {
  Result result;
  result.capture = capture;
  const Run run{capture, options, result};
  if (options.gain != GainOf::kNothing) options.grey != nullptr ? gains_from_grey(run) : gains_from_renders(run);
  if (options.chrome != nullptr) directions(run);
  if (options.noise) noise_floors(run);
  if (!options.chart.empty()) chart(run);
  if (!options.flat.empty()) flat_field(run);
  return result;
}

}  // namespace likeness::olat_calibrate
