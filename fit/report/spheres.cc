#include "fit/report/spheres.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fit/slice/slice.h"
#include "render/image/tone_curve.h"

namespace likeness::fit {
namespace {

using Vec3 = brdf::Vec3<double>;

constexpr double kRadius = 0.47 * kSphereSize;
constexpr std::uint8_t kBackground = 58;  // 8-bit sRGB: dark, but lighter than the unlit side of a sphere
constexpr int kLights = static_cast<int>(kSphereLightsDeg.size());

// Distance of a pixel's centre from the centre of its sphere [pixels].
double distance(int x, int y) {
  const double dx = x + 0.5 - kSphereSize / 2.0, dy = y + 0.5 - kSphereSize / 2.0;
  return std::sqrt(dx * dx + dy * dy);
}

// Share of a pixel that its sphere covers [1]: a ramp of one pixel at the rim.
double cover(int x, int y) { return std::clamp(kRadius - distance(x, y) + 0.5, 0.0, 1.0); }

// f(to_light, to_view, out) as Material::evaluate, for every lit pixel of the upper half; the lower half mirrors it,
// because light and camera lie in the horizontal plane.
template <class F>
SpherePicture render(F&& evaluate) {
  SpherePicture out;
  out.radiance = image::Picture(kLights * kSphereSize, kSphereSize);
  out.valid.assign(out.radiance.rgb.size() / 3, 1);
  for (int light = 0; light < kLights; ++light) {
    const double angle = kSphereLightsDeg[static_cast<std::size_t>(light)] * std::numbers::pi / 180;
    const Vec3 to_light{std::sin(angle), 0, std::cos(angle)};
    for (int y = 0; y < kSphereSize / 2; ++y)
      for (int x = 0; x < kSphereSize; ++x) {
        if (cover(x, y) <= 0) continue;
        // A rim pixel whose centre is off the sphere shows the rim.
        const double scale = 1 / std::max(kRadius, distance(x, y) * (1 + 1e-6));
        const double nx = (x + 0.5 - kSphereSize / 2.0) * scale, ny = (kSphereSize / 2.0 - y - 0.5) * scale;
        const double nz = std::sqrt(std::max(1e-12, 1 - nx * nx - ny * ny));
        const Vec3 normal{nx, ny, nz};
        const double cos_i = dot(normal, to_light);
        if (cos_i <= 0) continue;
        const double length = std::sqrt(nz * nz + nx * nx);
        const Vec3 tangent{nz / length, 0, -nx / length};
        const Vec3 bitangent{ny * tangent.z, nz * tangent.x - nx * tangent.z, -ny * tangent.x};  // normal x tangent
        const Vec3 l{dot(to_light, tangent), dot(to_light, bitangent), cos_i}, v{tangent.z, bitangent.z, nz};
        measured::Rgb f;
        const bool known = evaluate(l, v, f);
        for (const int row : {y, kSphereSize - 1 - y}) {
          const int column = light * kSphereSize + x;
          out.valid[static_cast<std::size_t>(row * kLights * kSphereSize + column)] = known;
          const auto pixel = out.radiance.at(column, row);
          pixel[0] = static_cast<float>(std::numbers::pi * f.r * cos_i);
          pixel[1] = static_cast<float>(std::numbers::pi * f.g * cos_i);
          pixel[2] = static_cast<float>(std::numbers::pi * f.b * cos_i);
        }
      }
  }
  return out;
}

// A direction that grazes the surface, lifted until its cosine to the normal is at least z.
Vec3 lifted(const Vec3& w, double z) {
  if (w.z >= z) return w;
  const double across = std::sqrt((1 - z * z) / std::max(1e-12, w.x * w.x + w.y * w.y));
  return {w.x * across, w.y * across, z};
}

}  // namespace

SpherePicture spheres_of(const measured::Material& material) {
  return render([&](const Vec3& l, const Vec3& v, measured::Rgb& f) {
    if (material.evaluate(l, v, f)) return true;
    for (double limit_deg = 88; limit_deg >= 78; limit_deg -= 2) {
      const double z = std::cos(limit_deg * std::numbers::pi / 180);
      if ((l.z < z || v.z < z) && material.evaluate(lifted(l, z), lifted(v, z), f)) return true;
    }
    return false;
  });
}

SpherePicture spheres_of(const brdf::AnyBrdf& any) {
  return std::visit(
      [](const auto& model) {
        return render([&](const Vec3& l, const Vec3& v, measured::Rgb& f) {
          f = model.eval(l, v);
          return true;
        });
      },
      any);
}

image::DisplayPicture spheres_picture(const SpherePicture& spheres, double ev) {
  image::DisplayPicture out = image::display(spheres.radiance, ev);
  for (int y = 0; y < kSphereSize; ++y)
    for (int x = 0; x < kSphereSize; ++x) {
      const double covered = cover(x, y);
      for (int light = 0; light < kLights; ++light) {
        const int column = light * kSphereSize + x;
        const auto pixel = out.at(column, y);
        const bool known = spheres.valid[static_cast<std::size_t>(y * kLights * kSphereSize + column)] != 0;
        const Color8 hatch = no_data_color(x, y);
        for (std::size_t c = 0; c < 3; ++c) {
          const double inside = known ? pixel[c] : hatch[c];
          pixel[c] = static_cast<std::uint8_t>(std::lround(covered * inside + (1 - covered) * kBackground));
        }
      }
    }
  return out;
}

double spheres_exposure(const SpherePicture& spheres) {
  std::vector<double> luminances;
  for (int y = 0; y < kSphereSize; ++y)
    for (int x = 0; x < kSphereSize; ++x) {
      if (cover(x, y) < 1 || !spheres.valid[static_cast<std::size_t>(y * kLights * kSphereSize + x)]) continue;
      const auto pixel = spheres.radiance.at(x, y);
      luminances.push_back(luminance(pixel[0], pixel[1], pixel[2]));
    }
  return exposure_of_median(std::move(luminances), 0.18, 4);
}

}  // namespace likeness::fit
