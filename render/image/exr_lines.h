#pragma once

#include <ImfInputPart.h>

#include <span>

#include "render/image/exr_part.h"

namespace likeness::image {

// What read_channels does, for scan lines that are stored plain, ZIPS or ZIP with all channels at every pixel: blocks of
// lines are inflated by TBB's threads and go straight to their targets, in about half of the CPU time of OpenEXR's frame
// buffers. False, and nothing is written, for a part of another kind. Throws what OpenEXR throws, and
// std::runtime_error for a block that is not whole.
bool read_zip_lines(Imf::InputPart& part, std::span<const ChannelTarget> targets);

}  // namespace likeness::image
