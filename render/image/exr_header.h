#pragma once

#include <string>
#include <string_view>

namespace likeness::image {

// Looks at the attributes of an EXR's headers before OpenEXR does, which asks for the memory that a length names before
// it reads, and does not see that a list runs beyond its attribute. Refuses, with files::InputError: headers that end
// too early, attributes longer than what is left of the file or of another size than their type has, channel lists,
// lists of texts and previews that do not fill their attribute, and id manifests, which nobody needs here.
void check_exr_header(std::string_view bytes, const std::string& name);

}  // namespace likeness::image
