#pragma once

#include <cstddef>
#include <string>

#include "render/capture/capture.h"

// What a user's words on the command line name in a capture. Throw files::UsageError.
namespace likeness::realis {

std::size_t camera_named(const capture::Capture& capture, const std::string& id);  // empty: the first
std::size_t variant_named(const capture::Capture& capture, const std::string& id, const std::string& way_out);

}  // namespace likeness::realis
