#include "olat/check/facts.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include <glm/geometric.hpp>

#include "olat/check/finder.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/image/attributes.h"
#include "render/image/exr_exposure.h"
#include "render/image/read.h"

namespace likeness::olat_check {
namespace {

namespace fs = std::filesystem;
using capture::Capture;
using capture::Frame;
using image::Picture;

// What a row states and its EXR states otherwise, in stops of light.
void compare_attributes(const Frame& frame, const image::ExrExposure& stated, Facts& facts) {
  const auto compare = [&](const char* name, std::optional<double> row, std::optional<double> file, double power) {
    if (!row || !file) return;
    const double off = *row > 0 && *file > 0 ? std::abs(power * std::log2(*row / *file)) : 1e3;
    if (!(off > row_of(Rule::kExposureAttributes).allowed)) return;
    facts.attributes += (facts.attributes.empty() ? "" : "; ") + std::string(name) + " is " + number(*row) +
                        " in frames.json and " + number(*file) + " in the EXR";
    facts.attributes_ev = std::max(facts.attributes_ev, off);
  };
  compare("exposure_s", frame.exposure_s, stated.exposure_s, 1);
  compare("iso", frame.iso, stated.iso, 1);
  compare("f_number", frame.f_number, stated.f_number, 2);
}

void read_bytes(const fs::path& file, const Frame& frame, Facts& facts) {
  const std::string bytes = files::read_whole(file, image::kMostFileBytes);
  if (!frame.sha256.empty())
    if (const std::string found = files::sha256(bytes); found != frame.sha256) facts.sha256 = found;
  compare_attributes(frame, image::exposure_of_exr(bytes, file.string()), facts);
}

// The size of a file that is no picture of its camera; nothing if it is none at all.
std::optional<std::array<int, 2>> size_of(const fs::path& file, const capture::Camera& camera) {
  try {
    const Picture picture = capture::read_encoded(file);
    if (picture.width != camera.width || picture.height != camera.height)
      return std::array{picture.width, picture.height};
  } catch (const files::InputError&) {}
  return {};
}

// The cosine as a picture: what light a white Lambert surface would send back.
Picture cosine(const Picture& normals, const std::array<double, 3>& to_light) {
  Picture out(normals.width, normals.height);
  for (std::size_t i = 0; i < normals.rgb.size(); i += 3) {
    const float* const n = normals.rgb.data() + i;
    const double value = static_cast<double>(n[0]) * to_light[0] + static_cast<double>(n[1]) * to_light[1] +
                         static_cast<double>(n[2]) * to_light[2];
    std::fill_n(out.rgb.begin() + static_cast<std::ptrdiff_t>(i), 3, static_cast<float>(std::max(0.0, value)));
  }
  return out;
}

bool is_older(const fs::path& file, const fs::path& than) {
  std::error_code a, b;
  const auto written = fs::last_write_time(file, a), changed = fs::last_write_time(than, b);
  return !a && !b && written < changed;
}

// What the header of a render says of another pair. Renders of other programs say nothing.
std::string other_pair(const Capture& capture, const capture::Variant& variant, const fs::path& file,
                       std::size_t camera, std::size_t light) {
  const auto attributes = image::attributes_of_whole_exr(file);
  if (!attributes) return {};
  std::string out;
  const auto compare = [&](const char* key, const std::string& id) {
    const auto stated = attributes->find(key);
    if (stated != attributes->end() && stated->second != id)
      out += (out.empty() ? "" : ", ") + std::string(key) + " is " + files::in_quotes(stated->second) + " instead of " +
             files::in_quotes(id);
  };
  compare("olat:camera", capture.cameras[camera].id);
  compare("olat:light", capture.lights[light].id);
  compare("olat:variant", variant.id);
  return out;
}

std::optional<Picture> render_of(const Capture& capture, const Request& request, std::size_t camera, Facts& facts) {
  if (request.variant == nullptr) return {};
  const fs::path file = capture::render_file(capture, *request.variant, camera, facts.light);
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  try {
    Picture render = capture::read_render(capture, *request.variant, camera, facts.light);
    facts.has_render = true;
    for (const char* list : {"cameras.json", "lights.json"})  // written before capture.json, unless they were changed
      facts.is_stale = facts.is_stale || (is_older(file, capture.root / list) &&
                                          is_older(capture.root / "capture.json", capture.root / list));
    facts.render_header = other_pair(capture, *request.variant, file, camera, facts.light);
    for (std::size_t i = 0; i < render.rgb.size(); i += 3)
      if (!std::all_of(&render.rgb[i], &render.rgb[i] + 3, [](float v) { return std::isfinite(v); }))
        ++facts.render_not_finite;
    return render;
  } catch (const files::InputError& error) {
    facts.render_unreadable = error.what();
    return {};
  }
}

// Weights of what can be compared: inside the mask, without flaws.
std::vector<float> look_inside(const capture::Photo& photo, const View& view, Facts& facts) {
  std::vector<float> weight = view.mask;
  std::array<double, 3> sum{};
  std::size_t sound = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    if (!(weight[i] > 0)) continue;
    ++facts.inside;
    facts.clipped += (photo.flaws[i] & capture::kClipped) != 0 ? 1 : 0;
    facts.not_finite += (photo.flaws[i] & capture::kNotFinite) != 0 ? 1 : 0;
    if ((photo.flaws[i] & (capture::kClipped | capture::kNotFinite)) != 0) {
      weight[i] = 0;
      continue;
    }
    ++sound;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(photo.light.rgb[3 * i + c]);
  }
  if (sound > 0)
    for (std::size_t c = 0; c < 3; ++c) facts.mean[c] = sum[c] / static_cast<double>(sound);
  return weight;
}

}  // namespace

std::optional<std::array<double, 3>> to_light_of(const capture::Light& light) {
  glm::dvec3 to{0, 0, 0};
  if (const auto* distant = std::get_if<capture::DistantLight>(&light.place)) to = distant->to_light;
  if (const auto* near = std::get_if<capture::NearLight>(&light.place)) to = near->position;
  if (!(glm::length(to) > 0)) return {};
  to = glm::normalize(to);
  return std::array{to.x, to.y, to.z};
}

Facts facts_of(const Capture& capture, const View& view, const Request& request) {
  const Frame& frame = capture.frames[request.frame];
  const fs::path file = capture::photo_file(capture, frame);
  Facts facts;
  facts.light = frame.light;
  facts.frame = request.frame;
  capture::Photo photo;
  try {
    if (request.reads_hash) read_bytes(file, frame, facts);
    photo = capture::read_photo(capture, request.frame);
  } catch (const files::InputError& error) {
    facts.size = size_of(file, capture.cameras[frame.camera]);
    facts.unreadable = error.what();
    return facts;
  }
  const std::vector<float> weight = look_inside(photo, view, facts);
  facts.darkness = registration::darkness_of(photo.light);
  facts.sketch = registration::sketch_of(photo.light, view.mask);

  std::optional<Picture> reference = render_of(capture, request, frame.camera, facts);
  if (!reference && view.normals)
    if (const auto to_light = to_light_of(capture.lights[frame.light])) reference = cosine(*view.normals, *to_light);
  if (!reference) return facts;
  facts.has_reference = true;
  facts.reference = registration::sketch_of(*reference, view.mask);
  const auto& noise = facts.darkness.noise;
  facts.curve = registration::curve_between(photo.light, *reference, weight, std::ranges::max(noise));
  if (!facts.has_render) return facts;
  facts.gain = registration::gain_between(photo.light, *reference, weight, noise);
  if (request.measures_shift)
    facts.shift = registration::shift_between(photo.light, *reference, weight, std::ranges::max(noise));
  return facts;
}

}  // namespace likeness::olat_check
