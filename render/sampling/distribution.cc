#include "render/sampling/distribution.h"

#include <algorithm>
#include <cmath>

namespace likeness::sampling {

Distribution::Distribution(std::span<const float> weights) : up_to_(weights.size() + 1, 0.0f) {
  for (const float w : weights) sum_ += static_cast<double>(w);
  double so_far = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    so_far += sum_ > 0 ? static_cast<double>(weights[i]) / sum_ : 1.0 / static_cast<double>(weights.size());
    up_to_[i + 1] = static_cast<float>(so_far);
  }
  // Rounding must neither leave a gap below 1 nor lift what has no weight: the last index that has any ends at 1.
  for (std::size_t i = weights.size(); i > 0 && (i == weights.size() || weights[i] <= 0 || !(sum_ > 0)); --i) {
    up_to_[i] = 1;
    if (!(sum_ > 0)) break;
  }
}

Distribution::Choice Distribution::choose(float u) const {
  const auto after = std::upper_bound(up_to_.begin() + 1, up_to_.end() - 1, u);
  const auto index = static_cast<std::size_t>(after - up_to_.begin()) - 1;
  const float p = probability(index);
  const float rest = p > 0 ? (u - up_to_[index]) / p : 0.0f;
  return {index, p, std::clamp(rest, 0.0f, 0x1.fffffep-1f)};
}

Distribution2::Distribution2(std::span<const float> weights, int width, int height) : width_(width), height_(height) {
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  std::vector<float> of_rows(rows);
  columns_.reserve(rows);
  for (std::size_t y = 0; y < rows; ++y) {
    columns_.emplace_back(weights.subspan(y * columns, columns));
    // Of the mean, which a float holds if it holds the weights.
    of_rows[y] = static_cast<float>(columns_.back().sum() / width);
  }
  rows_ = Distribution(of_rows);
}

Distribution2::Point Distribution2::sample(const glm::vec2& u) const {
  const auto row = rows_.choose(u.y);
  const auto column = columns_[row.index].choose(u.x);
  const auto columns = static_cast<float>(width_), rows = static_cast<float>(height_);
  const glm::vec2 at{(static_cast<float>(column.index) + column.rest) / columns,
                     (static_cast<float>(row.index) + row.rest) / rows};
  return {glm::vec2{std::min(at.x, 0x1.fffffep-1f), std::min(at.y, 0x1.fffffep-1f)},
          row.probability * column.probability * columns * rows};
}

float Distribution2::density(const glm::vec2& at) const {
  const auto cell = [](float x, int count) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(x * static_cast<float>(count)), 0, count - 1));
  };
  const std::size_t row = cell(at.y, height_);
  return rows_.probability(row) * columns_[row].probability(cell(at.x, width_)) * static_cast<float>(width_) *
         static_cast<float>(height_);
}

}  // namespace likeness::sampling
