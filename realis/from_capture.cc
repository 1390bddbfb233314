#include "realis/from_capture.h"

#include <glm/geometric.hpp>

#include "render/capture/pixels.h"
#include "render/capture/sight.h"

namespace likeness::realis {
namespace {

// The cosine of normal and light at each pixel; of no normals nothing.
std::vector<float> cosines_of(const capture::Light& light, const image::Picture& normals,
                              const capture::Positions& positions) {
  std::vector<float> out(normals.rgb.size() / 3);
  for (int y = 0; y < normals.height; ++y)
    for (int x = 0; x < normals.width; ++x) {
      const auto n = normals.at(x, y);
      out[static_cast<std::size_t>(y) * static_cast<std::size_t>(normals.width) + static_cast<std::size_t>(x)] =
          static_cast<float>(
              glm::dot(glm::dvec3(n[0], n[1], n[2]), capture::shine_of(light, positions.at(x, y)).to_light));
    }
  return out;
}

constexpr const char* kAsker = "likeness realis bake";

}  // namespace

Renderer renders_of_variant(const capture::Capture& capture, std::size_t camera, std::size_t variant) {
  image::Picture normals;
  if (!layer_file(capture, camera, capture::Layer::kNormal).empty()) normals = capture::read_normals(capture, camera);
  return [&capture, camera, variant, normals = std::move(normals),
          positions = capture::Positions(capture, camera, kAsker)](std::size_t light) -> Rendered {
    return {capture::read_render(capture, capture.variants[variant], camera, light),
            cosines_of(capture.lights[light], normals, positions)};
  };
}

Renderer renders_of_fit(const capture::Capture& capture, const capture_fit::Fit& fit) {
  return [&capture, &fit, relighting = std::make_shared<capture_fit::Relighting>(capture, fit),
          positions = capture::Positions(capture, fit.camera, kAsker)](std::size_t light) -> Rendered {
    return {relighting->render(light), cosines_of(capture.lights[light], fit.normals, positions)};
  };
}

}  // namespace likeness::realis
