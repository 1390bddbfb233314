#pragma once

#include <array>
#include <stdexcept>
#include <string>

#include "olat/calibrate/opencv_module.h"
#include "render/files/module.h"

namespace likeness::olat_calibrate {

inline constexpr files::Module kOpenCv{kOpenCvFile, "lenses and charts", "OpenCV"};

// The module's function of that type and name, called; its message becomes std::runtime_error.
template <class Function, class... Arguments>
void call_opencv(const char* name, Arguments... arguments) {
  const auto function = reinterpret_cast<Function>(files::module_function(kOpenCv, name));
  std::array<char, 512> error{};
  if (function(arguments..., error.data(), error.size()) != 0)
    throw std::runtime_error(std::string(kOpenCvFile) + ": " + error.data());
}

}  // namespace likeness::olat_calibrate
