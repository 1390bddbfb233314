#include "realis/weigh.h"

#include <limits>

#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "render/capture/sight.h"
#include "render/files/interrupt.h"
#include "render/image/write.h"

namespace likeness::realis {
namespace {

void write_one(const capture::Capture& capture, const capture::Variant& variant, const Subject& subject,
               std::span<const float> weights) {
  for (std::size_t i = 0; i < subject.lights.size(); ++i) {
    if (files::interrupted()) throw files::Interrupted();
    image::Picture picture(subject.width, subject.height);
    for (std::size_t texel = 0; texel < subject.texels(); ++texel)
      for (std::size_t c = 0; c < 3; ++c)
        picture.rgb[3 * std::size_t{subject.pixels[texel]} + c] = weights[subject.samples_of(texel) + i];
    image::write_exr(capture::render_file(capture, variant, subject.camera, subject.lights[i]), picture);
  }
}

}  // namespace

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
  s.photo = subject.photo, s.render = subject.render, s.cosine = subject.cosine;
  s.normals = normal_of, s.to_views = to_views;
  return weight::apply(s, choice, subject.weight, keeps);
}

void write_weights(capture::Capture& capture, const Subject& subject, std::span<const weight::Layer> layers,
                   const std::filesystem::path& folder) {
  const auto put = [&](std::string_view name, std::span<const float> weights) {
    const std::string id = "weight_" + std::string(name);
    const std::string pattern = (folder / "weights" / name / "{light}.exr").generic_string();
    if (capture::variant_of(capture, id) == capture::kAbsent) capture.variants.push_back({id, pattern});
    capture::Variant& variant = capture.variants[capture::variant_of(capture, id)];
    variant.pattern = pattern;
    write_one(capture, variant, subject, weights);
  };
  for (const weight::Layer& layer : layers) put(layer.name, layer.weights);
  put("all", subject.weight);
  capture::write_capture(capture);
}

}  // namespace likeness::realis
