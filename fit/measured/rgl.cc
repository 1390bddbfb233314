#include "fit/measured/rgl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "fit/measured/little_endian.h"
#include "fit/measured/refuse.h"
#include "fit/measured/tensor_file.h"
#include "fit/measured/vndf_warp.h"

namespace likeness::measured {
namespace {

using std::numbers::pi;
constexpr std::uint64_t kMostOfTheta = 64, kLargestMap = 512;
constexpr double kHorizon = 1e-6;  // cosine at and below which a direction is on the horizon
constexpr int kPoints = 3;         // a side and node, of the grid in s that solid angles are summed over
constexpr int kPointsU = 6;        // the same of the one in u

double elevation(const Direction& d) { return std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z); }
double unit_of_theta(double theta) { return std::sqrt(theta * 2 / pi); }
double unit_of_phi(double phi) {
  const double u = phi / (2 * pi) + 0.5;
  return u - std::floor(u);
}

std::string shape_of(const Tensor& tensor) {
  std::string text;
  for (const auto extent : tensor.shape) text += (text.empty() ? "" : " x ") + std::to_string(extent);
  return (text.empty() ? "a scalar" : text) + (tensor.real ? " float32" : " uint8");
}

class Rgl final : public Material {
 public:
  Rgl(std::string_view bytes, const std::string& name) {
    source = name;
    const std::vector<Tensor> tensors = tensors_in(bytes, name);
    const auto has = [&](std::string_view field) { return find(tensors, field) != nullptr; };
    if (has("spectra") && !has("rgb"))
      refuse(name, "a spectral file (field \"spectra\")",
             "an RGB one (field \"rgb\"); the database has each material in both forms");
    const Tensor& phi = field(tensors, "phi_i", 1);
    if (phi.size() > 2)
      refuse(name, "an anisotropic material (" + std::to_string(phi.size()) + " phi_i)",
             "an isotropic one (1 or 2 phi_i)");
    read_theta(field(tensors, "theta_i", 1));
    ndf_ = map(field(tensors, "ndf", 2), 0);
    sigma_ = map(field(tensors, "sigma", 2), 0);
    read_warps(field(tensors, "vndf", 4), phi.size());
    read_colors(field(tensors, "rgb", 5), phi.size());
    const Tensor* jacobian = find(tensors, "jacobian");
    if (jacobian == nullptr || jacobian->real || jacobian->size() != 1)
      refuse(name, jacobian == nullptr ? "no field \"jacobian\"" : "\"jacobian\" of " + shape_of(*jacobian),
             "one uint8");
    scaled_ = jacobian->data[0] != 0;
    if (coverage_.valid == 0)
      refuse(name,
             "no valid sample among " + std::to_string(coverage_.stored) + " (" + std::to_string(coverage_.negative) +
                 " negative, " + std::to_string(coverage_.not_finite) + " NaN or Inf)",
             "at least one");
  }

  bool evaluate(const Direction& to_light, const Direction& to_view, Rgb& f) const override {
    if (!(to_light.z > kHorizon) || !(to_view.z > kHorizon)) return false;
    const Direction m = to_light + to_view;
    const double phi = std::atan2(m.y, m.x) - std::atan2(to_light.y, to_light.x);
    const double theta_i = elevation(to_light);
    const Point2 u{unit_of_theta(elevation(m)), unit_of_phi(phi)};
    // The two neighbouring theta_i; beyond the last, the last.
    const auto above = std::upper_bound(theta_.begin() + 1, theta_.end() - 1, theta_i) - theta_.begin();
    const int low = int(above) - 1;
    const double t = std::clamp((theta_i - theta_[low]) / (theta_[low + 1] - theta_[low]), 0.0, 1.0);
    const Point2 s = warps_[low].cumulated(u).mixed(warps_[low + 1].cumulated(u), t).place();
    const double scale = factor(theta_i, u) / to_view.z;
    Rgb sum;
    for (int c = 0; c < 3; ++c) {
      const double a = t < 1 ? colors_[3 * low + c](s) : 0, b = t > 0 ? colors_[3 * low + 3 + c](s) : 0;
      (c == 0 ? sum.r : c == 1 ? sum.g : sum.b) = ((1 - t) * a + t * b) * scale;
    }
    if (!std::isfinite(sum.r + sum.g + sum.b)) return false;
    f = sum;
    return true;
  }

  void for_each_sample(const std::function<void(const Sample&)>& visit) const override {
    for (int t = 0; t < int(theta_.size()); ++t) {
      const double theta = theta_[t];
      if (std::cos(theta) <= kHorizon) continue;
      const double from = t == 0 ? 0 : (theta_[t - 1] + theta) / 2;
      const double to = t + 1 == int(theta_.size()) ? std::max(theta, pi / 2) : (theta + theta_[t + 1]) / 2;
      for_each_node(t, 2 * pi * (std::cos(from) - std::cos(to)), visit);
    }
  }

  Coverage coverage() const override { return coverage_; }
  Format format() const override { return Format::kRgl; }

 private:
  static const Tensor* find(const std::vector<Tensor>& tensors, std::string_view name) {
    const auto found = std::find_if(tensors.begin(), tensors.end(), [&](const Tensor& t) { return t.name == name; });
    return found == tensors.end() ? nullptr : &*found;
  }

  // A float field of so many dimensions.
  const Tensor& field(const std::vector<Tensor>& tensors, std::string_view name, std::size_t dimensions) const {
    const Tensor* tensor = find(tensors, name);
    if (tensor == nullptr)
      refuse(source, "no field " + in_quotes(name), "phi_i, theta_i, sigma, ndf, vndf, rgb, jacobian");
    if (!tensor->real || tensor->shape.size() != dimensions || tensor->size() == 0)
      refuse(source, in_quotes(name) + " of " + shape_of(*tensor),
             std::to_string(dimensions) + " dimensions of float32");
    return *tensor;
  }

  void read_theta(const Tensor& tensor) {
    if (tensor.size() < 2 || tensor.size() > kMostOfTheta)
      refuse(source, std::to_string(tensor.size()) + " theta_i", "2 to " + std::to_string(kMostOfTheta));
    for (std::size_t i = 0; i < tensor.size(); ++i) {
      theta_.push_back(number_at<float>(tensor.data, 4 * i));
      const double before = i == 0 ? -1e-6 : theta_[i - 1];
      if (!(theta_[i] > before) || !(theta_[i] < pi / 2 + 1e-3))
        refuse(source, "theta_i[" + std::to_string(i) + "] = " + std::to_string(theta_[i]),
               "rising angles from 0 to pi / 2");
      theta_[i] = std::max(theta_[i], 0.0);  // a rounding below 0 has no square root
    }
  }

  // One map [height][width], the last two extents of a tensor, from float number `first`; finite and >= 0 where
  // `limits` says so (the interpolants of the parametrisation; the measured colours may be anything).
  Map map(const Tensor& tensor, std::size_t first, bool limits = true) const {
    const std::uint64_t height = tensor.shape[tensor.shape.size() - 2], width = tensor.shape.back();
    if (height < 2 || height > kLargestMap || width < 2 || width > kLargestMap)
      refuse(source, in_quotes(tensor.name) + " of " + shape_of(tensor), "maps of 2 x 2 to 512 x 512");
    std::vector<float> nodes(height * width);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      nodes[i] = number_at<float>(tensor.data, 4 * (first + i));
      if (limits && !(nodes[i] >= 0 && nodes[i] < 1e30f))
        refuse(source, in_quotes(tensor.name) + "[" + std::to_string(first + i) + "] = " + std::to_string(nodes[i]),
               "a finite number >= 0");
    }
    return Map(std::move(nodes), int(width), int(height));
  }

  void read_warps(const Tensor& tensor, std::size_t phi) {
    if (tensor.shape[0] != phi || tensor.shape[1] != theta_.size())
      refuse(source, "\"vndf\" of " + shape_of(tensor),
             std::to_string(phi) + " phi_i x " + std::to_string(theta_.size()) + " theta_i maps");
    const std::size_t map_size = tensor.shape[2] * tensor.shape[3];
    for (std::size_t t = 0; t < theta_.size(); ++t) {
      const Map nodes = map(tensor, t * map_size);
      warps_.emplace_back(nodes.nodes(), nodes.width(), nodes.height());
      if (!(warps_.back().total() > 0))
        refuse(source, "\"vndf\" at theta_i[" + std::to_string(t) + "] adds up to 0", "a density");
    }
  }

  void read_colors(const Tensor& tensor, std::size_t phi) {
    if (tensor.shape[0] != phi || tensor.shape[1] != theta_.size() || tensor.shape[2] != 3)
      refuse(source, "\"rgb\" of " + shape_of(tensor),
             std::to_string(phi) + " phi_i x " + std::to_string(theta_.size()) + " theta_i x 3 maps");
    const std::size_t map_size = tensor.shape[3] * tensor.shape[4];
    for (std::size_t m = 0; m < 3 * theta_.size(); ++m) colors_.push_back(map(tensor, m * map_size, false));
    coverage_.stored = theta_.size() * map_size;
    for (std::size_t t = 0; t < theta_.size(); ++t)
      for (std::size_t i = 0; i < map_size; ++i) {
        std::array<float*, 3> rgb;
        for (int c = 0; c < 3; ++c) rgb[c] = colors_[3 * t + c].nodes() + i;
        const bool finite = std::isfinite(*rgb[0]) && std::isfinite(*rgb[1]) && std::isfinite(*rgb[2]);
        const bool any = *rgb[0] < 0 || *rgb[1] < 0 || *rgb[2] < 0, all = *rgb[0] < 0 && *rgb[1] < 0 && *rgb[2] < 0;
        coverage_.not_finite += !finite;
        coverage_.negative += finite && all;
        coverage_.valid += finite && !all;
        coverage_.clipped += finite && any && !all;
        for (float* value : rgb) *value = finite && !all ? std::max(*value, 0.0f) : std::nanf("");
      }
  }

  // What turns rgb into f cos theta_o.
  double factor(double theta_i, const Point2& u) const {
    return scaled_ ? ndf_(u) / (4 * sigma_({unit_of_theta(theta_i), 0.5})) : 1;
  }

  // The directions of a half vector's unit coordinates with the light at theta_i[t], and d(omega_o) / d(u).
  struct Pair {
    Direction to_light, to_view;
    double measure;
  };
  Pair pair_at(int t, const Point2& u) const {
    const double theta_m = u.x * u.x * pi / 2, phi_m = (2 * u.y - 1) * pi;
    const Direction m{std::sin(theta_m) * std::cos(phi_m), std::sin(theta_m) * std::sin(phi_m), std::cos(theta_m)};
    const Direction to_light{std::sin(theta_[t]), 0, std::cos(theta_[t])};
    const double cos_d = dot(to_light, m);
    // d(omega_o) = 4 cos theta_d d(omega_m) and d(omega_m) = sin theta_m 2 pi^2 u.x d(u).
    return {to_light, m * (2 * cos_d) - to_light, 4 * std::max(cos_d, 0.0) * std::sin(theta_m) * 2 * pi * pi * u.x};
  }

  // The solid angle of directions to the viewer nearest to each node of theta_i[t], nearest meant in s, and along s.x
  // where the nearest is not `above` the horizon (the outermost theta_m of a sharp lobe). It is a sum
  // over two regular grids, one in s, fine where vndf is large, and one in u, fine where it is small; each point counts
  // by the balance heuristic (Veach 1997, 9.2.2): d(omega_o) / d(u) over the summed density of both grids.
  std::vector<double> solid_angles(int t, const std::vector<bool>& above) const {
    const int width = colors_[0].width(), height = colors_[0].height();
    const int across = kPoints * width, up = kPoints * height;
    const int across_u = kPointsU * width, up_u = kPointsU * height;
    const double in_u = double(across_u) * up_u, in_s = double(across) * up;
    std::vector<double> sums(std::size_t(width) * height);
    const auto add = [&](const Point2& u, const Point2& s, double density) {
      const Pair pair = pair_at(t, u);
      if (!(pair.to_view.z > 0)) return;
      int x = int(std::lround(s.x * (width - 1)));
      const int y = int(std::lround(s.y * (height - 1)));
      while (x > 0 && !above[std::size_t(y) * width + x]) --x;
      sums[std::size_t(y) * width + x] += pair.measure / (in_u + in_s * density);
    };
    for (int i = 0; i < up; ++i)
      for (int j = 0; j < across; ++j) {
        const Point2 s{(j + 0.5) / across, (i + 0.5) / up};
        double density = 0;
        const Point2 u = warps_[t].sample(s, density);
        add(u, s, density);
      }
    for (int i = 0; i < up_u; ++i)
      for (int j = 0; j < across_u; ++j) {
        const Point2 u{(j + 0.5) / across_u, (i + 0.5) / up_u};
        const Warp::Cumulated there = warps_[t].cumulated(u);
        add(u, there.place(), warps_[t].density(u));
      }
    return sums;
  }

  // The nodes of one theta_i, whose cell in it has the measure `around` (azimuth included).
  void for_each_node(int t, double around, const std::function<void(const Sample&)>& visit) const {
    const int width = colors_[0].width(), height = colors_[0].height();
    std::vector<Sample> samples(std::size_t(width) * height);
    std::vector<bool> above(samples.size());
    for (std::size_t node = 0; node < samples.size(); ++node) {
      double density = 0;
      const int x = int(node) % width, y = int(node) / width;
      const Point2 u = warps_[t].sample({double(x) / (width - 1), double(y) / (height - 1)}, density);
      const Pair pair = pair_at(t, u);
      above[node] = pair.to_view.z > kHorizon;
      samples[node] = {pair.to_light, pair.to_view, color(t, node) * (factor(theta_[t], u) / pair.to_view.z), 0};
    }
    const std::vector<double> solid_angle = solid_angles(t, above);
    for (std::size_t node = 0; node < samples.size(); ++node) {
      Sample& sample = samples[node];
      sample.weight = around * solid_angle[node];
      if (above[node] && sample.weight > 0 && std::isfinite(sample.f.r + sample.f.g + sample.f.b)) visit(sample);
    }
  }

  Rgb color(int t, std::size_t node) const {
    return {colors_[3 * t].nodes()[node], colors_[3 * t + 1].nodes()[node], colors_[3 * t + 2].nodes()[node]};
  }

  std::vector<double> theta_;
  Map ndf_, sigma_;
  std::vector<Warp> warps_;  // one a theta_i
  std::vector<Map> colors_;  // R, G, B of each theta_i; NaN where there is no data
  bool scaled_ = true;
  Coverage coverage_;
};

}  // namespace

std::unique_ptr<Material> parse_rgl(std::string_view bytes, const std::string& name) {
  return std::make_unique<Rgl>(bytes, name);
}

}  // namespace likeness::measured
