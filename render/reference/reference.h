#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "render/image/layers.h"
#include "render/reference/film.h"
#include "render/world/world.h"

// The path tracer: what a camera sees of a scene, as exactly as one is willing to wait.
namespace likeness::reference {

struct Options {
  std::size_t camera = 0;
  std::uint32_t samples = 64;  // a pixel: at most, if there is another target
  double seconds = 0;          // stop after as much time; 0: no limit
  double relative_error = 0;   // stop at this Film::relative_error(); 0: no limit
  std::uint32_t seed = 0;
  int max_bounces = 64;
  int threads = 0;  // 0: one a core. The picture does not depend on it
  bool has_layers = false;
};

// What the state of a render belongs to: options that change its samples, not those that end it.
std::string key_of(const Options& options, const std::string& scene);

struct Progress {
  std::uint32_t samples = 0;  // a pixel, finished
  double share = 0;           // of the work, by the target that will be reached first
  double seconds = 0;
};

// Adds samples to `film`, which is new or of the same scene and options, pass by pass, until a target is reached or
// `goes_on` says no. It is asked between tiles too, by many threads at once and with share = -1: a film that was stopped
// within a pass has pixels with one pass more than others, and is as good. The picture does not depend on the number of
// threads, nor on stops.
void render(const world::World& world, const Options& options, Film& film,
            const std::function<bool(const Progress&)>& goes_on);

// For each light its visibility (the part of it that is not hidden, [0, 1]) and its lighting function (what it would
// send to the camera if nothing hid it), at the first surface: layers "visibility.NAME" and "light.NAME". A light without
// a name has its number, and one of two with the same name both.
void add_light_layers(const world::World& world, const Options& options, image::Layers& layers);

}  // namespace likeness::reference
