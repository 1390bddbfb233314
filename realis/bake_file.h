#pragma once

#include "realis/bake.h"
#include "render/baked/bake_file.h"

// The files of a bake are a room below, where renderers read them too.
namespace likeness::realis {

using baked::About;
using baked::bytes_of_texel;
using baked::kMostLobes;
using baked::quantised;
using baked::read_bake;
using baked::StoredBake;
using baked::write_bake;

}  // namespace likeness::realis
