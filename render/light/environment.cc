#include "render/light/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/common.hpp>

#include "render/texture/texture.h"

namespace likeness::light {
namespace {

using std::numbers::pi_v;
constexpr int kMostColumns = 1024;  // of the grid that directions are chosen by

// Of the angle to the poles: d.y has lost it there.
float sine_of(const glm::vec3& d) { return std::sqrt(d.x * d.x + d.z * d.z); }

}  // namespace

Environment::Environment(const scene::Scene& scene, const scene::Environment& environment)
    : scale_(environment.scale), turn_(environment.turn) {
  if (environment.image == scene::kNone) {
    mean_ = scale_;
    return;
  }
  image_ = &scene.images[environment.image];
  if (!image_->texels.bytes.empty()) transfer_ = scene::Transfer::kSrgb;
  const int width = image_->texels.width, height = image_->texels.height;
  const int block = std::max(1, (width + kMostColumns - 1) / kMostColumns);
  const int columns = std::max(1, width / block), rows = std::max(1, height / block);
  std::vector<float> bright(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const auto at = [&](int x, int y) -> float& {
    return bright[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)];
  };
  glm::dvec3 sum(0);
  double area = 0;
  for (int y = 0; y < height; ++y) {
    const double sine = std::sin((y + 0.5) / height * std::numbers::pi);
    for (int x = 0; x < width; ++x) {
      const glm::vec3 c = texture::color_of(*image_, transfer_, x, y);
      if (std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b)) sum += sine * glm::dvec3(c);
      area += sine;
      float& cell = at(std::min(x / block, columns - 1), std::min(y / block, rows - 1));
      cell = std::max(cell, std::max(brightness(c), 0.0f));
    }
  }
  mean_ = glm::vec3(sum / area) * scale_;
  // A point between texels takes from its neighbors: no cell may count for less than a part of each of those.
  std::vector<float> weights(bright.size());
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      float around = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) around += at((x + dx + columns) % columns, std::clamp(y + dy, 0, rows - 1));
      const float sine = std::sin((static_cast<float>(y) + 0.5f) / static_cast<float>(rows) * pi_v<float>);
      weights[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)] =
          (0.5f * at(x, y) + 0.5f * around / 9) * sine;
    }
  cells_ = sampling::Distribution2(weights, columns, rows);
}

glm::vec2 Environment::place_of(const glm::vec3& d) const {
  const float u = 0.5f + (std::atan2(d.x, -d.z) + turn_) / (2 * pi_v<float>);
  return {u - std::floor(u), std::atan2(sine_of(d), d.y) / pi_v<float>};
}
glm::vec3 Environment::direction_at(const glm::vec2& place) const {
  const float phi = (place.x - 0.5f) * 2 * pi_v<float> - turn_, theta = place.y * pi_v<float>, sine = std::sin(theta);
  return {sine * std::sin(phi), std::cos(theta), -sine * std::cos(phi)};
}

glm::vec3 Environment::pictured(const glm::vec3& direction) const {
  const glm::vec2 place = place_of(direction);
  const int width = image_->texels.width, height = image_->texels.height;
  const float x = place.x * static_cast<float>(width) - 0.5f, y = place.y * static_cast<float>(height) - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const int x0 = (static_cast<int>(left) + width) % width, x1 = (x0 + 1) % width;
  const int y0 = std::max(static_cast<int>(top), 0), y1 = std::min(static_cast<int>(top) + 1, height - 1);
  const auto texel = [&](int i, int j) { return texture::color_of(*image_, transfer_, i, j); };
  const glm::vec3 upper = glm::mix(texel(x0, y0), texel(x1, y0), x - left);
  const glm::vec3 lower = glm::mix(texel(x0, y1), texel(x1, y1), x - left);
  return scale_ * glm::mix(upper, lower, y - top);
}

Environment::Choice Environment::sample(const glm::vec2& u) const {
  const auto point = cells_.sample(u);
  const float sine = std::sin(point.at.y * pi_v<float>);
  if (!(sine > 0)) return {};
  return {direction_at(point.at), point.density / (2 * pi_v<float> * pi_v<float> * sine)};
}
float Environment::pdf(const glm::vec3& direction) const {
  const float sine = sine_of(direction);
  return sine > 0 ? cells_.density(place_of(direction)) / (2 * pi_v<float> * pi_v<float> * sine) : 0.0f;
}

}  // namespace likeness::light
