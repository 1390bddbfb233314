#include "fit/measured/mbsdf.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "fit/measured/half_angles.h"
#include "fit/measured/little_endian.h"
#include "fit/measured/refuse.h"

namespace likeness::measured {
namespace {

using std::numbers::pi;
constexpr std::uint32_t kMostTheta = 720, kMostPhi = 1440;
constexpr std::size_t kLongestHeader = 65536;
constexpr std::string_view kData = "MBSDF_DATA=\n", kReflection = "MBSDF_DATA_REFLECTION=\n",
                           kTransmission = "MBSDF_DATA_TRANSMISSION=\n";

struct Block {
  int theta = 0, phi = 0, channels = 0;
  std::size_t first = 0;  // byte of the first float

  std::size_t samples() const { return std::size_t(theta) * theta * phi; }
  std::size_t end() const { return first + samples() * channels * 4; }
};

// The block whose type and sizes start at byte `at`, whole.
Block block_at(std::string_view bytes, std::size_t at, const std::string& name) {
  if (bytes.size() - at < 12)
    refuse(name, std::to_string(bytes.size() - at) + " bytes after the data's heading",
           "type and two resolutions, 12 bytes");
  const auto type = number_at<std::uint32_t>(bytes, at), theta = number_at<std::uint32_t>(bytes, at + 4),
             phi = number_at<std::uint32_t>(bytes, at + 8);
  if (type > 1) refuse(name, "data type " + std::to_string(type), "0 (scalar) or 1 (RGB)");
  if (theta < 1 || theta > kMostTheta || phi < 1 || phi > kMostPhi)
    refuse(name, "resolution " + std::to_string(theta) + " theta, " + std::to_string(phi) + " phi",
           "1 to " + std::to_string(kMostTheta) + " theta and 1 to " + std::to_string(kMostPhi) + " phi");
  const Block block{int(theta), int(phi), type == 1 ? 3 : 1, at + 12};
  if (block.end() > bytes.size())
    refuse(name, std::to_string(bytes.size()) + " bytes",
           "at least " + std::to_string(block.end()) + " for " + std::to_string(theta) + " x " + std::to_string(theta) +
               " x " + std::to_string(phi) + " samples of " + std::to_string(block.channels) +
               " floats: the file is cut short");
  return block;
}

// Past the text, at the heading of the first data block.
std::size_t data_heading(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with(kMbsdfMagic)) refuse(name, "no \"NVIDIA ARC MBSDF V1\" at its start", "an NVIDIA .mbsdf file");
  std::size_t at = kMbsdfMagic.size();
  while (!bytes.substr(at).starts_with("MBSDF_DATA")) {
    const std::size_t line_end = bytes.substr(0, kLongestHeader).find('\n', at);
    if (line_end == std::string_view::npos)
      refuse(name, "no \"MBSDF_DATA_REFLECTION=\" line", "one after the text lines");
    at = line_end + 1;
  }
  return at;
}

// A place between two neighbouring centres of n over 0..1.
struct Between {
  int low, high;
  double towards_high;

  Between(double x, int n) {
    const double position = std::clamp(x * n - 0.5, 0.0, double(n - 1));
    low = std::min(int(position), n - 1);
    high = std::min(low + 1, n - 1);
    towards_high = position - low;
  }
};

class Mbsdf final : public Material {
 public:
  Mbsdf(std::string_view bytes, const std::string& name) {
    source = name;
    std::size_t at = data_heading(bytes, name);
    const std::string_view rest = bytes.substr(at);
    if (rest.starts_with(kTransmission)) refuse(name, "transmission data only", "reflection data");
    if (!rest.starts_with(kData) && !rest.starts_with(kReflection))
      refuse(name, "data heading " + in_quotes(rest.substr(0, rest.find('\n'))),
             "\"MBSDF_DATA=\" or \"MBSDF_DATA_REFLECTION=\"");
    at += rest.starts_with(kData) ? kData.size() : kReflection.size();
    const Block block = block_at(bytes, at, name);
    std::size_t end = block.end();
    if (bytes.substr(end).starts_with(kTransmission)) end = block_at(bytes, end + kTransmission.size(), name).end();
    if (end != bytes.size())
      refuse(name, std::to_string(bytes.size()) + " bytes", std::to_string(end) + ": the file is too long");

    theta_ = block.theta;
    phi_ = block.phi;
    load(bytes, block);
    if (coverage_.valid == 0)
      refuse(name,
             "no valid sample among " + std::to_string(coverage_.stored) + " (" + std::to_string(coverage_.negative) +
                 " negative, " + std::to_string(coverage_.not_finite) + " NaN or Inf)",
             "at least one");
  }

  bool evaluate(const Direction& to_light, const Direction& to_view, Rgb& f) const override {
    if (!(to_light.z > 0) || !(to_view.z > 0)) return false;
    const Elevations e = elevations(to_light, to_view);
    return interpolate(e, f) || interpolate({e.theta_o, e.theta_i, e.phi}, f);
  }

  void for_each_sample(const std::function<void(const Sample&)>& visit) const override {
    const double step = pi / 2 / theta_;
    Sample sample;
    for (int i = 0; i < theta_; ++i)
      for (int j = 0; j < theta_; ++j)
        for (int k = 0; k < phi_; ++k) {
          const float* value = &f_[3 * index(i, j, k)];
          if (std::isnan(value[0])) continue;
          directions_at({(i + 0.5) * step, (j + 0.5) * step, (k + 0.5) * pi / phi_}, sample.to_light, sample.to_view);
          sample.f = {value[0], value[1], value[2]};
          // 2 pi of azimuth, both sides of the mirror plane, and both polar cells whole.
          sample.weight = 2 * pi * (std::cos(i * step) - std::cos((i + 1) * step)) *
                          (std::cos(j * step) - std::cos((j + 1) * step)) * 2 * pi / phi_;
          visit(sample);
        }
  }

  Coverage coverage() const override { return coverage_; }
  Format format() const override { return Format::kMbsdf; }

 private:
  std::size_t index(int i, int j, int k) const { return (std::size_t(i) * theta_ + j) * phi_ + k; }

  void load(std::string_view bytes, const Block& block) {
    coverage_.stored = block.samples();
    f_.resize(3 * block.samples());
    const int in_end = measured_in(bytes, block), out_end = measured_out(bytes, block, in_end);
    for (std::size_t s = 0; s < block.samples(); ++s) {
      float rgb[3];
      for (int c = 0; c < 3; ++c)
        rgb[c] = number_at<float>(bytes, block.first + 4 * (s * block.channels + (block.channels == 3 ? c : 0)));
      const bool finite = std::isfinite(rgb[0]) && std::isfinite(rgb[1]) && std::isfinite(rgb[2]);
      const bool any = rgb[0] < 0 || rgb[1] < 0 || rgb[2] < 0, all = rgb[0] < 0 && rgb[1] < 0 && rgb[2] < 0;
      const bool padding = int(s / (std::size_t(theta_) * phi_)) >= in_end || int(s / phi_ % theta_) >= out_end;
      coverage_.padding += padding;
      coverage_.not_finite += !padding && !finite;
      coverage_.negative += !padding && finite && all;
      const bool valid = !padding && finite && !all;
      coverage_.valid += valid;
      coverage_.clipped += valid && any;
      for (int c = 0; c < 3; ++c) f_[3 * s + c] = valid ? std::max(rgb[c], 0.0f) : std::nanf("");
    }
  }

  // The number of leading theta_in rows that are no copies of the row before them.
  static int measured_in(std::string_view bytes, const Block& block) {
    const std::size_t row = std::size_t(block.theta) * block.phi * block.channels * 4;
    int end = block.theta;
    const auto at = [&](int i) { return bytes.data() + block.first + row * i; };
    while (end > 1 && std::memcmp(at(end - 1), at(end - 2), row) == 0) --end;
    return constant(std::string_view(at(end - 1), row), block.channels) ? block.theta : end;
  }

  // The same of theta_out, within the measured theta_in.
  static int measured_out(std::string_view bytes, const Block& block, int in_end) {
    const std::size_t row = std::size_t(block.phi) * block.channels * 4;
    const auto at = [&](int i, int j) { return bytes.data() + block.first + row * (std::size_t(i) * block.theta + j); };
    const auto copied = [&](int j) {
      for (int i = 0; i < in_end; ++i)
        if (std::memcmp(at(i, j), at(i, j - 1), row) != 0) return false;
      return true;
    };
    int end = block.theta;
    while (end > 1 && copied(end - 1)) --end;
    for (int i = 0; i < in_end; ++i)
      if (!constant(std::string_view(at(i, end - 1), row), block.channels)) return end;
    return block.theta;
  }

  static bool constant(std::string_view row, int channels) {
    const std::size_t sample = std::size_t(channels) * 4;
    return std::memcmp(row.data(), row.data() + sample, row.size() - sample) == 0;
  }

  bool interpolate(const Elevations& e, Rgb& f) const {
    const Between a(e.theta_i / (pi / 2), theta_), b(e.theta_o / (pi / 2), theta_), c(e.phi / pi, phi_);
    const auto nearest = [](const Between& x) { return x.towards_high < 0.5 ? x.low : x.high; };
    if (std::isnan(f_[3 * index(nearest(a), nearest(b), nearest(c))])) return false;
    double sum[3]{}, total = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const bool ia = corner & 1, ib = corner & 2, ic = corner & 4;
      const double weight = (ia ? a.towards_high : 1 - a.towards_high) * (ib ? b.towards_high : 1 - b.towards_high) *
                            (ic ? c.towards_high : 1 - c.towards_high);
      const float* value = &f_[3 * index(ia ? a.high : a.low, ib ? b.high : b.low, ic ? c.high : c.low)];
      if (weight == 0 || std::isnan(value[0])) continue;
      total += weight;
      for (int channel = 0; channel < 3; ++channel) sum[channel] += weight * value[channel];
    }
    f = {sum[0] / total, sum[1] / total, sum[2] / total};
    return true;
  }

  int theta_ = 0, phi_ = 0;
  std::vector<float> f_;  // RGB of every sample; NaN where there is no data
  Coverage coverage_;
};

}  // namespace

std::unique_ptr<Material> parse_mbsdf(std::string_view bytes, const std::string& name) {
  return std::make_unique<Mbsdf>(bytes, name);
}

}  // namespace likeness::measured
