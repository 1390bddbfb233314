#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>

#include "realis/texture/light_file.h"
#include "realis/texture/picture_planes.h"
#include "realis/texture/sight.h"
#include "realis/texture/texture_bake.h"
#include "realis/texture/tiles.h"
#include "render/files/interrupt.h"

namespace likeness::realis {

// One baking: what its steps share.
class Baking {
 public:
  Baking(const capture::Capture& capture, const scene::Scene& scene, const TextureBakeOptions& options,
         const std::filesystem::path& folder, const GoesOn& goes_on);

  TextureBake run();

 private:
  std::size_t channels() const { return options_.bake.channels == Channels::kRgb ? 3 : 1; }
  std::size_t texels() const { return unwrapped_.pixels.size(); }
  const capture::Variant& variant() const { return capture_.variants[options_.variant]; }
  const scene::Instance& object() const { return scene_.instances[instance_]; }
  bool has_frame(std::size_t camera, std::size_t light) const {
    return frames_.frame(camera, light) != capture::kAbsent;
  }
  void ask(double share, const std::string& what) const {
    if (!goes_on_(share, what)) throw files::Interrupted();
  }
  void find_cameras_and_lights();
  std::string digest() const;
  std::string mesh_digest() const;
  glm::dmat3 model_from_world() const;
  std::filesystem::path work_file(const char* name, std::size_t index) const;
  void find_sights();
  void find_samples();
  LightSamples samples_of(std::size_t i, std::vector<capture::CameraLayers>& layers,
                          const std::vector<LitLevels>& lit) const;
  std::vector<LitLevels> find_lit() const;
  Basis choose();
  void solve(const Basis& basis);
  void write(const TileSolve& solve, const std::vector<double>& largest);

  const capture::Capture& capture_;
  const TextureBakeOptions& options_;
  std::filesystem::path folder_, work_;
  const GoesOn& goes_on_;
  capture::FrameTable frames_;
  scene::Scene scene_;
  world::World world_;
  scene::Index instance_;

  std::vector<std::size_t> cameras_, lights_;
  glm::dvec3 middle_{0};  // of the object
  std::vector<double> irradiance_;
  double mean_irradiance_ = 1;
  Unwrapped unwrapped_;
  TexelSurface surface_;
  std::vector<CameraSight> sights_;
  std::vector<std::uint32_t> candidates_;
  std::vector<LightFile> samples_;
  std::string digest_;
  TextureBake out_;
};

}  // namespace likeness::realis
