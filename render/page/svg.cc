#include "render/page/svg.h"

#include "render/page/html.h"

namespace likeness::page {

std::string svg_text(double x, double y, std::string_view anchor, std::string_view content, double size,
                     std::string_view more) {
  return "<text x=\"" + number(x, 5) + "\" y=\"" + number(y, 5) + "\" font-size=\"" + number(size) +
         "\" text-anchor=\"" + std::string(anchor) + "\"" + std::string(more) + ">" + std::string(content) + "</text>";
}

std::string svg_line(double x1, double y1, double x2, double y2, std::string_view style) {
  return "<line x1=\"" + number(x1, 5) + "\" y1=\"" + number(y1, 5) + "\" x2=\"" + number(x2, 5) + "\" y2=\"" +
         number(y2, 5) + "\" " + std::string(style) + "/>";
}

std::string drawing(std::string_view view_box, std::string_view title, std::string_view content) {
  return "<svg viewBox=\"" + std::string(view_box) + "\" role=\"img\" aria-label=\"" + escape(title) + "\">" +
         element("title", title) + std::string(content) + "</svg>";
}

}  // namespace likeness::page
