#include <cmath>
#include <cstdio>
#include <variant>
#include <glm/vec3.hpp>

#include "brdf/any_brdf.h"

// What a game engine does with the package: GLM directions in, float values out, and a model chosen at run time.
int main() {
  using namespace likeness::brdf;
  const glm::vec3 to_light(0.6f, 0, 0.8f), to_view(0, 0, 1);

  Callisto<float> skin;
  skin.base_color = {0.6f, 0.4f, 0.3f};
  skin.retroreflection = 1.5f;
  const Rgb<float> f = skin.eval(to_light, to_view);

  AnyBrdf chosen;
  if (!model_of_name("disney2012", chosen) || model_of_name("no such model", chosen)) return 1;
  const glm::dvec3 light(0.6, 0, 0.8), view(0, 0, 1);
  const auto g = std::visit([&](const auto& model) { return model.eval(light, view); }, chosen);

  std::printf("callisto %.6g %.6g %.6g, disney2012 %.6g [1/sr]\n", double(f.r), double(f.g), double(f.b), g.r);
  return f.r > f.g && f.g > f.b && f.b > 0 && std::isfinite(g.r) && g.r > 0 ? 0 : 1;
}
