#include "render/view/view_list.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "render/files/files.h"
#include "render/view/color_config.h"
#include "render/view/view.h"

namespace likeness::view {
namespace {

bool is_built_in(const scene::View& view) {
  return view.config.empty() && view.display.empty() &&
         std::find(kOwnViews.begin(), kOwnViews.end(), view.name) != kOwnViews.end();
}

std::string file_text(const ConfigViews& config) { return config.file + (config.is_of_environment ? " ($OCIO)" : ""); }

}  // namespace

std::string list_text(const std::string& config) {
  std::string out = "Built in\n";
  for (const std::string_view name : kOwnViews) out += "  " + std::string(name) + "\n";
  const auto found = views_of_config(config);
  if (!found) return out + "No OpenColorIO config: --ocio FILE or $OCIO names one; gt is the default\n";
  out += "OpenColorIO config " + file_text(*found) + "; the first of each list is its default\n";
  for (const ConfigDisplay& display : found->displays) {
    out += "  --display " + files::in_quotes(display.name) + "\n";
    for (const std::string& name : display.views) out += "    --view " + files::in_quotes(name) + "\n";
  }
  return out;
}

scene::View with_defaults(const scene::View& view) {
  if (!view.name.empty()) return view;
  scene::View out = view;
  const auto found = views_of_config(view.config);
  if (!found && view.display.empty()) {
    out.name = "gt";
    return out;
  }
  if (!found)
    throw files::InputError("display " + files::in_quotes(view.display) +
                            ": no OpenColorIO config is named (by --ocio or by $OCIO)");
  std::vector<std::string_view> names;
  for (const ConfigDisplay& display : found->displays) {
    names.push_back(display.name);
    if (!view.display.empty() && display.name != view.display) continue;
    out.display = display.name;
    if (display.views.empty())
      throw files::InputError(file_text(*found) + ": display " + files::in_quotes(display.name) + " has no views");
    out.name = display.views.front();
    return out;
  }
  if (view.display.empty()) throw files::InputError(file_text(*found) + ": has no displays");
  const std::string near = files::nearest_name(view.display, names.data(), names.size());
  throw files::InputError(file_text(*found) + ": has no display " + files::in_quotes(view.display) +
                          (near.empty() ? "; --list shows those that it has" : "; did you mean " + near + "?"));
}

std::string origin_text(const scene::View& view) {
  if (is_built_in(view)) return view.name + ", built in";
  const auto found = views_of_config(view.config);
  if (!found) return files::in_quotes(view.name);
  const std::string display = !view.display.empty()     ? view.display
                              : found->displays.empty() ? ""
                                                        : found->displays.front().name;
  return files::in_quotes(view.name) + " on " + files::in_quotes(display) + " of " + file_text(*found);
}

}  // namespace likeness::view
