#include <utility>

#include "brdf/callisto_proxima.h"
#include "render/surface/kernel_of_model.h"

namespace likeness::surface {
namespace {

using C = brdf::Callisto<float>;

template <unsigned kParts>
struct Distant {
  static brdf::Rgb<float> eval(const Bound& b, const brdf::Geometry<float>& g) {
    return brdf::callisto_over_proxima<kParts>(model_of<C>(b), g, b.bumps);
  }
  static auto lobes(const Bound& b, const brdf::Vec3<float>& to_view) {
    return brdf::callisto_over_proxima_lobes<kParts>(model_of<C>(b), to_view, b.bumps);
  }
};

template <unsigned kParts>
constexpr Kernel distant() {
  Kernel kernel = kernel_with<C, Distant<kParts>>();
  kernel.lobes = &lobes_with<C, Distant<C::kAllParts>>;
  return kernel;
}

// Index: the parts but kDiffuse, which is the lowest bit.
static_assert(C::kDiffuse == 1);
template <unsigned... P>
constexpr std::array<Kernel, sizeof...(P)> distant_kernels_for(std::integer_sequence<unsigned, P...>) {
  return {distant<2 * P + 1>()...};
}
constexpr auto kDistantKernels = distant_kernels_for(std::make_integer_sequence<unsigned, (C::kAllParts + 1) / 2>{});

}  // namespace

Kernel distant_callisto_kernel(unsigned parts, bool has_dual_normals) {
  // The kernel of dual normals has Proxima in it.
  if (has_dual_normals || (parts & (C::kDiffuse | C::kRise | C::kRetro)) == 0)
    return callisto_kernel(parts, has_dual_normals);
  return kDistantKernels[(parts & C::kAllParts) / 2];
}

}  // namespace likeness::surface
