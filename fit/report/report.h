#pragma once

#include <string>

#include "fit/measured/measured.h"
#include "fit/result/result.h"

namespace likeness::fit {

// The report of one fit: one HTML page that needs nothing outside itself (pictures and styles are inside) and no
// script. `material` is what result was fitted to; its slice and spheres are the reference.
std::string report_html(const Result& result, const measured::Material& material);

// `likeness fit ...` as a shell takes it, with the options that lead to this result.
std::string command_line(const Result& result);

}  // namespace likeness::fit
