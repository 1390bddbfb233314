#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "realis/apply.h"
#include "realis/bake_file.h"
#include "realis/surface_maps.h"
#include "render/files/files.h"
#include "render/reference/reference.h"
#include "render/runtime/pipeline.h"
#include "render/scene/read_scene.h"
#include "tests/realis/domes.h"

// A subject in a picture, its bake in files, and the scene of it: a quad that fills an orthographic camera's picture, with the
// bake's own maps as textures. Pixel centers meet texel centers.
namespace likeness::realis::test {

inline constexpr int kWidth = 24, kHeight = 16;

struct Baking {
  std::size_t lobes = 20, kept = 8;
  Channels channels = Channels::kRgb;
  double size = 0.05;  // of coefficients [1/sr]
  double floor = 0.3, exposure = 1.7;
  bool is_float = false, has_surface = true;
  std::size_t mixes = 0;  // 0: coefficients of lobes; else kept is of mixes
  baked::Bits bits = baked::Bits::kEight;
  double spread = 0, least = 0;  // of the surface
};

struct BakedQuad {
  capture::Capture capture;
  StoredBake bake;
  capture_fit::Fit surface;
  double scale = 0;  // of base_color.png
};

inline BakedQuad write_quad(const std::filesystem::path& folder, const Baking& how) {
  BakedQuad out;
  capture::Camera camera;
  camera.id = "c", camera.width = kWidth, camera.height = kHeight, camera.is_orthographic = true;
  camera.world_from_camera = glm::dmat4(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 1, 1);
  out.capture.cameras.push_back(camera);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> even(0, 1);
  capture_fit::Fit fit;
  fit.exposure = how.exposure, fit.spread = how.spread, fit.least = how.least;
  fit.material.roughness = 0.4, fit.material.diffuse_fresnel = 3;
  fit.normals = image::Picture(kWidth, kHeight), fit.base_colors = image::Picture(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const glm::vec3 n = glm::normalize(
          glm::vec3(std::sin(0.4f * static_cast<float>(x)), std::cos(0.5f * static_cast<float>(y)), 1.6f));
      for (std::size_t k = 0; k < 3; ++k) {
        fit.normals.at(x, y)[k] = n[static_cast<int>(k)];
        fit.base_colors.at(x, y)[k] = 0.1f + 0.7f * even(random);
      }
    }
  out.surface = thin(fit);
  for (const float c : out.surface.base_colors.rgb) out.scale = std::max(out.scale, static_cast<double>(c));
  StoredBake& s = out.bake;
  s.width = kWidth, s.height = kHeight;
  s.about = {"quad", "c"};
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) s.pixels.push_back(i);
  s.bake.channels = how.channels, s.bake.kept = how.kept, s.bake.floor = how.floor;
  for (const glm::dvec3& axis : dome(how.lobes))
    s.bake.basis.lobes.push_back({axis, 9}), s.bake.basis.spread.push_back(1);
  std::normal_distribution<double> value(0, how.size), factor(0, 0.3);
  for (std::size_t i = 0; i < how.mixes * how.lobes; ++i) s.bake.basis.mix.push_back(factor(random));
  if (how.mixes > 0) s.bake.basis.spread.assign(how.mixes, 1.0);
  s.bake.bits = how.bits;
  const std::size_t functions = std::max<std::size_t>(s.bake.basis.size(), 1);
  const std::size_t each = s.bake.channel_count() * s.bake.basis.size();
  s.bake.coefficients.resize(s.pixels.size() * each);
  for (std::size_t i = 0; i < s.bake.coefficients.size(); ++i)
    if ((i / each + i % functions) % functions < how.kept) s.bake.coefficients[i] = static_cast<float>(value(random));
  write_bake(folder / "bake", s, how.is_float);
  write_surface(folder / "bake", out.surface);
  if (!how.has_surface) std::filesystem::remove(folder / "bake" / "surface.json");
  s = read_bake(folder / "bake");
  files::write_whole(folder / "quad.obj",
                     "v -12 -8 0\nv 12 -8 0\nv 12 8 0\nv -12 8 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                     "f 1/1 2/2 3/3 4/4\n");
  return out;
}

// `realis` goes into the material's object of that name after the bake; "none": there is none. `parameters` after base_color.
inline scene::Scene scene_of_quad(const std::filesystem::path& folder, const BakedQuad& quad, const std::string& lights,
                                  const std::string& realis = "", const std::string& parameters = "",
                                  const std::string& place = "",
                                  const std::string& camera = "\"position\": [0, 0, 5], \"target\": [0, 0, 0]") {
  const std::string text =
      R"({"format": "likeness scene", "version": 1, "cameras": [{)" + camera +
      R"(, "orthographic_height": 16, "width": 24, "height": 16}],
"meshes": {"quad": {"file": "quad.obj"}},
"materials": {"subject": {"file": "bake/surface.material.json", "parameters": {"base_color": {"file": "bake/base_color.png", "wrap": "clamp", "scale": )" +
      files::number_text(quad.scale) + "}" + parameters +
      R"(}, "normal_map": {"file": "bake/normal.png", "wrap": "clamp", "scale": 1.0039370078740157, "offset": -0.003937007874015741})" +
      (realis == "none" ? "" : R"(, "realis": {"bake": "bake")" + realis + "}") +
      R"(}}, "instances": [{"mesh": "quad", "material": "subject")" + place + "}], " + lights + "}";
  files::write_whole(folder / "scene.json", text);
  return scene::read_scene(folder / "scene.json");
}

inline std::string sun(const glm::dvec3& to_light, double strength) {
  const auto n = [](double x) { return files::number_text(x); };
  return R"("lights": [{"type": "directional", "direction": [)" + n(-to_light.x) + ", " + n(-to_light.y) + ", " +
         n(-to_light.z) + R"(], "strength": )" + n(strength) + "}]";
}

inline image::Picture frame_of(const scene::Scene& s, const runtime::Settings& settings = {}, bool force_all = false) {
  const world::World world(s, plan::plan_of(s, 0, force_all));
  return runtime::Pipeline(world).frame(0, settings);
}

inline image::Picture reference_of(const scene::Scene& s, std::uint32_t samples, int bounces = 1) {
  const world::World world(s, plan::plan_of(s));
  reference::Options options;
  options.samples = samples, options.max_bounces = bounces;
  reference::Film film(s.cameras[0].width, s.cameras[0].height, false);
  reference::render(world, options, film, [](const auto&) { return true; });
  return film.picture();
}

inline double peak(const image::Picture& p) {
  return static_cast<double>(*std::max_element(p.rgb.begin(), p.rgb.end()));
}
inline double mean(const image::Picture& p) {
  double sum = 0;
  for (const float x : p.rgb) sum += static_cast<double>(x);
  return sum / static_cast<double>(p.rgb.size());
}
// Over b's peak.
inline double largest_difference(const image::Picture& a, const image::Picture& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double d = std::abs(static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i]));
    most = std::isnan(d) ? d : std::max(most, d);
    if (std::isnan(most)) break;
  }
  return most / peak(b);
}

}  // namespace likeness::realis::test
