#include "realis/weigh.h"

#include "render/capture/pixels.h"
#include "render/capture/sight.h"

namespace likeness::realis {

std::vector<weight::Layer> weigh(const capture::Capture& capture, const image::Picture& normals,
                                 const weight::Choice& choice, bool keeps, Subject& subject) {
  const capture::Camera& camera = capture.cameras[subject.camera];
  image::Picture layer;
  if (normals.rgb.empty() && !capture::layer_file(capture, subject.camera, capture::Layer::kNormal).empty())
    layer = capture::read_normals(capture, subject.camera);
  const image::Picture& used = normals.rgb.empty() ? layer : normals;
  std::vector<glm::dvec3> to_views(subject.texels()), normal_of;
  for (std::size_t texel = 0; texel < subject.texels(); ++texel) {
    const int x = static_cast<int>(subject.pixels[texel]) % subject.width;
    const int y = static_cast<int>(subject.pixels[texel]) / subject.width;
    to_views[texel] = capture::to_view_of(camera, x, y);
    if (used.rgb.empty()) continue;
    const auto n = used.at(x, y);
    normal_of.emplace_back(n[0], n[1], n[2]);
  }
  weight::Samples s;
  s.width = subject.width, s.height = subject.height;
  s.pixels = subject.pixels, s.to_lights = subject.to_lights, s.irradiance = subject.irradiance;
  s.photo = subject.photo, s.render = subject.render, s.crossed = subject.crossed, s.cosine = subject.cosine;
  s.normals = normal_of, s.to_views = to_views;
  return weight::apply(s, choice, subject.weight, keeps);
}

}  // namespace likeness::realis
