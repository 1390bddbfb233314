#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "brdf/any_brdf.h"
#include "datasets_synthetic/material.h"
#include "fit/measured/measured.h"
#include "fit/samples.h"

// Measured materials whose truth is known, and the real ones that the talk sets by hand.
namespace likeness::fit::test {

inline measured::Rgb value_of(const brdf::AnyBrdf& model, const measured::Direction& l, const measured::Direction& v) {
  return std::visit([&](const auto& m) { return m.eval(l, v); }, model);
}

// A model in place of a file: no bins between the fit and the truth. `change` is applied to every value.
class Evaluated final : public measured::Material {
 public:
  using Change = std::function<measured::Rgb(measured::Rgb, const measured::Direction&, const measured::Direction&)>;
  explicit Evaluated(brdf::AnyBrdf model, Change change = {}) : model_(std::move(model)), change_(std::move(change)) {
    source = "evaluated";
  }
  bool evaluate(const measured::Direction& l, const measured::Direction& v, measured::Rgb& f) const override {
    if (!(l.z > 0) || !(v.z > 0)) return false;
    f = value_of(model_, l, v);
    if (change_) f = change_(f, l, v);
    return true;
  }
  void for_each_sample(const std::function<void(const measured::Sample&)>& visit) const override {
    constexpr double kPi = std::numbers::pi;
    for (int h = 0; h < kBins; ++h)
      for (int d = 0; d < kBins; ++d)
        for (int p = 0; p < kBins; ++p) {
          const double theta_d = (d + 0.5) / kBins * kPi / 2, theta_h = (h + 0.5) / kBins * kPi / 2;
          const auto g = brdf::geometry_at(theta_h, theta_d, (p + 0.5) / kBins * kPi);
          measured::Sample s{g.to_light, g.to_view, {}, std::sin(theta_h) * std::sin(theta_d) * std::cos(theta_d)};
          if (evaluate(s.to_light, s.to_view, s.f)) visit(s);
        }
  }
  measured::Coverage coverage() const override {
    measured::Coverage c;
    c.stored = c.valid = static_cast<std::size_t>(kBins) * kBins * kBins;
    return c;
  }
  measured::Format format() const override { return measured::Format::kCsv; }

 private:
  static constexpr int kBins = 24;
  brdf::AnyBrdf model_;
  Change change_;
};

// A standard normal number that depends on the directions, a seed and a channel alone.
inline double normal_at(const measured::Direction& l, const measured::Direction& v, std::uint64_t seed, int channel) {
  const auto mixed = [](std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
  };
  std::uint64_t x = mixed(seed * 8 + static_cast<std::uint64_t>(channel) + 1);
  for (const double c : {l.x, l.y, l.z, v.x, v.y, v.z})
    x = mixed(x + 0x9e3779b97f4a7c15 + std::bit_cast<std::uint64_t>(c));
  const double u = static_cast<double>(x >> 11) * 0x1p-53;
  const double w = static_cast<double>(mixed(x + 0x9e3779b97f4a7c15) >> 11) * 0x1p-53;
  return std::sqrt(-2 * std::log(1 - u)) * std::cos(2 * std::numbers::pi * w);
}

// What a fit of a slice sums over, each value at the directions where it is stored.
inline SampleSet samples_of(const measured::Material& material, const std::vector<SlicePoint>& slice) {
  return sample_set(material, slice, Options{}, Reading::kStored);
}

// A MERL table of a model, with faults, as a file would hold it.
inline std::string merl_bytes_of(const brdf::AnyBrdf& model, const datasets_synthetic::Faults& faults = {},
                                 std::uint64_t seed = 1) {
  return datasets_synthetic::make({model, {}, faults, seed}).bytes;
}

inline std::filesystem::path shared_file(const std::string& path) {
  return std::filesystem::path(LIKENESS_SHARED_DIR) / "data/materials" / path;
}

// The table of a MERL material; decoded into the build tree by the CTest fixture decoded_merl. May be absent.
inline std::filesystem::path decoded(const std::string& material) {
  return std::filesystem::path(LIKENESS_DECODED_DIR) / (material + ".binary");
}
inline constexpr const char* kNoDecoded =
    "no decoded MERL tables: `ctest -R decode_merl` makes them, from the shared data with python3-numpy; it says what "
    "it lacks";

inline const std::string kSix[] = {"black-soft-plastic", "yellow-phenolic",       "yellow-plastic",
                                   "light-red-paint",    "specular-red-phenolic", "two-layer-silver"};

}  // namespace likeness::fit::test
