#include "realis/texture/unwrap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "render/files/files.h"

namespace likeness::realis {
namespace {

constexpr std::int64_t kSteps = 256;  // of a texel
constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr std::size_t kMostShared = 200;  // one texel in so many

struct Corner {
  std::int64_t x, y;
};
using Corners = std::array<Corner, 3>;

// Twice the area of a, b, p: positive where p is to the one side of the edge, exact.
std::int64_t side_of(const Corner& a, const Corner& b, const Corner& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}
// Of an edge and the same edge walked backwards exactly one owns the points on it.
bool owns(const Corner& a, const Corner& b) { return b.y > a.y || (b.y == a.y && b.x > a.x); }

struct Texture {
  int size;
  std::vector<std::uint32_t> triangles;
  std::vector<glm::vec2> corners;
  std::vector<float> distances;

  explicit Texture(int size_)
      : size(size_),
        triangles(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_), kNone),
        corners(triangles.size()),
        distances(triangles.size(), std::numeric_limits<float>::infinity()) {}
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
  }
};

// f(x, y) of the texels about a triangle, and `beside` of them around it.
void over_box(const Corners& c, int size, int beside, const auto& f) {
  const auto low = [&](auto a, auto b, auto d) {
    return std::max<std::int64_t>(std::min({a, b, d}) / kSteps - beside - 1, 0);
  };
  const auto high = [&](auto a, auto b, auto d) {
    return std::min<std::int64_t>(std::max({a, b, d}) / kSteps + beside + 1, size - 1);
  };
  const std::int64_t x1 = high(c[0].x, c[1].x, c[2].x), y1 = high(c[0].y, c[1].y, c[2].y);
  for (std::int64_t y = low(c[0].y, c[1].y, c[2].y); y <= y1; ++y)
    for (std::int64_t x = low(c[0].x, c[1].x, c[2].x); x <= x1; ++x) f(static_cast<int>(x), static_cast<int>(y));
}

Corner middle_of(int x, int y) { return {x * kSteps + kSteps / 2, y * kSteps + kSteps / 2}; }

// The weights of the second and the third corner at the point of the triangle that is nearest to p, and how far that is
// [texel].
std::pair<glm::vec2, double> nearest_in(const Corners& c, const Corner& p) {
  const auto point = [](const Corner& a) {
    return glm::dvec2(static_cast<double>(a.x), static_cast<double>(a.y)) / static_cast<double>(kSteps);
  };
  const std::array<glm::dvec2, 3> q{point(c[0]), point(c[1]), point(c[2])};
  const glm::dvec2 at = point(p);
  double best = std::numeric_limits<double>::infinity();
  std::array<double, 3> weights{1, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const glm::dvec2 edge = q[j] - q[i];
    const double length2 = glm::dot(edge, edge);
    const double t = length2 > 0 ? std::clamp(glm::dot(at - q[i], edge) / length2, 0.0, 1.0) : 0.0;
    const double distance = glm::length(at - q[i] - t * edge);
    if (distance >= best) continue;
    best = distance, weights = {0, 0, 0}, weights[i] = 1 - t, weights[j] = t;
  }
  return {{static_cast<float>(weights[1]), static_cast<float>(weights[2])}, best};
}

// Texels whose middles are inside; how many were another triangle's.
std::size_t cover(Texture& texture, const Corners& c, std::uint32_t triangle) {
  const std::int64_t area = side_of(c[0], c[1], c[2]);
  if (area == 0) return 0;
  const Corner &a = c[0], &b = area > 0 ? c[1] : c[2], &d = area > 0 ? c[2] : c[1];
  const auto twice = static_cast<double>(std::abs(area));
  std::size_t shared = 0;
  over_box(c, texture.size, 0, [&](int x, int y) {
    const Corner p = middle_of(x, y);
    const std::int64_t of_d = side_of(a, b, p), of_a = side_of(b, d, p), of_b = side_of(d, a, p);
    if (of_a < 0 || of_b < 0 || of_d < 0) return;
    if ((of_d == 0 && !owns(a, b)) || (of_a == 0 && !owns(b, d)) || (of_b == 0 && !owns(d, a))) return;
    const std::size_t pixel = texture.at(x, y);
    if (texture.triangles[pixel] != kNone) {
      ++shared;
      return;
    }
    const auto second = static_cast<float>(static_cast<double>(of_b) / twice);
    const auto third = static_cast<float>(static_cast<double>(of_d) / twice);
    texture.triangles[pixel] = triangle, texture.distances[pixel] = 0;
    texture.corners[pixel] = area > 0 ? glm::vec2(second, third) : glm::vec2(third, second);
  });
  return shared;
}

// Texels beside the triangle that nothing covers, nor any other triangle more nearly.
void pad(Texture& texture, const Corners& c, std::uint32_t triangle) {
  over_box(c, texture.size, static_cast<int>(kGutter), [&](int x, int y) {
    const std::size_t pixel = texture.at(x, y);
    if (!(texture.distances[pixel] > 0)) return;
    const auto [corners, distance] = nearest_in(c, middle_of(x, y));
    if (distance > kGutter || !(static_cast<float>(distance) < texture.distances[pixel])) return;
    texture.triangles[pixel] = triangle, texture.corners[pixel] = corners;
    texture.distances[pixel] = std::max(static_cast<float>(distance), std::numeric_limits<float>::min());
  });
}

}  // namespace

Unwrapped unwrap(const scene::Mesh& mesh, int size, const std::string& name) {
  const auto refuse = [&](const std::string& text) {
    throw files::UsageError("object " + files::in_quotes(name) + " " + text);
  };
  if (mesh.is_sphere || mesh.triangles.empty())
    refuse("has no triangles, and texture space is theirs; the shape `faceted_sphere` has them");
  if (mesh.uvs.empty())
    refuse("has no texture coordinates; unwrap it where it was modelled (Blender: UV > Smart UV Project)");
  std::vector<Corner> places;
  places.reserve(mesh.uvs.size());
  for (const glm::vec2& uv : mesh.uvs)
    places.push_back({std::llround(static_cast<double>(uv.x) * size * static_cast<double>(kSteps)),
                      std::llround(static_cast<double>(uv.y) * size * static_cast<double>(kSteps))});
  const auto corners_of = [&](std::size_t t) {
    const auto& i = mesh.triangles[t];
    return Corners{places[i[0]], places[i[1]], places[i[2]]};
  };
  const std::int64_t last = (size + 1) * kSteps;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const scene::Index i : mesh.triangles[t])
      if (places[i].x < -kSteps || places[i].y < -kSteps || places[i].x > last || places[i].y > last)
        refuse("has texture coordinates outside [0, 1] (" + files::number_text(static_cast<double>(mesh.uvs[i].x)) +
               ", " + files::number_text(static_cast<double>(mesh.uvs[i].y)) +
               "): its texture repeats, so one texel would stand for several places; unwrap it into one square");

  Texture texture(size);
  Unwrapped out;
  out.size = size;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    out.overlapping += cover(texture, corners_of(t), static_cast<std::uint32_t>(t));
  out.inside = static_cast<std::size_t>(
      std::count_if(texture.triangles.begin(), texture.triangles.end(), [](std::uint32_t t) { return t != kNone; }));
  if (out.overlapping * kMostShared > out.inside)
    refuse("uses " + std::to_string(out.overlapping) + " of its " + std::to_string(out.inside) +
           " texels more than once (mirrored or stacked charts), and each could hold one residual only; unwrap it "
           "without overlap");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) pad(texture, corners_of(t), static_cast<std::uint32_t>(t));
  for (std::size_t pixel = 0; pixel < texture.triangles.size(); ++pixel) {
    if (texture.triangles[pixel] == kNone) continue;
    out.pixels.push_back(static_cast<std::uint32_t>(pixel));
    out.triangles.push_back(texture.triangles[pixel]);
    out.corners.push_back(texture.corners[pixel]);
  }
  return out;
}

}  // namespace likeness::realis
