#include "olat/render/from_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "brdf/about_normal.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"

namespace likeness::olat_render {
namespace {

using capture::Camera;
using image::Picture;

constexpr double kLeastCosine = 0.05;  // of a light that counts: 3 degrees above the surface
constexpr double kFarOff = 0.5;        // of the fit's value: a highlight or a shadow

}  // namespace

NormalRenderer::NormalRenderer(const capture::Capture& capture, std::size_t camera,
                               const std::optional<brdf::AnyBrdf>& material)
    : capture_(capture),
      camera_(camera),
      material_(material),
      frames_(capture),
      normals_(capture::read_normals(capture, camera)),
      positions_(capture, camera, "--from-normals"),
      colors_(normals_.width, normals_.height) {}

void NormalRenderer::begin_round() {
  photo_shading_.assign(normals_.rgb.size(), 0);
  shading_shading_.assign(normals_.rgb.size(), 0);
}

Picture NormalRenderer::shading(std::size_t light) const {
  const capture::Light& source = capture_.lights[light];
  if (!capture::has_place(source))
    throw files::UsageError("--from-normals: light " + files::in_quotes(source.id) +
                            " has no place; give it a direction or a position in lights.json");
  const Camera& camera = capture_.cameras[camera_];
  Picture out(normals_.width, normals_.height);
  tbb::parallel_for(0, out.height, [&](int y) {
    for (int x = 0; x < out.width; ++x) {
      const auto stored = normals_.at(x, y);
      const glm::dvec3 n(stored[0], stored[1], stored[2]);
      if (n == glm::dvec3(0)) continue;
      const auto [l, irradiance] = capture::shine_of(source, positions_.at(x, y));
      const double cos_i = glm::dot(n, l);
      if (!(cos_i > 0) || irradiance == 0) continue;
      const glm::dvec3 v = capture::to_view_of(camera, x, y);
      brdf::Rgb<double> f(std::numbers::inv_pi);
      if (material_) f = brdf::eval_about(*material_, {n.x, n.y, n.z}, {l.x, l.y, l.z}, {v.x, v.y, v.z});
      const auto pixel = out.at(x, y);
      pixel[0] = static_cast<float>(f.r * cos_i * irradiance);
      pixel[1] = static_cast<float>(f.g * cos_i * irradiance);
      pixel[2] = static_cast<float>(f.b * cos_i * irradiance);
    }
  });
  return out;
}

void NormalRenderer::add_photo(std::size_t light, int round) {
  const std::size_t frame = frames_.frame(camera_, light);
  if (frame == capture::kAbsent) return;
  const capture::Photo photo = capture::read_photo(capture_, frame);
  const Picture s = shading(light);
  // f cos at a light of kLeastCosine, of a Lambert surface; near lights are scaled by their brightest pixel.
  const float brightest = *std::max_element(s.rgb.begin(), s.rgb.end());
  const float least = static_cast<float>(kLeastCosine) * brightest;
  tbb::parallel_for(std::size_t{0}, photo.flaws.size(), [&](std::size_t i) {
    if ((photo.flaws[i] & (capture::kClipped | capture::kNotFinite | capture::kMasked)) != 0) return;
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
      if (!(s.rgb[k] > least)) continue;
      const double p = static_cast<double>(photo.light.rgb[k]), x = static_cast<double>(s.rgb[k]);
      const double fit = static_cast<double>(colors_.rgb[k]) * x;
      if (round > 0 && std::abs(p - fit) > kFarOff * fit) continue;
      photo_shading_[k] += p * x;
      shading_shading_[k] += x * x;
    }
  });
}

void NormalRenderer::end_round() {
  for (std::size_t k = 0; k < colors_.rgb.size(); ++k)
    if (shading_shading_[k] > 0)
      colors_.rgb[k] = static_cast<float>(std::max(0.0, photo_shading_[k] / shading_shading_[k]));
}

Picture NormalRenderer::render(std::size_t light) const {
  Picture out = shading(light);
  for (std::size_t k = 0; k < out.rgb.size(); ++k) out.rgb[k] *= colors_.rgb[k];
  return out;
}

}  // namespace likeness::olat_render
