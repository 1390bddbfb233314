#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "realis/inputs.h"
#include "realis/subject.h"

// What all cameras together say of the texels under one light, on disk: pictures are read light by light, texels are solved
// with all lights, and between the two lies more than fits into memory.
namespace likeness::realis {

struct LightSamples {
  std::vector<float> weights;    // of each texel, summed over cameras; 0: not seen
  std::vector<float> residuals;  // photo - render, their mean by those weights: channel by channel, the texels
  // Of some texels, which lobes are chosen by: weight, and residual and photo [luminance], three numbers each.
  std::vector<float> candidates;
  LightCensus census;
  Inputs inputs;
};

// Bytes that a light takes.
std::size_t bytes_of_light(std::size_t texels, std::size_t channels, std::size_t candidates);

// Writes the file whole. `digest` says of what it was made.
void write_light(const std::filesystem::path& file, const std::string& digest, const LightSamples& samples);

// A light's samples, read a piece at a time.
class LightFile {
 public:
  // None if there is no such file, or one of another digest or size.
  static std::optional<LightFile> open(const std::filesystem::path& file, const std::string& digest, std::size_t texels,
                                       std::size_t channels, std::size_t candidates);

  const LightCensus& census() const { return census_; }
  const Inputs& inputs() const { return inputs_; }
  // Texels from `first` on, as many as `weights` holds; residuals channel by channel. Throw files::InputError.
  void read(std::size_t first, std::span<float> weights, std::span<float> residuals) const;
  std::vector<float> candidates() const;

 private:
  std::filesystem::path file_;
  std::size_t begin_ = 0, texels_ = 0, channels_ = 0, candidates_ = 0;
  LightCensus census_;
  Inputs inputs_;
};

// Some bytes of a file, as numbers. Throws files::InputError.
void read_floats(const std::filesystem::path& file, std::size_t first_byte, std::span<float> out);

}  // namespace likeness::realis
