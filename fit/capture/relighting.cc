#include <array>
#include <numbers>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "brdf/realis/soft_cosine.h"
#include "fit/capture/capture_fit.h"
#include "fit/capture/shared.h"
#include "fit/capture/site.h"

namespace likeness::capture_fit {

Relighting::Relighting(const capture::Capture& capture, const Fit& fit)
    : capture_(capture), fit_(fit), positions_(capture, fit.camera, "likeness fit capture") {}

Shading Relighting::shading(std::size_t light) const {
  const capture::Camera& camera = capture_.cameras[fit_.camera];
  const image::Picture& normals = fit_.normals;
  Shading out;
  out.diffuse.resize(normals.rgb.size() / 3);
  out.specular.resize(normals.rgb.size() / 3);
  tbb::parallel_for(0, normals.height, [&](int y) {
    Face face;
    FaceShading shading;
    for (int x = 0; x < normals.width; ++x) {
      const auto n = normals.at(x, y);
      const glm::dvec3 normal(n[0], n[1], n[2]);
      if (normal == glm::dvec3(0)) continue;
      const Site site{capture::to_view_of(camera, x, y),
                      {capture::shine_of(capture_.lights[light], positions_.at(x, y))}};
      const auto at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(normals.width) + static_cast<std::size_t>(x);
      const capture::Shine& shine = site.shines[0];
      const double beyond = brdf::beyond_hard(glm::dot(normal, shine.to_light), fit_.spread) / std::numbers::pi;
      out.diffuse[at] = static_cast<float>(fit_.exposure * shine.irradiance * beyond);
      face_under(site, normal, fit_.exposure, face);
      shade(fit_.material, face, shading);
      if (face.angles.empty()) continue;
      out.diffuse[at] += static_cast<float>(shading.diffuse[0]);
      out.specular[at] = static_cast<float>(shading.specular[0]);
    }
  });
  return out;
}

image::Picture Relighting::render(std::size_t light) const {
  const Shading s = shading(light);
  image::Picture out(fit_.normals.width, fit_.normals.height);
  for (std::size_t k = 0; k < out.rgb.size(); ++k)
    out.rgb[k] = fit_.base_colors.rgb[k] * s.diffuse[k / 3] + s.specular[k / 3];
  return out;
}

}  // namespace likeness::capture_fit
