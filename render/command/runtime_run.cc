#include <limits>

#include "render/command/integrators.h"
#include "render/runtime/pipeline.h"

namespace likeness::render_command {

Rendered render_runtime(const Job& job) {
  const image::Picture picture =
      runtime::Pipeline(job.world).frame(job.options.camera, job.settings, job.options.threads);
  Rendered out;
  out.layers.width = picture.width, out.layers.height = picture.height;
  out.layers.layers.push_back({"", {"R", "G", "B"}, picture.rgb});
  out.samples = static_cast<std::uint32_t>(job.settings.pixel_samples);
  for (const runtime::SettingRow& row : runtime::kSettings)
    out.settings.emplace_back(row.name, row.levels[row.level_of(job.settings)]);
  out.relative_error = std::numeric_limits<double>::infinity();
  return out;
}

}  // namespace likeness::render_command
