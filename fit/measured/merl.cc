#include "fit/measured/merl.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fit/measured/little_endian.h"
#include "fit/measured/refuse.h"

namespace likeness::measured {
namespace {

using std::numbers::pi;

// floor(n x) for x in 0..1, the last bin at and beyond 1.
int bin_of(double x, int n) { return std::clamp(static_cast<int>(x * n), 0, n - 1); }

std::string dimensions(const MerlSize& size) {
  return std::to_string(size.theta_h) + " x " + std::to_string(size.theta_d) + " x " + std::to_string(size.phi_d);
}

struct Axis {
  std::vector<double> sine, cosine;  // at bin centres
  std::vector<double> measure;       // of the bin, see for_each_sample
};

}  // namespace

HalfAngles merl_bin_centre(const MerlSize& size, int theta_h, int theta_d, int phi_d) {
  const double h = (theta_h + 0.5) / size.theta_h;
  return {h * h * pi / 2, (theta_d + 0.5) / size.theta_d * pi / 2, (phi_d + 0.5) / size.phi_d * pi};
}

Merl::Merl(std::string bytes, std::string name, MerlSize size) : bytes_(std::move(bytes)), size_(size) {
  source = std::move(name);
  const std::string wanted = "MERL's " + std::to_string(size.bytes()) + " bytes (" + dimensions(size) + " x RGB)";
  if (bytes_.size() < 12) refuse(source, std::to_string(bytes_.size()) + " bytes", wanted);
  const MerlSize found{number_at<std::int32_t>(bytes_, 0), number_at<std::int32_t>(bytes_, 4),
                       number_at<std::int32_t>(bytes_, 8)};
  if (found != size) refuse(source, "dimensions " + dimensions(found), "MERL's " + dimensions(size));
  if (bytes_.size() != size.bytes())
    refuse(source, std::to_string(bytes_.size()) + " bytes",
           wanted + ": the file is " + (bytes_.size() < size.bytes() ? "cut short" : "too long"));
  coverage_.stored = size_.bins();
  const std::size_t plane = size_.bins() * 8;
  for (std::size_t i = 0; i < size_.bins(); ++i) {
    const double r = number_at<double>(bytes_, 12 + 8 * i), g = number_at<double>(bytes_, 12 + 8 * i + plane),
                 b = number_at<double>(bytes_, 12 + 8 * i + 2 * plane);
    // r + g + b could overflow where each is finite; 0 x is NaN for NaN and both infinities, else 0.
    const bool finite = 0 * r + 0 * g + 0 * b == 0;
    const bool negative = (r < 0) | (g < 0) | (b < 0);
    coverage_.not_finite += !finite;
    coverage_.negative += finite & negative;
  }
  coverage_.valid = coverage_.stored - coverage_.not_finite - coverage_.negative;
  if (coverage_.valid == 0)
    refuse(source,
           "no valid bin among " + std::to_string(coverage_.stored) + " (" + std::to_string(coverage_.negative) +
               " negative, " + std::to_string(coverage_.not_finite) + " NaN or Inf)",
           "at least one");
}

std::size_t Merl::bin(const HalfAngles& angles) const {
  const int h = bin_of(std::sqrt(std::max(0.0, angles.theta_h) / (pi / 2)), size_.theta_h);
  const int d = bin_of(angles.theta_d / (pi / 2), size_.theta_d);
  const int p = bin_of(angles.phi_d / pi, size_.phi_d);
  return (std::size_t(h) * size_.theta_d + d) * size_.phi_d + p;
}

bool Merl::value(std::size_t bin, Rgb& f) const {
  const std::size_t plane = size_.bins() * 8, at = 12 + 8 * bin;
  const double r = number_at<double>(bytes_, at), g = number_at<double>(bytes_, at + plane),
               b = number_at<double>(bytes_, at + 2 * plane);
  if (!(0 * r + 0 * g + 0 * b == 0) || r < 0 || g < 0 || b < 0) return false;
  f = {r * kMerlScale[0], g * kMerlScale[1], b * kMerlScale[2]};
  return true;
}

bool Merl::nearest(const brdf::Geometry<double>& asked, Rgb& f, brdf::Geometry<double>& holds) const {
  const std::size_t at = bin(half_angles(asked.to_light, asked.to_view));
  if (!value(at, f)) return false;
  const auto i = static_cast<int>(at);
  const HalfAngles centre =
      merl_bin_centre(size_, i / (size_.theta_d * size_.phi_d), i / size_.phi_d % size_.theta_d, i % size_.phi_d);
  holds = brdf::geometry_at(centre.theta_h, centre.theta_d, centre.phi_d);
  return true;
}

bool Merl::evaluate(const Direction& to_light, const Direction& to_view, Rgb& f) const {
  if (!(to_light.z > 0) || !(to_view.z > 0)) return false;
  return value(bin(half_angles(to_light, to_view)), f);
}

// The measure of a cell of pairs of directions in half-angle coordinates:
//
//     d(omega_i) d(omega_o) = 4 cos theta_d d(omega_h) d(omega_d)
//                           = 4 cos theta_d sin theta_d sin theta_h d(theta_h) d(theta_d) d(phi_h) d(phi_d)
//
// (d(omega_o) = 4 cos theta_d d(omega_h) at a fixed omega_i: Walter 2007 eq. 14; at a fixed h, omega_d is omega_i
// turned.) phi_h gives 2 pi, phi_d in 0..pi stands also for pi..2 pi, and both sines are integrated over the bin:
//
//     weight = 2 pi (cos h0 - cos h1) 2 (sin^2 d1 - sin^2 d0) 2 delta(phi_d)
void Merl::for_each_sample(const std::function<void(const Sample&)>& visit) const {
  Axis h, d, p;
  const auto add = [](Axis& axis, double angle, double measure) {
    axis.sine.push_back(std::sin(angle));
    axis.cosine.push_back(std::cos(angle));
    axis.measure.push_back(measure);
  };
  const auto edge_h = [&](int i) { return brdf::squared(double(i) / size_.theta_h) * pi / 2; };
  const auto edge_d = [&](int i) { return double(i) / size_.theta_d * pi / 2; };
  for (int i = 0; i < size_.theta_h; ++i)
    add(h, merl_bin_centre(size_, i, 0, 0).theta_h, 2 * pi * (std::cos(edge_h(i)) - std::cos(edge_h(i + 1))));
  for (int i = 0; i < size_.theta_d; ++i)
    add(d, merl_bin_centre(size_, 0, i, 0).theta_d,
        2 * (brdf::squared(std::sin(edge_d(i + 1))) - brdf::squared(std::sin(edge_d(i)))));
  for (int i = 0; i < size_.phi_d; ++i) add(p, merl_bin_centre(size_, 0, 0, i).phi_d, 2 * pi / size_.phi_d);

  Sample sample;
  std::size_t at = 0;
  for (int i = 0; i < size_.theta_h; ++i)
    for (int j = 0; j < size_.theta_d; ++j)
      for (int k = 0; k < size_.phi_d; ++k, ++at) {
        const double x = d.sine[j] * p.cosine[k], y = d.sine[j] * p.sine[k], z = d.cosine[j];
        const double lean = h.sine[i] * x, rise = h.cosine[i] * z;
        if (!(rise - lean > 0) || !(rise + lean > 0) || !value(at, sample.f)) continue;
        sample.to_light = {h.cosine[i] * x + h.sine[i] * z, y, rise - lean};
        sample.to_view = {h.sine[i] * z - h.cosine[i] * x, -y, rise + lean};
        sample.weight = h.measure[i] * d.measure[j] * p.measure[k];
        visit(sample);
      }
}

std::unique_ptr<Merl> parse_merl(std::string bytes, const std::string& name, MerlSize size) {
  return std::make_unique<Merl>(std::move(bytes), name, size);
}

std::string merl_bytes(const std::vector<Rgb>& f, MerlSize size) {
  std::string bytes(size.bytes(), '\0');
  const std::int32_t dims[3]{size.theta_h, size.theta_d, size.phi_d};
  std::memcpy(bytes.data(), dims, sizeof dims);
  for (std::size_t i = 0; i < size.bins(); ++i) {
    const double raw[3]{f[i].r, f[i].g, f[i].b};
    const bool valid = std::all_of(raw, raw + 3, [](double x) { return std::isfinite(x) && x >= 0; });
    for (int c = 0; c < 3; ++c) {
      const double stored = valid ? raw[c] / kMerlScale[c] : -1;
      std::memcpy(bytes.data() + 12 + 8 * (i + size.bins() * c), &stored, 8);
    }
  }
  return bytes;
}

void write_merl(const std::filesystem::path& file, const std::vector<Rgb>& f) {
  files::write_whole(file, merl_bytes(f));
}

}  // namespace likeness::measured
