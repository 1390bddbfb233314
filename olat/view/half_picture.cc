#include "olat/view/half_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Imath/half.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "render/capture/pixels.h"

namespace likeness::olat_view {
namespace {

constexpr float kLargestHalf = 65504;

std::uint16_t bits_of(float v) {
  if (std::isnan(v)) v = 0;
  return Imath::half(std::clamp(v, -kLargestHalf, kLargestHalf)).bits();
}
float float_of(std::uint16_t bits) {
  Imath::half h;
  h.setBits(bits);
  return h;
}

template <class Row>
void over_rows(int height, const Row& row) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height, 16), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y) row(y);
  });
}

HalfPicture empty_of(int width, int height) {
  return {width, height,
          std::vector<std::uint16_t>(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
}

}  // namespace

HalfPicture half_of(const image::Picture& picture, std::span<const std::uint8_t> flaws) {
  HalfPicture out = empty_of(picture.width, picture.height);
  const auto width = static_cast<std::size_t>(picture.width);
  std::array<std::uint16_t, 256> bits_of_flaws{};
  for (std::size_t k = 0; k < bits_of_flaws.size(); ++k) bits_of_flaws[k] = bits_of(static_cast<float>(k));
  over_rows(picture.height, [&](int y) {
    for (std::size_t i = static_cast<std::size_t>(y) * width; i < static_cast<std::size_t>(y + 1) * width; ++i) {
      for (std::size_t c = 0; c < 3; ++c) out.rgba[4 * i + c] = bits_of(picture.rgb[3 * i + c]);
      out.rgba[4 * i + 3] = flaws.empty() ? 0 : bits_of_flaws[flaws[i]];
    }
  });
  return out;
}

HalfPicture half_of_map(int width, int height, std::span<const float> values) {
  HalfPicture out = empty_of(width, height);
  for (std::size_t i = 0; i < values.size() && 4 * i < out.rgba.size(); ++i) out.rgba[4 * i] = bits_of(values[i]);
  return out;
}

HalfPicture halved(const HalfPicture& picture) {
  HalfPicture out = empty_of((picture.width + 1) / 2, (picture.height + 1) / 2);
  over_rows(out.height, [&](int y) {
    for (int x = 0; x < out.width; ++x) {
      float sum[3] = {};
      unsigned any = 0, all = ~0u;
      for (int k = 0; k < 4; ++k) {
        const int from_x = std::min(2 * x + k % 2, picture.width - 1),
                  from_y = std::min(2 * y + k / 2, picture.height - 1);
        const std::uint16_t* const p =
            &picture.rgba[4 * (static_cast<std::size_t>(from_y) * static_cast<std::size_t>(picture.width) +
                               static_cast<std::size_t>(from_x))];
        for (int c = 0; c < 3; ++c) sum[c] += float_of(p[c]);
        const auto flaws = static_cast<unsigned>(float_of(p[3]));
        any |= flaws;
        all &= flaws;
      }
      std::uint16_t* const to = &out.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
                                               static_cast<std::size_t>(x))];
      for (int c = 0; c < 3; ++c) to[c] = bits_of(0.25f * sum[c]);
      to[3] = bits_of(static_cast<float>((any & ~capture::kMasked) | (all & capture::kMasked)));
    }
  });
  return out;
}

image::Picture light_of(const HalfPicture& picture) {
  image::Picture out(picture.width, picture.height);
  for (std::size_t i = 0; 4 * i < picture.rgba.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) out.rgb[3 * i + c] = float_of(picture.rgba[4 * i + c]);
  return out;
}

std::vector<std::uint8_t> flaws_of(const HalfPicture& picture) {
  std::vector<std::uint8_t> out(picture.rgba.size() / 4);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint8_t>(float_of(picture.rgba[4 * i + 3]));
  return out;
}

}  // namespace likeness::olat_view
