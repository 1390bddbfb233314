#include "render/scene/format.h"

#include <array>

namespace likeness::scene {
namespace {

using Words = std::string_view;

constexpr std::array<Words, 4> kChannels{"r", "g", "b", "a"};
constexpr std::array<Words, 2> kTransfers{"srgb", "linear"};
constexpr std::array<Words, 2> kWraps{"repeat", "clamp"};
constexpr std::array<Words, 5> kShapes{"sphere", "faceted_sphere", "plane", "box", "disk"};
constexpr std::array<Words, 3> kNormals{"file", "smooth", "flat"};
constexpr std::array<Words, 5> kIntensityUnits{"W/sr", "W", "cd", "lm", "profile"};
constexpr std::array<Words, 2> kIrradianceUnits{"W/m2", "lx"};
constexpr std::array<Words, 4> kRadianceUnits{"W/(m2 sr)", "W", "cd/m2", "lm"};
constexpr std::array<Words, 2> kEmissionUnits{"W/(m2 sr)", "cd/m2"};

// clang-format off
constexpr std::array kTextureKeys{
    Key{.name = "file", .form = Form::kFile, .required = true, .text = "picture: PNG, JPEG, TIFF, TGA, HDR, EXR and what else OpenImageIO reads"},
    Key{.name = "channel", .form = Form::kChoice, .initial = "r", .choices = kChannels, .text = "which one, where a number is wanted; a color takes the first three"},
    Key{.name = "transfer", .form = Form::kChoice, .choices = kTransfers, .text = "of 8-bit files; default: srgb for colors, linear for numbers and normals. Files of floats are linear"},
    Key{.name = "scale", .form = Form::kScale, .initial = "1", .text = "value = scale * texel + offset, clamped to the parameter's range"},
    Key{.name = "offset", .form = Form::kScale, .initial = "0", .text = "scale -1 and offset 1 turn gloss into roughness"},
    Key{.name = "wrap", .form = Form::kChoice, .initial = "repeat", .choices = kWraps, .text = "beyond [0, 1]"},
    Key{.name = "uv_scale", .form = Form::kPair, .initial = "1 1", .text = "texture coordinates are multiplied by it"},
    Key{.name = "uv_offset", .form = Form::kPair, .initial = "0 0", .text = "and then moved by it"},
};
constexpr Section kTexture{"texture", "A value over a surface, from a picture.", kTextureKeys};
constexpr std::array kTextures{&kTexture};
constexpr std::array kCameraKeys{
    Key{.name = "name", .form = Form::kText, .text = "for --camera"},
    Key{.name = "width", .form = Form::kWhole, .initial = "512", .range = {1, 65536}, .unit = "pixel", .text = "width x height is at most 268435456"},
    Key{.name = "height", .form = Form::kWhole, .initial = "512", .range = {1, 65536}, .unit = "pixel", .text = "of the picture"},
    Key{.name = "position", .form = Form::kVector, .initial = "0 0 0", .unit = "m", .text = "where it stands"},
    Key{.name = "target", .form = Form::kVector, .unit = "m", .text = "what it looks at; default: 1 m along -z"},
    Key{.name = "up", .form = Form::kVector, .initial = "0 1 0", .text = "what is upwards in the picture"},
    Key{.name = "matrix", .form = Form::kMatrix, .text = "world from camera, in the place of position, target and up: looks along -z, x right, y up (a computer-vision camera has y and z turned round)"},
    Key{.name = "fov_deg", .form = Form::kNumber, .initial = "40", .range = {1e-3, 179}, .unit = "degree", .text = "vertical field of view, whole angle"},
    Key{.name = "focal_mm", .form = Form::kNumber, .range = {1e-3, 1e6}, .unit = "mm", .text = "focal length, in the place of fov_deg"},
    Key{.name = "sensor_mm", .form = Form::kNumber, .initial = "24", .range = {1e-3, 1e5}, .unit = "mm", .text = "height of the sensor"},
    Key{.name = "orthographic_height", .form = Form::kNumber, .range = {1e-9, 1e9}, .unit = "m", .text = "in the place of fov_deg: rays are parallel, and this is what the picture is high; there is no lens, and nothing behind the camera's plane is seen"},
    Key{.name = "focal_px", .form = Form::kPair, .range = {1e-3, 1e9}, .unit = "pixel", .text = "calibrated [fx, fy], in the place of fov_deg"},
    Key{.name = "center_px", .form = Form::kPair, .unit = "pixel", .text = "principal point from the top left corner; default: the middle"},
    Key{.name = "aperture_radius", .form = Form::kNumber, .range = {0, 1e3}, .unit = "m", .text = "of the thin lens; 0: pinhole"},
    Key{.name = "f_number", .form = Form::kNumber, .range = {1e-2, 1e6}, .text = "in its place: radius = focal length / (2 f_number), by focal_mm or by fov_deg and sensor_mm"},
    Key{.name = "focus_distance", .form = Form::kNumber, .range = {0, 1e9}, .above = true, .unit = "m", .text = "along the view; default: to the target, or 1"},
};
constexpr std::array kMeshKeys{
    Key{.name = "file", .form = Form::kFile, .text = ".glb, .gltf, .obj or .ply; this or `shape`"},
    Key{.name = "shape", .form = Form::kChoice, .choices = kShapes, .text = "made here, about the origin: the unit sphere itself (not to be stretched), or of triangles; a plane and a disk face +y"},
    Key{.name = "size", .form = Form::kScale, .initial = "1", .range = {1e-6, 1e6}, .unit = "m", .text = "edges of a box; of a plane x and z count. Spheres and disks have radius 1: scale the instance"},
    Key{.name = "segments", .form = Form::kWhole, .initial = "64", .range = {3, 2048}, .text = "around a disk or a faceted sphere"},
    Key{.name = "flip_v", .form = Form::kFlag, .initial = "false", .text = "turn V upside down: for a file whose V runs against the habit of its format (glTF downwards; OBJ and PLY upwards, which is turned without this)"},
    Key{.name = "part", .form = Form::kText, .text = "take only the glTF node (with what hangs on it) or the OBJ object or group of this name"},
    Key{.name = "normals", .form = Form::kChoice, .initial = "file", .choices = kNormals, .text = "the file's (flat if it has none), smooth (angle-weighted mean of the triangles), or flat"},
};
constexpr std::array kResidualKeys{
    Key{.name = "bake", .form = Form::kFile, .required = true, .text = "folder that `likeness realis bake` wrote; its texels are placed by uv"},
    Key{.name = "strength", .form = Form::kNumber, .initial = "1", .range = {0, 100}, .text = "times the residual"},
    Key{.name = "fades", .form = Form::kFlag, .initial = "true", .text = "the residual goes where base color, roughness or normal are no longer the bake's; a bake without them does not fade"},
    Key{.name = "fade_base_color", .form = Form::kPair, .initial = "0.1 0.5", .range = {0, 10}, .text = "relative difference from which on it is less, and at which it is gone"},
    Key{.name = "fade_roughness", .form = Form::kPair, .initial = "0.05 0.3", .range = {0, 10}, .text = "the same, of the difference"},
    Key{.name = "fade_normal_deg", .form = Form::kPair, .initial = "5 26", .range = {0, 360}, .unit = "degree", .text = "the same, of the angle between normals; above 180 is never reached"},
    Key{.name = "jitter", .form = Form::kWhole, .initial = "0", .range = {0, 8}, .text = "run-time frames: so many lobes of one texel, drawn by pixel and frame, in the place of the eight dominant ones of four; 0: no jitter"},
};
constexpr Section kResidual{"realis", "What photographs have and the model has not, baked (docs/realis.md).", kResidualKeys};
constexpr std::array kResiduals{&kResidual};
constexpr std::array kMaterialKeys{
    Key{.name = "file", .form = Form::kFile, .text = "material file (docs/material_file.md); its parameters come first"},
    Key{.name = "model", .form = Form::kText, .initial = "callisto", .text = "surface model (docs/models/README.md), if there is no file"},
    Key{.name = "parameters", .form = Form::kParameters, .sections = kTextures, .text = "of the model, by name: a number, [r, g, b], or a texture"},
    Key{.name = "normal_map", .form = Form::kObject, .sections = kTextures, .text = "texture, 2 texel - 1 in the tangent frame: x along u, y against v (green is up)"},
    Key{.name = "normal_strength", .form = Form::kNumber, .initial = "1", .range = {-100, 100}, .text = "times its x and y"},
    Key{.name = "diffuse_normal_map", .form = Form::kObject, .sections = kTextures, .text = "dual normals: this one for the diffuse, normal_map for the specular"},
    Key{.name = "opacity", .form = Form::kObject, .sections = kTextures, .text = "texture: the surface is cut out where it is below opacity_cutoff"},
    Key{.name = "opacity_cutoff", .form = Form::kNumber, .initial = "0.5", .range = {0, 1}, .text = "see opacity"},
    Key{.name = "emission", .form = Form::kColor, .initial = "0", .range = {0, 1e12}, .text = "radiance, in emission_unit"},
    Key{.name = "emission_unit", .form = Form::kChoice, .initial = "W/(m2 sr)", .choices = kEmissionUnits, .text = "cd/m2 is divided by 683 lm/W"},
    Key{.name = "emission_map", .form = Form::kObject, .sections = kTextures, .text = "texture, multiplies it"},
    Key{.name = "two_sided", .form = Form::kFlag, .initial = "true", .text = "false: its back is black, and emits nothing"},
    Key{.name = "realis", .form = Form::kObject, .sections = kResiduals, .text = "a baked residual that is added to the light which the model returns"},
};
constexpr std::array kInstanceKeys{
    Key{.name = "name", .form = Form::kText, .text = "for people"},
    Key{.name = "mesh", .form = Form::kText, .required = true, .text = "key in meshes"},
    Key{.name = "material", .form = Form::kText, .text = "key in materials; without it the file's own, or Callisto at its defaults"},
    Key{.name = "materials", .form = Form::kNames, .text = "the file's name of a material to a key in materials, for some of them"},
    Key{.name = "scale", .form = Form::kScale, .initial = "1", .text = "first"},
    Key{.name = "rotate_deg", .form = Form::kVector, .initial = "0 0 0", .unit = "degree", .text = "then: about x, then the world's y, then its z, counter-clockwise"},
    Key{.name = "translate", .form = Form::kVector, .initial = "0 0 0", .unit = "m", .text = "last"},
    Key{.name = "matrix", .form = Form::kMatrix, .text = "world from object, in the place of those three"},
};
// What every light has, what those have that stand somewhere, those of a profile, and those with an area.
constexpr std::array kAnyLightKeys{
    Key{.name = "type", .form = Form::kText, .required = true, .text = "point, spot, directional, rectangle, disk or sphere"},
    Key{.name = "name", .form = Form::kText, .text = "for people"},
    Key{.name = "color", .form = Form::kColor, .initial = "1", .range = {0, 1e6}, .text = "multiplies strength, which is stated for white (1)"},
    Key{.name = "movable", .form = Form::kFlag, .initial = "false", .text = "its shadows cannot be kept from frame to frame"},
};
constexpr std::array kPlacedLightKeys{
    Key{.name = "position", .form = Form::kVector, .initial = "0 0 0", .unit = "m", .text = "its center"},
    Key{.name = "range", .form = Form::kNumber, .range = {0, 1e9}, .above = true, .unit = "m", .text = "attenuation radius: the light is multiplied by (1 - (d / range)^4)^2, clamped at 0; default: none"},
};
constexpr std::array kProfileKeys{
    Key{.name = "strength", .form = Form::kColor, .initial = "1", .range = {0, 1e12}, .text = "in `unit`"},
    Key{.name = "unit", .form = Form::kChoice, .initial = "W/sr", .choices = kIntensityUnits, .text = "W and lm: of the whole light; profile: strength times the candela of the profile's file"},
    Key{.name = "profile", .form = Form::kFile, .text = "IES LM-63 file, type C or B: intensity is multiplied by it over its largest candela"},
    Key{.name = "profile_axis", .form = Form::kVector, .initial = "0 -1 0", .text = "where the profile's nadir (0 degrees) points"},
    Key{.name = "profile_zero", .form = Form::kVector, .initial = "1 0 0", .text = "towards its plane of 0 degrees; made square to the axis"},
};
constexpr std::array kAreaKeys{
    Key{.name = "strength", .form = Form::kColor, .initial = "1", .range = {0, 1e12}, .text = "in `unit`"},
    Key{.name = "unit", .form = Form::kChoice, .initial = "W/(m2 sr)", .choices = kRadianceUnits, .text = "W and lm: of the whole light, both sides if it has two"},
    Key{.name = "visible", .form = Form::kFlag, .initial = "true", .text = "to cameras and mirrors"},
};
constexpr std::array kSpotKeys{
    Key{.name = "direction", .form = Form::kVector, .initial = "0 -1 0", .text = "where it shines to"},
    Key{.name = "target", .form = Form::kVector, .unit = "m", .text = "in its place: the point it shines at"},
    Key{.name = "inner_deg", .form = Form::kNumber, .initial = "20", .range = {0, 179}, .unit = "degree", .text = "half angle of the cone of full intensity"},
    Key{.name = "outer_deg", .form = Form::kNumber, .initial = "30", .range = {0, 180}, .above = true, .unit = "degree", .text = "half angle where it ends; between them smoothstep of the cosine"},
};
constexpr std::array kDirectionalKeys{
    Key{.name = "direction", .form = Form::kVector, .initial = "0 -1 0", .text = "the way the light travels"},
    Key{.name = "strength", .form = Form::kColor, .initial = "1", .range = {0, 1e12}, .text = "in `unit`, on a surface that faces it"},
    Key{.name = "unit", .form = Form::kChoice, .initial = "W/m2", .choices = kIrradianceUnits, .text = "lx is divided by 683 lm/W"},
};
constexpr std::array kRectangleKeys{
    Key{.name = "direction", .form = Form::kVector, .initial = "0 -1 0", .text = "where it shines to"},
    Key{.name = "target", .form = Form::kVector, .unit = "m", .text = "in its place: the point it shines at"},
    Key{.name = "up", .form = Form::kVector, .initial = "0 1 0", .text = "its height is along this, as far as square to its direction; of no account to one that shines along it"},
    Key{.name = "size", .form = Form::kPair, .initial = "1 1", .range = {1e-6, 1e6}, .unit = "m", .text = "[width, height]"},
    Key{.name = "half_u", .form = Form::kVector, .unit = "m", .text = "with half_v, in the place of those four: from the center to an edge; shines along half_u x half_v"},
    Key{.name = "half_v", .form = Form::kVector, .unit = "m", .text = "see half_u"},
    Key{.name = "two_sided", .form = Form::kFlag, .initial = "false", .text = "shines from its back too"},
};
constexpr std::array kDiskKeys{
    Key{.name = "direction", .form = Form::kVector, .initial = "0 -1 0", .text = "where it shines to"},
    Key{.name = "target", .form = Form::kVector, .unit = "m", .text = "in its place: the point it shines at"},
    Key{.name = "radius", .form = Form::kNumber, .initial = "0.5", .range = {1e-6, 1e6}, .unit = "m", .text = "of the disk"},
    Key{.name = "two_sided", .form = Form::kFlag, .initial = "false", .text = "shines from its back too"},
};
constexpr std::array kSphereKeys{
    Key{.name = "radius", .form = Form::kNumber, .initial = "0.5", .range = {1e-6, 1e6}, .unit = "m", .text = "of the sphere"},
};
constexpr std::array kEnvironmentKeys{
    Key{.name = "file", .form = Form::kFile, .text = "latitude-longitude picture: its middle column is -z, to the right of it +x, its top row +y"},
    Key{.name = "radiance", .form = Form::kColor, .initial = "1", .range = {0, 1e12}, .text = "in `unit`, of all directions, if there is no file"},
    Key{.name = "scale", .form = Form::kColor, .initial = "1", .range = {0, 1e12}, .text = "times the picture, whose numbers are in `unit`"},
    Key{.name = "unit", .form = Form::kChoice, .initial = "W/(m2 sr)", .choices = kEmissionUnits, .text = "cd/m2 is divided by 683 lm/W"},
    Key{.name = "turn_deg", .form = Form::kNumber, .initial = "0", .unit = "degree", .text = "of the picture about +y, counter-clockwise seen from above"},
};
constexpr std::array kViewKeys{
    Key{.name = "ev", .form = Form::kNumber, .initial = "0", .range = {-60, 60}, .unit = "stop", .text = "exposure: the picture is multiplied by 2^ev"},
    Key{.name = "name", .form = Form::kText, .initial = "srgb", .text = "srgb, gt, or the name of the OCIO view"},
    Key{.name = "display", .form = Form::kText, .text = "of OCIO"},
    Key{.name = "config", .form = Form::kFile, .text = "of OCIO; default: the environment variable OCIO"},
};
// clang-format on

template <std::size_t... N>
constexpr auto joined(const std::array<Key, N>&... parts) {
  std::array<Key, (N + ...)> out{};
  std::size_t at = 0;
  const auto append = [&](const auto& part) {
    for (const Key& key : part) out[at++] = key;
  };
  (append(parts), ...);
  return out;
}
constexpr auto kPointLight = joined(kAnyLightKeys, kPlacedLightKeys, kProfileKeys);
constexpr auto kSpotLight = joined(kAnyLightKeys, kPlacedLightKeys, kSpotKeys, kProfileKeys);
constexpr auto kDirectionalLight = joined(kAnyLightKeys, kDirectionalKeys);
constexpr auto kRectangleLight = joined(kAnyLightKeys, kPlacedLightKeys, kRectangleKeys, kAreaKeys);
constexpr auto kDiskLight = joined(kAnyLightKeys, kPlacedLightKeys, kDiskKeys, kAreaKeys);
constexpr auto kSphereLight = joined(kAnyLightKeys, kPlacedLightKeys, kSphereKeys, kAreaKeys);

constexpr Section kCamera{"camera", "Where the picture is taken from.", kCameraKeys};
constexpr Section kMesh{"mesh", "Triangles, from a file or made here.", kMeshKeys};
constexpr Section kMaterial{"material", "A surface.", kMaterialKeys};
constexpr Section kInstance{"instance", "A mesh in its place.", kInstanceKeys};
constexpr Section kEnvironment{"environment", "Light from infinitely far away.", kEnvironmentKeys};
constexpr Section kView{"view", "How the light becomes a picture.", kViewKeys};
constexpr Section kPoint{"point", "A light without size.", kPointLight};
constexpr Section kSpot{"spot", "A light without size that shines into a cone.", kSpotLight};
constexpr Section kDirectional{"directional", "The same light everywhere, from one direction: the sun.",
                               kDirectionalLight};
constexpr Section kRectangle{"rectangle", "A panel.", kRectangleLight};
constexpr Section kDisk{"disk", "A round panel.", kDiskLight};
constexpr Section kSphere{"sphere", "A ball.", kSphereLight};

constexpr std::array kCameras{&kCamera};
constexpr std::array kMeshes{&kMesh};
constexpr std::array kMaterials{&kMaterial};
constexpr std::array kInstances{&kInstance};
constexpr std::array kLights{&kPoint, &kSpot, &kDirectional, &kRectangle, &kDisk, &kSphere};
constexpr std::array kEnvironments{&kEnvironment};
constexpr std::array kViews{&kView};

// clang-format off
constexpr std::array kSceneKeys{
    Key{.name = "format", .form = Form::kText, .required = true, .text = "the text `likeness scene`"},
    Key{.name = "version", .form = Form::kWhole, .range = {1, 1}, .required = true, .text = "of the format"},
    Key{.name = "name", .form = Form::kText, .text = "for people"},
    Key{.name = "cameras", .form = Form::kList, .sections = kCameras, .text = "the first is used unless another is asked for; without any, one is made that sees everything"},
    Key{.name = "meshes", .form = Form::kMap, .sections = kMeshes, .text = "by name"},
    Key{.name = "materials", .form = Form::kMap, .sections = kMaterials, .text = "by name"},
    Key{.name = "instances", .form = Form::kList, .sections = kInstances, .text = "what stands in the scene"},
    Key{.name = "lights", .form = Form::kList, .sections = kLights, .text = "see there"},
    Key{.name = "environment", .form = Form::kObject, .sections = kEnvironments, .text = "see there"},
    Key{.name = "view", .form = Form::kObject, .sections = kViews, .text = "see there"},
};
// clang-format on

}  // namespace

const Section kSceneSection{"scene", "The file.", kSceneKeys};
const Section kTextureSection = kTexture;

}  // namespace likeness::scene
