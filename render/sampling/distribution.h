#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace likeness::sampling {

// Chooses an index in proportion to weights. A monotone map of the number it is given, so that stratified numbers give
// stratified choices.
class Distribution {
 public:
  struct Choice {
    std::size_t index = 0;
    float probability = 0;
    float rest = 0;  // what is left of the number: uniform in [0, 1) again
  };

  Distribution() = default;
  // Weights >= 0 and finite. If all are 0 every index is as likely.
  explicit Distribution(std::span<const float> weights);

  Choice choose(float u) const;
  float probability(std::size_t index) const { return up_to_[index + 1] - up_to_[index]; }
  std::size_t size() const { return up_to_.empty() ? 0 : up_to_.size() - 1; }
  double sum() const { return sum_; }

 private:
  std::vector<float> up_to_;  // up_to_[i]: probability of all before i
  double sum_ = 0;
};

// Density over the unit square that is constant in each cell of a grid.
class Distribution2 {
 public:
  struct Point {
    glm::vec2 at{0, 0};  // in [0, 1)^2
    float density = 0;   // over the square
  };

  Distribution2() = default;
  // Row by row; weights as above.
  Distribution2(std::span<const float> weights, int width, int height);

  Point sample(const glm::vec2& u) const;
  float density(const glm::vec2& at) const;

 private:
  int width_ = 0, height_ = 0;
  Distribution rows_;
  std::vector<Distribution> columns_;
};

}  // namespace likeness::sampling
