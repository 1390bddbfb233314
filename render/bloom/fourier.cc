#include "render/bloom/fourier.h"

#include <algorithm>
#include <utility>

#include <unsupported/Eigen/FFT>

namespace likeness::bloom {
namespace {

void transform_rows(Square& square, bool is_inverse) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::Unscaled);
  std::vector<std::complex<double>> row(static_cast<std::size_t>(square.size));
  for (int y = 0; y < square.size; ++y) {
    std::complex<double>* at = &square(0, y);
    if (is_inverse) fft.inv(row.data(), at, square.size);
    else fft.fwd(row.data(), at, square.size);
    std::copy(row.begin(), row.end(), at);
  }
}

void transpose(Square& square) {
  constexpr int kBlock = 32;
  for (int by = 0; by < square.size; by += kBlock)
    for (int bx = by; bx < square.size; bx += kBlock)
      for (int y = by; y < std::min(by + kBlock, square.size); ++y)
        for (int x = std::max(bx, y + 1); x < std::min(bx + kBlock, square.size); ++x)
          std::swap(square(x, y), square(y, x));
}

}  // namespace

void transform(Square& square, bool is_inverse) {
  if (square.size < 2) return;  // its own transform
  // The order of the two passes does not matter, so the second transposition is spared: spectra are kept transposed.
  if (is_inverse) {
    transform_rows(square, true);
    transpose(square);
    transform_rows(square, true);
    const double factor = 1.0 / (static_cast<double>(square.size) * square.size);
    for (std::complex<double>& value : square.at) value *= factor;
    return;
  }
  transform_rows(square, false);
  transpose(square);
  transform_rows(square, false);
}

int fast_size(int least) {
  for (int size = std::max(1, least);; ++size) {
    int rest = size;
    for (const int prime : {2, 3, 5})
      while (rest % prime == 0) rest /= prime;
    if (rest == 1) return size;
  }
}

void add_kernel(Square& square, const std::vector<double>& kernel, int radius, std::complex<double> factor) {
  const int side = 2 * radius + 1;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int px = (x - radius + square.size) % square.size, py = (y - radius + square.size) % square.size;
      square(px, py) +=
          factor * kernel[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)];
    }
}

}  // namespace likeness::bloom
