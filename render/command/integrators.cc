#include "render/command/integrators.h"

#include <array>

namespace likeness::render_command {

std::span<const Integrator> integrators() {
  static constexpr std::array kRows{
      Integrator{"reference", "path tracer, exact but for noise", true, render_reference},
      Integrator{"runtime", "as a game would: one bounce of light, in milliseconds (docs/renderer.md)", false,
                 render_runtime},
  };
  return kRows;
}

}  // namespace likeness::render_command
