#pragma once

#include <complex>
#include <vector>

namespace likeness::bloom {

// A square of complex numbers, row by row, and its discrete Fourier transform in place. Two real pictures that are to be
// multiplied by one real spectrum, or two symmetric kernels for one picture, may share it as real and imaginary part.
struct Square {
  int size = 0;
  std::vector<std::complex<double>> at;

  explicit Square(int size_) : size(size_), at(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_)) {}
  std::complex<double>& operator()(int x, int y) {
    return at[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x)];
  }
};

// Forward: without a factor. Inverse: divided by the number of elements.
void transform(Square& square, bool is_inverse);

// The least size of at least `least` whose prime factors are 2, 3 and 5.
int fast_size(int least);

// A kernel of (2 radius + 1)^2 numbers, its middle at (0, 0), wrapped around, times factor. size > 2 radius.
void add_kernel(Square& square, const std::vector<double>& kernel, int radius, std::complex<double> factor);

}  // namespace likeness::bloom
