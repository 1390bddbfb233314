#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "datasets_synthetic/random.h"
#include "datasets_synthetic/scene.h"
#include "datasets_synthetic/scene_files.h"
#include "datasets_synthetic/scene_shapes.h"

namespace likeness::datasets_synthetic {
namespace {

using std::numbers::pi;

double smooth(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

void store(float* channels, double r, double g, double b) {
  channels[0] = static_cast<float>(std::clamp(r, 0.0, 1.0));
  channels[1] = static_cast<float>(std::clamp(g, 0.0, 1.0));
  channels[2] = static_cast<float>(std::clamp(b, 0.0, 1.0));
}

// A normal of the tangent frame, z away from the surface, as a texel.
void store_normal(float* channels, double x, double y) {
  const double length = std::sqrt(x * x + y * y + 1);
  store(channels, 0.5 + 0.5 * x / length, 0.5 + 0.5 * y / length, 0.5 + 0.5 / length);
}

// |x|^p + |y|^p + |z|^p = 1 stretched to the half sizes, narrower towards its top by `taper`.
scene::Mesh tooth(const glm::dvec3& half, double power, double taper) {
  const auto bent = [&](double value) { return std::copysign(std::pow(std::abs(value), 2 / power), value); };
  return mesh_of(
      [&](double s, double t) {
        const double phi = 2 * pi * s, theta = pi * t;
        const glm::dvec3 unit(bent(std::sin(theta)) * bent(std::cos(phi)), bent(std::cos(theta)),
                              -bent(std::sin(theta)) * bent(std::sin(phi)));
        const double width = 1 - taper * 0.5 * (1 + unit.y);
        return SurfacePoint{{half.x * width * unit.x, half.y * unit.y, half.z * width * unit.z}, {s, t}};
      },
      48, 32);
}

// Where a row of teeth runs: a parabola, 0 in front.
glm::dvec3 arch(double x) { return {x, 0, -14 * x * x}; }

}  // namespace

// Sizes of adult front teeth, to a millimetre. Upper teeth overlap the lower ones a little.
void make_teeth(const SceneOptions& options, SceneFiles& files) {
  files.add_camera({{"name", "front"},
                    {"width", options.width},
                    {"height", options.height},
                    {"position", {0.02, 0.012, 0.22}},
                    {"target", {0, 0, -0.006}},
                    {"fov_deg", 14}});
  const SceneJson bumps = files.add_texture("wet_bumps", 256, 256, 3, [&](double u, double v, float* channels) {
    constexpr double kStep = 1e-3;
    const auto height = [&](double x, double y) { return rough_noise(12 * x, 12 * y, 7, 12); };
    store_normal(channels, -0.02 * (height(u + kStep, v) - height(u - kStep, v)) / (2 * kStep),
                 0.02 * (height(u, v + kStep) - height(u, v - kStep)) / (2 * kStep));
  });
  files.add_material("enamel", {{"parameters",
                                 {{"base_color", {0.72, 0.66, 0.52}},
                                  {"roughness", 0.16},
                                  {"specular", 0.7},
                                  {"diffuse_fresnel", 2},
                                  {"dual_specular_opacity", 0.4},
                                  {"dual_specular_roughness_scale", 3}}}});
  files.add_material("gum", {{"parameters",
                              {{"base_color", {0.42, 0.11, 0.1}},
                               {"roughness", 0.28},
                               {"specular", 0.6},
                               {"smooth_terminator", 0.4},
                               {"smooth_terminator_tint", {1, 0.4, 0.35}}}},
                             {"normal_map", bumps},
                             {"normal_strength", 0.6}});

  Random random(options.seed, 2);
  struct Row {
    const char* name;
    double side, height, z;  // side: +1 upper
    std::array<double, 5> half_widths;
  };
  const std::array<Row, 2> rows{Row{"upper", 1, 0.0052, 0, {0.0043, 0.0035, 0.0038, 0.0036, 0.0034}},
                                Row{"lower", -1, 0.0045, -0.0025, {0.0027, 0.003, 0.0035, 0.0035, 0.0036}}};
  for (const Row& row : rows) {
    double x = 0;
    for (std::size_t i = 0; i < row.half_widths.size(); ++i) {
      const double half = row.half_widths[i];
      const std::string name = std::string(row.name) + "_" + std::to_string(i);
      files.add_mesh(name, tooth({half, row.height, 0.0034}, 3.2, 0.22));
      x += half;
      for (const double side : {-1.0, 1.0}) {
        const glm::dvec3 at = arch(side * x);
        const double lean = rounded(-side * std::atan(28 * x) * 180 / pi + 3 * (random.uniform() - 0.5), 5);
        // The taper is at the root: lower teeth stand upside down.
        files.add_instance(
            name, "enamel",
            {{"rotate_deg", {row.side > 0 ? 0 : 180, row.side > 0 ? -lean : lean, 0}},
             {"translate",
              {rounded(at.x, 5), rounded(row.side * (row.height - 0.0008) + 0.0003 * random.uniform(), 5),
               rounded(at.z + row.z, 5)}}});
      }
      x += half + 0.0002;
    }
    // The gum: a tube along the arch that swallows the roots.
    const double reach = x + 0.004, side = row.side;
    files.add_mesh(std::string(row.name) + "_gum",
                   mesh_of(
                       [&](double s, double t) {
                         const double along = reach * (2 * t - 1), phi = 2 * pi * s;
                         const double radius = 0.0052 * std::sqrt(std::max(1e-4, 1 - std::pow(2 * t - 1, 6)));
                         const glm::dvec3 middle = arch(along) + glm::dvec3(0, side * 0.0118, row.z - 0.0012);
                         const glm::dvec3 out = glm::normalize(glm::dvec3(28 * along, 0, 1));
                         const double scallop = 1 + 0.05 * std::cos(along / 0.0037 * pi);
                         return SurfacePoint{
                             middle + radius * scallop * (std::cos(phi) * glm::dvec3(0, 1, 0) + std::sin(-phi) * out),
                             {4 * t, s}};
                       },
                       48, 160));
    files.add_instance(std::string(row.name) + "_gum", "gum");
  }
  const auto panel = [&](const char* name, const SceneJson& position, const SceneJson& size, double strength) {
    files.add_light({{"type", "rectangle"},
                     {"name", name},
                     {"position", position},
                     {"target", {0, 0, 0}},
                     {"size", size},
                     {"strength", strength}});
  };
  panel("key", {-0.15, 0.2, 0.25}, {0.12, 0.12}, 12);
  panel("fill", {0.25, 0.0, 0.2}, {0.05, 0.25}, 3);
  files.set_environment({{"radiance", {0.12, 0.13, 0.15}}});
}

// Radii of an adult eye: sclera 12 mm, cornea 7.8 mm, limbus 5.8 mm from the axis. It looks along +z. The texture is
// azimuthal: the middle is the front pole, the rim the back.
void make_eye(const SceneOptions& options, SceneFiles& files) {
  constexpr double kSclera = 0.012, kCornea = 0.0078, kLimbus = 0.0058;
  const double limbus = std::asin(kLimbus / kSclera);
  const double cornea_z = kSclera * std::cos(limbus) - std::sqrt(kCornea * kCornea - kLimbus * kLimbus);
  files.add_camera({{"name", "front"},
                    {"width", options.width},
                    {"height", options.height},
                    {"position", {0.03, 0.015, 0.12}},
                    {"target", {0, 0, 0.002}},
                    {"fov_deg", 16}});
  files.add_mesh("eyeball", mesh_of(
                                [&](double s, double t) {
                                  // Rows lie closer in front, where the cornea is.
                                  const double theta = pi * std::pow(t, 1.5), phi = 2 * pi * s;
                                  const double side = cornea_z * std::sin(theta);
                                  double radius = kSclera;
                                  if (side < kCornea && theta < pi / 2) {
                                    const double over = cornea_z * std::cos(theta) +
                                                        std::sqrt(kCornea * kCornea - side * side) - kSclera;
                                    constexpr double kBlend = 0.0002;  // rounds the limbus
                                    radius += 0.5 * (over + std::sqrt(over * over + kBlend * kBlend));
                                  }
                                  const glm::dvec3 out(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                                       std::cos(theta));
                                  const double r = 0.5 * theta / pi;
                                  return SurfacePoint{radius * out, {0.5 + r * std::cos(phi), 0.5 - r * std::sin(phi)}};
                                },
                                128, 96));
  struct Polar {
    double theta, phi, turn;  // turn in [0, 1)
  };
  const auto polar = [](double u, double v) {
    const double x = 2 * u - 1, y = 1 - 2 * v, phi = std::atan2(y, x);
    return Polar{std::hypot(x, y) * pi, phi, phi / (2 * pi) + 0.5};
  };
  const double pupil = 0.38 * limbus;
  const unsigned seed = static_cast<unsigned>(options.seed);
  const auto fibers = [&](const Polar& p) { return rough_noise(48 * p.turn, 3 * p.theta / limbus, seed + 11, 48); };
  const SceneJson color = files.add_texture("eye_color", 768, 768, 3, [&](double u, double v, float* channels) {
    const Polar p = polar(u, v);
    const double fiber = fibers(p), ring = smooth(pupil, 1.6 * pupil, p.theta);
    const double dark = smooth(0.8 * limbus, limbus, p.theta);
    const std::array<double, 3> inner{0.28, 0.16, 0.06}, outer{0.08, 0.16, 0.2};
    const double vein_line =
        std::abs(noise(24 * p.turn + 0.6 * noise(9 * p.theta, 3 * p.turn, seed + 3), 2 * p.theta, seed + 5, 24));
    const double vein = smooth(0.06, 0.0, vein_line) * smooth(1.2 * limbus, 3 * limbus, p.theta);
    const std::array<double, 3> sclera{0.72 - 0.2 * vein, 0.68 - 0.5 * vein, 0.64 - 0.5 * vein};
    const double is_sclera = smooth(0.97 * limbus, 1.06 * limbus, p.theta);
    const double is_pupil = smooth(1.05 * pupil, 0.95 * pupil, p.theta);
    std::array<double, 3> out{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double iris = (inner[c] + ring * (outer[c] - inner[c])) * (1 + 0.7 * fiber) * (1 - 0.75 * dark);
      out[c] = (iris * (1 - is_pupil) + 0.005 * is_pupil) * (1 - is_sclera) + sclera[c] * is_sclera;
    }
    store(channels, out[0], out[1], out[2]);
  });
  // What is seen through the cornea is a bowl: its normals lean towards the axis, and its fibers are rough. The gloss
  // on top keeps the cornea's own normals.
  const SceneJson bowl = files.add_texture("iris_normals", 768, 768, 3, [&](double u, double v, float* channels) {
    const Polar p = polar(u, v);
    const double inside = smooth(limbus, 0.85 * limbus, p.theta);
    constexpr double kStep = 2e-3;
    const Polar next{p.theta, p.phi, p.turn + kStep};
    const double across = 0.35 * (fibers(next) - fibers(p)) / (48 * kStep);
    const double in = -1.1 * p.theta / limbus;
    store_normal(channels, inside * (in * std::cos(p.phi) + across * std::sin(p.phi)),
                 inside * (in * std::sin(p.phi) - across * std::cos(p.phi)));
  });
  files.add_material("eye", {{"parameters",
                              {{"base_color", color},
                               {"roughness", 0.1},
                               {"specular", 0.6},
                               {"dual_specular_opacity", 0.25},
                               {"dual_specular_roughness_scale", 4}}},
                             {"diffuse_normal_map", bowl}});
  files.add_instance("eyeball", "eye");
  files.add_light({{"type", "rectangle"},
                   {"name", "window"},
                   {"position", {-0.08, 0.12, 0.16}},
                   {"target", {0, 0, 0}},
                   {"size", {0.06, 0.09}},
                   {"strength", 10}});
  files.add_light(
      {{"type", "sphere"}, {"name", "lamp"}, {"position", {0.12, 0.02, 0.1}}, {"radius", 0.01}, {"strength", 40}});
  files.set_environment({{"radiance", {0.15, 0.16, 0.18}}});
}

}  // namespace likeness::datasets_synthetic
