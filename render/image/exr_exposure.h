#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace likeness::image {

// How a picture was taken, by the standard attributes of its EXR: expTime [s], isoSpeed, aperture [f-number].
struct ExrExposure {
  std::optional<double> exposure_s, iso, f_number;
};

// Of the first part of an EXR in memory; nothing of what is no EXR. Throws files::InputError, one line that begins with
// `name`, for a damaged header.
ExrExposure exposure_of_exr(std::string_view bytes, const std::string& name);

}  // namespace likeness::image
