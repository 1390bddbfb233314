#include "olat/compare/compare.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include <glm/geometric.hpp>

#include "olat/compare/cache.h"
#include "olat/registration/gain.h"
#include "olat/registration/noise.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/image/read.h"
#include "render/view/view.h"

namespace likeness::olat_compare {
namespace {

namespace fs = std::filesystem;
using capture::Capture;
using capture::kAbsent;
using image::Picture;
using metric::Metric;
using metric::Summary;

constexpr std::size_t kGainPairs = 16, kNoisePhotos = 5;
constexpr double kUnknownNoise = 1e-4;  // where photos show none: a fifth of a step of 11 bits

template <class List>
std::set<std::size_t> positions(const char* what, const std::vector<std::string>& ids, const List& list) {
  std::set<std::size_t> out;
  if (ids.empty())
    for (std::size_t i = 0; i < list.size(); ++i) out.insert(i);
  for (const std::string& id : ids) {
    std::vector<std::string_view> names;
    for (const auto& one : list) names.push_back(one.id);
    const auto at = std::ranges::find(names, id);
    if (at == names.end()) {
      const std::string near = files::nearest_name(id, names.data(), names.size());
      throw files::UsageError(std::string("the capture has no ") + what + " " + files::in_quotes(id) +
                              (near.empty() ? "" : "; did you mean " + near + "?"));
    }
    out.insert(static_cast<std::size_t>(at - names.begin()));
  }
  return out;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// What does not change from pair to pair.
struct Work {
  const Capture& capture;
  const Options& options;
  const capture::Variant& variant;
  const view::Shower& shower;
  const std::vector<std::array<double, 3>>& noise_floor;
  const std::array<double, 3>& capture_gain_ev;
  std::string settings;                // of every result, as text
  std::vector<std::string> layer_key;  // of each camera: mask, normals and flat field by their contents
  Cache& cache;
};

struct Pair {
  Picture photo, render;
  std::vector<float> weight;
  double total = 0;
  std::size_t clipped = 0;
};

std::optional<glm::dvec3> to_light_at(const capture::Light& light) {
  if (const auto* distant = std::get_if<capture::DistantLight>(&light.place)) return distant->to_light;
  if (const auto* near = std::get_if<capture::NearLight>(&light.place))
    if (glm::length(near->position) > 0) return glm::normalize(near->position);  // the subject is about the origin
  return {};
}

Pair read_pair(const Capture& capture, const capture::Variant& variant, std::size_t frame, Weight weight) {
  const std::size_t camera = capture.frames[frame].camera, light = capture.frames[frame].light;
  capture::Photo photo = capture::read_photo(capture, frame);
  Pair pair{std::move(photo.light), capture::read_render(capture, variant, camera, light), {}};
  pair.weight.resize(photo.flaws.size());
  std::optional<Picture> normals;
  glm::dvec3 to_light(0);
  if (weight == Weight::kCosine) {
    normals = capture::read_normals(capture, camera);
    const auto known = to_light_at(capture.lights[light]);
    if (!known)
      throw files::InputError("light " + files::in_quotes(capture.lights[light].id) +
                              " has no place; --weight cosine needs one");
    to_light = *known;
  }
  for (std::size_t i = 0; i < pair.weight.size(); ++i) {
    if ((photo.flaws[i] & capture::kMasked) != 0) continue;
    if ((photo.flaws[i] & (capture::kClipped | capture::kNotFinite)) != 0) {
      ++pair.clipped;
      continue;
    }
    double w = 1;
    if (normals) {
      const float* const n = normals->rgb.data() + 3 * i;
      w = std::max(0.0, glm::dot(glm::dvec3(n[0], n[1], n[2]), to_light));
    }
    pair.weight[i] = static_cast<float>(w);
    pair.total += w;
  }
  return pair;
}

std::array<double, 3> gain_of(const Pair& pair, Match match, const std::array<double, 3>& noise) {
  const registration::Gain gain = registration::gain_between(pair.photo, pair.render, pair.weight, noise);
  return match == Match::kChannel ? gain.stops : std::array{gain.all, gain.all, gain.all};
}

std::string hash_of(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored) ? files::sha256(files::read_whole(file, image::kMostFileBytes)) : "absent";
}

// Everything that a pair's numbers depend on, in 32 digits.
std::string key_of(const Work& work, std::size_t at) {
  const capture::Frame& frame = work.capture.frames[at];
  const capture::Camera& camera = work.capture.cameras[frame.camera];
  const capture::Light& light = work.capture.lights[frame.light];
  std::string text = work.settings + work.layer_key[frame.camera];
  const auto add = [&](double value) { text += " " + files::number_text(value); };
  for (const double v : {frame.black, frame.white, frame.gain, light.intensity.x, light.intensity.y, light.intensity.z})
    add(v);
  text += std::isfinite(frame.clip) ? " " + files::number_text(frame.clip) : " never";
  text += " " + std::to_string(static_cast<int>(frame.transfer)) + std::to_string(static_cast<int>(frame.primaries));
  for (int i = 0; i < 9; ++i) add(camera.rec709_from_camera[i / 3][i % 3]);
  if (work.options.weight == Weight::kCosine)
    if (const auto to = to_light_at(light)) add(to->x), add(to->y), add(to->z);
  for (const double n : work.noise_floor[frame.camera]) add(n);
  for (const double g : work.capture_gain_ev) add(g);
  text += " " + hash_of(capture::photo_file(work.capture, frame)) + " " +
          hash_of(capture::render_file(work.capture, work.variant, frame.camera, frame.light));
  return files::sha256(text).substr(0, 32);
}

void compare(const Work& work, const std::vector<Metric>& metrics, std::size_t frame, Row& row,
             std::atomic<std::size_t>& from_cache) {
  const std::string key = work.options.cache.empty() ? "" : key_of(work, frame);
  row.summaries.resize(metrics.size());
  std::vector<std::size_t> open;
  for (std::size_t k = 0; k < metrics.size(); ++k) {
    if (const auto known = work.cache.find(key, metrics[k])) row.summaries[k] = *known;
    else open.push_back(k);
  }
  const auto facts = work.cache.find(key);
  if (open.empty() && facts) {
    row.gain_ev = facts->gain_ev;
    row.weight = facts->weight;
    row.clipped = facts->clipped;
    row.state = State::kCompared;
    from_cache += metrics.size();
    return;
  }
  Pair pair = read_pair(work.capture, work.variant, frame, work.options.weight);
  const auto& noise = work.noise_floor[row.camera];
  row.gain_ev = work.capture_gain_ev;
  if (work.options.match == Match::kLight || work.options.match == Match::kChannel)
    row.gain_ev = gain_of(pair, work.options.match, noise);
  for (std::size_t i = 0; i < pair.render.rgb.size(); ++i)
    pair.render.rgb[i] *= static_cast<float>(std::exp2(row.gain_ev[i % 3]));
  row.weight = pair.total;
  row.clipped = pair.clipped;
  metric::Pair both{.photo = &pair.photo, .render = &pair.render, .weight = pair.weight};
  for (std::size_t c = 0; c < 3; ++c) both.noise_floor[c] = static_cast<float>(noise[c]);
  both.exposures = {work.capture.flip_first_ev, work.capture.flip_last_ev};
  image::DisplayPicture shown_photo, shown_render;
  if (std::ranges::any_of(open, [&](std::size_t k) { return metric::row_of(metrics[k]).of == metric::Of::kDisplay; })) {
    shown_photo = work.shower.show(pair.photo);
    shown_render = work.shower.show(pair.render);
    both.shown_photo = &shown_photo;
    both.shown_render = &shown_render;
  }
  for (const std::size_t k : open) {
    row.summaries[k] = metric::summary_of(metric::map_of(metrics[k], both), pair.weight);
    work.cache.add(key, metrics[k], row.summaries[k]);
  }
  work.cache.add(key, PairFacts{row.gain_ev, row.weight, row.clipped});
  from_cache += metrics.size() - open.size();
  row.state = State::kCompared;
}

// The frames of a list that are evenly drawn.
std::vector<std::size_t> drawn(const std::vector<std::size_t>& frames, std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t count = std::min(frames.size(), most);
  for (std::size_t k = 0; k < count; ++k) out.push_back(frames[k * frames.size() / count]);
  return out;
}

// Of a camera whose noise nobody stated: the median of a few photos.
std::array<double, 3> measured_noise(const Capture& capture, const std::vector<std::size_t>& frames) {
  std::array<std::vector<double>, 3> all;
  for (const std::size_t frame : drawn(frames, kNoisePhotos)) {
    try {
      const auto dark = registration::darkness_of(capture::read_photo(capture, frame).light);
      for (std::size_t c = 0; c < 3; ++c) all[c].push_back(dark.noise[c]);
    } catch (const files::InputError&) {  // its row will say so
    }
  }
  std::array<double, 3> noise{kUnknownNoise, kUnknownNoise, kUnknownNoise};
  for (std::size_t c = 0; c < 3; ++c)
    if (!all[c].empty() && median(all[c]) > 0) noise[c] = median(all[c]);
  return noise;
}

std::array<double, 3> median_gain(const Capture& capture, const capture::Variant& variant,
                                  const std::vector<std::size_t>& frames, const Options& options,
                                  const std::vector<std::array<double, 3>>& noise) {
  std::vector<double> gains;
  for (const std::size_t frame : drawn(frames, kGainPairs)) {
    try {
      const Pair pair = read_pair(capture, variant, frame, options.weight);
      gains.push_back(gain_of(pair, Match::kLight, noise[capture.frames[frame].camera])[0]);
    } catch (const files::InputError&) {  // its row will say so
    }
  }
  const double gain = gains.empty() ? 0 : median(gains);
  return {gain, gain, gain};
}

// Whether the fault of a file is its size.
bool is_other_size(const fs::path& file, const capture::Camera& camera) {
  try {
    const Picture picture = capture::read_encoded(file);
    return picture.width != camera.width || picture.height != camera.height;
  } catch (const files::InputError&) {
    return false;
  }
}

}  // namespace

Comparison run_compare(const Capture& capture, const Options& options) {
  const std::set<std::size_t> cameras = positions("camera", options.cameras, capture.cameras);
  const std::set<std::size_t> lights = positions("light", options.lights, capture.lights);
  if (capture.variants.empty())
    throw files::UsageError("the capture has no variant of renders; make one with likeness olat render");
  const capture::Variant& variant =
      capture.variants[options.variant.empty() ? capture::rendered_variant_of(capture)
                                               : *positions("variant", {options.variant}, capture.variants).begin()];
  if (options.weight == Weight::kCosine)
    for (const std::size_t camera : cameras)
      if (capture::layer_file(capture, camera, capture::Layer::kNormal).empty())
        throw files::UsageError("--weight cosine needs normals; camera " +
                                files::in_quotes(capture.cameras[camera].id) + " has none");

  Comparison out;
  out.variant = variant.id;
  out.view = options.view.empty() ? capture.pipeline.view : options.view;
  out.ev = capture.pipeline.ev + options.ev;
  out.match = options.match;
  out.weight = options.weight;
  out.metrics = options.metrics;
  for (std::size_t k = 0; options.metrics.empty() && k < metric::kMetrics.size(); ++k)
    out.metrics.push_back(static_cast<Metric>(k));
  scene::View shown;
  shown.name = out.view;
  shown.ev = out.ev;
  const view::Shower shower(shown);

  const capture::FrameTable table(capture);
  std::vector<std::size_t> frames;
  for (const std::size_t camera : cameras)
    for (const std::size_t light : lights) {
      const std::size_t frame = table.frame(camera, light);
      if (frame == kAbsent) continue;
      Row& row = out.rows.emplace_back();
      row.camera = camera;
      row.light = light;
      std::error_code ignored;
      if (!fs::exists(capture::render_file(capture, variant, camera, light), ignored)) row.state = State::kNoRender;
      frames.push_back(frame);
    }
  for (std::size_t camera = 0; camera < capture.cameras.size(); ++camera) {
    const bool stated = camera < capture.noise_floor.size() && glm::length(capture.noise_floor[camera]) > 0;
    std::array<double, 3> noise{kUnknownNoise, kUnknownNoise, kUnknownNoise};
    if (stated) {
      for (int c = 0; c < 3; ++c) noise[static_cast<std::size_t>(c)] = capture.noise_floor[camera][c];
    } else {
      std::vector<std::size_t> own;
      for (const std::size_t frame : frames)
        if (capture.frames[frame].camera == camera) own.push_back(frame);
      noise = measured_noise(capture, own);
    }
    out.noise_floor.push_back(noise);
    out.noise_is_measured.push_back(!stated);
  }
  std::array<double, 3> capture_gain_ev{};
  if (options.match == Match::kCapture) {
    std::vector<std::size_t> rendered;
    for (std::size_t i = 0; i < frames.size(); ++i)
      if (out.rows[i].state != State::kNoRender) rendered.push_back(frames[i]);
    capture_gain_ev = median_gain(capture, variant, rendered, options, out.noise_floor);
  }

  Cache cache(options.cache);
  Work work{capture, options, variant, shower, out.noise_floor, capture_gain_ev, {}, {}, cache};
  if (!options.cache.empty()) {
    work.settings = "1 " + out.view + " " + files::number_text(out.ev) + " " +
                    std::string(kMatches[static_cast<std::size_t>(out.match)].word) + " " +
                    std::string(kWeights[static_cast<std::size_t>(out.weight)].word) + " " +
                    files::number_text(capture.flip_first_ev) + " " + files::number_text(capture.flip_last_ev);
    for (std::size_t camera = 0; camera < capture.cameras.size(); ++camera) {
      std::string& text = work.layer_key.emplace_back();
      for (const auto layer : {capture::Layer::kMask, capture::Layer::kNormal, capture::Layer::kFlatField})
        if (const fs::path file = capture::layer_file(capture, camera, layer); !file.empty())
          text += " " + hash_of(file);
    }
  }
  std::atomic<std::size_t> done{0}, from_cache{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t i) {
    Row& row = out.rows[i];
    if (stop) return;
    try {
      if (row.state != State::kNoRender) compare(work, out.metrics, frames[i], row, from_cache);
    } catch (const files::InputError& error) {
      const capture::Camera& camera = capture.cameras[row.camera];
      const bool size = is_other_size(capture::photo_file(capture, capture.frames[frames[i]]), camera) ||
                        is_other_size(capture::render_file(capture, variant, row.camera, row.light), camera);
      row.state = size ? State::kOtherSize : State::kUnreadable;
      row.fault = error.what();
      row.summaries.clear();
    }
    const double share = static_cast<double>(++done) / static_cast<double>(frames.size());
    const std::scoped_lock lock(mutex);
    if (options.keep_going && !options.keep_going("compare", share)) stop = true;
  });
  out.from_cache = from_cache;
  out.is_complete = std::ranges::none_of(out.rows, [](const Row& r) { return r.state == State::kNotReached; });
  return out;
}

}  // namespace likeness::olat_compare
