#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/image/layers.h"
#include "render/image/picture.h"
#include "render/reference/reference.h"
#include "render/runtime/settings.h"
#include "render/world/world.h"

// The ways to make a picture of a scene: what `likeness render --integrator` names. A new one is a function and a row in
// integrators.cc.
namespace likeness::render_command {

struct Job {
  const world::World& world;
  reference::Options options;  // camera, targets, seed; what an integrator has no use for it leaves unread
  bool has_light_layers = false;
  runtime::Settings settings{};  // of the run-time pipeline
  // Empty: from the start. Otherwise the state that an interrupted render left, and what it must be a state of.
  std::filesystem::path state{};
  std::string key{};
  std::function<void(const image::Picture&)> preview{};  // shown every few seconds; empty: nobody looks
};

struct Rendered {
  image::Layers layers;  // the picture, and what was asked for beside it
  std::uint32_t samples = 0, samples_before = 0;
  double relative_error = 0;  // infinity: not known
  std::uint64_t rejected = 0;
  std::vector<std::pair<std::string_view, std::string_view>> settings{};  // name and level of each, if it has any
  bool is_interrupted = false;
  std::function<image::Layers(const std::string& key)> state{};  // of an interrupted render that can go on
};

struct Integrator {
  std::string_view name, text;
  bool can_resume;
  // Asks files::interrupted() often, and then returns what it has.
  Rendered (*render)(const Job& job);
};
std::span<const Integrator> integrators();

Rendered render_reference(const Job& job);
Rendered render_runtime(const Job& job);

}  // namespace likeness::render_command
