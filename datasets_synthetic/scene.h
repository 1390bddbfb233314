#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

// Small scenes whose contents are known: `likeness make scene`.
namespace likeness::datasets_synthetic {

struct SceneOptions {
  std::filesystem::path folder;
  std::uint64_t seed = 0;
  int width = 0, height = 0;  // of the pictures; 0: the kind's own
  int lights = 64;            // corridor
  double light_deg = 45;      // spheres: 0 behind the camera, 90 at its right, 180 opposite
  int frames = 1;             // spheres: scene files in which the light goes once around
};

class SceneFiles;

struct SceneKind {
  std::string_view name;
  std::string_view text;
  void (*make)(const SceneOptions& options, SceneFiles& files);
  int width, height;
};

void make_spheres(const SceneOptions& options, SceneFiles& files);
void make_cornell(const SceneOptions& options, SceneFiles& files);
void make_corridor(const SceneOptions& options, SceneFiles& files);
void make_ggx_sphere(const SceneOptions& options, SceneFiles& files);
void make_plastic_sphere(const SceneOptions& options, SceneFiles& files);
void make_teeth(const SceneOptions& options, SceneFiles& files);
void make_eye(const SceneOptions& options, SceneFiles& files);
void make_distance(const SceneOptions& options, SceneFiles& files);
void make_torture(const SceneOptions& options, SceneFiles& files);

// clang-format off
inline constexpr std::array kSceneKinds{
    SceneKind{"spheres", "rows of spheres, one row for each effect of Callisto, under one light that can turn around them", make_spheres, 896, 512},
    SceneKind{"cornell", "the Cornell box, as it was measured, in metres", make_cornell, 512, 512},
    SceneKind{"corridor", "a corridor with many lights of all kinds and of bounded range", make_corridor, 960, 540},
    SceneKind{"ggx_sphere", "a rough metal sphere in a constant environment", make_ggx_sphere, 256, 256},
    SceneKind{"plastic_sphere", "a plastic sphere in a constant environment", make_plastic_sphere, 256, 256},
    SceneKind{"teeth", "two rows of rounded, wet teeth in their gums", make_teeth, 768, 512},
    SceneKind{"eye", "an eye: cornea, iris and veins, and normals for its diffuse light alone", make_eye, 512, 512},
    SceneKind{"distance", "bumpy spheres and a tiled floor into the distance, where pixels cover many texels", make_distance, 768, 432},
    SceneKind{"torture", "what breaks renderers: grazing planes, mirrors, needles, the huge and the tiny, holes, NaN", make_torture, 640, 480},
};
// clang-format on

// Writes the scene, its meshes and its textures into the folder and returns the scene files. The same options give the
// same bytes. Precondition: the kind is one of kSceneKinds. Throws std::runtime_error for what cannot be written.
std::vector<std::filesystem::path> write_scene(const SceneKind& kind, const SceneOptions& options);

}  // namespace likeness::datasets_synthetic
