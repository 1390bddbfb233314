#pragma once

#include <filesystem>

#include "realis/texture/texel_surface.h"

namespace likeness::realis {

// What the mesh was when it was baked, texel by texel, below the bake's folder: base_color.png, normal.png (in the axes of the
// object), surface.json and surface.material.json of render/baked/surface_maps.h; and
//
//     roughness.png    8 bit, b / 255, of the (first) specular lobe; only if the material has one
//
// The material is that of the object if it is Callisto, else Callisto's default.
void write_property_maps(const world::World& world, scene::Index instance, const Unwrapped& unwrapped,
                         const std::filesystem::path& folder);

}  // namespace likeness::realis
