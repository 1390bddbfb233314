#include <nlohmann/json.hpp>

#include "render/baked/format.h"
#include "render/baked/surface_maps.h"
#include "render/files/files.h"
#include "render/image/write.h"
#include "render/material/material_file.h"

namespace likeness::baked {

void write_surface(const std::filesystem::path& folder, const Surface& surface) {
  const ThinSurface pictures = packed(surface);
  image::write_png(folder / kNormals, pictures.normals);
  image::write_png(folder / kColors, pictures.colors);
  material::write_material(folder / kMaterial, {"what a Realis bake was baked over", surface.material});
  const nlohmann::ordered_json numbers{
      {"scale", pictures.scale}, {"exposure", surface.exposure}, {"spread", surface.spread}, {"least", surface.least}};
  files::write_whole(folder / kSurfaceFile, numbers.dump(1) + "\n");
}

}  // namespace likeness::baked
