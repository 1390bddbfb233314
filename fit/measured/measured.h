#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "brdf/geometry.h"

namespace likeness::measured {

using Rgb = brdf::Rgb<double>;
using Direction = brdf::Vec3<double>;  // unit, leaving the surface, z along the normal

enum class Format { kMerl, kMbsdf, kRgl, kCsv };
inline constexpr std::array<std::string_view, 4> kFormatNames{"MERL .binary", "NVIDIA .mbsdf", "RGL .bsdf", "CSV"};

// One stored value of a measured material.
struct Sample {
  Direction to_light, to_view;
  Rgb f;          // [1/sr], linear RGB, cosine not included
  double weight;  // [sr^2], > 0: d(omega_i) d(omega_o) of the sample's cell, with all that stands for by isotropy
                  // and mirror symmetry; a full set of samples adds up to (2 pi)^2
};

// How much of a file is data.
struct Coverage {
  std::size_t stored = 0;      // samples in the file
  std::size_t valid = 0;       // finite, and not marked invalid, negative or padding
  std::size_t negative = 0;    // dropped: MERL: negative in any channel, the mark of 'not measured'; others: in all
  std::size_t not_finite = 0;  // dropped: NaN or Inf in a channel
  std::size_t padding = 0;     // dropped: copies of the last measured angle in place of data (.mbsdf)
  std::size_t clipped = 0;     // valid, but a channel was negative and reads as 0 (noise, colours out of gamut)
  std::size_t repeats = 0;     // averaged away: further samples of the same directions (CSV)
};

// An isotropic measured BRDF, whatever file it came from. Immutable once read; reading from several
// threads at once is safe.
class Material {
 public:
  virtual ~Material() = default;

  // f(l, v) [1/sr]; false, and f untouched, where the file has no valid data for these directions.
  virtual bool evaluate(const Direction& to_light, const Direction& to_view, Rgb& f) const = 0;

  // The value that stands for a pair of directions, and the pair at which it holds: this one where the format
  // interpolates, the centre of the nearest bin in a MERL table. A model is held against f there; at the asked pair
  // it would also be charged for the half bin between the two. False, and both untouched, where there is none.
  virtual bool nearest(const brdf::Geometry<double>& asked, Rgb& f, brdf::Geometry<double>& holds) const {
    if (!evaluate(asked.to_light, asked.to_view, f)) return false;
    holds = asked;
    return true;
  }

  // Calls visit for every valid sample above the horizon, always in the same order.
  virtual void for_each_sample(const std::function<void(const Sample&)>& visit) const = 0;

  virtual Coverage coverage() const = 0;
  virtual Format format() const = 0;
  std::string source;  // the file as the user named it
};

// Reads a measured material; the format is told from the content, the extension only breaks ties.
// Throws files::InputError.
std::unique_ptr<Material> read(const std::filesystem::path& file);

// The same from the content of a file, for a caller that also needs the bytes (to hash them). `name` is for
// messages, and its extension breaks ties.
std::unique_ptr<Material> parse(std::string bytes, const std::string& name);

// No measured material is larger: read() refuses what is [bytes].
inline constexpr std::size_t kLargestFile = 128'000'000;

}  // namespace likeness::measured
