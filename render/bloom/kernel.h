#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

// How a lens spreads light: what of a point's light stays, and what is scattered how far.
namespace likeness::bloom {

enum class Family { kGaussian, kCauchy };

struct FamilyRow {
  Family family;
  std::string_view name, text;
};
// The density at r pixels, whose integral over the plane is 1.
inline constexpr std::array kFamilies{
    FamilyRow{Family::kGaussian, "gaussian", "exp(-r^2 / (2 s^2)) / (2 pi s^2)"},
    FamilyRow{Family::kCauchy, "cauchy", "s / (2 pi (r^2 + s^2)^1.5), that is (1 + (r / s)^2)^-1.5 / (2 pi s^2)"},
};
double density(Family family, double scale, double r);

struct Component {
  Family family = Family::kGaussian;
  double scale = 1;                // s [pixels], in [0.1, 1e5]
  std::array<double, 3> weight{};  // of red, green, blue
  // One standard deviation; 0 where it is not known.
  double scale_error = 0;
  std::array<double, 3> weight_error{};
};

// Weights are 0 or more, and for each channel direct + the components' is 1: no light is made and none is lost.
struct Kernel {
  int radius = 1;  // [pixels], 1 to kMostRadius: nothing is scattered farther; components are 1 within it
  std::array<double, 3> direct{1, 1, 1};
  std::vector<Component> components;
};
inline constexpr int kMostRadius = 4096;
inline constexpr std::size_t kMostComponents = 16;

// One component on pixels: (2 radius + 1)^2 numbers that sum to 1, the middle one for no shift; 0 beyond the radius. Each
// is the mean of the density over its pixel, as fine as the scale asks for.
std::vector<double> sampled(Family family, double scale, int radius);

// JSON; docs/bloom.md. The reader throws files::InputError, one line with the line's number.
std::string text_of(const Kernel& kernel);
Kernel kernel_of(std::string_view text, const std::string& source);
Kernel read_kernel(const std::filesystem::path& file);

}  // namespace likeness::bloom
