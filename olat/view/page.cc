#include "olat/view/page.h"

namespace likeness::olat_view {

extern const std::string_view k_index_html, k_viewer_css, k_viewer_js, k_view_glsl, k_icon_svg;

std::optional<PageFile> page_file(std::string_view path) {
  if (path == "/") return PageFile{"text/html; charset=utf-8", k_index_html};
  if (path == "/viewer.css") return PageFile{"text/css; charset=utf-8", k_viewer_css};
  if (path == "/viewer.js") return PageFile{"text/javascript; charset=utf-8", k_viewer_js};
  if (path == "/view.glsl") return PageFile{"text/plain; charset=utf-8", k_view_glsl};
  if (path == "/icon.svg") return PageFile{"image/svg+xml", k_icon_svg};
  return std::nullopt;
}

}  // namespace likeness::olat_view
