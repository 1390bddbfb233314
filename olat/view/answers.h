#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <semaphore>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "olat/pair/picture.h"
#include "olat/tev/images.h"
#include "olat/view/cache.h"
#include "render/capture/capture.h"
#include "render/capture/pixels.h"

// What the viewer's server says, without the server: a request is a path and its parameters, an answer is bytes. Files
// are opened for reading only, and only those that the capture names: no path comes from a request.
namespace likeness::olat_view {

using Parameters = std::map<std::string, std::string>;

struct Answer {
  int status = 200;  // of HTTP
  std::string type = "application/json";
  std::string body;
  std::shared_ptr<const HalfPicture> pixels;  // instead of a body, if there is one
};

struct ViewOptions {
  std::size_t cache_bytes = std::size_t{1} << 30;
  bool with_scores = true;  // compare every pair in the background
  // What renderers sent by tev's protocol, or null: further variants of renders. VARIANT/CAMERA/LIGHT is the render of that
  // pair, any other name a variant that stands for every pair of its size. Must outlive Answers.
  const olat_tev::Images* received = nullptr;
};

//   /api/capture                                         cameras, lights, variants, which frames there are, pipeline
//   /api/tables                                          olat_pair::tables_json()
//   /api/pixels?kind=photo|render|flip&state=&level=     half floats, 1 / 2^level of the size
//   /api/gain?state=                                     match gain of the render, noise floor
//   /api/exposure?state=                                 olat_pair::exposures_of the photo, else of the render; or null
//   /api/frame?state=                                    where the files are, and how the photo was taken
//   /api/scores?metric=&variant=&camera=                 of every pair, as far as they are known; camera: the first to do
//   /render?state=                                       the CPU's picture, PNG
class Answers {
 public:
  explicit Answers(capture::Capture capture, const ViewOptions& options = {});
  ~Answers();
  Answers(const Answers&) = delete;
  Answers& operator=(const Answers&) = delete;

  // Any thread. Does not throw: what goes wrong is a status and {"error": "one line"}.
  Answer answer(std::string_view path, const Parameters& parameters);

  const Cache& cache() const { return cache_; }

 private:
  struct Score {
    std::vector<float> of_metric;  // NaN: not known yet, or nothing to compare
  };

  // A state's variant may be a received one, which the capture does not have: then place.variant is kAbsent.
  bool is_received(const olat_pair::State& state) const;
  olat_pair::Place place_of(const olat_pair::State& state) const;
  std::map<std::string, std::uint64_t> received_variants() const;  // with their last version
  std::string received_name(const std::string& variant, const olat_pair::Place& place) const;  // "": there is none
  image::Picture received_render(const std::string& variant, const olat_pair::Place& place) const;
  olat_pair::Pair pair_of(const olat_pair::State& state) const;
  std::array<double, 3> gain_of(olat_pair::State state, const olat_pair::Pair& pair) const;

  Answer answer_or_throw(std::string_view path, const Parameters& parameters);
  std::string capture_json() const;
  std::string frame_json(const olat_pair::State& state) const;
  std::string exposure_json(const olat_pair::State& state);
  std::string scores_json(const Parameters& parameters);
  Answer gain(const Parameters& parameters);
  double noise_of(const olat_pair::State& state, const olat_pair::Place& place) const;
  Answer pixels(const Parameters& parameters);
  Cache::Entry picture(std::string_view kind, const olat_pair::State& state, int level);
  HalfPicture read(std::string_view kind, const olat_pair::State& state);
  std::shared_ptr<const capture::CameraLayers> layers_of(std::size_t camera);
  void score_all();
  Score score(const olat_pair::Place& place);

  const capture::Capture capture_;
  const capture::FrameTable frames_;
  const olat_tev::Images* const received_;
  Cache cache_;
  std::counting_semaphore<> large_{2};  // answers in the making that hold pictures as floats
  std::mutex layers_mutex_;
  std::size_t layers_camera_ = capture::kAbsent;  // whose mask and flat field are kept: the last camera's
  std::shared_ptr<const capture::CameraLayers> layers_;

  std::thread scorer_;
  std::atomic<bool> stop_{false};
  std::atomic<long> last_request_ms_{0};
  std::atomic<std::size_t> first_camera_{0}, variant_{0};
  std::mutex scores_mutex_;
  std::map<std::size_t, std::vector<Score>> scores_;  // of a variant: camera-major
  std::map<std::size_t, std::size_t> scored_;         // how many
};

}  // namespace likeness::olat_view
