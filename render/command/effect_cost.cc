#include "render/command/effect_cost.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "render/command/camera_choice.h"
#include "render/files/interrupt.h"
#include "render/plan/without.h"
#include "render/reference/reference.h"
#include "render/runtime/pipeline.h"
#include "render/world/world.h"

namespace likeness::render_command {
namespace {

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at), high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

// A scene that can be rendered again and again.
class Subject {
 public:
  Subject(const scene::Scene& scene, std::size_t camera)
      : world_(scene, plan::plan_of(scene, camera)),
        pipeline_(world_),
        camera_(scene.cameras[camera]),
        index_(camera) {}

  // CPU milliseconds for a million samples: of the path tracer, or of frames of one point a pixel.
  double read(std::uint32_t samples, bool is_of_frames = false) const {
    const double start = thread_seconds();
    if (is_of_frames)
      for (std::uint32_t i = 0; i < samples && !files::interrupted(); ++i) pipeline_.frame(index_, {}, 1);
    else trace(samples);
    const double took = thread_seconds() - start;
    if (files::interrupted()) throw files::Interrupted{};
    return 1e9 * took / (static_cast<double>(samples) * camera_.width * camera_.height);
  }
  double pixels() const { return static_cast<double>(camera_.width) * camera_.height; }

 private:
  void trace(std::uint32_t samples) const {
    reference::Options options;
    options.camera = index_, options.samples = samples, options.threads = 1;  // all on this thread, whose clock is read
    reference::Film film(camera_.width, camera_.height, false);
    reference::render(world_, options, film, [](const reference::Progress&) { return !files::interrupted(); });
  }

  world::World world_;
  runtime::Pipeline pipeline_;
  scene::Camera camera_;
  std::size_t index_;
};

}  // namespace

plan::Costs costs_of(const scene::Scene& original, const CostOptions& options,
                     const std::function<void(const std::string&, double)>& progress) {
  scene::Scene scene = original;
  scene::Camera& camera = scene.cameras[options.camera];
  const double pixels = static_cast<double>(camera.width) * camera.height;
  if (const double smaller = std::sqrt(options.most_pixels / pixels); smaller < 1)
    resize(camera, {std::max(1, static_cast<int>(std::lround(camera.width * smaller))),
                    std::max(1, static_cast<int>(std::lround(camera.height * smaller)))});

  plan::Costs costs;
  const Subject with(scene, options.camera);
  const double first_ms = with.read(1);  // also fills caches
  const auto samples =
      static_cast<std::uint32_t>(std::clamp(options.seconds * 1e9 / (first_ms * with.pixels()), 1.0, 4096.0));
  const plan::Plan plan = plan::plan_of(scene, options.camera);
  std::vector<plan::Effect> on;
  for (const plan::EffectRow& row : plan::kEffects)
    if (plan.has(row.effect)) on.push_back(row.effect);
  for (std::size_t i = 0; i < on.size(); ++i) {
    const scene::Scene edited = plan::without(scene, on[i]);
    const Subject without(edited, options.camera);
    const bool of_frames = plan::row_of(on[i]).is_of_frames;
    if (of_frames) with.read(1, true);  // makes what later frames read
    without.read(1, of_frames);
    std::vector<double> a, b, differences;
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
      // Which comes first changes, so that neither always finds the other's caches.
      if (repeat % 2 == 0) a.push_back(with.read(samples, of_frames));
      b.push_back(without.read(samples, of_frames));
      if (repeat % 2 == 1) a.push_back(with.read(samples, of_frames));
      differences.push_back(a.back() - b.back());
      if (progress)
        progress(std::string(plan::row_of(on[i]).name),
                 (static_cast<double>(i) + (repeat + 1.0) / options.repeats) / static_cast<double>(on.size()));
    }
    costs[static_cast<std::size_t>(on[i])] = {.with_ms = quantile(a, 0.5),
                                              .without_ms = quantile(b, 0.5),
                                              .low_ms = quantile(differences, 0.25),
                                              .high_ms = quantile(differences, 0.75),
                                              .difference_ms = quantile(differences, 0.5),
                                              .is_measured = true};
  }
  return costs;
}

}  // namespace likeness::render_command
