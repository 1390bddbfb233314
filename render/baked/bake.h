#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

// The residual between photographs and renders, as a function of the light's direction: e(l) = sum_k c_k G_k(l) of each
// texel, with photo = render + e(l) max(cos_i, floor) for a light of irradiance 1 (spec: Realis).
namespace likeness::baked {

inline constexpr std::size_t kMostLobes = 256;  // a byte names one

enum class Channels : unsigned char { kLuminance, kRgb };

// brdf::WindowedGaussian of amplitude 1.
struct Lobe {
  glm::dvec3 axis{0, 0, 1};  // unit, model space
  double sharpness = 1;      // >= 0
};

// The functions that all texels of an asset share, in which a residual is written down (spec: Realis, Bake, 4): lobes, or
// sums of them.
struct Basis {
  std::vector<Lobe> lobes;
  // What is known of a texel's coefficients before it was seen: their standard deviations about 0, in units of that of a
  // sample of weight 1. Ridge regression with 1 / spread^2: large ones are free, small ones are kept near 0.
  std::vector<double> spread;
  // What a texel's coefficients are of: mixes of the lobes, mix by mix a factor for each. Empty: the lobes themselves.
  std::vector<double> mix{};

  // How many coefficients a texel and channel has.
  std::size_t size() const { return mix.empty() ? lobes.size() : mix.size() / lobes.size(); }
};

// How a coefficient is stored: a byte b says (b - 128) / 127 of its multiplier. Squared it says that number's square with
// its sign, since most coefficients of mixes are small beside those of a highlight; with four bits a nibble n so says
// (n - 8) / 7. 0 says nothing was known there.
enum class Bits : unsigned char { kEight, kFour, kEightSquared };

struct Bake {
  Basis basis;
  Channels channels = Channels::kLuminance;
  double floor = 0.4;               // what a cosine counts for at least
  std::size_t kept = 0;             // lobes or mixes of each texel that are not 0
  std::vector<float> coefficients;  // [1/sr] for irradiance 1: texel by texel, channel by channel, those of the basis
  Bits bits = Bits::kEight;         // four: of mixes that are all kept

  std::size_t channel_count() const { return channels == Channels::kRgb ? 3 : 1; }
  bool is_sparse() const { return kept < basis.size(); }
};

// What the pixels of a bake are: those of a camera's picture, or texels of a mesh. Lobes of a picture stand in the world's
// axes; those of a mesh in the axes of the object, so that they turn with it.
enum class Space : unsigned char { kImage, kTexture };

struct About {
  std::string capture, camera;                                // names
  std::vector<std::pair<std::string, std::string>> inputs{};  // files and their SHA-256
  std::vector<std::pair<std::string, double>> metrics{};
  Space space = Space::kImage;
  std::string scene{}, object{};              // of a texture: the scene's file, the instance's name
  std::string scene_sha256{}, mesh_sha256{};  // of all that cameras may see; of the object's triangles and uv
};

struct StoredBake {
  Bake bake;
  About about;
  int width = 0, height = 0;
  std::vector<std::uint32_t> pixels;  // of each texel
};

// What a texel costs, in bytes: coefficients, and lobes if they are told apart.
std::size_t bytes_of_texel(const Bake& bake);

// The bake as its bits hold it: what a reader of the pictures gets.
Bake quantised(const Bake& bake);

// What the largest byte stands for, channel by channel, the lobes or mixes: the largest coefficient; of four bits the one
// that 1 in 200 is above, and those are clipped.
std::vector<double> multipliers_of(const Bake& bake);

// What stands for c: [1, 255], of four bits [1, 15]; what is no number is 0. And what that says.
inline constexpr int kNibbleZero = 8;
std::uint8_t stored_of(double c, double multiplier, Bits bits);
double worth_of(std::uint8_t stored, double multiplier, Bits bits);

}  // namespace likeness::baked
