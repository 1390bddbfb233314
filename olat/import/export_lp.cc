#include "olat/import/export_lp.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "olat/import/light_lists.h"
#include "render/files/files.h"

namespace likeness::olat_import {

Exported export_lp(const capture::Capture& capture, std::size_t camera, const std::filesystem::path& file) {
  Exported out;
  std::vector<ListedLight> lights;
  const capture::FrameTable table(capture);
  const glm::dmat3 camera_from_world = glm::transpose(glm::dmat3(capture.cameras[camera].world_from_camera));
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  for (std::size_t l = 0; l < capture.lights.size(); ++l) {
    const std::size_t frame = table.frame(camera, l);
    const capture::Light& light = capture.lights[l];
    const auto* distant = std::get_if<capture::DistantLight>(&light.place);
    const auto* near = std::get_if<capture::NearLight>(&light.place);
    const glm::dvec3 to_light = distant ? distant->to_light : near ? near->position : glm::dvec3(0);
    if (frame == capture::kAbsent || !(glm::length(to_light) > 1e-9)) {
      ++out.left_out;
      continue;
    }
    out.near += near != nullptr;
    const glm::dvec3 v = camera_from_world * glm::normalize(to_light);
    ListedLight& one = lights.emplace_back();
    one.light.place = capture::DistantLight{{v.x, -v.y, -v.z}};
    std::error_code error;
    const auto photo = std::filesystem::absolute(photo_file(capture, capture.frames[frame]));
    const auto relative = std::filesystem::relative(photo, folder, error);
    one.file = (error || relative.empty() ? photo : relative).string();
  }
  if (lights.empty())
    throw files::InputError(capture.root.string() + ": camera " + files::in_quotes(capture.cameras[camera].id) +
                            " has no photograph under a light whose place is known");
  out.lights = lights.size();
  files::write_whole(file, lp_text(lights));
  return out;
}

}  // namespace likeness::olat_import
