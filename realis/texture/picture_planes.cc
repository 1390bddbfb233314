#include "realis/texture/picture_planes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "render/capture/sight.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"

namespace likeness::realis {
namespace {

constexpr std::size_t kPicturesAtOnce = 4;
constexpr int kMostLooks = 8;  // along each side of a texel

// The upper half of a float: a relative error of 1/256, in the same order.
std::uint16_t coarse(float x) { return static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(x) >> 16); }
float fine(std::uint16_t x) { return std::bit_cast<float>(std::uint32_t{x} << 16); }
constexpr std::uint16_t kUnknown = 0xffff;  // NaN

weight::Color color_at(const image::Picture& picture, std::size_t pixel) {
  return {picture.rgb[3 * pixel], picture.rgb[3 * pixel + 1], picture.rgb[3 * pixel + 2]};
}

// The light that a pixel's surface receives.
struct Received {
  double cosine, irradiance;
};
Received received_of(const capture::Light& light, const PictureSurface& picture, std::size_t i) {
  const capture::Shine shine = capture::shine_of(light, glm::dvec3(picture.positions[i]));
  return {glm::dot(glm::dvec3(picture.normals[i]), shine.to_light), shine.irradiance};
}

}  // namespace

weight::Choice streamed(weight::Choice choice, std::vector<std::string>& left_out) {
  for (std::size_t i = 0; i < weight::kWeights.size(); ++i)
    if (choice.is_on[i] && std::find(kStreamedWeights.begin(), kStreamedWeights.end(), weight::kWeights[i].name) ==
                               kStreamedWeights.end()) {
      choice.is_on[i] = false;
      left_out.emplace_back(weight::kWeights[i].name);
    }
  return choice;
}

void must_stream(const weight::Choice& choice) {
  std::vector<std::string> others;
  streamed(choice, others);
  if (!others.empty())
    throw files::UsageError("--with " + others[0] +
                            " compares all pictures of a camera at once, and a mesh is baked light by light; leave it "
                            "out, or bake a camera's picture without --scene");
}

LitLevels lit_levels(const capture::Capture& capture, const capture::Variant& variant, std::size_t camera,
                     const std::vector<std::size_t>& lights, const PictureSurface& picture, const GoesOn& goes_on) {
  std::vector<std::size_t> used;
  const std::size_t pixels = picture.pixels.size();
  const std::size_t most = std::max<std::size_t>(kMostLitBytes / std::max<std::size_t>(4 * pixels, 1), 1);
  const std::size_t stride = (lights.size() + most - 1) / most;
  const capture::FrameTable frames(capture);
  for (std::size_t i = 0; i < lights.size(); i += stride)
    if (frames.frame(camera, lights[i]) != capture::kAbsent) used.push_back(lights[i]);
  const std::size_t count = used.size();
  LitLevels out{std::vector<float>(pixels), std::vector<float>(pixels)};
  if (count == 0) return out;
  const capture::CameraLayers layers = capture::read_camera_layers(capture, camera);
  std::vector<std::uint16_t> photos(pixels * count, kUnknown), renders(pixels * count, kUnknown);
  for (std::size_t begin = 0; begin < count; begin += kPicturesAtOnce) {
    if (!goes_on(static_cast<double>(begin) / static_cast<double>(count), "what is lit")) throw files::Interrupted();
    tbb::parallel_for(begin, std::min(begin + kPicturesAtOnce, count), [&](std::size_t i) {
      const capture::Light& light = capture.lights[used[i]];
      const capture::Photo photo = capture::read_photo(capture, frames.frame(camera, used[i]), layers);
      const image::Picture render = capture::read_render(capture, variant, camera, used[i]);
      for (std::size_t p = 0; p < pixels; ++p) {
        const auto [cosine, irradiance] = received_of(light, picture, p);
        const std::size_t pixel = picture.pixels[p];
        if (!(cosine > weight::kLeastShadowCosine && irradiance > 0)) continue;
        const double scale = 1 / (cosine * irradiance);
        if ((photo.flaws[pixel] & capture::kNotFinite) == 0)
          photos[p * count + i] = coarse(static_cast<float>(weight::luminance(color_at(photo.light, pixel)) * scale));
        const double shown = weight::luminance(color_at(render, pixel)) * scale;
        if (std::isfinite(shown)) renders[p * count + i] = coarse(static_cast<float>(shown));
      }
    });
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels, 4096), [&](const auto& range) {
    std::vector<double> values;
    const auto level = [&](const std::vector<std::uint16_t>& of, std::size_t p) {
      values.clear();
      for (std::size_t i = 0; i < count; ++i)
        if (const std::uint16_t x = of[p * count + i]; x != kUnknown) values.push_back(static_cast<double>(fine(x)));
      return static_cast<float>(weight::quantile(values, weight::kLitShare));
    };
    for (std::size_t p = range.begin(); p < range.end(); ++p)
      out.photo[p] = level(photos, p), out.render[p] = level(renders, p);
  });
  return out;
}

PicturePlanes planes_of(const capture::Capture& capture, const capture::Variant& variant, std::size_t frame,
                        const capture::CameraLayers& layers, const PictureSurface& picture, const LitLevels& lit,
                        const weight::Choice& choice, Channels channels, LightCensus& census) {
  const std::size_t camera = capture.frames[frame].camera, light = capture.frames[frame].light;
  PicturePlanes out;
  out.width = capture.cameras[camera].width, out.height = capture.cameras[camera].height;
  out.channels = channels == Channels::kRgb ? 3 : 1;
  const std::size_t all = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
  const std::size_t pixels = picture.pixels.size();
  std::vector<weight::Color> photos(pixels), renders(pixels);
  std::vector<float> weights(pixels, 1.0f);
  {
    const capture::Photo photo = capture::read_photo(capture, frame, layers);
    const image::Picture render = capture::read_render(capture, variant, camera, light);
    for (std::size_t p = 0; p < pixels; ++p) {
      const std::size_t pixel = picture.pixels[p];
      photos[p] = color_at(photo.light, pixel), renders[p] = color_at(render, pixel);
      if ((photo.flaws[pixel] & capture::kMasked) != 0) weights[p] = 0;
      else {
        census.add(photos[p], photo.flaws[pixel]);
        if ((photo.flaws[pixel] & (capture::kClipped | capture::kNotFinite)) != 0) weights[p] = 0;
      }
      if (!std::isfinite(renders[p][0] + renders[p][1] + renders[p][2])) weights[p] = 0;
    }
  }
  weight::Samples samples;
  const glm::dvec3 anywhere(0, 0, 1);
  samples.width = out.width, samples.height = out.height, samples.pixels = picture.pixels;
  samples.to_lights = std::span(&anywhere, 1), samples.photo = photos, samples.render = renders;
  if (choice.is_on[weight::weight_named("clipped")]) {
    const weight::Weights w = weight::clipped(samples, choice.settings.clipped);
    for (std::size_t p = 0; p < pixels; ++p) weights[p] *= w[p];
  }

  if (choice.is_on[weight::weight_named("shadow")] && !lit.photo.empty()) {
    const float unknown = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> photo(all, unknown), render(all, unknown);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels, 1 << 14), [&](const auto& range) {
      for (std::size_t p = range.begin(); p < range.end(); ++p) {
        const auto [cosine, irradiance] = received_of(capture.lights[light], picture, p);
        if (!(cosine > weight::kLeastShadowCosine && irradiance > 0)) continue;
        const auto visible = [&](const weight::Color& shown, float level) {
          return level > 0
                     ? static_cast<float>(weight::luminance(shown) / (cosine * irradiance * static_cast<double>(level)))
                     : unknown;
        };
        photo[picture.pixels[p]] = visible(photos[p], lit.photo[p]);
        render[picture.pixels[p]] = visible(renders[p], lit.render[p]);
      }
    });
    const std::vector<float> w = weight::shadow_of_light(out.width, out.height, photo, render, choice.settings.shadow);
    for (std::size_t p = 0; p < pixels; ++p) weights[p] *= w[picture.pixels[p]];
  }

  out.weight.resize(all), out.residual.resize(all * out.channels), out.photo.resize(all);
  for (std::size_t p = 0; p < pixels; ++p) {
    const std::size_t pixel = picture.pixels[p];
    out.weight[pixel] = weights[p];
    if (!(weights[p] > 0)) continue;
    out.photo[pixel] = static_cast<float>(weight::luminance(photos[p]));
    if (out.channels == 1)
      out.residual[pixel] = static_cast<float>(weight::luminance(photos[p]) - weight::luminance(renders[p]));
    else
      for (std::size_t c = 0; c < 3; ++c) out.residual[3 * pixel + c] = photos[p][c] - renders[p][c];
  }
  return out;
}

Look look_at(const PicturePlanes& planes, const Seen& seen) {
  const auto looks = [](const std::array<float, 2>& step) {
    return std::clamp(static_cast<int>(std::ceil(std::hypot(step[0], step[1]))), 1, kMostLooks);
  };
  const int across = looks(seen.right), along = looks(seen.down);
  Look out;
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < across; ++i) {
      const float a = (static_cast<float>(i) + 0.5f) / static_cast<float>(across) - 0.5f;
      const float b = (static_cast<float>(j) + 0.5f) / static_cast<float>(along) - 0.5f;
      const float x = seen.x + a * seen.right[0] + b * seen.down[0] - 0.5f;
      const float y = seen.y + a * seen.right[1] + b * seen.down[1] - 0.5f;
      if (!(x > -1 && y > -1 && x < static_cast<float>(planes.width) && y < static_cast<float>(planes.height)))
        continue;
      const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
      const float tx = x - static_cast<float>(x0), ty = y - static_cast<float>(y0);
      for (const int dy : {0, 1})
        for (const int dx : {0, 1}) {
          const int px = x0 + dx, py = y0 + dy;
          if (px < 0 || py < 0 || px >= planes.width || py >= planes.height) continue;
          const std::size_t pixel =
              static_cast<std::size_t>(py) * static_cast<std::size_t>(planes.width) + static_cast<std::size_t>(px);
          const float w = (dx == 1 ? tx : 1 - tx) * (dy == 1 ? ty : 1 - ty) * planes.weight[pixel];
          if (!(w > 0)) continue;
          out.weight += w, out.photo += w * planes.photo[pixel];
          for (std::size_t c = 0; c < planes.channels; ++c)
            out.residual[c] += w * planes.residual[planes.channels * pixel + c];
        }
    }
  if (out.weight > 0) {
    out.photo /= out.weight;
    for (float& e : out.residual) e /= out.weight;
    out.weight /= static_cast<float>(across * along);
  }
  return out;
}

}  // namespace likeness::realis
