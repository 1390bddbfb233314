#include "realis/from_capture.h"

#include <variant>

#include <glm/geometric.hpp>

#include "render/capture/pixels.h"
#include "render/image/read.h"

namespace likeness::realis {
namespace {

// The cosine of normal and light at each pixel.
class Cosines {
 public:
  Cosines(const capture::Capture& capture, std::size_t camera) : capture_(capture) {
    if (layer_file(capture, camera, capture::Layer::kNormal).empty()) return;
    normals_ = capture::read_normals(capture, camera);
    if (const auto file = layer_file(capture, camera, capture::Layer::kPosition); !file.empty())
      positions_ = image::read_picture(file);
  }
  std::vector<float> of(std::size_t light) const {
    std::vector<float> out(normals_.rgb.size() / 3);
    const auto& place = capture_.lights[light].place;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const glm::dvec3 normal(normals_.rgb[3 * i], normals_.rgb[3 * i + 1], normals_.rgb[3 * i + 2]);
      glm::dvec3 to_light(0);
      if (const auto* distant = std::get_if<capture::DistantLight>(&place)) to_light = distant->to_light;
      if (const auto* near = std::get_if<capture::NearLight>(&place)) {
        to_light = near->position;
        if (positions_.rgb.size() == normals_.rgb.size())
          to_light -= glm::dvec3(positions_.rgb[3 * i], positions_.rgb[3 * i + 1], positions_.rgb[3 * i + 2]);
        if (const double length = glm::length(to_light); length > 0) to_light /= length;
      }
      out[i] = static_cast<float>(glm::dot(normal, to_light));
    }
    return out;
  }

 private:
  const capture::Capture& capture_;
  image::Picture normals_, positions_;
};

}  // namespace

Renderer renders_of_variant(const capture::Capture& capture, std::size_t camera, std::size_t variant) {
  return [&capture, camera, variant, cosines = Cosines(capture, camera)](std::size_t light) -> Rendered {
    return {capture::read_render(capture, capture.variants[variant], camera, light), cosines.of(light)};
  };
}

}  // namespace likeness::realis
