#include "olat/view/answers.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <utility>

#include <nlohmann/json.hpp>

#include "olat/pair/exposure.h"
#include "olat/pair/tables.h"
#include "olat/view/clock.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/image/write.h"

namespace likeness::olat_view {
namespace {

using Json = nlohmann::ordered_json;
using capture::kAbsent;
using files::InputError;
using files::UsageError;
using olat_pair::Place;
using olat_pair::State;

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string parameter(const Parameters& parameters, const std::string& name, const std::string& otherwise) {
  const auto at = parameters.find(name);
  return at == parameters.end() ? otherwise : at->second;
}

int whole(const Parameters& parameters, const std::string& name, int low, int high) {
  const std::string text = parameter(parameters, name, "0");
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high)
    throw UsageError(name + " = " + files::in_quotes(text) + " is not a whole number from " + std::to_string(low) +
                     " to " + std::to_string(high));
  return value;
}

// From the subject to the light, or null.
Json direction_of(const capture::Light& light) {
  glm::dvec3 to{0};
  if (const auto* distant = std::get_if<capture::DistantLight>(&light.place)) to = distant->to_light;
  if (const auto* near = std::get_if<capture::NearLight>(&light.place)) to = near->position;
  const double length = std::sqrt(to.x * to.x + to.y * to.y + to.z * to.z);
  if (!(length > 0)) return nullptr;
  return {to.x / length, to.y / length, to.z / length};
}

class Turn {
 public:
  explicit Turn(std::counting_semaphore<>& of) : of_(of) { of_.acquire(); }
  ~Turn() { of_.release(); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  std::counting_semaphore<>& of_;
};

Answer refusal(int status, const std::string& text) {
  Answer out;
  out.status = status;
  out.body = dumped({{"error", text}});
  return out;
}

}  // namespace

Answers::Answers(capture::Capture capture, const ViewOptions& options)
    : capture_(std::move(capture)), frames_(capture_), received_(options.received), cache_(options.cache_bytes) {
  // Refuses a capture without cameras or lights.
  if (const std::size_t v = olat_pair::place_of(capture_, {}).variant; v != kAbsent) variant_ = v;
  if (options.with_scores) scorer_ = std::thread([this] { score_all(); });
}

Answers::~Answers() {
  stop_ = true;
  if (scorer_.joinable()) scorer_.join();
}

Answer Answers::answer(std::string_view path, const Parameters& parameters) {
  try {
    return answer_or_throw(path, parameters);
  } catch (const UsageError& e) {
    return refusal(400, e.what());
  } catch (const InputError& e) {
    return refusal(422, e.what());
  } catch (const std::exception& e) {
    return refusal(500, e.what());
  }
}

Answer Answers::answer_or_throw(std::string_view path, const Parameters& parameters) {
  const auto json = [](std::string body) {
    Answer out;
    out.body = std::move(body);
    return out;
  };
  if (path == "/api/scores") return json(scores_json(parameters));
  last_request_ms_ = milliseconds_now();
  const State state = olat_pair::state_of(parameter(parameters, "state", ""));
  if (path == "/api/tables") return json(olat_pair::tables_json());
  if (path == "/api/capture") return json(capture_json());
  if (path == "/api/frame") return json(frame_json(state));
  if (path == "/api/gain") return gain(parameters);
  if (path == "/api/exposure") return json(exposure_json(state));
  if (path == "/api/pixels") return pixels(parameters);
  if (path == "/render") {
    const Turn turn(large_);
    Answer out;
    out.type = "image/png";
    out.body = image::png_bytes(olat_pair::picture_of(state, pair_of(state)));
    return out;
  }
  return refusal(404, "there is nothing at " + files::in_quotes(path));
}

std::string Answers::capture_json() const {
  Json out{{"name", capture_.name},
           {"root", capture_.root.string()},
           {"license", capture_.license},
           {"citation", capture_.citation},
           {"source", capture_.source}};
  for (const capture::Camera& camera : capture_.cameras) {
    Json rows;
    for (int row = 0; row < 3; ++row)
      rows.push_back(
          {camera.world_from_camera[0][row], camera.world_from_camera[1][row], camera.world_from_camera[2][row]});
    out["cameras"].push_back({{"id", camera.id},
                              {"label", camera.label},
                              {"width", camera.width},
                              {"height", camera.height},
                              {"world_from_camera", rows}});
  }
  for (const capture::Light& light : capture_.lights)
    out["lights"].push_back({{"id", light.id}, {"label", light.label}, {"direction", direction_of(light)}});
  out["variants"] = Json::array();
  for (const capture::Variant& variant : capture_.variants) out["variants"].push_back(variant.id);
  for (const auto& [variant, version] : received_variants()) out["variants"].push_back(variant);
  if (const std::size_t v = olat_pair::place_of(capture_, {}).variant; v != kAbsent)
    out["variant"] = capture_.variants[v].id;
  for (std::size_t c = 0; c < capture_.cameras.size(); ++c) {
    std::string has(capture_.lights.size(), '0');
    for (std::size_t l = 0; l < has.size(); ++l)
      if (frames_.frame(c, l) != kAbsent) has[l] = '1';
    out["photos"].push_back(has);
  }
  out["pipeline"] = {
      {"ev", capture_.pipeline.ev}, {"view", capture_.pipeline.view}, {"match", capture_.pipeline.match_gain}};
  out["flip"] = {capture_.flip_first_ev, capture_.flip_last_ev};
  return dumped(out);
}

std::string Answers::frame_json(const State& state) const {
  const Place place = place_of(state);
  Json out{{"camera", capture_.cameras[place.camera].id}, {"light", capture_.lights[place.light].id}};
  const std::size_t at = frames_.frame(place.camera, place.light);
  if (at != kAbsent) {
    const capture::Frame& frame = capture_.frames[at];
    out["photo"] = frame.file.string();
    out["transfer"] = std::string(capture::kTransfers[static_cast<std::size_t>(frame.transfer)]);
    out["primaries"] = std::string(capture::kPrimaries[static_cast<std::size_t>(frame.primaries)]);
    out["gain"] = frame.gain;
    if (frame.exposure_s) out["exposure_s"] = *frame.exposure_s;
    if (frame.iso) out["iso"] = *frame.iso;
    if (frame.f_number) out["f_number"] = *frame.f_number;
    if (!frame.sha256.empty()) out["sha256"] = frame.sha256;
  }
  const glm::dvec3 i = capture_.lights[place.light].intensity;
  out["intensity"] = {i.x, i.y, i.z};
  if (!capture_.lights[place.light].calibrated_by.empty())
    out["calibrated_by"] = capture_.lights[place.light].calibrated_by;
  if (place.variant != kAbsent) {
    const auto file = capture::render_file(capture_, capture_.variants[place.variant], place.camera, place.light);
    if (std::filesystem::exists(file)) out["render"] = file.lexically_relative(capture_.root).string();
  }
  if (is_received(state))
    if (const std::string name = received_name(state.variant, place); !name.empty()) out["render"] = "tev: " + name;
  return dumped(out);
}

Answer Answers::gain(const Parameters& parameters) {
  const State state = olat_pair::state_of(parameter(parameters, "state", ""));
  olat_pair::Pair pair;
  const Place place = place_of(state);
  std::array<double, 3> gain{1, 1, 1};
  if (state.match != olat_pair::Match::kNone) {
    const Turn turn(large_);
    const Cache::Entry photo = picture("photo", state, 0), render = picture("render", state, 0);
    if (!photo->rgba.empty() && !render->rgba.empty()) {
      pair.photo = light_of(*photo);
      pair.flaws = flaws_of(*photo);
      pair.render = light_of(*render);
      gain = gain_of(state, pair);
    }
  }
  Answer out;
  out.body = dumped({{"gain", gain}, {"noise", noise_of(state, place)}});
  return out;
}

double Answers::noise_of(const State& state, const Place& place) const {
  if (state.noise > 0) return state.noise;
  if (place.camera < capture_.noise_floor.size()) {
    const glm::dvec3 n = capture_.noise_floor[place.camera];
    if (const double y = 0.2126 * n.x + 0.7152 * n.y + 0.0722 * n.z; y > 0) return y;
  }
  return static_cast<double>(olat_pair::Pair::kUnknownNoise);
}

std::string Answers::exposure_json(const State& state) {
  Cache::Entry from = picture("photo", state, 0);
  if (from->rgba.empty()) from = picture("render", state, 0);
  Json out{{"percentile", nullptr}, {"average", nullptr}};
  if (from->rgba.empty()) return dumped(out);
  const Turn turn(large_);
  if (const auto found = olat_pair::exposures_of(light_of(*from), flaws_of(*from), noise_of(state, place_of(state)))) {
    out["percentile"] = found->percentile;
    out["average"] = found->average;
  }
  return dumped(out);
}

Answer Answers::pixels(const Parameters& parameters) {
  constexpr int kMostLevel = 12;
  const std::string kind = parameter(parameters, "kind", "");
  if (kind != "photo" && kind != "render" && kind != "flip")
    throw UsageError("kind = " + files::in_quotes(kind) + " is none of photo, render and flip");
  Answer out;
  out.type = "application/octet-stream";
  out.pixels =
      picture(kind, olat_pair::state_of(parameter(parameters, "state", "")), whole(parameters, "level", 0, kMostLevel));
  if (out.pixels->rgba.empty()) return refusal(404, "there is no " + kind + " of this camera and light");
  return out;
}

Cache::Entry Answers::picture(std::string_view kind, const State& state, int level) {
  const Place place = place_of(state);
  std::string key = std::string(kind) + " " + std::to_string(place.camera) + " " + std::to_string(place.light) + " ";
  if (kind != "photo" && is_received(state)) {
    const std::string name = received_name(state.variant, place);
    key += name + " " + std::to_string(received_->version(name).value_or(0)) + " ";
  } else if (kind != "photo") {
    key += std::to_string(place.variant) + " ";
  }
  if (kind == "flip") key += state.metric + " " + olat_pair::pipeline_of(state) + " ";
  const auto key_of = [&](int k) { return key + std::to_string(k); };
  if (Cache::Entry at = cache_.kept(key_of(level))) return at;
  Cache::Entry above = cache_.find(key_of(0), [&] { return read(kind, state); });
  for (int k = 1; k <= level; ++k) above = cache_.find(key_of(k), [&] { return halved(*above); });
  return above;
}

std::shared_ptr<const capture::CameraLayers> Answers::layers_of(std::size_t camera) {
  const std::lock_guard lock(layers_mutex_);
  if (layers_camera_ != camera || !layers_) {
    layers_ = std::make_shared<const capture::CameraLayers>(capture::read_camera_layers(capture_, camera));
    layers_camera_ = camera;
  }
  return layers_;
}

HalfPicture Answers::read(std::string_view kind, const State& state) {
  const Place place = place_of(state);
  if (kind == "photo") {
    const std::size_t at = frames_.frame(place.camera, place.light);
    if (at == kAbsent || !std::filesystem::exists(capture::photo_file(capture_, capture_.frames[at]))) return {};
    const capture::Photo photo = capture::read_photo(capture_, at, *layers_of(place.camera));
    return half_of(photo.light, photo.flaws);
  }
  if (kind == "render") {
    if (is_received(state)) return half_of(received_render(state.variant, place), {});
    if (place.variant == kAbsent) return {};
    const capture::Variant& variant = capture_.variants[place.variant];
    if (!std::filesystem::exists(capture::render_file(capture_, variant, place.camera, place.light))) return {};
    return half_of(capture::read_render(capture_, variant, place.camera, place.light), {});
  }
  const olat_pair::Pair pair = pair_of(state);
  if (pair.photo.width == 0 || pair.render.width == 0) return {};
  return half_of_map(pair.width(), pair.height(), olat_pair::flip_map(state, pair));
}

}  // namespace likeness::olat_view
