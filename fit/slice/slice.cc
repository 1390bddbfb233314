#include "fit/slice/slice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/image/tone_curve.h"

namespace likeness::fit {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

brdf::Geometry<double> geometry_of(int column, int row, const SliceGrid& grid) {
  return brdf::geometry_at(slice_theta_h_deg(column, grid.size) * kDegree, slice_theta_d_deg(row, grid.size) * kDegree,
                           grid.phi_d);
}

// Calls value(geometry, f), which says whether the pixel is valid, for every pixel.
template <class F>
SlicePicture fill(const SliceGrid& grid, F&& value) {
  SlicePicture slice(grid.size);
  for (int row = 0; row < grid.size; ++row)
    for (int column = 0; column < grid.size; ++column) {
      measured::Rgb f;
      if (!value(geometry_of(column, row, grid), f)) continue;
      slice.valid[slice.index(column, row)] = 1;
      const auto pixel = slice.f.at(column, row);
      pixel[0] = static_cast<float>(f.r);
      pixel[1] = static_cast<float>(f.g);
      pixel[2] = static_cast<float>(f.b);
    }
  return slice;
}

double luminance_at(const SlicePicture& slice, int column, int row) {
  const auto pixel = slice.f.at(column, row);
  return luminance(pixel[0], pixel[1], pixel[2]);
}

void paint(image::DisplayPicture& picture, int column, int row, const Color8& color) {
  std::copy(color.begin(), color.end(), picture.at(column, row).begin());
}

}  // namespace

SlicePicture slice_of(const measured::Material& material, const SliceGrid& grid) {
  return fill(grid, [&](const brdf::Geometry<double>& g, measured::Rgb& f) {
    return material.evaluate(g.to_light, g.to_view, f);
  });
}

SlicePicture slice_of(const brdf::AnyBrdf& any, const SliceGrid& grid) {
  return std::visit(
      [&](const auto& model) {
        return fill(grid, [&](const brdf::Geometry<double>& g, measured::Rgb& f) {
          f = model.eval(g);
          return true;
        });
      },
      any);
}

bool within_cut(int column, int row, double cut_deg, int size) {
  const double cos_i =
      std::cos(slice_theta_h_deg(column, size) * kDegree) * std::cos(slice_theta_d_deg(row, size) * kDegree);
  return cos_i >= std::cos(cut_deg * kDegree);
}

Stops difference_in_stops(const SlicePicture& reference, const SlicePicture& model, double cut_deg) {
  Stops stops(reference.valid.size(), std::numeric_limits<float>::quiet_NaN());
  for (int row = 0; row < reference.size(); ++row)
    for (int column = 0; column < reference.size(); ++column) {
      if (!reference.valid_at(column, row) || !model.valid_at(column, row) ||
          !within_cut(column, row, cut_deg, reference.size()))
        continue;
      const double f = std::max(luminance_at(reference, column, row), kDarkest);
      const double g = std::max(luminance_at(model, column, row), kDarkest);
      stops[reference.index(column, row)] = static_cast<float>(std::log2(g / f));
    }
  return stops;
}

double median_difference(const Stops& stops) {
  std::vector<float> sizes;
  sizes.reserve(stops.size());
  for (const float s : stops)
    if (!std::isnan(s)) sizes.push_back(std::abs(s));
  if (sizes.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

Color8 difference_color(double stops) {
  static constexpr std::array<Color8, 9> kScale{{{5, 48, 97},
                                                 {33, 102, 172},
                                                 {67, 147, 195},
                                                 {146, 197, 222},
                                                 {247, 247, 247},
                                                 {253, 184, 99},
                                                 {224, 130, 20},
                                                 {179, 88, 6},
                                                 {127, 59, 8}}};
  const double at = (std::clamp(stops / kStopsRange, -1.0, 1.0) + 1) * 0.5 * (kScale.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), kScale.size() - 2);
  const double t = at - static_cast<double>(below);
  Color8 out;
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = static_cast<std::uint8_t>(std::lround(kScale[below][c] * (1 - t) + kScale[below + 1][c] * t));
  return out;
}

Color8 no_data_color(int column, int row) {
  const std::uint8_t grey = (column + row) % 8 < 4 ? 150 : 184;
  return {grey, grey, grey};
}

image::DisplayPicture difference_picture(const Stops& stops) {
  const int size = static_cast<int>(std::lround(std::sqrt(static_cast<double>(stops.size()))));
  image::DisplayPicture out(size, size);
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const float s = stops[static_cast<std::size_t>(row * size + column)];
      paint(out, column, row, std::isnan(s) ? no_data_color(column, row) : difference_color(s));
    }
  return out;
}

image::DisplayPicture slice_picture(const SlicePicture& slice, double ev) {
  image::DisplayPicture out = image::display(slice.f, ev);
  for (int row = 0; row < slice.size(); ++row)
    for (int column = 0; column < slice.size(); ++column)
      if (!slice.valid_at(column, row)) paint(out, column, row, no_data_color(column, row));
  return out;
}

double exposure_of_median(std::vector<double> luminances, double target, double highest_ev) {
  if (luminances.empty()) return 0;
  const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  return std::clamp(std::round(std::log2(target / std::max(*middle, 1e-9))), -4.0, highest_ev) + 0.0;  // no -0
}

double slice_exposure(const SlicePicture& reference, double cut_deg) {
  std::vector<double> luminances;
  for (int row = 0; row < reference.size(); ++row)
    for (int column = 0; column < reference.size(); ++column)
      if (reference.valid_at(column, row) && within_cut(column, row, cut_deg, reference.size()))
        luminances.push_back(luminance_at(reference, column, row));
  return exposure_of_median(std::move(luminances), 0.18, 6);
}

}  // namespace likeness::fit
