#include "realis/terminator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "brdf/realis/soft_cosine.h"
#include "realis/weight/samples.h"

namespace likeness::realis {
namespace {

constexpr std::array kSpreads{0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.13, 0.16, 0.2};
constexpr double kNear = 0.3, kBehind = -0.05, kMostLeast = 0.2;  // cosines; of what faces the light
constexpr std::size_t kFewest = 100, kMost = 200000;              // samples
constexpr double kPeakShare = 0.999, kNoiseShare = 1e-3;

struct Near {
  double photo, render, facing, cosine;  // luminance
};

}  // namespace

void face(Subject& subject, const capture_fit::Fit& fit) {
  subject.facing.resize(subject.texels());
  for (std::size_t t = 0; t < subject.texels(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      subject.facing[t][c] = static_cast<float>(static_cast<double>(fit.base_colors.rgb[3 * subject.pixels[t] + c]) *
                                                fit.exposure / std::numbers::pi);
}

Terminator terminator_of(const Subject& s) {
  Terminator out;
  if (s.facing.empty()) return out;
  const std::size_t samples = s.texels() * s.lights.size(), stride = samples / kMost + 1;
  std::vector<Near> near;
  std::vector<double> photos, behind;
  for (std::size_t k = 0; k < samples; k += stride) {
    const std::size_t texel = k / s.lights.size(), light = k % s.lights.size();
    const double facing = weight::luminance(s.facing[texel]) * s.irradiance_of(light),
                 cosine = static_cast<double>(s.cosine[k]);
    if (!(s.weight[k] > 0) || !(facing > 0)) continue;
    const double photo = std::max(weight::luminance(s.photo[k]), 0.0);
    photos.push_back(photo);
    if (cosine < kBehind) behind.push_back(photo / facing);
    if (std::abs(cosine) < kNear) near.push_back({photo, weight::luminance(s.render[k]), facing, cosine});
  }
  if (behind.size() >= kFewest) out.least = std::clamp(weight::quantile(behind, 0.5), 0.0, kMostLeast);
  const double noise = kNoiseShare * weight::quantile(photos, kPeakShare);
  if (near.size() < kFewest || !(noise > 0)) return out;
  double best = HUGE_VAL;
  for (const double spread : kSpreads) {
    double sum = 0;
    for (const Near& n : near) {
      const double soft = n.render + n.facing * brdf::beyond_hard(n.cosine, spread);
      sum += std::abs(std::log((std::max(soft, out.least * n.facing) + noise) / (n.photo + noise)));
    }
    if (sum < best) best = sum, out.spread = spread;
  }
  return out;
}

void soften(Subject& s, const Terminator& terminator) {
  s.least = terminator.least;
  if (!(terminator.spread > 0) || s.facing.empty()) return;
  for (std::size_t t = 0; t < s.texels(); ++t)
    for (std::size_t i = 0; i < s.lights.size(); ++i) {
      const std::size_t at = s.samples_of(t) + i;
      const double more = s.irradiance_of(i) * brdf::beyond_hard(static_cast<double>(s.cosine[at]), terminator.spread);
      for (std::size_t c = 0; c < 3; ++c)
        s.render[at][c] += static_cast<float>(static_cast<double>(s.facing[t][c]) * more);
    }
}

}  // namespace likeness::realis
