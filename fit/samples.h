#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fit/kernel.h"
#include "fit/measured/measured.h"

namespace likeness::fit {

// Samples of a measured material in the arrays that the kernel reads, in one precision.
template <class N>
class SampleArrays {
 public:
  explicit SampleArrays(Loss loss) : loss_(loss) {}

  // weight [any unit], > 0; the loss divides by the sum of the weights.
  void add(const measured::Direction& to_light, const measured::Direction& to_view, const measured::Rgb& f,
           double weight);
  // Fills up to a multiple of kLane with samples of weight 0. Call once, after the last add.
  void finish();

  std::size_t count() const { return count_; }  // without padding
  std::size_t padded() const { return root_weight_.size(); }
  double weight_sum() const { return weight_sum_; }
  // The samples [first, last); both multiples of kLane, last at most padded().
  KernelInput<N> input(std::size_t model, const double* channels, bool derivatives, std::size_t first, std::size_t last,
                       bool scatter = false) const;

 private:
  Loss loss_;
  std::array<std::vector<N>, 3> to_light_, to_view_, target_, shown_;
  std::vector<N> root_weight_;
  std::size_t count_ = 0;
  double weight_sum_ = 0;
};

// The standard slice of a material: 90 x 90 bin centres, theta_h and theta_d linear, phi_d = 90 deg, those with valid
// data and both directions within the cut. A table of bins answers with the value of the nearest bin, whose centre is
// not quite where it was asked: both places are kept.
inline constexpr int kSliceGrid = 90;
struct SlicePoint {
  int h, d;  // bin of theta_h and of theta_d: angle = (bin + 0.5) deg
  measured::Rgb f;
  brdf::Geometry<double> at_grid;    // the directions of the grid
  brdf::Geometry<double> at_stored;  // where f holds (measured::Material::nearest); the same if the format interpolates
};
std::vector<SlicePoint> slice_points(const measured::Material& material, double cut_deg);

// What a fit sums over, in three finenesses: many cheap starts, then few exact steps.
struct SampleSet {
  Loss loss;
  SampleArrays<float> coarse;   // a few hundred, weighted to stand for all
  SampleArrays<float> single;   // all (slice), or some twenty thousand of the table
  SampleArrays<double> exact;   // all (slice); empty for the table
  SampleArrays<float> table;    // all valid samples of the table; empty for the slice
  measured::Rgb diffuse_level;  // pi x the 30th percentile of f: where starts look for the base color
};

// Where a slice's values are held against the model: where they are stored, or half there and half at the grid's own
// directions, between which a table of bins does not tell. Of no meaning for the table or for formats that interpolate.
enum class Reading { kStored, kBoth };

// Throws files::InputError, naming the material, where the cut leaves fewer than 100 samples.
SampleSet sample_set(const measured::Material& material, const std::vector<SlicePoint>& slice, const Options& options,
                     Reading reading);

}  // namespace likeness::fit
