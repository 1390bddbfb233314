#include "render/reference/reference.h"

#include <algorithm>
#include <atomic>
#include <chrono>

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "render/reference/path.h"
#include "render/sampling/sobol.h"
#include "render/world/camera.h"

namespace likeness::reference {
namespace {

constexpr int kTile = 16;                   // pixels on a side
constexpr std::uint32_t kMostInAPass = 16;  // samples: a pass ends, and the targets are looked at

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

std::string key_of(const Options& options, const std::string& scene) {
  return "scene " + scene + " camera " + std::to_string(options.camera) + " seed " + std::to_string(options.seed) +
         " bounces " + std::to_string(options.max_bounces) + (options.has_layers ? " layers" : "");
}

void render(const world::World& world, const Options& options, Film& film,
            const std::function<bool(const Progress&)>& goes_on) {
  const world::Camera camera(world.scene.cameras[options.camera]);
  const PathFunction follow = path_function(path_parts(world.plan, options.has_layers));
  const PathOptions path = path_options(world, options.max_bounces);
  const bool has_lens = camera.has_lens(), has_layers = options.has_layers;
  const double start = seconds_now();
  std::atomic<bool> is_stopped = false;
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);

  Progress progress{film.least_samples(), 0, 0};
  const auto share = [&] {
    double done = static_cast<double>(progress.samples) / options.samples;
    if (options.seconds > 0) done = std::max(done, progress.seconds / options.seconds);
    if (options.relative_error > 0 && progress.samples > 1) {
      const double error = film.relative_error();
      done = std::max(done, error > 0 ? options.relative_error / error : 1.0);
    }
    return std::min(done, 1.0);
  };
  while (progress.samples < options.samples) {
    const std::uint32_t size = std::clamp(progress.samples, 1u, kMostInAPass);
    const std::uint32_t end = std::min(options.samples, progress.samples + size);
    const auto tile = [&](const tbb::blocked_range2d<int>& pixels) {
      surface::Point point;
      First first;
      First* const layers = has_layers ? &first : nullptr;
      for (int y = pixels.rows().begin(); y < pixels.rows().end(); ++y)
        for (int x = pixels.cols().begin(); x < pixels.cols().end(); ++x) {
          const auto pixel =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width()) + static_cast<std::size_t>(x);
          for (std::uint32_t sample = film.samples(pixel); sample < end; ++sample) {
            sampling::Samples samples(static_cast<std::uint32_t>(pixel), sample, options.seed);
            const glm::vec2 in_pixel = samples.next();
            const glm::vec2 on_lens = has_lens ? samples.next() : glm::vec2(0.5f);
            if (layers != nullptr) first = {};
            const glm::vec3 radiance =
                follow(world, camera.ray(glm::vec2(x, y) + in_pixel, on_lens), samples, path, point, layers);
            film.add(pixel, radiance, layers);
          }
        }
    };
    arena.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range2d<int>(0, camera.height(), kTile, 0, camera.width(), kTile),
          [&](const tbb::blocked_range2d<int>& pixels) {
            if (is_stopped) return;
            const double now = seconds_now() - start;
            if ((options.seconds > 0 && now > options.seconds && progress.samples > 0) ||
                !goes_on({progress.samples, -1, now})) {
              is_stopped = true;
              return;
            }
            tile(pixels);
          },
          tbb::simple_partitioner());
    });
    if (is_stopped) break;
    progress.samples = end;
    progress.seconds = seconds_now() - start;
    progress.share = share();
    if (!goes_on(progress) || progress.share >= 1) break;
  }
}

}  // namespace likeness::reference
