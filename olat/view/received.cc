// Renders that were not read from the capture but received by tev's protocol.
#include <algorithm>
#include <string>
#include <utility>

#include "olat/view/answers.h"
#include "render/files/files.h"

namespace likeness::olat_view {

using capture::kAbsent;
using olat_pair::Pair;
using olat_pair::Place;
using olat_pair::State;

namespace {

template <class List>
bool has_id(const List& list, std::string_view id) {
  return std::any_of(list.begin(), list.end(), [&](const auto& item) { return item.id == id; });
}

// "pbrt/c0/l3" to "pbrt" if the capture has c0 and l3; other names are variants as they are.
std::string variant_of(const capture::Capture& capture, const std::string& name) {
  const std::size_t light = name.rfind('/');
  if (light == name.npos || light == 0) return name;
  const std::size_t camera = name.rfind('/', light - 1);
  if (camera == name.npos || camera == 0) return name;
  const bool is_pair = has_id(capture.cameras, std::string_view(name).substr(camera + 1, light - camera - 1)) &&
                       has_id(capture.lights, std::string_view(name).substr(light + 1));
  return is_pair ? name.substr(0, camera) : name;
}

}  // namespace

std::map<std::string, std::uint64_t> Answers::received_variants() const {
  std::map<std::string, std::uint64_t> out;
  if (!received_) return out;
  for (const auto& known : received_->list()) {
    const std::string variant = variant_of(capture_, known.name);
    if (has_id(capture_.variants, variant)) continue;  // the capture's own is not hidden
    std::uint64_t& version = out[variant];
    version = std::max(version, known.version);
  }
  return out;
}

bool Answers::is_received(const State& state) const {
  return received_ && !state.variant.empty() && received_variants().contains(state.variant);
}

Place Answers::place_of(const State& state) const {
  if (!is_received(state)) return olat_pair::place_of(capture_, state);
  State without = state;
  without.variant.clear();
  Place place = olat_pair::place_of(capture_, without);
  place.variant = kAbsent;
  return place;
}

std::string Answers::received_name(const std::string& variant, const Place& place) const {
  const std::string of_pair = variant + "/" + capture_.cameras[place.camera].id + "/" + capture_.lights[place.light].id;
  for (const std::string& name : {of_pair, variant})
    if (received_->version(name)) return name;
  return "";
}

image::Picture Answers::received_render(const std::string& variant, const Place& place) const {
  const std::string name = received_name(variant, place);
  const auto picture = name.empty() ? std::nullopt : received_->picture(name);
  if (!picture) return {};
  const capture::Camera& camera = capture_.cameras[place.camera];
  if (picture->width != camera.width || picture->height != camera.height)
    throw files::InputError(files::in_quotes(name) + ", received by tev's protocol, has " +
                            std::to_string(picture->width) + " x " + std::to_string(picture->height) +
                            " pixels; camera " + files::in_quotes(camera.id) + " has " + std::to_string(camera.width) +
                            " x " + std::to_string(camera.height));
  return *picture;
}

std::array<double, 3> Answers::gain_of(State state, const Pair& pair) const {
  if (is_received(state)) {
    state.variant.clear();
    if (state.match == olat_pair::Match::kCapture) state.match = olat_pair::Match::kLight;  // there is one pair
  }
  return olat_pair::gain_of(capture_, state, pair);
}

Pair Answers::pair_of(const State& state) const {
  if (!is_received(state)) return olat_pair::load_pair(capture_, state);
  State without = state;
  without.variant.clear();
  without.match = olat_pair::Match::kNone;
  Pair pair = olat_pair::load_pair(capture_, without);
  pair.render = received_render(state.variant, place_of(state));
  const std::array<double, 3> gain = gain_of(state, pair);
  for (std::size_t c = 0; c < 3; ++c) pair.gain[c] = static_cast<float>(gain[c]);
  return pair;
}

}  // namespace likeness::olat_view
