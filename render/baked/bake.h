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

// The lobes that all texels of an asset share, in which a residual is written down (spec: Realis, Bake, 4).
struct Basis {
  std::vector<Lobe> lobes;
  // What is known of a texel's coefficients before it was seen: their standard deviations about 0, in units of that of a
  // sample of weight 1. Ridge regression with 1 / spread^2: large ones are free, small ones are kept near 0.
  std::vector<double> spread;
};

struct Bake {
  Basis basis;
  Channels channels = Channels::kLuminance;
  double floor = 0.4;               // what a cosine counts for at least
  std::size_t kept = 0;             // lobes of each texel that are not 0
  std::vector<float> coefficients;  // [1/sr] for irradiance 1: texel by texel, channel by channel, the lobes

  std::size_t channel_count() const { return channels == Channels::kRgb ? 3 : 1; }
  bool is_sparse() const { return kept < basis.lobes.size(); }
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

// The bake as 8 bits hold it: what a reader of the pictures gets.
Bake quantised(const Bake& bake);

// The largest coefficient of each channel and lobe, channel by channel: what the byte 255 stands for.
std::vector<double> multipliers_of(const Bake& bake);

}  // namespace likeness::baked
