#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace likeness::measured {

struct Point2 {
  double x, y;
};

// A map over the unit square: nodes [y][x] on its borders, bilinear between them.
class Map {
 public:
  Map() = default;
  Map(std::vector<float> nodes, int width, int height) : nodes_(std::move(nodes)), width_(width), height_(height) {}

  double operator()(const Point2& u) const {
    const Place x(u.x, width_), y(u.y, height_);
    return (1 - y.towards) * row(x, y.low) + y.towards * row(x, y.low + 1);
  }
  int width() const { return width_; }
  int height() const { return height_; }
  const float* nodes() const { return nodes_.data(); }
  float* nodes() { return nodes_.data(); }

  // A place in 0..1 between nodes low and low + 1 of n >= 2.
  struct Place {
    int low;
    double towards;
    Place(double u, int n) {
      const double position = std::clamp(u, 0.0, 1.0) * (n - 1);
      low = std::min(static_cast<int>(position), n - 2);
      towards = position - low;
    }
  };

 private:
  double row(const Place& x, int y) const {
    const float* at = nodes_.data() + std::size_t(y) * width_ + x.low;
    return (1 - x.towards) * double{at[0]} + x.towards * double{at[1]};
  }

  std::vector<float> nodes_;
  int width_ = 0, height_ = 0;
};

// A bilinear density over the unit square that is mapped to the uniform one: first y by its marginal, then x at
// that y. Lengths within are in cells, so that the integral of the density over all cells is 1.
class Warp {
 public:
  // Nodes [y][x] >= 0. total() is 0 if there is nothing to map; then nothing else may be called.
  Warp(const float* nodes, int width, int height) : width_(width), height_(height) {
    density_.assign(nodes, nodes + std::size_t(width) * height);
    across_.resize(density_.size());
    up_.resize(height);
    for (int y = 0; y < height; ++y)
      for (int x = 1; x < width; ++x) across(x, y) = across(x - 1, y) + 0.5 * (density(x - 1, y) + density(x, y));
    for (int y = 1; y < height; ++y) up_[y] = up_[y - 1] + 0.5 * (marginal(y - 1) + marginal(y));
    total_ = up_.back();
    if (!(total_ > 0)) return;
    for (std::vector<double>* values : {&density_, &across_, &up_})
      for (double& value : *values) value /= total_;
  }

  double total() const { return total_; }

  // What a place has cumulated; linear in the density, so that two warps may be mixed before dividing.
  struct Cumulated {
    double up, across, marginal;
    Cumulated mixed(const Cumulated& b, double t) const {
      return {up + t * (b.up - up), across + t * (b.across - across), marginal + t * (b.marginal - marginal)};
    }
    // The uniform place.
    Point2 place() const {
      return {marginal > 0 ? std::clamp(across / marginal, 0.0, 1.0) : 0.5, std::clamp(up, 0.0, 1.0)};
    }
  };

  Cumulated cumulated(const Point2& u) const {
    const Map::Place x(u.x, width_), y(u.y, height_);
    const double m0 = marginal(y.low), m1 = marginal(y.low + 1);
    const double p0 = at_height(density_, x.low, y), p1 = at_height(density_, x.low + 1, y);
    return {up_[y.low] + y.towards * (m0 + 0.5 * y.towards * (m1 - m0)),
            at_height(across_, x.low, y) + x.towards * (p0 + 0.5 * x.towards * (p1 - p0)), m0 + y.towards * (m1 - m0)};
  }

  // The density per unit square at a place.
  double density(const Point2& u) const {
    const Map::Place x(u.x, width_), y(u.y, height_);
    const double p0 = at_height(density_, x.low, y), p1 = at_height(density_, x.low + 1, y);
    return (p0 + x.towards * (p1 - p0)) * (width_ - 1) * (height_ - 1);
  }

  // The place that a uniform one comes from, and the density there per unit square.
  Point2 sample(const Point2& s, double& density_there) const {
    const int y0 = last_below(height_, [&](int y) { return up_[y]; }, s.y);
    const double m0 = marginal(y0), m1 = marginal(y0 + 1);
    const double ty = solve(m0, m1, s.y - up_[y0]);
    Map::Place y(0, height_);
    y.low = y0, y.towards = ty;
    const double target = s.x * (m0 + ty * (m1 - m0));
    const int x0 = last_below(width_, [&](int x) { return at_height(across_, x, y); }, target);
    const double p0 = at_height(density_, x0, y), p1 = at_height(density_, x0 + 1, y);
    const double tx = solve(p0, p1, target - at_height(across_, x0, y));
    density_there = (p0 + tx * (p1 - p0)) * (width_ - 1) * (height_ - 1);
    return {(x0 + tx) / (width_ - 1), (y0 + ty) / (height_ - 1)};
  }

 private:
  double& across(int x, int y) { return across_[std::size_t(y) * width_ + x]; }
  double density(int x, int y) const { return density_[std::size_t(y) * width_ + x]; }
  double marginal(int y) const { return across_[std::size_t(y) * width_ + width_ - 1]; }
  double at_height(const std::vector<double>& values, int x, const Map::Place& y) const {
    const double* at = values.data() + std::size_t(y.low) * width_ + x;
    return (1 - y.towards) * at[0] + y.towards * at[width_];
  }

  // The last of n rising values, but the final one, that is not above `target`.
  template <class F>
  static int last_below(int n, F&& value, double target) {
    int low = 0, high = n - 1;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (value(middle) <= target ? low : high) = middle;
    }
    return low;
  }

  // t in 0..1 with a t + (b - a) t^2 / 2 = area, in the form that does not cancel.
  static double solve(double a, double b, double area) {
    const double root = std::sqrt(std::max(0.0, a * a + 2 * (b - a) * area));
    return a + root > 0 ? std::clamp(2 * area / (a + root), 0.0, 1.0) : 0.0;
  }

  int width_, height_;
  std::vector<double> density_, across_, up_;
  double total_ = 0;
};

}  // namespace likeness::measured
