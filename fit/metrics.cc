#include "fit/metrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fit/coordinates.h"
#include "render/image/difference.h"
#include "render/image/tone_curve.h"

namespace likeness::fit {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::array kMetricLightsDeg{30.0, 120.0};
constexpr int kMetricSphereSize = 96;  // pixels; the two pictures of sphere_psnr and sphere_ssim

void add_direction(const measured::Direction& d, std::array<std::vector<float>, 3>& arrays) {
  arrays[0].push_back(static_cast<float>(d.x));
  arrays[1].push_back(static_cast<float>(d.y));
  arrays[2].push_back(static_cast<float>(d.z));
}

// Fills up to a multiple of kLane: directions along the normal, everything else 0.
void pad(std::array<std::vector<float>, 3>& directions) {
  while (directions[0].size() % kLane != 0) add_direction({0, 0, 1}, directions);
}
void pad(std::vector<float>& values) {
  while (values.size() % kLane != 0) values.push_back(0);
}

std::array<const float*, 3> pointers(const std::array<std::vector<float>, 3>& arrays) {
  return {arrays[0].data(), arrays[1].data(), arrays[2].data()};
}

// Sums of squared differences over samples and color channels, as a display shows them and in the logarithm.
struct Squares {
  double shown = 0, log = 0;
  std::size_t count = 0;

  void add(const measured::Rgb& f, const measured::Rgb& g, double cos_i) {
    const double pair[3][2] = {{f.r, g.r}, {f.g, g.g}, {f.b, g.b}};
    for (const auto& [a, b] : pair) {
      const double by_eye = std::clamp(a, 0.0, 1.0) - std::clamp(b, 0.0, 1.0);
      const double by_log = std::log1p(a * cos_i) - std::log1p(b * cos_i);
      shown += by_eye * by_eye;
      log += by_log * by_log;
    }
    count += 3;
  }
  double error_pct() const { return 100 * std::sqrt(shown / static_cast<double>(count)); }
  double log_rms() const { return std::sqrt(log / static_cast<double>(count)); }
};

}  // namespace

Metrics slice_metrics(const std::vector<SlicePoint>& slice, const brdf::AnyBrdf& model) {
  Squares stored, grid;
  std::visit(
      [&](const auto& m) {
        for (const SlicePoint& p : slice) {
          stored.add(p.f, m.eval(p.at_stored), p.at_stored.cos_i);
          grid.add(p.f, m.eval(p.at_grid), p.at_grid.cos_i);
        }
      },
      model);
  Metrics metrics;
  metrics.slice_error_pct = stored.error_pct();
  metrics.slice_log_rms = stored.log_rms();
  metrics.slice_error_pct_at_grid = grid.error_pct();
  metrics.slice_log_rms_at_grid = grid.log_rms();
  metrics.slice_samples = slice.size();
  metrics.slice_grid = static_cast<std::size_t>(kSliceGrid) * kSliceGrid;
  return metrics;
}

double half_bin_error_pct(const std::vector<SlicePoint>& slice, const brdf::AnyBrdf& model) {
  Squares squares;
  std::visit(
      [&](const auto& m) {
        for (const SlicePoint& p : slice) squares.add(m.eval(p.at_stored), m.eval(p.at_grid), p.at_grid.cos_i);
      },
      model);
  return squares.error_pct();
}

Reference::Reference(const measured::Material& material, double cut_deg) : slice_(slice_points(material, cut_deg)) {
  const double least_cosine = std::cos(cut_deg * kDegree);
  const measured::Coverage coverage = material.coverage();
  table_stored_ = coverage.stored;
  double flux[3] = {0, 0, 0};
  for (auto& array : to_light_) array.reserve(coverage.valid);
  for (auto& array : to_view_) array.reserve(coverage.valid);
  for (auto& array : target_) array.reserve(coverage.valid);
  weight_.reserve(coverage.valid);
  material.for_each_sample([&](const measured::Sample& s) {
    const double cos_i = s.to_light.z, cos_o = s.to_view.z;
    if (cos_i < least_cosine || cos_o < least_cosine) return;
    add_direction(s.to_light, to_light_);
    add_direction(s.to_view, to_view_);
    const double f[3] = {s.f.r, s.f.g, s.f.b}, cosines = s.weight * cos_i * cos_o;
    for (int c = 0; c < 3; ++c) {
      target_[c].push_back(std::log1p(static_cast<float>(f[c] * cos_i)));
      flux[c] += cosines * f[c];
    }
    weight_.push_back(static_cast<float>(s.weight));
    weight_sum_ += s.weight;
    cosine_sum_ += cosines;
    ++table_count_;
  });
  pad(to_light_);
  pad(to_view_);
  for (auto& array : target_) pad(array);
  pad(weight_);
  if (cosine_sum_ > 0) {
    const double scale = std::numbers::pi / cosine_sum_;
    albedo_ = {flux[0] * scale, flux[1] * scale, flux[2] * scale};
  }

  std::array<std::vector<float>, 3> f;
  for (const SpherePixel& pixel : lit_pixels(kMetricLightsDeg, kMetricSphereSize)) {
    measured::Rgb value;
    if (!material.evaluate(pixel.to_light, pixel.to_view, value)) continue;
    pixels_.push_back(pixel);
    add_direction(pixel.to_light, pixel_light_);
    add_direction(pixel.to_view, pixel_view_);
    f[0].push_back(static_cast<float>(value.r));
    f[1].push_back(static_cast<float>(value.g));
    f[2].push_back(static_cast<float>(value.b));
  }
  pad(pixel_light_);
  pad(pixel_view_);
  spheres_ = picture_of(f);
}

image::DisplayPicture Reference::picture_of(const std::array<std::vector<float>, 3>& f) const {
  image::Picture picture(static_cast<int>(kMetricLightsDeg.size()) * kMetricSphereSize, kMetricSphereSize);
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const auto pixel = picture.at(pixels_[i].column, pixels_[i].row);
    const float scale = static_cast<float>(std::numbers::pi * pixels_[i].to_light.z);
    for (std::size_t c = 0; c < 3; ++c) pixel[c] = f[c][i] * scale;
  }
  return image::display(picture);
}

Metrics Reference::of(const brdf::AnyBrdf& model) const {
  Metrics metrics = slice_metrics(slice_, model);
  const std::vector<double> channels = plain_channels(model);

  const auto l = pointers(to_light_), v = pointers(to_view_), t = pointers(target_);
  const TableInput in{{l[0], l[1], l[2]}, {v[0], v[1], v[2]}, {t[0], t[1], t[2]}, weight_.data(),
                      weight_.size(),     model.index(),      channels.data()};
  TableOutput sums;
  kernels().table(in, sums);
  metrics.log_rms_3d = std::sqrt(sums.log_squares / (3 * weight_sum_));
  const double scale = std::numbers::pi / cosine_sum_;
  metrics.albedo_model = {sums.flux[0] * scale, sums.flux[1] * scale, sums.flux[2] * scale};
  metrics.albedo_reference = albedo_;
  metrics.table_samples = table_count_;
  metrics.table_stored = table_stored_;

  std::array<std::vector<float>, 3> f;
  for (auto& array : f) array.resize(pixel_light_[0].size());
  const auto pl = pointers(pixel_light_), pv = pointers(pixel_view_);
  kernels().values({{pl[0], pl[1], pl[2]},
                    {pv[0], pv[1], pv[2]},
                    pixel_light_[0].size(),
                    model.index(),
                    channels.data(),
                    {f[0].data(), f[1].data(), f[2].data()}});
  const image::DisplayPicture render = picture_of(f);
  metrics.sphere_psnr = image::psnr(spheres_, render);
  metrics.sphere_ssim = image::ssim(spheres_, render);
  return metrics;
}

}  // namespace likeness::fit
