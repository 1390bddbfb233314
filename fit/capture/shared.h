#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "brdf/callisto.h"
#include "brdf/geometry.h"
#include "fit/capture/site.h"
#include "fit/capture/stack.h"
#include "fit/result/result.h"

// One Callisto material for all pixels, and the color of a pixel under it. Photos are linear in the color,
//
//     photo_l,c = E_l (color_c D_l + S_l),     E = exposure times irradiance times cos_i
//
// so the colors have a closed form for given shared parameters, and only those are searched (variable projection, Golub and
// Pereyra 1973, with Kaufman's derivative). The loss is the mean over samples of ln(1 + q), Cauchy's, with q the mean
// over the channels of (r / (level scale))^2: a sample in a cast shadow or with light of a neighbour counts little.
namespace likeness::capture_fit {

// What the shared parameters are. A pair belongs together: the second shapes what the first is the strength of, and means
// nothing while that is neutral.
struct SharedGroup {
  std::string_view strength, shape;
  double neutral;  // of the strength: the material is then without it
  unsigned part;   // of Callisto
};
inline constexpr std::array<SharedGroup, 4> kSharedGroups{{
    {"specular", "roughness", 0, brdf::Callisto<double>::kDiffuse},
    {"smooth_terminator", "smooth_terminator_length", 0, brdf::Callisto<double>::kTerminator},
    {"diffuse_fresnel", "diffuse_fresnel_falloff", 1, brdf::Callisto<double>::kRise},
    {"retroreflection", "retroreflection_falloff", 1, brdf::Callisto<double>::kRetro},
}};
// Without a specular lobe there is no rise to white at grazing angles either.
inline constexpr double kMatteFalloff = 0, kGlossyFalloff = 0.5;  // of specular_fresnel_falloff

// f with the parts of Callisto that these groups of parameters read, as a template argument.
template <class F>
void with_parts(bool is_glossy, bool is_soft, bool is_curved, F&& f) {
  using C = brdf::Callisto<double>;
  constexpr unsigned kSoft = C::kTerminator, kCurved = C::kTerminator | C::kRise | C::kRetro;
  const auto choose = [&]<unsigned kSpecular>() {
    if (is_curved) f.template operator()<kSpecular | kCurved>();
    else if (is_soft) f.template operator()<kSpecular | kSoft>();
    else f.template operator()<kSpecular>();
  };
  if (is_glossy) choose.template operator()<C::kDiffuse>();
  else choose.template operator()<C::kDiffuse | C::kFalloff>();
}

inline constexpr std::size_t kSharedParameters = 2 * kSharedGroups.size();

// A pixel under the lights that its normal faces: what the parameters do not change.
struct Face {
  std::vector<brdf::Geometry<double>> angles;
  std::vector<double> shine;                 // E_l
  std::vector<std::array<double, 3>> light;  // the photos
  double level = 0;                          // what residuals are divided by [photo's unit]
};
// Samples that are NaN and lights behind the horizon are left out. Empty where the normal is 0 or away from the camera.
void face_of(const Site& site, const glm::dvec3& normal, const Stack& stack, std::size_t pixel, double exposure,
             double level, Face& out);
// The same without photos.
void face_under(const Site& site, const glm::dvec3& normal, double exposure, Face& out);

// D_l and S_l times E_l.
struct FaceShading {
  std::vector<double> diffuse, specular;
};
void shade(const brdf::Callisto<double>& material, const Face& face, FaceShading& out);

// Color of a pixel [>= 0], its samples' weights, and what they leave.
struct Colored {
  std::array<double, 3> color{};
  std::vector<double> weights, squares;                 // of each sample: 1 / (1 + q), and q scale^2
  std::vector<std::pair<double, std::size_t>> asked{};  // room for the start
  double weight = 0;                                    // their sum
  double error = 0;                                     // standard error of the color over the color, mean of channels
  bool is_known = false;
};
void color_of(const Face& face, const FaceShading& shading, double scale, Colored& out);

struct SharedFit {
  brdf::Callisto<double> material;  // base_color is not touched
  std::vector<fit::Estimate> estimates;
  std::vector<fit::Step> convergence;
  double scale = 0;
  double lambert_loss = 0, callisto_loss = 0, lambert_rms = 0, callisto_rms = 0;
};
// `step(loss)` is asked before every step; where it says no, files::Interrupted is thrown.
SharedFit fit_shared(const std::vector<Face>& faces, const std::function<bool(double share)>& step);

}  // namespace likeness::capture_fit
