#include "realis/named.h"

#include <string_view>
#include <vector>

#include "render/files/files.h"

namespace likeness::realis {
namespace {

std::size_t named(const char* option, const std::string& id, std::size_t found,
                  const std::vector<std::string_view>& names, const std::string& way_out) {
  if (found != capture::kAbsent) return found;
  const std::string near = files::nearest_name(id, names.data(), names.size());
  throw files::UsageError(std::string(option) + " " + files::in_quotes(id) + " is not in the capture" +
                          (near.empty() ? "" : "; did you mean " + files::in_quotes(near) + "?") +
                          (way_out.empty() ? "" : "; " + way_out));
}

}  // namespace

std::size_t camera_named(const capture::Capture& capture, const std::string& id) {
  if (id.empty()) return 0;
  std::vector<std::string_view> names;
  for (const capture::Camera& camera : capture.cameras) names.push_back(camera.id);
  return named("--camera", id, capture::camera_of(capture, id), names, "");
}

std::size_t variant_named(const capture::Capture& capture, const std::string& id, const std::string& way_out) {
  std::vector<std::string_view> names;
  for (const capture::Variant& variant : capture.variants) names.push_back(variant.id);
  return named("--variant", id, capture::variant_of(capture, id), names, way_out);
}

}  // namespace likeness::realis
