#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

// Ways to relight photographs without a render, to compare with: each says of a direction what every photograph counts for.
// What is not linear in the photographs (LRGB) is made from the linear ones by who asks.
//
// Directions  unit, in the frame of the camera: x right, y up, z to the camera; lu = x, lv = y.
namespace likeness::realis {

enum class Relighter : unsigned char {
  kPtm6,        // lu^2, lv^2, lu lv, lu, lv, 1: Malzbender et al. 2001, Polynomial Texture Maps
  kPtm10,       // and lu^3, lu^2 lv, lu lv^2, lv^3
  kHsh4,        // hemispherical harmonics of 2, 3 and 4 bands: Gautron et al. 2004, A Novel Hemispherical Basis
  kHsh9,        //
  kHsh16,       //
  kThinPlate,   // radial basis functions r^2 ln r of all lights in (lu, lv), with a plane
  kGaussian,    // exp(-(r / w)^2) with a plane; w is twice the median distance of a light to its nearest neighbour
  kBarycentric  // linear in the triangles of Delaunay in (lu, lv); outside of them the nearest point of an edge
};

struct RelighterRow {
  Relighter relighter;
  std::string_view name;
  std::size_t terms;  // numbers a texel and channel, 8 bit each; 0: it keeps every photograph
};
inline constexpr std::array kRelighters{
    RelighterRow{Relighter::kPtm6, "PTM 6", 6},
    RelighterRow{Relighter::kPtm10, "PTM 10", 10},
    RelighterRow{Relighter::kHsh4, "HSH 4", 4},
    RelighterRow{Relighter::kHsh9, "HSH 9", 9},
    RelighterRow{Relighter::kHsh16, "HSH 16", 16},
    RelighterRow{Relighter::kThinPlate, "RBF thin plate", 0},
    RelighterRow{Relighter::kGaussian, "RBF Gaussian", 0},
    RelighterRow{Relighter::kBarycentric, "barycentric", 0},
};

// The terms of a direction; empty for those that keep every photograph. A direction below the horizon counts as on it.
std::vector<double> terms_of(Relighter relighter, const glm::dvec3& direction);

// Photographs under these lights from now on. Least squares of least norm: with fewer lights than terms, or all in a plane,
// everything stays finite. The lights may not be empty.
class Baseline {
 public:
  Baseline(Relighter relighter, std::span<const glm::dvec3> to_lights);
  ~Baseline();
  Baseline(Baseline&&) noexcept;

  // What each photograph counts for: the picture is their sum with these weights.
  std::vector<double> weights(const glm::dvec3& to_light) const;

 private:
  struct Work;
  std::unique_ptr<const Work> work_;
};

// Bytes of a texel: of RGB three times the terms, of LRGB the terms and a color; of what keeps photographs three a light.
std::size_t bytes_of(const RelighterRow& row, std::size_t lights, bool is_lrgb);

}  // namespace likeness::realis
