#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fit/result/result.h"
#include "render/image/picture.h"

// The drawings of the report, as inline SVG. Titles are escaped here.
namespace likeness::fit {

// A slice with its axes: theta_h to the right, theta_d up, 0 to 90 deg, and the cut as a dashed line.
// `title` is what a reader who does not see the picture is told.
std::string slice_figure(const image::DisplayPicture& picture, double cut_deg, std::string_view title);

// The axes alone, with the four regions named where they lie.
std::string regions_figure();

// The scale of difference_color() with its ends in words, and the hatch of what is not compared.
std::string difference_legend();

// Loss against iteration of the winning start, logarithmic up. Empty if there are fewer than two steps.
std::string convergence_figure(const std::vector<Step>& steps);

// The final loss of every start, the best on the left, logarithmic up. Empty if there are no starts.
std::string starts_figure(std::vector<double> losses);

}  // namespace likeness::fit
