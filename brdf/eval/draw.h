#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "brdf/parameter.h"

// Random inputs of an evaluator, with the edges of their ranges over-weighted.
namespace likeness::eval {

// SplitMix64 (Steele, Lea and Flood 2014): a stream for each row of each evaluator, the same on every machine.
class Random {
 public:
  // `stream` is that of stream_of(); rows of one stream are independent of one another.
  Random(std::uint64_t stream, std::uint64_t row) : state_(stream + row * 0xd1342543de82ef95u) { state_ = next(); }
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double uniform(double low = 0, double high = 1) {
    return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
  }
  unsigned below(unsigned count) { return static_cast<unsigned>((next() >> 32) * count >> 32); }

 private:
  std::uint64_t state_;
};

// Each evaluator has rows of its own.
std::uint64_t stream_of(std::uint64_t seed, std::string_view name);

// Draws rows of inputs as floats, each within its range also after rounding.
//
// A quarter of the rows has every input drawn evenly from its range (by its logarithm, if the parameter says so); in a
// quarter one input in eight lies on an edge, in half of the rows one in two: an end of the range, the default, 1e-7 of
// the range beside an end and at any smaller or larger power of ten, or 0, +-1e-7, 1/2, 2/3, 1, pi/2 and the like.
// Directions are unit vectors to rounding: along the normal, in the surface, 1e-7 above and below it, or anywhere; the
// second one is often the first, its mirror image or its opposite, or a little beside one of these.
class Draw {
 public:
  explicit Draw(std::span<const brdf::Parameter> inputs);

  std::size_t count() const { return rows_.size(); }  // of inputs, colors by channel

  // The float beside x, towards the middle of the input's range.
  float beside(std::size_t input, float x) const;

  // Whether 0 is within an input's range.
  bool reaches_zero(std::size_t input) const { return rows_[input].low <= 0 && rows_[input].high >= 0; }

  // One row, written to columns[i][row].
  void row(Random& random, float* const* columns, std::size_t row) const;

 private:
  struct Input {
    brdf::Parameter parameter;
    float low, high;  // the floats nearest to the ends of the range, within it
    std::vector<double> special;
    bool direction;  // the first of a unit vector's three
  };
  float scalar(const Input& input, Random& random, unsigned edges) const;

  std::vector<Input> rows_;
};

}  // namespace likeness::eval
