#include "render/runtime/pipeline.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace likeness::runtime {
namespace {

double wall() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
double cpu() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

void for_tiles(Frame& frame, bool only_surfaces, const std::function<void(Tile&)>& work) {
  constexpr std::size_t kTilesInAGrain = 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, frame.tiles.size(), kTilesInAGrain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i)
                        if (!only_surfaces || frame.tiles[i].surfaces > 0) work(frame.tiles[i]);
                    });
}

std::vector<Pass> passes_of(const plan::Plan& plan, const Settings& settings) {
  using plan::Effect;
  std::vector<Pass> passes{visibility_pass(plan)};
  if (has_textures(plan)) passes.push_back(texture_pass(plan));
  if (plan.has(Effect::kPointLights) || plan.has(Effect::kAreaLights) || plan.has(Effect::kEmission)) {
    passes.push_back(light_list_pass(plan));
    passes.push_back(direct_pass(plan));
  }
  if (plan.has(Effect::kEnvironment)) passes.push_back(environment_pass(plan, settings));
  return passes;
}

std::string complaint(const std::vector<Pass>& passes) {
  std::vector<Buffer> written;
  for (const Pass& pass : passes) {
    for (const Buffer b : pass.reads)
      if (std::find(written.begin(), written.end(), b) == written.end())
        return "pass \"" + std::string(pass.name) + "\" reads " +
               std::string(kBufferNames[static_cast<std::size_t>(b)]) + ", which no pass before it writes";
    written.insert(written.end(), pass.writes.begin(), pass.writes.end());
  }
  return {};
}

Pipeline::Pipeline(const world::World& world) : world_(world) {}
Pipeline::~Pipeline() = default;

// The buffers of a frame of this size, but its picture: those of one that is done, or new ones.
std::unique_ptr<Frame> Pipeline::idle_frame(const world::Camera& camera) const {
  std::unique_ptr<Frame> frame;
  {
    const std::scoped_lock lock(idle_mutex_);
    if (!idle_.empty()) frame = std::move(idle_.back()), idle_.pop_back();
  }
  if (frame && frame->width == camera.width() && frame->height == camera.height()) return frame;
  frame = std::make_unique<Frame>();
  frame->width = camera.width(), frame->height = camera.height();
  const auto pixels = static_cast<std::size_t>(frame->width) * static_cast<std::size_t>(frame->height);
  frame->cells = image::Plane<Cell>(pixels);
  if (world_.plan.has(plan::Effect::kDualNormals)) frame->dual_cells = image::Plane<DualCell>(pixels);
  for (int y = 0; y < frame->height; y += kTileHeight)
    for (int x = 0; x < frame->width; x += kTileWidth) {
      Tile tile;
      tile.x = x, tile.y = y;
      tile.width = std::min(kTileWidth, frame->width - x), tile.height = std::min(kTileHeight, frame->height - y);
      frame->tiles.push_back(tile);
    }
  return frame;
}

image::Picture Pipeline::frame(std::size_t index, const Settings& settings, int threads,
                               std::vector<PassTime>* times) const {
  const world::Camera camera(world_.scene.cameras[index]);
  std::unique_ptr<Frame> frame = idle_frame(camera);
  frame->radiance = image::Picture(frame->width, frame->height);
  if (world_.lights.environment() && settings.environment == EnvironmentLevel::kMaps)
    std::call_once(maps_made_, [&] {
      maps_ = EnvironmentMaps(*world_.lights.environment());
      if (world_.plan.has(plan::Effect::kRealis)) residuals_ = ResidualMaps(*world_.lights.environment(), world_);
    });
  const bool has_levels = world_.plan.has(plan::Effect::kTextureLevels) && settings.textures != texture::Filter::kFull;
  if (has_levels) std::call_once(levels_made_, [&] { levels_.emplace(world_.materials); });
  const std::vector<Pass> passes = passes_of(world_.plan, settings);
  if (times != nullptr) {
    times->clear();
    for (const Pass& pass : passes) times->push_back({pass.name});
  }
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  Context context{world_, camera, settings, maps_, residuals_, has_levels ? &*levels_ : nullptr, *frame};
  for (; context.sample < static_cast<std::uint32_t>(settings.pixel_samples); ++context.sample)
    for (std::size_t i = 0; i < passes.size(); ++i) {
      const double wall_start = wall(), cpu_start = cpu();
      arena.execute([&] { passes[i].run(context); });
      if (times == nullptr) continue;
      (*times)[i].seconds += wall() - wall_start, (*times)[i].cpu_seconds += cpu() - cpu_start;
    }
  image::Picture picture = std::move(frame->radiance);
  const std::scoped_lock lock(idle_mutex_);
  idle_.push_back(std::move(frame));
  return picture;
}

}  // namespace likeness::runtime
