#include "realis/apply.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "render/files/files.h"

namespace likeness::realis {
namespace {

double luminance(const glm::dvec3& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

// A rectangle of the environment: columns [left, right), rows [top, bottom).
struct Part {
  int left, right, top, bottom;
};

class Sky {
 public:
  explicit Sky(const image::Picture& picture) : picture_(picture), rows_(static_cast<std::size_t>(picture.height)) {
    for (int y = 0; y < picture.height; ++y) {
      const double step = std::numbers::pi / picture.height;
      // Solid angle of a pixel of the row [sr].
      rows_[static_cast<std::size_t>(y)] =
          (std::cos(y * step) - std::cos((y + 1) * step)) * 2 * std::numbers::pi / picture.width;
    }
  }
  glm::dvec3 light(int x, int y) const {
    const auto p = picture_.at(x, y);
    glm::dvec3 c(p[0], p[1], p[2]);
    for (int k = 0; k < 3; ++k)
      if (!(c[k] > 0 && std::isfinite(c[k]))) c[k] = 0;
    return c * rows_[static_cast<std::size_t>(y)];
  }
  double of(const Part& part) const {
    double sum = 0;
    for (int y = part.top; y < part.bottom; ++y)
      for (int x = part.left; x < part.right; ++x) sum += luminance(light(x, y));
    return sum;
  }
  // Two parts of equal light, cut across the longer side; a part of one pixel stays whole.
  bool halve(const Part& part, Part& a, Part& b) const {
    const double middle = std::sin(std::numbers::pi * 0.5 * (part.top + part.bottom) / picture_.height);
    const double wide = 2 * (part.right - part.left) * middle * picture_.height,
                 high = (part.bottom - part.top) * static_cast<double>(picture_.width);
    const bool across = part.right - part.left > 1 && (wide >= high || part.bottom - part.top < 2);
    if (!across && part.bottom - part.top < 2) return false;
    const int begin = across ? part.left : part.top, end = across ? part.right : part.bottom;
    const double half = 0.5 * of(part);
    double sum = 0;
    int cut = begin + 1;
    for (; cut < end - 1; ++cut) {
      sum += of(across ? Part{cut - 1, cut, part.top, part.bottom} : Part{part.left, part.right, cut - 1, cut});
      if (sum >= half) break;
    }
    a = b = part;
    if (across) a.right = b.left = cut;
    else a.bottom = b.top = cut;
    return true;
  }
  Beam beam(const Part& part) const {
    Beam out;
    glm::dvec3 direction(0), sum(0);
    for (int y = part.top; y < part.bottom; ++y)
      for (int x = part.left; x < part.right; ++x) {
        const glm::dvec3 c = light(x, y);
        const double phi = ((x + 0.5) / picture_.width - 0.5) * 2 * std::numbers::pi,
                     theta = (y + 0.5) / picture_.height * std::numbers::pi, sine = std::sin(theta);
        direction += luminance(c) * glm::dvec3(sine * std::sin(phi), std::cos(theta), -sine * std::cos(phi));
        sum += c;
      }
    const double length = glm::length(direction);
    out.to_light = length > 0 ? direction / length : glm::dvec3(0, 1, 0);
    out.irradiance = sum;
    return out;
  }

 private:
  const image::Picture& picture_;
  std::vector<double> rows_;
};

}  // namespace

std::vector<Beam> beams_of(const image::Picture& environment, std::size_t count) {
  std::vector<Beam> out;
  if (environment.width == 0 || environment.height == 0 || count == 0) return out;
  const Sky sky(environment);
  struct Weighed {
    Part part;
    double light;
  };
  std::vector<Weighed> parts{{{0, environment.width, 0, environment.height}, 0}};
  parts[0].light = sky.of(parts[0].part);
  if (!(parts[0].light > 0)) return out;
  std::vector<Weighed> whole;
  while (!parts.empty() && parts.size() + whole.size() < count) {
    const auto most = std::max_element(parts.begin(), parts.end(),
                                       [](const Weighed& a, const Weighed& b) { return a.light < b.light; });
    const Weighed chosen = *most;
    parts.erase(most);
    Part a{}, b{};
    if (!sky.halve(chosen.part, a, b)) {
      whole.push_back(chosen);
      continue;
    }
    parts.push_back({a, sky.of(a)}), parts.push_back({b, sky.of(b)});
  }
  whole.insert(whole.end(), parts.begin(), parts.end());
  for (const Weighed& part : whole)
    if (part.light > 0) out.push_back(sky.beam(part.part));
  return out;
}

Relit relight(const capture::Capture& capture, const StoredBake& stored, const capture_fit::Fit& surface,
              std::span<const Beam> beams) {
  if (surface.normals.width != stored.width || surface.normals.height != stored.height)
    throw files::InputError("the bake is " + std::to_string(stored.width) + " x " + std::to_string(stored.height) +
                            ", its normals " + std::to_string(surface.normals.width) + " x " +
                            std::to_string(surface.normals.height) + "; they were not baked together");
  // The capture as it would be with these lights.
  capture::Capture lit = capture;
  lit.lights.clear();
  for (const Beam& beam : beams) {
    capture::Light light;
    light.id = std::to_string(lit.lights.size());
    light.place = capture::DistantLight{beam.to_light};
    lit.lights.push_back(light);
  }
  const capture_fit::Relighting relighting(lit, surface);
  Relit out{{stored.width, stored.height}, {stored.width, stored.height}};
  std::vector<double> residual(out.realis.rgb.size(), 0.0);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const image::Picture render = relighting.render(i);
    const Residual e(stored.bake, beams[i].to_light);
    for (std::size_t k = 0; k < render.rgb.size(); ++k)
      out.render.rgb[k] +=
          static_cast<float>(static_cast<double>(render.rgb[k]) * beams[i].irradiance[static_cast<int>(k % 3)]);
    for (std::size_t texel = 0; texel < stored.pixels.size(); ++texel) {
      const std::size_t pixel = stored.pixels[texel];
      const glm::dvec3 normal(surface.normals.rgb[3 * pixel], surface.normals.rgb[3 * pixel + 1],
                              surface.normals.rgb[3 * pixel + 2]);
      const auto added = e.at(texel, glm::dot(normal, beams[i].to_light));
      for (std::size_t c = 0; c < 3; ++c)
        residual[3 * pixel + c] += added[c] * beams[i].irradiance[static_cast<int>(c)];
    }
  }
  // No less than the surroundings give back.
  glm::dvec3 received(0);
  for (const Beam& beam : beams) received += beam.irradiance;
  const glm::dvec3 least = surface.least * surface.exposure / std::numbers::pi * received;
  for (std::size_t k = 0; k < residual.size(); ++k)
    out.realis.rgb[k] =
        static_cast<float>(std::max(static_cast<double>(out.render.rgb[k]) + residual[k],
                                    static_cast<double>(surface.base_colors.rgb[k]) * least[static_cast<int>(k % 3)]));
  return out;
}

}  // namespace likeness::realis
