#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "fit/measured/half_angles.h"
#include "fit/measured/measured.h"

// MERL .binary: int32 {90, 90, 180}, then the planes R, G, B of float64, index
// (i_theta_h * 90 + i_theta_d) * 180 + i_phi_d; f = stored x (1, 1.15, 1.66) / 1500; negative in any channel = not
// measured. Source: Matusik et al. 2003, "A Data-Driven Reflectance Model", and its reference reader.
namespace likeness::measured {

// The numbers of bins. A MERL file has 90 x 90 x 180 and nothing else; other sizes serve tests and fuzzers.
struct MerlSize {
  int theta_h = 90, theta_d = 90, phi_d = 180;
  bool operator==(const MerlSize&) const = default;
  std::size_t bins() const { return std::size_t(theta_h) * theta_d * phi_d; }
  std::size_t bytes() const { return 12 + bins() * 24; }  // of the file
};

inline constexpr std::array<double, 3> kMerlScale{1.0 / 1500, 1.15 / 1500, 1.66 / 1500};

// Centre of a bin, radians. theta_h is square-root spaced: theta_h = ((i + 0.5) / n)^2 pi / 2.
HalfAngles merl_bin_centre(const MerlSize& size, int theta_h, int theta_d, int phi_d);

// A MERL table in memory. Values are looked up in the nearest bin, not interpolated, as the format's own reader does.
class Merl final : public Material {
 public:
  Merl(std::string bytes, std::string name, MerlSize size);  // as parse_merl

  // The bin of angles in radians, theta in 0..pi/2, phi_d in 0..pi (beyond: the last bin).
  std::size_t bin(const HalfAngles& angles) const;
  // f of a bin, bin < size().bins(); false, and f untouched, where the bin holds no data.
  bool value(std::size_t bin, Rgb& f) const;
  // Nearest bin at angles, for grids that are defined in half-angle coordinates.
  bool evaluate(const HalfAngles& angles, Rgb& f) const { return value(bin(angles), f); }
  const MerlSize& size() const { return size_; }

  bool evaluate(const Direction& to_light, const Direction& to_view, Rgb& f) const override;
  bool nearest(const brdf::Geometry<double>& asked, Rgb& f, brdf::Geometry<double>& holds) const override;
  void for_each_sample(const std::function<void(const Sample&)>& visit) const override;
  Coverage coverage() const override { return coverage_; }
  Format format() const override { return Format::kMerl; }

 private:
  std::string bytes_;  // the file as it was given: 35 MB, never copied
  MerlSize size_;
  Coverage coverage_;
};

// Takes the content of a file; `name` is for messages. Throws files::InputError if the dimensions or the length
// are not those of `size`, or if no bin is valid.
std::unique_ptr<Merl> parse_merl(std::string bytes, const std::string& name, MerlSize size = {});

// The content of a MERL file. `f` has size.bins() values [1/sr] in the file's order; a bin with a negative or
// non-finite channel is written as -1 -1 -1, which readers take for 'not measured'.
std::string merl_bytes(const std::vector<Rgb>& f, MerlSize size = {});

// Writes them, whole or not at all. Throws std::runtime_error naming the file.
void write_merl(const std::filesystem::path& file, const std::vector<Rgb>& f);

}  // namespace likeness::measured
