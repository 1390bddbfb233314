#include "realis/surface_maps.h"

#include "render/baked/surface_maps.h"

namespace likeness::realis {
namespace {

baked::Surface surface_of(const capture_fit::Fit& fit) {
  return {fit.normals, fit.base_colors, fit.material, fit.exposure, fit.spread, fit.least};
}

void put(baked::Surface surface, capture_fit::Fit& fit) {
  fit.normals = std::move(surface.normals), fit.base_colors = std::move(surface.base_colors);
  fit.material = surface.material, fit.exposure = surface.exposure;
  fit.spread = surface.spread, fit.least = surface.least;
}

}  // namespace

capture_fit::Fit thin(const capture_fit::Fit& fit) {
  capture_fit::Fit out = fit;
  put(baked::thin(surface_of(fit)), out);
  return out;
}

void write_surface(const std::filesystem::path& folder, const capture_fit::Fit& fit) {
  baked::write_surface(folder, surface_of(fit));
}

capture_fit::Fit read_surface(const std::filesystem::path& folder, std::size_t camera) {
  capture_fit::Fit fit;
  fit.camera = camera;
  put(baked::read_surface(folder), fit);
  return fit;
}

}  // namespace likeness::realis
