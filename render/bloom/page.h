#pragma once

#include <string>

#include "render/bloom/fit.h"

namespace likeness::bloom {

// A fit in words, as JSON (the kernel, and how it was found), and as a page.
std::string summary_of(const Fit& fit);
std::string json_of(const Fit& fit);
std::string page_of(const Fit& fit, const std::string& source, const std::string& glare);

}  // namespace likeness::bloom
