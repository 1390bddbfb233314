#include "realis/subject.h"

#include <algorithm>
#include <limits>
#include <string>

#include <tbb/parallel_for.h>

#include "realis/weight/samples.h"
#include "render/capture/pixels.h"
#include "render/capture/sight.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"

namespace likeness::realis {

void LightCensus::add(const std::array<float, 3>& photo, std::uint8_t flaws) {
  ++samples;
  if ((flaws & capture::kNotFinite) != 0) ++not_finite;
  else if ((flaws & capture::kClipped) != 0) ++clipped;
  else {
    const double shown = weight::luminance(photo);
    negative += shown < 0 ? 1 : 0, sum += shown;
  }
}

Subject read_subject(const capture::Capture& capture, std::size_t camera, const Renderer& render,
                     std::span<const std::size_t> leave_out, const GoesOn& goes_on) {
  const capture::FrameTable frames(capture);
  const capture::CameraLayers layers = capture::read_camera_layers(capture, camera);
  Subject s;
  s.camera = camera;
  s.width = capture.cameras[camera].width, s.height = capture.cameras[camera].height;
  for (std::size_t light = 0; light < capture.lights.size(); ++light) {
    if (frames.frame(camera, light) == capture::kAbsent || !capture::has_place(capture.lights[light])) continue;
    if (std::find(leave_out.begin(), leave_out.end(), light) != leave_out.end()) continue;
    const capture::Shine shine = capture::shine_of(capture.lights[light], glm::dvec3(0));
    if (!(shine.irradiance > 0)) continue;
    s.lights.push_back(light), s.to_lights.push_back(shine.to_light), s.irradiance.push_back(shine.irradiance);
  }
  if (s.lights.empty())
    throw files::UsageError(
        "camera " + files::in_quotes(capture.cameras[camera].id) +
        " has no photograph under a light whose direction is known; `likeness olat calibrate` finds "
        "directions, `likeness olat check` says what is missing");
  for (std::size_t i = 0; i < layers.mask.size(); ++i)
    if (layers.mask[i] != 0) s.pixels.push_back(static_cast<std::uint32_t>(i));

  const std::size_t lights = s.lights.size(), samples = s.texels() * lights;
  s.photo.resize(samples), s.render.resize(samples), s.cosine.assign(samples, 1.0f), s.weight.assign(samples, 1.0f);
  s.census.resize(lights);
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  if (std::any_of(s.lights.begin(), s.lights.end(),
                  [&](std::size_t light) { return frames.crossed(camera, light) != capture::kAbsent; }))
    s.crossed.assign(samples, {kNone, kNone, kNone});
  // A few photographs at a time: each is read, and strewn over the texels.
  constexpr std::size_t kAtOnce = 8;
  for (std::size_t begin = 0; begin < lights; begin += kAtOnce) {
    if (!goes_on(static_cast<double>(begin) / static_cast<double>(lights), "reading photographs"))
      throw files::Interrupted();
    const std::size_t end = std::min(begin + kAtOnce, lights);
    std::vector<capture::Photo> photos(end - begin), crossed(end - begin);
    std::vector<Rendered> renders(end - begin);
    tbb::parallel_for(begin, end, [&](std::size_t i) {
      photos[i - begin] = capture::read_photo(capture, frames.frame(camera, s.lights[i]), layers);
      renders[i - begin] = render(s.lights[i]);
      const std::size_t pair = frames.crossed(camera, s.lights[i]);
      if (pair != capture::kAbsent) crossed[i - begin] = capture::read_photo(capture, pair, layers);
    });
    tbb::parallel_for(std::size_t{0}, s.texels(), [&](std::size_t texel) {
      const std::size_t pixel = s.pixels[texel];
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t sample = s.samples_of(texel) + i;
        const capture::Photo& photo = photos[i - begin];
        const Rendered& rendered = renders[i - begin];
        for (std::size_t c = 0; c < 3; ++c) {
          s.photo[sample][c] = photo.light.rgb[3 * pixel + c];
          s.render[sample][c] = rendered.light.rgb[3 * pixel + c];
        }
        if (!rendered.cosine.empty()) s.cosine[sample] = rendered.cosine[pixel];
        const capture::Photo& pair = crossed[i - begin];
        if (!pair.flaws.empty() && (pair.flaws[pixel] & (capture::kClipped | capture::kNotFinite)) == 0)
          std::copy_n(pair.light.rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel), 3, s.crossed[sample].begin());
        // Black is what a shadow is, too: only what the sensor could not hold says nothing.
        if ((photo.flaws[pixel] & (capture::kClipped | capture::kNotFinite)) != 0) s.weight[sample] = 0;
      }
    });
    for (std::size_t i = begin; i < end; ++i)
      for (const std::uint32_t pixel : s.pixels) {
        const float* rgb = photos[i - begin].light.rgb.data() + 3 * std::size_t{pixel};
        s.census[i].add({rgb[0], rgb[1], rgb[2]}, photos[i - begin].flaws[pixel]);
      }
  }
  return s;
}

}  // namespace likeness::realis
