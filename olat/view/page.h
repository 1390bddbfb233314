#pragma once

#include <optional>
#include <string_view>

// The page of olat/viewer, which the build puts into the program.
namespace likeness::olat_view {

struct PageFile {
  std::string_view type, text;
};

// "/", "/viewer.js", "/viewer.css", "/view.glsl", "/icon.svg"; nothing for other paths.
std::optional<PageFile> page_file(std::string_view path);

}  // namespace likeness::olat_view
