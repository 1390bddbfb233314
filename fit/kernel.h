#pragma once

#include <cstddef>

#include "fit/result/result.h"

// The inner loop of a fit: residuals of one model over many samples, with J^T J and J^T r, in SIMD batches of
// float or double, for the best instruction set of the machine it runs on.
namespace likeness::fit {

inline constexpr int kMaxChannels = 32;   // of any model's parameters together
inline constexpr std::size_t kLane = 16;  // samples are padded to a multiple of this

// Weight of the second residual of Loss::kLog, the difference of f and g clamped to [0, 1] as a display shows
// it, beside the logarithmic one. A purely logarithmic loss gives the shown picture away to gain in the peaks,
// a purely clamped one ruins the peaks; docs/fit.md measures the choice.
inline constexpr double kShownWeight = 0.5;
// Added under the cube root of Loss::kCubeRoot, so that its slope is finite at f = 0.
inline constexpr double kCubeRootOffset = 1e-6;

// Samples as arrays. `count` is a multiple of kLane; padding has root_weight 0 and any directions above the
// horizon.
template <class N>
struct KernelInput {
  const N* to_light[3];
  const N* to_view[3];
  const N* target[3];    // phi(f cos_i): ln(1 + y) or cbrt(y + offset), by the loss
  const N* shown[3];     // min(f, 1)
  const N* root_weight;  // square root of the sample's weight
  std::size_t count;
  std::size_t model;  // index in AnyBrdf
  Loss loss;
  bool derivatives;
  const double* channels;  // parameters in table order; an intensity is folded into its tint (docs/fit.md)
  bool scatter = false;    // `hessian` gathers (r dr)(r dr)^T in place of dr dr^T: what the residuals' own sizes say of
                           // the spread of J^T r (uncertainty.h)
};

// Sums over samples and color channels; derivatives in the order of the channels.
struct KernelOutput {
  double loss;                                 // sum of squared residuals
  double gradient[kMaxChannels];               // J^T r
  double hessian[kMaxChannels][kMaxChannels];  // J^T J (or the scatter), both triangles
};

// Model values at many pairs of directions, for metrics over whole tables.
struct ValueInput {
  const float* to_light[3];
  const float* to_view[3];
  std::size_t count;  // multiple of kLane
  std::size_t model;
  const double* channels;  // parameters in table order, as they are
  float* f[3];             // out
};

// A model against a whole table: what log_rms_3d and the albedo sum over.
struct TableInput {
  const float* to_light[3];
  const float* to_view[3];
  const float* target[3];  // ln(1 + f cos_i)
  const float* weight;     // solid angle, 0 for padding
  std::size_t count;       // multiple of kLane
  std::size_t model;
  const double* channels;  // parameters in table order, as they are
};
struct TableOutput {
  double log_squares;  // sum over samples and channels of weight (target - ln(1 + g cos_i))^2
  double flux[3];      // sum of weight g cos_i cos_o
};

struct Kernels {
  void (*evaluate_float)(const KernelInput<float>&, KernelOutput&);
  void (*evaluate_double)(const KernelInput<double>&, KernelOutput&);
  void (*values)(const ValueInput&);
  void (*table)(const TableInput&, TableOutput&);
  const char* instruction_set;
};

// The fastest set that this processor has. LIKENESS_INSTRUCTION_SET=baseline|avx2|avx512 in the environment
// asks for a lesser one, to compare or to reproduce another machine's numbers.
const Kernels& kernels();

}  // namespace likeness::fit
