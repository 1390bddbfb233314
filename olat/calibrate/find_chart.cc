#include "olat/calibrate/find_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "olat/calibrate/call_opencv.h"
#include "olat/calibrate/perspective.h"
#include "render/files/files.h"
#include "render/image/tone_curve.h"

namespace likeness::olat_calibrate {
namespace {

using image::Picture;

constexpr int kLongestSide = 1600;          // of the picture that quadrangles are looked for in
constexpr int kMostQuads = 16384;           // of all thresholds
constexpr std::size_t kFewestPatches = 12;  // of 24
constexpr double kLargestDeltaE = 12;       // mean; charts in mixed light reach 4, other grids begin at 20
constexpr double kAsGoodAs = 1.3;           // a second reading with less than this times the error is not told apart

struct Grey {
  int width = 0, height = 0, reduction = 1;
  std::vector<std::uint8_t> values;
};

double luminance(std::span<const float, 3> rgb) {
  return 0.2126 * double(rgb[0]) + 0.7152 * double(rgb[1]) + 0.0722 * double(rgb[2]);
}

// As a screen would show it, of means over reduction x reduction pixels; the brightest hundredth is white.
Grey grey_of(const Picture& photo) {
  Grey out;
  out.reduction = std::max(1, (std::max(photo.width, photo.height) + kLongestSide - 1) / kLongestSide);
  out.width = photo.width / out.reduction, out.height = photo.height / out.reduction;
  std::vector<double> light;
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      double sum = 0;
      for (int j = 0; j < out.reduction; ++j)
        for (int i = 0; i < out.reduction; ++i) {
          const double l = luminance(photo.at(x * out.reduction + i, y * out.reduction + j));
          if (std::isfinite(l)) sum += std::max(0.0, l);
        }
      light.push_back(sum);
    }
  std::vector<double> sorted = light;
  const auto bright = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 99 / 100);
  if (sorted.empty()) return out;
  std::nth_element(sorted.begin(), bright, sorted.end());
  const double white = *bright > 0 ? *bright : 1;
  for (const double l : light)
    out.values.push_back(static_cast<std::uint8_t>(255 * std::clamp(image::srgb_encode(l / white), 0.0, 1.0) + 0.5));
  return out;
}

Point operator+(const Point& p, const Point& q) { return {p[0] + q[0], p[1] + q[1]}; }
Point operator-(const Point& p, const Point& q) { return {p[0] - q[0], p[1] - q[1]}; }
Point operator*(double s, const Point& p) { return {s * p[0], s * p[1]}; }
double length(const Point& p) { return std::hypot(p[0], p[1]); }

struct Patch {
  Point middle{}, right{}, down{};  // of the quadrangle, and its sides
  double area = 0;
};

std::vector<Patch> patches_in(const Grey& grey) {
  std::vector<double> numbers(kQuadNumbers * kMostQuads);
  int count = 0;
  const double side = std::max(grey.width, grey.height), least = side / 100, largest = side / 6;
  call_opencv<likeness_quads_function>(kQuadsName, grey.values.data(), grey.width, grey.height, least * least,
                                       largest * largest, numbers.data(), kMostQuads, &count);
  std::vector<Patch> all;
  for (int k = 0; k < count; ++k) {
    const double* q = numbers.data() + static_cast<std::ptrdiff_t>(kQuadNumbers) * k;
    const auto corner = [&](int i) { return Point{q[2 * i], q[2 * i + 1]}; };
    Patch& patch = all.emplace_back();
    patch.middle = {q[8], q[9]};
    patch.right = 0.5 * ((corner(1) - corner(0)) + (corner(2) - corner(3)));
    patch.down = 0.5 * ((corner(3) - corner(0)) + (corner(2) - corner(1)));
    patch.area = patch.right[0] * patch.down[1] - patch.right[1] * patch.down[0];
    const double longer = std::max(length(patch.right), length(patch.down)),
                 shorter = std::min(length(patch.right), length(patch.down));
    if (!(shorter > 0.4 * longer && patch.area > 0.5 * longer * shorter)) all.pop_back();
  }
  // Thresholds find a patch many times: the largest of them is kept, with the median of their middles.
  std::sort(all.begin(), all.end(), [](const Patch& p, const Patch& q) { return p.area > q.area; });
  std::vector<Patch> out;
  std::vector<std::array<std::vector<double>, 2>> middles;
  for (const Patch& patch : all) {
    std::size_t same = 0;
    while (same < out.size() && !(length(out[same].middle - patch.middle) < 0.4 * std::sqrt(patch.area) &&
                                  out[same].area < 2.5 * patch.area))
      ++same;
    if (same == out.size()) out.push_back(patch), middles.emplace_back();
    if (out[same].area < 1.5 * patch.area)
      for (std::size_t k = 0; k < 2; ++k) middles[same][k].push_back(patch.middle[k]);
  }
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k) {
      auto& values = middles[i][k];
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      out[i].middle[k] = *middle;
    }
  return out;
}

using Cell = std::pair<int, int>;  // column, row
using Grid = std::map<Cell, std::size_t>;

// All that stands in a grid with one patch: from neighbour to neighbour, each step as the one before.
Grid grid_from(const std::vector<Patch>& patches, std::size_t seed) {
  struct Node {
    Cell at;
    std::size_t patch;
    Point right, down;
  };
  constexpr double kGap = 1.2;  // cells are wider than their patches
  constexpr int kMostCells = 12;
  Grid grid{{{0, 0}, seed}};
  std::vector<bool> used(patches.size());
  used[seed] = true;
  std::deque<Node> open{{{0, 0}, seed, kGap * patches[seed].right, kGap * patches[seed].down}};
  for (; !open.empty(); open.pop_front()) {
    const Node node = open.front();
    for (const auto& [dx, dy] : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      const Cell at{node.at.first + dx, node.at.second + dy};
      if (grid.contains(at) || std::abs(at.first) > kMostCells || std::abs(at.second) > kMostCells) continue;
      const Point step = double(dx) * node.right + double(dy) * node.down;
      std::size_t best = patches.size();
      double nearest = 0.3 * length(step);
      for (std::size_t i = 0; i < patches.size(); ++i) {
        const double ratio = patches[i].area / patches[node.patch].area;
        if (used[i] || ratio < 0.5 || ratio > 2) continue;
        const double off = length(patches[i].middle - (patches[node.patch].middle + step));
        if (off < nearest) nearest = off, best = i;
      }
      if (best == patches.size()) continue;
      used[best] = true;
      grid[at] = best;
      const Point went = patches[best].middle - patches[node.patch].middle;
      open.push_back({at, best, dx != 0 ? double(dx) * went : node.right, dy != 0 ? double(dy) * went : node.down});
    }
  }
  return grid;
}

struct Window {
  Cell first;
  int columns, rows;
  std::size_t seen;
};

// Where a chart of 6 x 4, upright or lying on its side, covers most of a grid.
std::vector<Window> windows_of(const Grid& grid) {
  std::vector<Window> out;
  Cell low = grid.begin()->first, high = low;
  for (const auto& [at, patch] : grid) {
    low = {std::min(low.first, at.first), std::min(low.second, at.second)};
    high = {std::max(high.first, at.first), std::max(high.second, at.second)};
  }
  std::size_t most = 0;
  for (const auto& [columns, rows] : {Cell{kPatchColumns, kPatchRows}, Cell{kPatchRows, kPatchColumns}})
    for (int x = low.first - columns + 1; x <= high.first; ++x)
      for (int y = low.second - rows + 1; y <= high.second; ++y) {
        const auto is_in = [&, columns = columns, rows = rows](const Grid::value_type& one) {
          const auto [i, j] = one.first;
          return i >= x && i < x + columns && j >= y && j < y + rows;
        };
        const auto seen = static_cast<std::size_t>(std::count_if(grid.begin(), grid.end(), is_in));
        if (seen < kFewestPatches) continue;
        out.push_back({{x, y}, columns, rows, seen});
        most = std::max(most, seen);
      }
  std::erase_if(out, [&](const Window& window) { return 4 * window.seen < 3 * most; });
  return out;
}

// The window's perspective in pixels of the photo, by the patches that agree with it.
std::optional<Perspective> perspective_of_window(const std::vector<Patch>& patches, const Grid& grid,
                                                 const Window& window, int reduction) {
  std::vector<Point> cells, pixels;
  for (const auto& [at, patch] : grid) {
    const int x = at.first - window.first.first, y = at.second - window.first.second;
    if (x < 0 || y < 0 || x >= window.columns || y >= window.rows) continue;
    cells.push_back({x + 0.5, y + 0.5});
    pixels.push_back(double(reduction) * (patches[patch].middle + Point{0.5, 0.5}));
  }
  for (int round = 0; round < 4; ++round) {
    if (cells.size() < kFewestPatches) return {};
    const Perspective seen = perspective_of(cells, pixels);
    const double pitch = length(seen(1, 0.5) - seen(0, 0.5));
    std::vector<Point> good_cells, good_pixels;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (length(seen(cells[i][0], cells[i][1]) - pixels[i]) < 0.04 * pitch)
        good_cells.push_back(cells[i]), good_pixels.push_back(pixels[i]);
    if (good_cells.size() == cells.size()) return seen;
    cells = std::move(good_cells), pixels = std::move(good_pixels);
  }
  return {};
}

// How far a patch lies from the middle of its cell along one axis of it [cell], by the middle between its two edges: in
// the cell's own coordinates, perspective moves neither. Nothing if the edges do not lie like those of a patch.
std::optional<double> off_middle(const Picture& photo, const Perspective& seen, double column, double row,
                                 bool is_across) {
  constexpr int kSteps = 80, kLines = 24;
  std::array<glm::dvec3, kSteps> profile{};
  for (int k = 0; k < kSteps; ++k)
    for (int j = 0; j < kLines; ++j) {
      const double along = (k + 0.5) / kSteps, beside = 0.3 + 0.4 * (j + 0.5) / kLines;
      const auto [u, v] = seen(column + (is_across ? along : beside), row + (is_across ? beside : along));
      if (!(u >= 0 && v >= 0 && u < photo.width && v < photo.height)) return {};
      const auto pixel = photo.at(static_cast<int>(u), static_cast<int>(v));
      profile[static_cast<std::size_t>(k)] += glm::dvec3(pixel[0], pixel[1], pixel[2]);
    }
  constexpr int kReach = 2, kSide = 28;  // of a slope; of the part of the cell in which an edge may lie
  std::array<double, 2> edges{};
  for (const bool is_second : {false, true}) {
    double sum = 0, moment = 0;
    for (int k = kReach; k < kSide; ++k) {
      const auto at = static_cast<std::size_t>(is_second ? kSteps - 1 - k : k);
      const glm::dvec3 slope = profile[at + kReach] - profile[at - kReach];
      const double weight = glm::dot(slope, slope) * glm::dot(slope, slope);
      sum += weight, moment += weight * (static_cast<double>(at) + 0.5) / kSteps;
    }
    if (!(sum > 0)) return {};
    edges[is_second ? 1 : 0] = moment / sum;
  }
  const double off = 0.5 * (edges[0] + edges[1]) - 0.5;
  return std::abs(off) < 0.08 ? std::optional(off) : std::nullopt;
}

// The same perspective by the edges of the patches in all the photo's pixels.
Perspective refined(const Picture& photo, Perspective seen, const Window& window) {
  for (int round = 0; round < 3; ++round) {
    std::vector<Point> cells, pixels;
    for (int row = 0; row < window.rows; ++row)
      for (int column = 0; column < window.columns; ++column) {
        const auto across = off_middle(photo, seen, column, row, true),
                   down = off_middle(photo, seen, column, row, false);
        if (!across || !down) continue;
        cells.push_back({column + 0.5, row + 0.5});
        pixels.push_back(seen(column + 0.5 + *across, row + 0.5 + *down));
      }
    if (cells.size() < kFewestPatches) return seen;
    seen = perspective_of(cells, pixels);
    // Once more without those that do not fit: an edge of a shadow, a label beside the chart.
    std::vector<double> off;
    for (std::size_t i = 0; i < cells.size(); ++i) off.push_back(length(seen(cells[i][0], cells[i][1]) - pixels[i]));
    std::vector<double> sorted = off;
    std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2), sorted.end());
    const double largest = std::max(0.1, 3 * sorted[sorted.size() / 2]);
    for (std::size_t i = off.size(); i-- > 0;)
      if (off[i] > largest)
        cells.erase(cells.begin() + std::ptrdiff_t(i)), pixels.erase(pixels.begin() + std::ptrdiff_t(i));
    if (cells.size() >= kFewestPatches) seen = perspective_of(cells, pixels);
  }
  return seen;
}

// How well a chart with these corners has the reference's colors; nothing if it has not.
std::optional<double> delta_e_at(const Picture& photo, const Corners& corners, const Reference& reference) {
  try {
    const auto colors = patches_of(photo, corners);
    // White to black falls but for one step, which a shadow may turn.
    int rises = 0;
    for (std::size_t i = kFirstGrey; i + 1 < kPatches; ++i) rises += colors[i][1] > colors[i + 1][1] ? 0 : 1;
    if (rises > 1) return {};
    const double mean = fit_chart(colors, reference).stages[2].mean;
    if (mean < kLargestDeltaE) return mean;
  } catch (const files::UsageError&) {  // beyond the edge, or without light
  }
  return {};
}

// The window read in its two directions.
std::vector<Corners> readings(const Perspective& seen, const Window& window) {
  const double w = window.columns, h = window.rows;
  const std::array<Point, 4> round{seen(0, 0), seen(w, 0), seen(w, h), seen(0, h)};
  const std::size_t first = window.columns > window.rows ? 0 : 1;
  std::vector<Corners> out;
  for (const std::size_t turn : {first, first + 2}) {
    Corners& corners = out.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) corners[i] = round[(i + turn) % 4];
  }
  return out;
}

}  // namespace

std::vector<FoundChart> find_charts(const Picture& photo, const Reference& reference) {
  const Grey grey = grey_of(photo);
  if (std::min(grey.width, grey.height) < 64) return {};
  const std::vector<Patch> patches = patches_in(grey);
  std::vector<bool> taken(patches.size());
  std::vector<FoundChart> out;
  for (std::size_t seed = 0; seed < patches.size(); ++seed) {
    if (taken[seed]) continue;
    const Grid grid = grid_from(patches, seed);
    if (grid.size() < kFewestPatches) continue;
    std::vector<FoundChart> read;
    for (const Window& window : windows_of(grid))
      if (const auto seen = perspective_of_window(patches, grid, window, grey.reduction))
        for (const Corners& corners : readings(refined(photo, *seen, window), window))
          if (const auto delta_e = delta_e_at(photo, corners, reference))
            read.push_back({corners, window.seen, *delta_e});
    std::sort(read.begin(), read.end(), [](const auto& p, const auto& q) { return p.delta_e < q.delta_e; });
    for (const auto& [at, patch] : grid) taken[patch] = true;  // a chart or none, it is not looked at again
    if (read.empty() || (read.size() > 1 && read[1].delta_e < kAsGoodAs * read[0].delta_e)) continue;
    const bool is_known = std::any_of(out.begin(), out.end(), [&](const FoundChart& other) {
      return length(other.corners[0] - read[0].corners[0]) < length(read[0].corners[1] - read[0].corners[0]) / 6;
    });
    if (!is_known) out.push_back(read[0]);
  }
  std::sort(out.begin(), out.end(), [](const auto& p, const auto& q) { return p.delta_e < q.delta_e; });
  return out;
}

}  // namespace likeness::olat_calibrate
