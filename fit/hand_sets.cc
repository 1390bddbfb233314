#include "fit/hand_sets.h"

#include <cctype>
#include <string>

#include "render/image/tone_curve.h"

namespace likeness::fit {

namespace {

using Color = brdf::Rgb<double>;

// The slides give colors and tints as 8-bit sRGB.
Color srgb(int r, int g, int b) {
  const auto linear = [](int code) { return image::srgb_decode(code / 255.0); };
  return {linear(r), linear(g), linear(b)};
}

// In the order of the slides' parameters, so that a row can be held against its slide.
struct CallistoRow {
  Color base_color;
  double metallic, specular, roughness, diffuse_fresnel, diffuse_fresnel_falloff, retroreflection,
      retroreflection_falloff, smooth_terminator;
  Color diffuse_fresnel_tint, retroreflection_tint;
  double specular_fresnel_falloff, dual_specular_roughness_scale, dual_specular_opacity,
      diffuse_fresnel_tangent_falloff, retroreflection_tangent_falloff;
};
struct DisneyRow {
  Color base_color;
  double metallic, subsurface, specular, roughness, specular_tint, anisotropic, sheen, sheen_tint, clearcoat,
      clearcoat_gloss;
};
struct Row {
  std::string_view material;
  CallistoRow callisto;
  DisneyRow disney;
};

const Row kRows[] = {
    {"black-soft-plastic",
     {srgb(20, 20, 20), 0, 0.2, 0.6, 0.75, 0.7, 3, 0.7, 0, srgb(255, 255, 255), srgb(255, 255, 255), 0, 2, 0, 0.75,
      0.75},
     {srgb(20, 20, 20), 0, 0, 0.2, 0.6, 0, 0, 0, 0.5, 0, 1}},
    {"blue-fabric",
     {srgb(40, 42, 66), 0, 0.2, 0.77, 4, 0.6, 3, 0.5, 0, srgb(255, 218, 185), srgb(255, 255, 255), 0, 2, 0, 0.95, 0.75},
     {srgb(38, 44, 66), 0, 0, 0.25, 0.6, 0, 0, 0.15, 1, 0, 1}},
    {"yellow-phenolic",
     {srgb(152, 130, 93), 0, 0.5, 0.055, 0.8, 0.85, 0.3, 0.85, 0.25, srgb(255, 255, 255), srgb(255, 255, 255), 0.5,
      4.25, 0.15, 1, 1},
     {srgb(148, 125, 92), 0, 0, 0.5, 0.04, 0, 0, 0, 0.5, 1, 0.9}},
    {"yellow-plastic",
     {srgb(128, 124, 55), 0, 0.1, 0.5, 5, 0.6, 3.5, 0.25, 0, srgb(255, 200, 255), srgb(225, 191, 255), 0.375, 2, 0,
      0.85, 1},
     {srgb(130, 121, 56), 0, 0, 0.05, 0.5, 0, 0, 0, 0.5, 0, 1}},
    {"gold-metallic-paint2",
     {srgb(105, 86, 88), 0.85, 1, 0.21, 1, 0.5, 1, 0.5, 0, srgb(255, 255, 255), srgb(255, 255, 255), 0, 2, 0.9, 1,
      0.75},
     {srgb(105, 95, 84), 0.86, 0, 1, 0.45, 0.889, 0, 0.77, 0.5, 3, 0.75}},
    {"light-red-paint",
     {srgb(173, 58, 23), 0, 0.25, 0.8, 1, 0.5, 3.5, 0.5, 0.2, srgb(255, 255, 255), srgb(200, 240, 255), 0.4, 2, 0, 1,
      0.65},
     {srgb(173, 60, 27), 0, 0, 0.175, 0.55, 0, 0, 0, 0.5, 0, 1}},
    {"red-fabric2",
     {srgb(106, 29, 8), 0, 0.5, 1, 25, 0.6, 1.25, 0.5, -0.1, srgb(180, 160, 255), srgb(255, 0, 255), 0.5, 2, 0, 0.97,
      0.75},
     {srgb(105, 33, 10), 0, 0, 0.5, 1, 0, 0, 0.2, 1, 0, 1}},
    {"specular-red-phenolic",
     {srgb(154, 57, 32), 0, 0.55, 0.03, 0.6, 0.9, 0.5, 0.8, 0.2, srgb(255, 255, 255), srgb(255, 255, 255), 0.5, 4,
      0.125, 1, 0.95},
     {srgb(151, 58, 27), 0, 0, 0.5, 0.057, 0, 0, 0, 0.5, 0.35, 1}},
    {"two-layer-silver",
     {srgb(250, 250, 250), 0.37, 0.5, 0.027, 1, 0.5, 1, 0.5, 0, srgb(255, 255, 255), srgb(255, 255, 255), 0.5, 14, 0.18,
      1, 0.75},
     {srgb(125, 125, 125), 0.9, 0, 0.5, 0.41, 1, 0, 0.5, 1, 1, 0.9}},
    {"yellow-matte-plastic",
     {srgb(148, 97, 48), 0, 0.16, 0.165, 0.25, 0.75, 0.5, 0.85, 0.25, srgb(255, 255, 255), srgb(255, 255, 255), 0.25, 2,
      0.9, 1, 1},
     {srgb(145, 86, 43), 0, 0, 0.15, 0.3, 0, 0, 0, 0.5, 0, 1}},
};

std::string plain_name(std::string_view name) {
  std::string out;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

brdf::Callisto<double> model_of(const CallistoRow& r) {
  brdf::Callisto<double> m;
  m.base_color = r.base_color;
  m.metallic = r.metallic;
  m.specular = r.specular;
  m.roughness = r.roughness;
  m.diffuse_fresnel = r.diffuse_fresnel;
  m.diffuse_fresnel_falloff = r.diffuse_fresnel_falloff;
  m.retroreflection = r.retroreflection;
  m.retroreflection_falloff = r.retroreflection_falloff;
  m.smooth_terminator = r.smooth_terminator;
  m.diffuse_fresnel_tint = r.diffuse_fresnel_tint;
  m.retroreflection_tint = r.retroreflection_tint;
  m.specular_fresnel_falloff = r.specular_fresnel_falloff;
  m.dual_specular_roughness_scale = r.dual_specular_roughness_scale;
  m.dual_specular_opacity = r.dual_specular_opacity;
  m.diffuse_fresnel_tangent_falloff = r.diffuse_fresnel_tangent_falloff;
  m.retroreflection_tangent_falloff = r.retroreflection_tangent_falloff;
  return m;
}

brdf::Disney2012<double> model_of(const DisneyRow& r) {
  brdf::Disney2012<double> m;
  m.base_color = r.base_color;
  m.metallic = r.metallic;
  m.subsurface = r.subsurface;
  m.specular = r.specular;
  m.roughness = r.roughness;
  m.specular_tint = r.specular_tint;
  m.anisotropic = r.anisotropic;
  m.sheen = r.sheen;
  m.sheen_tint = r.sheen_tint;
  m.clearcoat = r.clearcoat;
  m.clearcoat_gloss = r.clearcoat_gloss;
  return m;
}

}  // namespace

std::optional<HandSet> hand_set_of(std::string_view material) {
  const std::string wanted = plain_name(material);
  for (const Row& row : kRows)
    if (plain_name(row.material) == wanted) return HandSet{model_of(row.callisto), model_of(row.disney)};
  return std::nullopt;
}

}  // namespace likeness::fit
