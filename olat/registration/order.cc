#include "olat/registration/order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "olat/registration/plane.h"

namespace likeness::registration {
namespace {

constexpr double kFloor = 0.05;             // of the mean: below it shadows are all alike
constexpr std::size_t kFewestPictures = 4;  // pictures whose mean says what they share
constexpr std::size_t kFewestBlocks = 16;

// Without what they share, of length 1.
std::vector<Sketch> own_part(std::span<const Sketch> sketches) {
  std::size_t size = 0, count = 0;
  for (const Sketch& s : sketches) {
    if (s.empty()) continue;
    if (size != 0 && s.size() != size)
      throw std::invalid_argument("registration: sketches of " + std::to_string(size) + " and " +
                                  std::to_string(s.size()) + " blocks");
    size = s.size();
    ++count;
  }
  std::vector<double> mean(size, 0.0);
  if (count >= kFewestPictures)
    for (const Sketch& s : sketches)
      for (std::size_t i = 0; i < s.size(); ++i) mean[i] += static_cast<double>(s[i]) / static_cast<double>(count);
  std::vector<Sketch> out(sketches.begin(), sketches.end());
  for (Sketch& s : out) {
    double squares = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
      s[i] -= static_cast<float>(mean[i]);
      squares += static_cast<double>(s[i]) * static_cast<double>(s[i]);
    }
    const double length = std::sqrt(squares);
    if (length > 1e-6 * static_cast<double>(s.size()))
      for (float& v : s) v /= static_cast<float>(length);
    else s.clear();  // one tone, or the same as all others
  }
  return out;
}

double product(const Sketch& p, const Sketch& q) {
  if (p.empty() || q.empty()) return 0;
  if (p.size() != q.size())
    throw std::invalid_argument("registration: sketches of " + std::to_string(p.size()) + " and " +
                                std::to_string(q.size()) + " blocks");
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += static_cast<double>(p[i]) * static_cast<double>(q[i]);
  return sum;
}

}  // namespace

Sketch sketch_of(const image::Picture& picture, std::span<const float> weight) {
  require_one_size(picture, picture, weight);
  const int block = std::max(1, (std::max(picture.width, picture.height) + kSketchSide - 1) / kSketchSide);
  const Plane light = luminance(picture);
  const double mean = weighted_mean(light, weight);
  if (!(mean > 0)) return {};
  Sketch sketch;
  for (int top = 0; top < picture.height; top += block)
    for (int left = 0; left < picture.width; left += block) {
      double sum = 0, total = 0;
      const int bottom = std::min(top + block, picture.height), right = std::min(left + block, picture.width);
      for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
          const std::size_t i =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x);
          const double w = weight.empty() ? 1 : static_cast<double>(weight[i]);
          if (!(w > 0)) continue;
          sum += static_cast<double>(light.values[i]);
          ++total;
        }
      if (2 * total <= (bottom - top) * (right - left)) continue;
      sketch.push_back(static_cast<float>(std::log2(std::max(0.0, sum / total) + kFloor * mean)));
    }
  if (sketch.size() < kFewestBlocks) return {};
  double level = 0;
  for (const float v : sketch) level += static_cast<double>(v) / static_cast<double>(sketch.size());
  for (float& v : sketch) v -= static_cast<float>(level);
  return sketch;
}

std::vector<double> likenesses(std::span<const Sketch> photos, std::span<const Sketch> renders) {
  const std::vector<Sketch> seen = own_part(photos), made = own_part(renders);
  std::vector<double> score;
  score.reserve(seen.size() * made.size());
  for (const Sketch& p : seen)
    for (const Sketch& r : made) score.push_back(product(p, r));
  return score;
}

// Kuhn's method with potentials (Munkres 1957; shortest augmenting paths of Jonker and Volgenant 1987), on the costs
// -score. Row and column 0 stand for "none".
std::vector<std::size_t> assignment(const std::vector<double>& score, std::size_t rows, std::size_t columns) {
  if (rows > columns || score.size() != rows * columns)
    throw std::invalid_argument("assignment: " + std::to_string(score.size()) + " scores of " + std::to_string(rows) +
                                " rows and " + std::to_string(columns) + " columns");
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> row_potential(rows + 1, 0.0), column_potential(columns + 1, 0.0);
  std::vector<std::size_t> row_of(columns + 1, 0), before(columns + 1, 0);
  for (std::size_t row = 1; row <= rows; ++row) {
    std::vector<double> least(columns + 1, kInfinity);
    std::vector<bool> reached(columns + 1, false);
    std::size_t at = 0;
    row_of[0] = row;
    do {
      reached[at] = true;
      double step = kInfinity;
      std::size_t next = 0;
      for (std::size_t column = 1; column <= columns; ++column) {
        if (reached[column]) continue;
        const double cost =
            -score[(row_of[at] - 1) * columns + column - 1] - row_potential[row_of[at]] - column_potential[column];
        if (cost < least[column]) least[column] = cost, before[column] = at;
        if (least[column] < step) step = least[column], next = column;
      }
      for (std::size_t column = 0; column <= columns; ++column) {
        if (reached[column]) row_potential[row_of[column]] += step, column_potential[column] -= step;
        else least[column] -= step;
      }
      at = next;
    } while (row_of[at] != 0);
    for (; at != 0; at = before[at]) row_of[at] = row_of[before[at]];
  }
  std::vector<std::size_t> out(rows);
  for (std::size_t column = 1; column <= columns; ++column)
    if (row_of[column] != 0) out[row_of[column] - 1] = column - 1;
  return out;
}

std::vector<Misplaced> misplaced(std::span<const Sketch> photos, std::span<const Sketch> renders, double margin) {
  if (photos.size() != renders.size())
    throw std::invalid_argument("misplaced: " + std::to_string(photos.size()) + " photos and " +
                                std::to_string(renders.size()) + " renders");
  const std::size_t count = photos.size();
  const std::vector<double> score = likenesses(photos, renders);
  const std::vector<std::size_t> found = assignment(score, count, count);
  std::vector<Misplaced> out;
  for (std::size_t i = 0; i < count; ++i) {
    if (photos[i].empty() || renders[found[i]].empty()) continue;
    const Misplaced m{i, found[i], score[i * count + i], score[i * count + found[i]]};
    if (m.render != i && m.found >= m.own + margin) out.push_back(m);
  }
  return out;
}

std::string_view flips_text(int flips) {
  constexpr std::array<std::string_view, 8> kTexts{"none", "x",       "y",       "x and y",
                                                   "z",    "x and z", "y and z", "x, y and z"};
  return kTexts.at(static_cast<std::size_t>(flips));
}

Mirror mirror_of(const image::Picture& normals, std::span<const float> weight, std::span<const Sketch> photos,
                 std::span<const std::array<double, 3>> to_light) {
  if (photos.size() != to_light.size())
    throw std::invalid_argument("mirror_of: " + std::to_string(photos.size()) + " photos and " +
                                std::to_string(to_light.size()) + " directions");
  Mirror out;
  const std::vector<Sketch> seen = own_part(photos);
  image::Picture cosine(normals.width, normals.height);
  for (int flips = 0; flips < 8; ++flips) {
    std::vector<Sketch> made;
    for (const auto& direction : to_light) {
      std::array<float, 3> l{};
      for (std::size_t k = 0; k < 3; ++k)
        l[k] = static_cast<float>((flips >> k & 1) != 0 ? -direction[k] : direction[k]);
      for (std::size_t i = 0; i < normals.rgb.size(); i += 3) {
        const float* const n = normals.rgb.data() + i;
        std::fill_n(cosine.rgb.begin() + static_cast<std::ptrdiff_t>(i), 3,
                    std::max(0.0f, n[0] * l[0] + n[1] * l[1] + n[2] * l[2]));
      }
      made.push_back(sketch_of(cosine, weight));
    }
    made = own_part(made);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i].empty()) continue;
      sum += product(seen[i], made[i]);
      ++count;
    }
    const double mean = count > 0 ? sum / count : 0;
    if (flips == 0) out.own = out.found = mean;
    else if (mean > out.found) out.found = mean, out.flips = flips;
  }
  return out;
}

}  // namespace likeness::registration
