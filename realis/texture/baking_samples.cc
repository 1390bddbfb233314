#include <algorithm>
#include <random>

#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "realis/texture/baking.h"
#include "render/capture/sight.h"

// From pictures to what all cameras say of each texel under each light.
namespace likeness::realis {
namespace {

constexpr std::size_t kCandidates = 2048;  // to choose lobes by
constexpr std::size_t kCamerasAtOnce = 2;

}  // namespace

void Baking::find_sights() {
  ask(0, "drawing texels");
  unwrapped_ = unwrap(scene_.meshes[object().mesh], options_.resolution, object().name);
  surface_ = surface_of(world_, instance_, unwrapped_);
  for (const glm::vec3& p : surface_.positions)
    middle_ += glm::dvec3(p) / static_cast<double>(std::max<std::size_t>(texels(), 1));
  for (const std::size_t light : lights_)
    irradiance_.push_back(capture::shine_of(capture_.lights[light], middle_).irradiance);
  mean_irradiance_ = std::accumulate(irradiance_.begin(), irradiance_.end(), 0.0) / static_cast<double>(lights_.size());
  if (!(mean_irradiance_ > 0)) mean_irradiance_ = 1;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    ask(static_cast<double>(i) / static_cast<double>(cameras_.size()), "what cameras see");
    sights_.push_back(sight_of(world_, instance_, unwrapped_, surface_, capture_.cameras[cameras_[i]]));
  }
  if (options_.weights.is_on[weight::weight_named("stretch")]) stretch_all(sights_, options_.weights.settings.stretch);

  std::vector<std::uint8_t> is_seen(texels(), 0);
  for (const CameraSight& sight : sights_)
    for (const Seen& seen : sight.seen) is_seen[seen.texel] = 1, ++out_.texels_of_cameras;
  for (std::size_t t = 0; t < texels(); ++t)
    if (is_seen[t] != 0) candidates_.push_back(static_cast<std::uint32_t>(t));
  out_.census.texels = texels(), out_.census.unseen = texels() - candidates_.size();
  std::mt19937_64 random(options_.bake.seed);
  const std::size_t count = std::min(kCandidates, candidates_.size());
  for (std::size_t i = 0; i < count; ++i)
    std::swap(candidates_[i], candidates_[i + random() % (candidates_.size() - i)]);
  candidates_.resize(count);
  std::sort(candidates_.begin(), candidates_.end());
}

std::vector<LitLevels> Baking::find_lit() const {
  std::vector<LitLevels> out(cameras_.size());
  if (!options_.weights.is_on[weight::weight_named("shadow")]) return out;
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    out[i] =
        lit_levels(capture_, variant(), cameras_[i], lights_, sights_[i].picture, [&](double share, std::string_view) {
          return goes_on_((static_cast<double>(i) + share) / static_cast<double>(cameras_.size()),
                          "reading pictures for what is lit");
        });
  return out;
}

LightSamples Baking::samples_of(std::size_t i, std::vector<capture::CameraLayers>& layers,
                                const std::vector<LitLevels>& lit) const {
  const capture::Light& light = capture_.lights[lights_[i]];
  LightSamples out;
  out.weights.resize(texels()), out.residuals.resize(texels() * channels()),
      out.candidates.resize(3 * candidates_.size());
  const bool has_stretch = options_.weights.is_on[weight::weight_named("stretch")];
  const auto stretch_of = [&](const Seen& seen, const Projection& projection) {
    if (!has_stretch) return 1.0f;
    const glm::dvec3 p(surface_.positions[seen.texel]);
    const glm::dvec3 to_light = capture::shine_of(light, p).to_light;
    return static_cast<float>(
        weight::stretch_weight(static_cast<double>(seen.strength), glm::dot(projection.to_view(p), to_light)));
  };
  for (std::size_t begin = 0; begin < cameras_.size(); begin += kCamerasAtOnce) {
    const std::size_t end = std::min(begin + kCamerasAtOnce, cameras_.size());
    std::vector<PicturePlanes> planes(end - begin);
    std::vector<LightCensus> censuses(end - begin);
    tbb::parallel_for(begin, end, [&](std::size_t c) {
      if (has_frame(cameras_[c], lights_[i]))
        planes[c - begin] =
            planes_of(capture_, variant(), frames_.frame(cameras_[c], lights_[i]), layers[c], sights_[c].picture,
                      lit[c], options_.weights, options_.bake.channels, censuses[c - begin]);
    });
    for (std::size_t c = begin; c < end; ++c) {
      const PicturePlanes& picture = planes[c - begin];
      if (picture.width == 0) continue;
      const Projection projection(capture_.cameras[cameras_[c]]);
      const std::vector<Seen>& all = sights_[c].seen;
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, all.size(), 1024), [&](const auto& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) {
          const Look look = look_at(picture, all[k]);
          const float w = look.weight * stretch_of(all[k], projection);
          if (!(w > 0)) continue;
          const std::size_t t = all[k].texel;
          out.weights[t] += w;
          for (std::size_t ch = 0; ch < channels(); ++ch) out.residuals[ch * texels() + t] += w * look.residual[ch];
          const auto candidate = std::lower_bound(candidates_.begin(), candidates_.end(), all[k].texel);
          if (candidate != candidates_.end() && *candidate == all[k].texel)
            out.candidates[3 * static_cast<std::size_t>(candidate - candidates_.begin()) + 2] += w * look.photo;
        }
      });
      const Inputs inputs = inputs_of_pictures(capture_, cameras_[c], std::span(&lights_[i], 1), options_.variant);
      out.inputs.insert(out.inputs.end(), inputs.begin(), inputs.end());
      const LightCensus& census = censuses[c - begin];
      out.census.samples += census.samples, out.census.clipped += census.clipped, out.census.sum += census.sum;
      out.census.not_finite += census.not_finite, out.census.negative += census.negative;
    }
  }
  for (std::size_t t = 0; t < texels(); ++t)
    if (out.weights[t] > 0)
      for (std::size_t ch = 0; ch < channels(); ++ch) out.residuals[ch * texels() + t] /= out.weights[t];
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    const std::size_t t = candidates_[k];
    if (!(out.weights[t] > 0)) continue;
    const auto residual = [&](std::size_t ch) { return out.residuals[ch * texels() + t]; };
    float* to = out.candidates.data() + 3 * k;
    to[0] = out.weights[t], to[2] /= out.weights[t];
    to[1] =
        channels() == 1 ? residual(0) : static_cast<float>(weight::luminance({residual(0), residual(1), residual(2)}));
  }
  return out;
}

void Baking::find_samples() {
  const auto file_of = [&](std::size_t i) { return work_file("light", i); };
  const auto opened = [&](std::size_t i) {
    return LightFile::open(file_of(i), digest_, texels(), channels(), candidates_.size());
  };
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < lights_.size(); ++i)
    if (!opened(i)) missing.push_back(i);
  out_.kept_lights = lights_.size() - missing.size();
  if (!missing.empty()) {
    const std::vector<LitLevels> lit = find_lit();
    std::vector<capture::CameraLayers> layers;
    for (const std::size_t camera : cameras_) layers.push_back(capture::read_camera_layers(capture_, camera));
    for (std::size_t k = 0; k < missing.size(); ++k) {
      ask(static_cast<double>(k) / static_cast<double>(missing.size()), "reading lights");
      write_light(file_of(missing[k]), digest_, samples_of(missing[k], layers, lit));
    }
  }
  out_.bake.floor = options_.bake.floor;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    samples_.push_back(opened(i).value());
    out_.census.ids.push_back(capture_.lights[lights_[i]].id);
    out_.census.irradiance.push_back(irradiance_[i]);
    out_.census.to_lights.push_back(capture::shine_of(capture_.lights[lights_[i]], middle_).to_light);
    out_.census.lights.push_back(samples_.back().census());
  }
}

}  // namespace likeness::realis
