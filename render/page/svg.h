#pragma once

#include <string>
#include <string_view>

// Small pieces of drawings, as inline SVG. Coordinates are the drawing's own units.
namespace likeness::page {

// Text whose baseline starts, has its middle or ends at (x, y); `content` is markup: escape() what is not the page's
// own. `more` is attributes, with a space before them.
std::string svg_text(double x, double y, std::string_view anchor, std::string_view content, double size = 8,
                     std::string_view more = "");

// `style` is attributes: stroke="#555" and so on.
std::string svg_line(double x1, double y1, double x2, double y2, std::string_view style);

// A whole drawing. `title` is what a reader who does not see it is told; it is escaped here.
std::string drawing(std::string_view view_box, std::string_view title, std::string_view content);

}  // namespace likeness::page
