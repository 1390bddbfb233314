#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/image/picture.h"
#include "render/plan/plan.h"
#include "render/runtime/pass.h"
#include "render/runtime/settings.h"
#include "render/world/world.h"

// The run-time pipeline: a frame as a game would light it, by the same evaluators as the path tracer. What it leaves out
// or approximates is stated in docs/runtime.md and measured by `likeness cost`.
namespace likeness::runtime {

// The passes of a frame, in order: those that the plan calls for.
std::vector<Pass> passes_of(const plan::Plan& plan, const Settings& settings);

// What is wrong with a list of passes: the first that reads what no pass before it wrote, in words; empty: nothing.
std::string complaint(const std::vector<Pass>& passes);

// What a pass of a frame took, all its samples together.
struct PassTime {
  std::string_view name;
  double seconds = 0;  // wall clock
  double cpu_seconds = 0;
};

// A scene that frames are made of: holds what is made once, by the first frame that reads it (the maps of the
// environment, the levels of textures), and the buffers of frames from one to the next (about 55 bytes a pixel, and 30 to
// 60 more with textures, for each frame that was made at the same time as another).
class Pipeline {
 public:
  // Keeps the world, which must outlive it.
  explicit Pipeline(const world::World& world);
  ~Pipeline();

  // One frame of a camera: radiance [W/(m^2 sr)]. `threads` 0: one a core. `times` takes the passes' times if it is not
  // null.
  image::Picture frame(std::size_t camera, const Settings& settings, int threads = 0,
                       std::vector<PassTime>* times = nullptr) const;

 private:
  std::unique_ptr<Frame> idle_frame(const world::Camera& camera) const;

  const world::World& world_;
  mutable std::once_flag maps_made_;
  mutable EnvironmentMaps maps_;
  mutable ResidualMaps residuals_;
  mutable std::once_flag levels_made_;
  mutable std::optional<surface::SceneLevels> levels_;
  mutable std::mutex idle_mutex_;
  mutable std::vector<std::unique_ptr<Frame>> idle_;
};

}  // namespace likeness::runtime
