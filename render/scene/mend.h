#pragma once

#include <string>

#include "render/scene/loading.h"
#include "render/scene/scene.h"

namespace likeness::scene {

enum class Normals { kFile, kSmooth, kFlat };

// Makes a mesh fit to be traced, and counts what that took in loading's repairs:
//   - triangles with a repeated or an absent corner, with a corner that is no number or farther out than kFarthest, or
//     without area (less than 1e-8 of their longest edge squared) are left out;
//   - a position that is no number becomes that of a sound vertex, so that bounds are bounds;
//   - normals become unit; one without length or that is no number becomes the angle-weighted mean of its triangles;
//   - texture coordinates that are no numbers become 0;
//   - tangents are made square to the normals and unit; if one cannot be, all are left out and made anew where needed.
// Normals kSmooth makes them all by the angle-weighted mean (G. Thuermer, C. Wuethrich, "Computing vertex normals from
// polygonal facets", Journal of Graphics Tools 3(1), 1998); kFlat leaves none.
void mend(Mesh& mesh, Normals normals, const std::string& where, Loading& loading);

// Tangents for a normal map, from positions and texture coordinates: each vertex takes the mean of the directions of
// rising u in its triangles, weighted by their angles there, made square to its normal and unit. w is the side on which
// V runs upwards (against v), by the weighted majority of its triangles: a vertex that two mirrored halves of a texture
// share belongs to the larger. Where u has no direction, any one square to the normal. Needs uvs.
void make_tangents(Mesh& mesh, const std::string& where, Loading& loading);

// Turns v upside down: 1 - v.
void flip_v(Mesh& mesh);

}  // namespace likeness::scene
