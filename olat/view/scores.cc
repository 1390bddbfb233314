// Every pair of the capture compared in the background, while nobody waits for a picture.
#include <chrono>
#include <cmath>
#include <limits>

#include <sys/resource.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <tbb/task_arena.h>

#include "olat/metric/metric.h"
#include "olat/view/answers.h"
#include "olat/view/clock.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/view/view.h"

namespace likeness::olat_view {
namespace {

using Json = nlohmann::ordered_json;
using capture::kAbsent;

constexpr int kLongestSide =
    512;  // pictures are halved until they fit: quick, and single pixels say little in a matrix
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

bool is_mean(metric::Metric metric) { return metric == metric::Metric::kFlip || metric == metric::Metric::kHdrFlip; }

HalfPicture reduced(HalfPicture picture) {
  while (std::max(picture.width, picture.height) > kLongestSide) picture = halved(picture);
  return picture;
}

}  // namespace

void Answers::score_all() {
  // On one thread of its own, which the system runs when nobody else wants to: a picture that is asked for comes first.
  tbb::task_arena alone(1);
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 19);
  constexpr auto kNap = std::chrono::milliseconds(50);
  constexpr long kQuiet = 400;  // [ms] since the last request
  while (!stop_) {
    std::this_thread::sleep_for(kNap);
    if (milliseconds_now() - last_request_ms_ < kQuiet || capture_.variants.empty()) continue;

    const std::size_t variant = variant_, lights = capture_.lights.size(), all = capture_.cameras.size() * lights;
    std::size_t next = kAbsent;
    {
      const std::lock_guard lock(scores_mutex_);
      std::vector<Score>& scores = scores_[variant];
      scores.resize(all);
      if (scored_[variant] == all) continue;
      const std::size_t first = first_camera_ * lights;
      for (std::size_t k = 0; k < all && next == kAbsent; ++k)
        if (scores[(first + k) % all].of_metric.empty()) next = (first + k) % all;
    }
    if (next == kAbsent) continue;
    Score score = alone.execute([&] { return this->score({next / lights, next % lights, variant}); });
    const std::lock_guard lock(scores_mutex_);
    scores_[variant][next] = std::move(score);
    ++scored_[variant];
  }
}

Answers::Score Answers::score(const olat_pair::Place& place) {
  Score out{std::vector<float>(metric::kMetrics.size(), kUnknown)};
  try {
    const std::size_t at = frames_.frame(place.camera, place.light);
    const capture::Variant& variant = capture_.variants[place.variant];
    if (at == kAbsent || !std::filesystem::exists(capture::photo_file(capture_, capture_.frames[at])) ||
        !std::filesystem::exists(capture::render_file(capture_, variant, place.camera, place.light)))
      return out;
    const capture::Photo from = capture::read_photo(capture_, at, *layers_of(place.camera));
    const HalfPicture photo_half = reduced(half_of(from.light, from.flaws));
    const image::Picture photo = light_of(photo_half);
    const image::Picture render =
        light_of(reduced(half_of(capture::read_render(capture_, variant, place.camera, place.light), {})));
    if (photo.width != render.width || photo.height != render.height) return out;

    std::vector<float> weight;
    for (const std::uint8_t flaws : flaws_of(photo_half))
      weight.push_back(flaws == 0 || flaws == capture::kBlack ? 1.0f : 0.0f);
    const view::Shower shower({capture_.pipeline.ev, capture_.pipeline.view, "", ""});
    const image::DisplayPicture shown_photo = shower.show(photo), shown_render = shower.show(render);
    metric::Pair pair{.photo = &photo, .render = &render, .shown_photo = &shown_photo, .shown_render = &shown_render};
    pair.weight = weight;
    pair.exposures = {capture_.flip_first_ev, capture_.flip_last_ev};
    if (place.camera < capture_.noise_floor.size())
      for (std::size_t c = 0; c < 3; ++c)
        pair.noise_floor[c] = static_cast<float>(capture_.noise_floor[place.camera][static_cast<int>(c)]);
    for (std::size_t m = 0; m < metric::kMetrics.size() && !stop_; ++m) {
      const auto metric = static_cast<metric::Metric>(m);
      const metric::Summary summary = metric::summary_of(metric::map_of(metric, pair), weight);
      if (summary.pixels > 0) out.of_metric[m] = static_cast<float>(is_mean(metric) ? summary.mean : summary.p95);
    }
  } catch (const std::exception&) {
    // A file that cannot be used has no score; whoever looks at it is told why.
  }
  return out;
}

std::string Answers::scores_json(const Parameters& parameters) {
  const auto text = [&](const char* name) {
    const auto at = parameters.find(name);
    return at == parameters.end() ? std::string() : at->second;
  };
  olat_pair::State state;
  state.camera = text("camera");
  state.variant = text("variant");
  if (!text("metric").empty()) state.metric = text("metric");
  const auto metric = metric::metric_of(state.metric);
  const olat_pair::Place place = place_of(state);
  first_camera_ = place.camera;
  Json out{{"metric", state.metric},
           {"statistic", is_mean(metric) ? "mean" : "p95"},
           {"all", capture_.cameras.size() * capture_.lights.size()}};
  std::size_t known = 0;
  if (place.variant != kAbsent) {
    variant_ = place.variant;
    const std::lock_guard lock(scores_mutex_);
    const std::vector<Score>& scores = scores_[place.variant];
    Json row = Json::array();
    for (std::size_t k = 0; k < scores.size(); ++k) {
      const bool is_known = !scores[k].of_metric.empty();
      known += is_known ? 1 : 0;
      const float value = is_known ? scores[k].of_metric[static_cast<std::size_t>(metric)] : kUnknown;
      row.push_back(std::isfinite(value) ? Json(std::round(static_cast<double>(value) * 1e4) / 1e4) : Json(nullptr));
      if ((k + 1) % capture_.lights.size() == 0) {
        out["rows"].push_back(row);
        row = Json::array();
      }
    }
  }
  out["known"] = known;
  if (received_) out["received"] = received_variants();
  return out.dump();
}

}  // namespace likeness::olat_view
