#pragma once

#include <string>

#include "render/scene/scene.h"

// Which views there are, and which one is used, in words for a command line.
namespace likeness::view {

// The own views, and every display and view of the OpenColorIO config that is named or that $OCIO names, one a line. Throws
// files::InputError for a config that cannot be read.
std::string list_text(const std::string& config);

// What is left open, chosen: without a name that of the config which is named or which $OCIO names, on `display` or else on its
// default display, the default view; and "gt", built in, where there is no config. Throws files::InputError for a config that
// cannot be read, and a display that it does not have.
scene::View with_defaults(const scene::View& view);

// "gt, built in", or "'Un-tone-mapped' on 'sRGB - Display' of studio.ocio ($OCIO)". The view has a name.
std::string origin_text(const scene::View& view);

}  // namespace likeness::view
