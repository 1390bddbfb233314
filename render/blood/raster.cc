#include "render/blood/raster.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/blood/palette_fit.h"

namespace likeness::blood {
namespace {

constexpr int kSamples = 4;
// Of the palette: blood that thick has an opacity of 1 - 1/e [mm].
constexpr double kOpaqueThickness = brdf::BloodPalette<double>::kParameters[0].initial;
constexpr double kSpineHeight = 0.035;  // of the radius

// A pixel of a layer: coverage of several stains adds as independent ones do.
void lay(Decal& decal, std::size_t part, int x, int y, double share, double thickness) {
  const std::size_t at =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(decal.size) + static_cast<std::size_t>(x);
  float& covered = decal.coverage[part][at];
  covered = static_cast<float>(1 - (1 - static_cast<double>(covered)) * (1 - share));
  decal.thickness[part][at] += static_cast<float>(share * thickness);
}

// Pixels a mm, and pixel coordinates of a place on the receiver.
struct Grid {
  double scale, middle;
  double x(double right) const { return middle + scale * right; }
  double y(double up) const { return middle - scale * up; }
};

// Every pixel of a box by the share of its samples for which inside(right, up) holds, in mm from the drop's middle; profile
// is their mean thickness. Returns whether any lies on the decal.
template <class Inside>
bool fill(Decal& decal, const Grid& grid, std::size_t part, const std::array<double, 2>& low,
          const std::array<double, 2>& high, Inside&& inside) {
  const auto clamped = [&](double value) {
    return static_cast<int>(std::clamp(value, -1.0, static_cast<double>(decal.size)));
  };
  const int x0 = std::max(0, clamped(std::floor(grid.x(low[0])))),
            x1 = std::min(decal.size - 1, clamped(std::floor(grid.x(high[0]))));
  const int y0 = std::max(0, clamped(std::floor(grid.y(high[1])))),
            y1 = std::min(decal.size - 1, clamped(std::floor(grid.y(low[1]))));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      int hits = 0;
      double sum = 0;
      for (int j = 0; j < kSamples; ++j)
        for (int i = 0; i < kSamples; ++i) {
          const double thickness = inside((x + (i + 0.5) / kSamples - grid.middle) / grid.scale,
                                          (grid.middle - (y + (j + 0.5) / kSamples)) / grid.scale);
          if (thickness > 0) ++hits, sum += thickness;
        }
      if (hits > 0) lay(decal, part, x, y, static_cast<double>(hits) / (kSamples * kSamples), sum / hits);
    }
  return x0 <= x1 && y0 <= y1;
}

bool lay_stain(Decal& decal, const Grid& grid, const Drop& drop) {
  const auto part = static_cast<std::size_t>(drop.part);
  const double area = std::numbers::pi / 4 * drop.width * drop.length,
               volume = std::numbers::pi / 6 * std::pow(drop.diameter, 3);
  const double mean = volume / area;
  if (drop.width * grid.scale < 2) {  // smaller than samples can see
    const double px = grid.x(drop.at[0]), py = grid.y(drop.at[1]);
    if (!(px >= 0 && py >= 0 && px < decal.size && py < decal.size)) return false;
    const double share = area * grid.scale * grid.scale;
    lay(decal, part, static_cast<int>(px), static_cast<int>(py), std::min(1.0, share), share > 1 ? mean * share : mean);
    return true;
  }
  const double c = std::cos(drop.turn), s = std::sin(drop.turn), reach = 0.5 * drop.length * (1 + kSpineHeight);
  const bool is_spined = drop.spines >= 3 && drop.width * grid.scale > 8;
  return fill(decal, grid, part, {drop.at[0] - reach, drop.at[1] - reach}, {drop.at[0] + reach, drop.at[1] + reach},
              [&](double right, double up) {
                const double dx = right - drop.at[0], dy = up - drop.at[1];
                const double u = 2 * (c * dx + s * dy) / drop.length, v = 2 * (c * dy - s * dx) / drop.width;
                const double rim = is_spined ? 1 + kSpineHeight * std::cos(drop.spines * std::atan2(v, u)) : 1.0;
                const double rho2 = (u * u + v * v) / (rim * rim);
                return rho2 <= 1 ? mean * (0.6 + 0.8 * rho2) : 0.0;  // its mean over the ellipse is 1
              });
}

void lay_run(Decal& decal, const Grid& grid, const Drop& drop) {
  if (!(drop.run > 0)) return;
  const double half = drop.run_width / 2, end = drop.at[1] - drop.run;
  fill(decal, grid, static_cast<std::size_t>(Part::kDrips), {drop.at[0] - 1.3 * half, end - 1.3 * half},
       {drop.at[0] + 1.3 * half, drop.at[1]}, [&](double right, double up) {
         const double dx = right - drop.at[0], head = std::hypot(dx, up - end);
         if (head <= 1.3 * half) return 0.25;  // the bead at its end
         return std::abs(dx) <= half && up >= end && up <= drop.at[1] ? kTrackThickness : 0.0;
       });
}

}  // namespace

std::vector<float> Decal::all_coverage() const {
  std::vector<float> out(coverage[0].size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    float bare = 1;
    for (const auto& part : coverage) bare *= 1 - part[i];
    out[i] = 1 - bare;
  }
  return out;
}

std::vector<float> Decal::all_thickness() const {
  std::vector<float> out(thickness[0].size());
  for (std::size_t i = 0; i < out.size(); ++i)
    for (const auto& part : thickness) out[i] += part[i];
  return out;
}

Decal decal_of(const Spatter& spatter, int size, double extent) {
  Decal decal;
  decal.size = size;
  decal.extent = extent;
  const std::size_t count = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  for (std::size_t part = 0; part < kParts.size(); ++part)
    decal.coverage[part].assign(count, 0), decal.thickness[part].assign(count, 0);
  const Grid grid{size / extent, 0.5 * size};
  for (const Drop& drop : spatter.drops) {
    decal.outside += lay_stain(decal, grid, drop) ? 0 : 1;
    lay_run(decal, grid, drop);
  }
  return decal;
}

image::Picture preview_of(const Decal& decal, double time) {
  constexpr int kSteps = 256;
  const brdf::BloodPalette<double> palette;
  std::array<std::array<double, 3>, kSteps> colors;
  for (int k = 0; k < kSteps; ++k) colors[static_cast<std::size_t>(k)] = color_of(palette, k / (kSteps - 1.0), time);
  image::Picture out(decal.size, decal.size);
  const std::vector<float> covered = decal.all_coverage(), thick = decal.all_thickness();
  for (std::size_t i = 0; i < covered.size(); ++i) {
    const double share = static_cast<double>(covered[i]);
    // Of the covered part of the pixel alone.
    const double opacity = share > 0 ? -std::expm1(-static_cast<double>(thick[i]) / share / kOpaqueThickness) : 0;
    const auto& color = colors[static_cast<std::size_t>(opacity * (kSteps - 1) + 0.5)];
    for (std::size_t c = 0; c < 3; ++c)
      out.rgb[3 * i + c] = static_cast<float>(colors[0][c] + share * (color[c] - colors[0][c]));
  }
  return out;
}

}  // namespace likeness::blood
