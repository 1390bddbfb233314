#pragma once

#include <vector>

// The steps of FLIP (flip.h), one by one, so that each can be tested. Section numbers are those of the 2020 paper.
namespace likeness::image::flip_steps {

struct Triple {
  float x, y, z;
};

// Linear sRGB in [0, 1] to YyCxCz, the opponent space that is linear in light (4.1.1): Yy = 116 Y/Yn - 16,
// Cx = 500 (X/Xn - Y/Yn), Cz = 200 (Y/Yn - Z/Zn); and back.
Triple ycxcz_of_linear(const Triple& rgb);
Triple linear_of_ycxcz(const Triple& ycxcz);

// Linear sRGB in [0, 1] to CIELAB with Hunt's adjustment: a and b times 0.01 L (4.1.2).
Triple hunt_lab(const Triple& rgb);

// |L1 - L2| + sqrt((a1 - a2)^2 + (b1 - b2)^2) (4.1.3).
float hyab(const Triple& lab1, const Triple& lab2);

// The color difference in [0, 1]: HyAB to the power 0.7, of which [0, 0.4 of the largest] is spread over [0, 0.95] and
// the rest over [0.95, 1] (4.1.3). The largest is that of green and blue.
float color_difference(float hyab);

// A filter of two dimensions, symmetric and a sum of terms: weight * taps[x] * taps[y]. The taps of each sum to 1, the
// weights too. taps[radius] is the middle.
struct Term {
  float weight;
  std::vector<float> taps;
};
enum class Opponent { kAchromatic, kRedGreen, kBlueYellow };

// Contrast sensitivity as a filter of the picture, from the table of 4.1.1; the radius is that of the widest.
std::vector<Term> contrast_filter(Opponent channel, double pixels_per_degree);

// First and second derivative of a Gaussian of standard deviation 0.041 degrees (4.2); their positive taps sum to 1, the
// negative to -1, those of `across` to 1.
struct FeatureFilters {
  std::vector<float> edge, point, across;
};
FeatureFilters feature_filters(double pixels_per_degree);

// The curve of the HDR paper: Narkowicz, "ACES Filmic Tone Mapping Curve", 2016, in [0, 1]; and the exposed luminance
// that it maps to 0.85.
float tone_curve(float light);
double light_of_tone_085();

}  // namespace likeness::image::flip_steps
