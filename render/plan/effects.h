#pragma once

#include <array>
#include <cstddef>
#include <string_view>

// Every effect that the renderer knows. The one list that the plan, its page, the command line and the docs are made of.
namespace likeness::plan {

enum class Effect : std::size_t {
  kDiffuse,
  kDiffuseFresnel,
  kRetroreflection,
  kSmoothTerminator,
  kSpecularFalloff,
  kSecondLobe,
  kOtherModels,
  kTextures,
  kTextureLevels,
  kNormalMaps,
  kProxima,
  kDualNormals,
  kRealis,
  kCutOuts,
  kEmission,
  kPointLights,
  kAreaLights,
  kProfiles,
  kRanges,
  kEnvironment,
  kEnvironmentPicture,
  kDepthOfField,
  kCount
};
inline constexpr auto kEffectCount = static_cast<std::size_t>(Effect::kCount);

struct EffectRow {
  Effect effect;
  std::string_view name;
  std::string_view text;   // what it is
  std::string_view saves;  // what is not done without it
  // The path tracer does nothing for it, whose samples look at points: it tells what a pixel sees by taking many.
  bool is_of_frames = false;
};

// clang-format off
inline constexpr std::array<EffectRow, kEffectCount> kEffects{{
    {Effect::kDiffuse, "diffuse", "Callisto's diffuse", "the cosine lobe and its sampling, in materials that are all metal"},
    {Effect::kDiffuseFresnel, "diffuse_fresnel", "rise of the diffuse towards grazing angles", "two powers a light and view"},
    {Effect::kRetroreflection, "retroreflection", "rise of the diffuse towards the light", "two powers a light and view"},
    {Effect::kSmoothTerminator, "smooth_terminator", "shading of the terminator", "a division and a blend for each channel"},
    {Effect::kSpecularFalloff, "specular_falloff", "a Fresnel rise that is not Schlick's", "a power a light and view"},
    {Effect::kSecondLobe, "second_lobe", "a second specular lobe", "half of the specular's work, and a lobe to sample"},
    {Effect::kOtherModels, "other_models", "materials of other models than Callisto", "their kernels"},
    {Effect::kTextures, "textures", "parameters that vary over a surface", "a copy of the material and its look-ups at every hit"},
    {Effect::kTextureLevels, "texture_levels", "textures of which a pixel may cover more than a texel (run-time frames)", "levels of the textures, and a footprint for each pixel", true},
    {Effect::kNormalMaps, "normal_maps", "normals from a picture", "tangents and a look-up at every hit"},
    {Effect::kProxima, "proxima", "the diffuse of bumps that are too small to be seen (run-time frames)", "kernels with Proxima in the place of Lambert, far away", true},
    {Effect::kDualNormals, "dual_normals", "one normal for the diffuse, one for the specular", "a second frame, and all terms of c1 and c2 twice"},
    {Effect::kRealis, "realis", "baked residuals of photographs", "four texels of lobes for each light, and a second way to choose directions"},
    {Effect::kCutOuts, "cut_outs", "surfaces with holes, by an opacity texture", "a question for every candidate that a ray meets"},
    {Effect::kEmission, "emission", "surfaces that shine", "lists of their triangles, and weights where they are met"},
    {Effect::kPointLights, "point_lights", "points, spots and directions", "a shadow ray a hit"},
    {Effect::kAreaLights, "area_lights", "rectangles, disks and spheres", "the sampling of their shapes, and weights where they are met"},
    {Effect::kProfiles, "profiles", "lights with a measured distribution", "a look-up in the profile for each direction"},
    {Effect::kRanges, "ranges", "lights that end at an attenuation radius", "a window for each light and point"},
    {Effect::kEnvironment, "environment", "light from infinitely far away", "a look-up for every ray that leaves the scene"},
    {Effect::kEnvironmentPicture, "environment_picture", "an environment that is not the same everywhere", "its table of directions, a shadow ray a hit"},
    {Effect::kDepthOfField, "depth_of_field", "a lens with a size", "a point on the lens for every camera ray"},
}};
// clang-format on

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < kEffectCount; ++i)
    if (kEffects[i].effect != static_cast<Effect>(i)) return false;
  return true;
}
static_assert(is_in_order(), "kEffects has a row for each Effect, in order");

constexpr const EffectRow& row_of(Effect effect) { return kEffects[static_cast<std::size_t>(effect)]; }

}  // namespace likeness::plan
