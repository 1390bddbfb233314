#include <algorithm>
#include <cmath>

#include "realis/report/leave_one_out.h"

// What is compared of a study, and in which numbers.
namespace likeness::realis {
namespace {

using Color = std::array<float, 3>;

double quantile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto at = std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return static_cast<double>(values[at]);
}

// Of samples that can be trusted.
class Sum {
 public:
  Sum(double peak, double noise) : peak_(peak), noise_(noise) {}
  void add(std::span<const Color> predicted, std::span<const Color> photo, std::span<const float> weight) {
    for (std::size_t t = 0; t < predicted.size(); ++t) {
      if (!(weight[t] > 0)) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const double a = std::max(static_cast<double>(predicted[t][c]), 0.0);
        const double b = std::max(static_cast<double>(photo[t][c]), 0.0);
        squares_ += (a - b) * (a - b);
        stops_.push_back(static_cast<float>(std::abs(std::log2((a + noise_) / (b + noise_)))));
      }
    }
  }
  Errors errors() {
    if (stops_.empty()) return {};
    const double mean = squares_ / static_cast<double>(stops_.size());
    constexpr double kExact = 1e-20;  // of the peak's square: 200 dB
    return {-10 * std::log10(std::max(mean / (peak_ * peak_), kExact)), quantile(stops_, 0.5), quantile(stops_, 0.95)};
  }

 private:
  double peak_, noise_, squares_ = 0;
  std::vector<float> stops_;
};

}  // namespace

double quantile_of(std::vector<float> values, double share) { return quantile(values, share); }

Subject without(const Subject& s, std::span<const std::size_t> lights) {
  Subject out;
  out.camera = s.camera, out.width = s.width, out.height = s.height, out.pixels = s.pixels;
  out.facing = s.facing, out.least = s.least;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < s.lights.size(); ++i) {
    if (std::find(lights.begin(), lights.end(), i) != lights.end()) continue;
    kept.push_back(i);
    out.lights.push_back(s.lights[i]), out.to_lights.push_back(s.to_lights[i]);
    if (!s.irradiance.empty()) out.irradiance.push_back(s.irradiance[i]);
  }
  for (std::size_t t = 0; t < s.texels(); ++t)
    for (const std::size_t i : kept) {
      const std::size_t at = s.samples_of(t) + i;
      out.photo.push_back(s.photo[at]), out.render.push_back(s.render[at]);
      out.cosine.push_back(s.cosine[at]), out.weight.push_back(s.weight[at]);
    }
  return out;
}

Subject on_grid(const Subject& s, int stride) {
  Subject out;
  out.camera = s.camera, out.width = s.width, out.height = s.height;
  out.lights = s.lights, out.to_lights = s.to_lights, out.irradiance = s.irradiance, out.least = s.least;
  for (std::size_t t = 0; t < s.texels(); ++t) {
    const int x = static_cast<int>(s.pixels[t]) % s.width, y = static_cast<int>(s.pixels[t]) / s.width;
    if (x % stride != stride / 2 || y % stride != stride / 2) continue;
    out.pixels.push_back(s.pixels[t]);
    if (!s.facing.empty()) out.facing.push_back(s.facing[t]);
    for (std::size_t at = s.samples_of(t); at < s.samples_of(t + 1); ++at) {
      out.photo.push_back(s.photo[at]), out.render.push_back(s.render[at]);
      out.cosine.push_back(s.cosine[at]), out.weight.push_back(s.weight[at]);
    }
  }
  return out;
}

Errors errors_of(std::span<const Color> predicted, std::span<const Color> photo, std::span<const float> weight,
                 double peak, double noise) {
  Sum sum(peak, noise);
  sum.add(predicted, photo, weight);
  return sum.errors();
}

Errors errors_of(std::span<const std::vector<Color>> predicted, const Subject& subject, double peak, double noise) {
  Sum sum(peak, noise);
  for (std::size_t i = 0; i < predicted.size(); ++i) sum.add(predicted[i], photo_of(subject, i), weight_of(subject, i));
  return sum.errors();
}

std::vector<Color> photo_of(const Subject& s, std::size_t light) {
  std::vector<Color> out(s.texels());
  for (std::size_t t = 0; t < s.texels(); ++t) out[t] = s.photo[s.samples_of(t) + light];
  return out;
}
std::vector<float> weight_of(const Subject& s, std::size_t light) {
  std::vector<float> out(s.texels());
  for (std::size_t t = 0; t < s.texels(); ++t) out[t] = s.weight[s.samples_of(t) + light];
  return out;
}

}  // namespace likeness::realis
