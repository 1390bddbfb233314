#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "olat/pair/picture.h"
#include "olat/registration/gain.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"

namespace likeness::olat_pair {
namespace {

using capture::kAbsent;

template <class List>
std::size_t position(std::string_view what, const std::string& id, const List& list) {
  if (list.empty()) return kAbsent;
  if (id.empty()) return 0;
  std::vector<std::string_view> ids;
  for (const auto& item : list) ids.push_back(item.id);
  const auto at = std::find(ids.begin(), ids.end(), id);
  if (at != ids.end()) return static_cast<std::size_t>(at - ids.begin());
  const std::string near = files::nearest_name(id, ids.data(), ids.size());
  throw files::UsageError(
      "state: the capture has no " + std::string(what) + " " + files::in_quotes(id) +
      (near.empty() ? " (it has " + std::to_string(ids.size()) + ", the first is " + files::in_quotes(ids.front()) + ")"
                    : "; did you mean " + near + "?"));
}

float luminance(const float* rgb) { return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]; }

}  // namespace

Place place_of(const capture::Capture& capture, const State& state) {
  if (capture.cameras.empty() || capture.lights.empty())
    throw files::UsageError("the capture has no " + std::string(capture.cameras.empty() ? "cameras" : "lights"));
  std::size_t variant = position("variant", state.variant, capture.variants);
  for (std::size_t v = 0; state.variant.empty() && v < capture.variants.size(); ++v) {
    if (!std::filesystem::exists(capture::render_file(capture, capture.variants[v], 0, 0).parent_path())) continue;
    variant = v;
    break;
  }
  return {position("camera", state.camera, capture.cameras), position("light", state.light, capture.lights), variant};
}

namespace {

Pair read_pair(const capture::Capture& capture, const Place& place) {
  Pair pair;
  const std::size_t frame = capture::FrameTable(capture).frame(place.camera, place.light);
  if (frame != kAbsent && std::filesystem::exists(capture::photo_file(capture, capture.frames[frame]))) {
    capture::Photo photo = capture::read_photo(capture, frame);
    pair.photo = std::move(photo.light);
    pair.flaws = std::move(photo.flaws);
  }
  if (place.variant != kAbsent) {
    const capture::Variant& variant = capture.variants[place.variant];
    const auto file = capture::render_file(capture, variant, place.camera, place.light);
    if (std::filesystem::exists(file)) pair.render = capture::read_render(capture, variant, place.camera, place.light);
  }
  if (pair.photo.width > 0 && pair.render.width > 0 &&
      (pair.photo.width != pair.render.width || pair.photo.height != pair.render.height))
    throw files::InputError("camera " + files::in_quotes(capture.cameras[place.camera].id) + ", light " +
                            files::in_quotes(capture.lights[place.light].id) + ": the photo is " +
                            std::to_string(pair.photo.width) + " x " + std::to_string(pair.photo.height) +
                            ", the render " + std::to_string(pair.render.width) + " x " +
                            std::to_string(pair.render.height));
  const std::size_t count = static_cast<std::size_t>(pair.width()) * static_cast<std::size_t>(pair.height());
  if (pair.flaws.size() != count) pair.flaws.assign(count, 0);
  if (place.camera < capture.noise_floor.size()) {
    const glm::dvec3 n = capture.noise_floor[place.camera];
    const float rgb[] = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
    if (luminance(rgb) > 0) pair.noise = luminance(rgb);
  }
  return pair;
}

}  // namespace

std::array<double, 3> match_gain(const Pair& pair, bool by_channel) {
  if (pair.photo.rgb.size() != pair.render.rgb.size()) return {1, 1, 1};
  // A million pixels say as much as all of them.
  const std::size_t step = 1 + pair.flaws.size() / 1'000'000;
  std::vector<float> weight(pair.flaws.size(), 0);
  for (std::size_t i = 0; i < weight.size(); i += step) weight[i] = pair.flaws[i] == 0 ? 1 : 0;
  const double noise = static_cast<double>(pair.noise);
  const registration::Gain gain = registration::gain_between(pair.photo, pair.render, weight, {noise, noise, noise});
  std::array<double, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = std::exp2(by_channel ? gain.stops[c] : gain.all);
  return out;
}

std::array<double, 3> gain_of(const capture::Capture& capture, const State& state, const Pair& pair) {
  if (state.match == Match::kNone || pair.render.width == 0 || pair.photo.width == 0) return {1, 1, 1};
  if (state.match != Match::kCapture) return match_gain(pair, state.match == Match::kChannel);

  constexpr std::size_t kMostPairs = 16;
  const Place place = place_of(capture, state);
  const std::size_t all = capture.cameras.size() * capture.lights.size(), count = std::min(all, kMostPairs);
  std::vector<double> gains;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = k * all / count;
    const Pair other = read_pair(capture, {at / capture.lights.size(), at % capture.lights.size(), place.variant});
    if (other.photo.width > 0 && other.render.width > 0) gains.push_back(match_gain(other, false)[0]);
  }
  if (gains.empty()) return {1, 1, 1};
  const auto middle = gains.begin() + static_cast<std::ptrdiff_t>(gains.size() / 2);
  std::nth_element(gains.begin(), middle, gains.end());
  return {*middle, *middle, *middle};
}

Pair load_pair(const capture::Capture& capture, const State& state) {
  Pair pair = read_pair(capture, place_of(capture, state));
  const std::array<double, 3> gain = gain_of(capture, state, pair);
  for (std::size_t c = 0; c < 3; ++c) pair.gain[c] = static_cast<float>(gain[c]);
  pair.flip_exposures = {capture.flip_first_ev, capture.flip_last_ev};
  if (state.noise > 0) pair.noise = static_cast<float>(state.noise);
  return pair;
}

}  // namespace likeness::olat_pair
