#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "brdf/any_brdf.h"
#include "brdf/realis/fade.h"
#include "render/baked/residual.h"
#include "render/image/texels.h"

// What a picture is made of, as plain values: a scene file read, checked and repaired, before anything is built from it.
//
// World       right-handed, y up, metres.
// Light       radiance in W/(m^2 sr) for each of linear red, green and blue (Rec. 709); photometric numbers have been
//             divided by 683 lm/W.
// Texture     coordinates as glTF has them: u to the right, v downwards from the top row.
namespace likeness::scene {

using Index = std::uint32_t;
inline constexpr Index kNone = ~Index{0};
inline constexpr double kLumensPerWatt = 683;  // at 555 nm, by the definition of the candela
inline constexpr float kForever = std::numeric_limits<float>::infinity();

// ---- surfaces

struct Mesh {
  std::string name;
  bool is_sphere = false;  // the unit sphere about the origin itself, and the vectors are empty
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;   // unit, one for each position, or none: triangles are flat
  std::vector<glm::vec2> uvs;       // one for each position, or none
  std::vector<glm::vec4> tangents;  // unit, w = +1 or -1 is the side of the bitangent; one for each position, or none
  std::vector<std::array<Index, 3>> triangles;
};

enum class Transfer : std::uint8_t { kLinear, kSrgb };  // of 8-bit texels; floats are linear
enum class Wrap : std::uint8_t { kRepeat, kClamp };

struct Image {
  std::string name;  // the file, for messages
  image::Texels texels;
};

// A value over a surface: scale * texel + offset. A number takes one channel, a color the first three.
struct Texture {
  Index image = kNone;
  Transfer transfer = Transfer::kLinear;
  Wrap wrap = Wrap::kRepeat;
  int channel = 0;
  glm::vec2 uv_scale{1, 1}, uv_offset{0, 0};
  glm::vec3 scale{1, 1, 1}, offset{0, 0, 0};
};

struct Material {
  // A row of the model's table that a texture gives. What it gives is clamped to the row's range.
  struct Binding {
    std::size_t parameter;
    Texture texture;
  };

  // What photographs had beyond the model (docs/realis.md): added to f cos_i of every light.
  struct BakedResidual {
    Index bake = kNone;  // in Scene::bakes
    float strength = 1;
    std::optional<brdf::RealisFade> fade;  // absent: the residual does not fade
    int jitter = 0;                        // of frames: so many lobes of a texel, drawn anew each frame; 0: all
  };

  std::string name;
  brdf::AnyBrdf brdf;
  std::vector<Binding> bindings;
  std::optional<BakedResidual> residual;

  std::optional<Texture> normal_map;          // in the tangent frame, 2 texel - 1; x along u, y against v (as glTF)
  float normal_strength = 1;                  // times x and y
  std::optional<Texture> diffuse_normal_map;  // dual normals: this one for the diffuse, normal_map for the specular
  std::optional<Texture> opacity;             // cut out where below opacity_cutoff
  float opacity_cutoff = 0.5f;

  glm::vec3 emission{0, 0, 0};          // radiance [W/(m^2 sr)]
  std::optional<Texture> emission_map;  // multiplies it
  bool two_sided = true;                // false: its back is black, and emits nothing
};

struct Instance {
  std::string name;
  Index mesh = kNone, material = kNone;
  glm::mat4 world_from_object{1};
};

// ---- lights

// Luminous intensity over direction, of IES LM-63: of a type C or B photometer, angles in degrees, both ascending.
struct Profile {
  enum class Type : std::uint8_t { kC, kB };
  std::string name;
  Type type = Type::kC;
  std::vector<float> vertical_deg, horizontal_deg;
  std::vector<float> candela;  // horizontal x vertical: [h * vertical_deg.size() + v]
};

struct PointLight {
  glm::vec3 position{0, 0, 0};
  glm::vec3 intensity{1, 1, 1};  // [W/sr]
};
struct SpotLight {
  glm::vec3 position{0, 0, 0}, direction{0, -1, 0};  // unit, where it shines to
  glm::vec3 intensity{1, 1, 1};                      // [W/sr] within the inner cone
  float inner = 0.3f, outer = 0.5f;                  // half angles [rad]; smoothstep of the cosine between them
};
struct DirectionalLight {
  glm::vec3 direction{0, -1, 0};  // unit, the way the light travels
  glm::vec3 irradiance{1, 1, 1};  // [W/m^2] on a surface that faces it
};
// Both shine along `normal`, and from the other side too if two_sided.
struct RectangleLight {
  glm::vec3 center{0, 0, 0}, half_u{0.5f, 0, 0}, half_v{0, 0, -0.5f};  // from the center to two edges; normal: u x v
  glm::vec3 radiance{1, 1, 1};
  bool two_sided = false;
};
struct DiskLight {
  glm::vec3 center{0, 0, 0}, normal{0, -1, 0};
  float radius = 0.5f;
  glm::vec3 radiance{1, 1, 1};
  bool two_sided = false;
};
struct SphereLight {
  glm::vec3 center{0, 0, 0};
  float radius = 0.5f;
  glm::vec3 radiance{1, 1, 1};
};
using LightShape = std::variant<PointLight, SpotLight, DirectionalLight, RectangleLight, DiskLight, SphereLight>;

struct Light {
  std::string name;
  LightShape shape;
  bool is_movable = false;  // its shadows cannot be kept from frame to frame
  bool is_visible = true;   // to cameras and mirrors: those with an area
  // Attenuation radius: the light is multiplied by (1 - (d / range)^4)^2, clamped at 0 (Karis, "Real Shading in Unreal
  // Engine 4", SIGGRAPH 2013 course). Infinity: the inverse square alone.
  float range = kForever;
  // Point and spot: intensity is multiplied by the profile over its largest candela. Its nadir is `profile_axis`,
  // its 0 degree plane `profile_zero`.
  Index profile = kNone;
  glm::vec3 profile_axis{0, -1, 0}, profile_zero{1, 0, 0};
};

// Light from infinitely far away: a latitude-longitude picture, or one color.
struct Environment {
  Index image = kNone;
  glm::vec3 scale{1, 1, 1};  // times the picture, or the radiance itself [W/(m^2 sr)]
  float turn = 0;            // of the picture about +y [rad], counter-clockwise seen from above
};
// The picture's middle column is -z at turn 0 (ahead of a camera at rest), its right neighbor is towards +x; the top row
// is +y.

// ---- how it is looked at

// Pinhole, thin lens, or orthographic: then rays are parallel and start on the camera's plane. Looks along its -z, x to the right, y up; pixel (0, 0) is the top left one and spans [0, 1)^2.
struct Camera {
  std::string name;
  glm::mat4 world_from_camera{1};
  int width = 512, height = 512;
  bool is_orthographic = false;
  double focal_x = 512, focal_y = 512;    // [pixel]; orthographic: [pixel/m]
  double center_x = 256, center_y = 256;  // of projection [pixel]
  float lens_radius = 0;                  // [m]; 0: pinhole
  float focus_distance = 1;               // [m], along -z
};

struct View {
  double ev = 0;              // exposure [stops]: the picture is multiplied by 2^ev
  std::string name = "srgb";  // srgb, gt, or NAME of the OCIO view
  std::string display;        // of OCIO
  std::string config;         // file of OCIO; empty: $OCIO
};

// What was wrong with the input and has been put right.
struct Repair {
  std::string what;   // "triangles without area left out"
  std::string where;  // file and mesh
  std::size_t count = 0;
};

struct Scene {
  std::string name;
  std::vector<Camera> cameras;
  std::vector<Image> images;
  std::vector<baked::Residual> bakes;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Instance> instances;
  std::vector<Profile> profiles;
  std::vector<Light> lights;
  std::optional<Environment> environment;
  View view;
  std::vector<Repair> repairs;
};

}  // namespace likeness::scene
