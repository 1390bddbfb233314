#pragma once

#include "fit/report/sphere_pixels.h"
#include "fit/samples.h"
#include "render/image/picture.h"

namespace likeness::fit {

// A measured material prepared for comparison with any number of models: the slice, every sample of the table within
// the cut (in single precision, 40 bytes a sample) and two sphere pictures.
class Reference {
 public:
  Reference(const measured::Material& material, double cut_deg);

  const std::vector<SlicePoint>& slice() const { return slice_; }

  // All of fit::Metrics for one model. Definitions: docs/fit.md.
  Metrics of(const brdf::AnyBrdf& model) const;

 private:
  image::DisplayPicture picture_of(const std::array<std::vector<float>, 3>& f) const;

  std::vector<SlicePoint> slice_;
  std::size_t table_stored_ = 0, table_count_ = 0;
  std::array<std::vector<float>, 3> to_light_, to_view_, target_;
  std::vector<float> weight_;
  double weight_sum_ = 0, cosine_sum_ = 0;
  measured::Rgb albedo_;
  std::vector<SpherePixel> pixels_;  // lit, and with valid data
  std::array<std::vector<float>, 3> pixel_light_, pixel_view_;
  image::DisplayPicture spheres_;
};

// The metrics of the slice alone: a few milliseconds.
Metrics slice_metrics(const std::vector<SlicePoint>& slice, const brdf::AnyBrdf& model);

// How much of a slice error the half bins between grid and stored directions are worth: slice_error_pct of the model at
// the one against itself at the other.
double half_bin_error_pct(const std::vector<SlicePoint>& slice, const brdf::AnyBrdf& model);

}  // namespace likeness::fit
