#include <algorithm>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "render/ray/offset.h"
#include "render/reference/reference.h"
#include "render/sampling/sobol.h"
#include "render/world/camera.h"

namespace likeness::reference {

void add_light_layers(const world::World& world, const Options& options, image::Layers& layers) {
  const world::Camera camera(world.scene.cameras[options.camera]);
  const auto width = static_cast<std::size_t>(camera.width()), height = static_cast<std::size_t>(camera.height());
  const std::size_t lights = world.scene.lights.size();
  std::vector<image::Layer> visibility, function;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < lights; ++i) {
    std::string name = world.scene.lights[i].name.empty() ? std::to_string(i) : world.scene.lights[i].name;
    while (std::find(names.begin(), names.end(), name) != names.end()) name += "_" + std::to_string(i);
    names.push_back(name);
    visibility.push_back({"visibility." + name, {"V"}, std::vector<float>(width * height), image::Storage::kHalf});
    function.push_back({"light." + name, {"R", "G", "B"}, std::vector<float>(3 * width * height)});
  }
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  const auto row = [&](std::size_t y) {
    surface::Point point;
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t pixel = y * width + x;
      for (std::uint32_t s = 0; s < options.samples; ++s) {
        sampling::Samples samples(static_cast<std::uint32_t>(pixel), s, options.seed);
        const glm::vec2 at = glm::vec2(x, y) + samples.next();
        const ray::Ray ray = camera.ray(at, camera.has_lens() ? samples.next() : glm::vec2(0.5f));
        const ray::Hit hit = world.tracer.closest(ray, ray::Seen::kSurfaces);  // lights hide nothing
        if (!hit.is_some()) continue;
        world.surfaces.at<surface::Detail::kTextures>(ray, hit, point);
        if (point.is_black()) continue;
        for (std::size_t i = 0; i < lights; ++i) {
          const light::Sample light = world.lights.sample_light(i, point.position, samples.next());
          if (!light.is_some()) continue;
          const glm::vec3 f = point.f_cos(light.to_light) * light.value;
          for (std::size_t k = 0; k < 3; ++k) function[i].data[3 * pixel + k] += f[static_cast<int>(k)];
          const float far = light.distance == ray::kFar ? ray::kFar : light.distance * (1 - 1e-4f);
          const bool is_lit = glm::dot(light.to_light, point.normal) > 0;
          if (is_lit && !world.tracer.occluded({ray::beside(point.position, point.normal), 0, light.to_light, far}))
            visibility[i].data[pixel] += 1;
        }
      }
    }
  };
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, height, row); });
  const float scale = 1 / static_cast<float>(std::max(options.samples, 1u));
  for (std::size_t i = 0; i < lights; ++i) {
    for (float& v : visibility[i].data) v *= scale;
    for (float& v : function[i].data) v *= scale;
    layers.layers.push_back(std::move(visibility[i]));
    layers.layers.push_back(std::move(function[i]));
  }
}

}  // namespace likeness::reference
