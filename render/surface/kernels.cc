#include <variant>

#include "render/surface/kernel_of_model.h"

namespace likeness::surface {
namespace {

template <template <class> class M>
Kernel of(const M<double>&) {
  static_assert(sizeof(M<float>) <= kModelBytes);
  return kernel_with<M<float>, Whole<M<float>>>();
}

}  // namespace

Kernel kernel_of(const brdf::AnyBrdf& model) {
  return std::visit(
      []<class M>(const M& m) {
        if constexpr (std::same_as<M, brdf::Callisto<double>>) return callisto_kernel(M::kAllParts, false);
        else return of(m);
      },
      model);
}

}  // namespace likeness::surface
