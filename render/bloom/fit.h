#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "render/bloom/kernel.h"
#include "render/image/picture.h"

namespace likeness::bloom {

struct FitOptions {
  int radius = 0;  // of the square about the source [pixels]; 0: to the nearest edge, at most 256
  int most = 4;    // components at most, 1 to 6
  std::optional<double>
      clip;  // values of the photograph with glare from here on are not used; nothing: found (see clip_of)
  std::function<void(double share)> tell = {};  // may throw to stop
};

// One number of components.
struct Trial {
  int components = 0;
  double held_out = 0;        // misfit of rings that were not fitted, per ring and channel; 1 is noise
  double held_out_error = 0;  // of that mean
};

struct Fit {
  Kernel kernel;
  std::array<double, 3> scale{1, 1, 1};  // light of the photograph with glare over light of the other
  bool is_direct_seen = true;            // false: the source's own pixels are clipped, and scale 1 is assumed
  std::optional<double> clip;            // where clipping was taken to begin
  std::size_t clipped = 0;               // pixels left out
  double misfit = 0;                     // chi2 per degree of freedom
  std::vector<Trial> trials;
  // For each ring: its radius, and for each channel what was there, one standard error, the source, and the fit.
  std::vector<double> radius;
  std::array<std::vector<double>, 3> glare, error, source, model;
};

// The value at which a photograph is cut off: its largest, if four or more values are equal to it; else nothing.
std::optional<double> clip_of(const image::Picture& glare);

// The kernel K for which glare = scale (source * K), from a small source that is the same in both and dark surroundings.
// Rings about the source are fitted by non-negative least squares; scales are common to the channels, weights are not.
// How many components: the least whose rings left out (each fourth in turn) are fitted as well as the best, within one
// standard error. Throws std::invalid_argument (see rings_about; or the sizes differ, or no ring is left).
Fit fit_kernel(const image::Picture& source, const image::Picture& glare, const FitOptions& options = {});

}  // namespace likeness::bloom
