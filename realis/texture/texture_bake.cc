#include "realis/texture/texture_bake.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "realis/choose.h"
#include "realis/texture/light_file.h"
#include "realis/texture/picture_planes.h"
#include "realis/texture/property_maps.h"
#include "realis/texture/sight.h"
#include "realis/texture/tiles.h"
#include "render/baked/bake_file.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/sight.h"
#include "render/command/scene_digest.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"

namespace likeness::realis {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kCandidates = 2048, kTexelsToChooseBy = 512;
constexpr std::size_t kCamerasAtOnce = 2;
constexpr std::size_t kMostFloatBytes = std::size_t{1} << 31;  // of a picture of floats, which is written from memory

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

std::string numbered(const char* name, std::size_t index) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%s_%05zu", name, index);
  return text.data();
}

scene::Index instance_of(const scene::Scene& scene, const std::string& name) {
  std::vector<std::string_view> names;
  std::string all;
  for (const scene::Instance& instance : scene.instances) {
    names.push_back(instance.name);
    all += (all.empty() ? "" : ", ") + files::in_quotes(instance.name);
  }
  if (name.empty() && names.size() == 1) return 0;
  if (name.empty()) throw files::UsageError("--object says which one is baked; the scene has " + all);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<scene::Index>(found - names.begin());
  const std::string near = files::nearest_name(name, names.data(), names.size());
  throw files::UsageError("--object " + files::in_quotes(name) + " is not in the scene, which has " + all +
                          (near.empty() ? "" : "; did you mean " + files::in_quotes(near) + "?"));
}

// What cameras see of the scene: lights are the capture's.
scene::Scene unlit(scene::Scene scene) {
  scene.lights.clear(), scene.environment.reset();
  scene.cameras.assign(1, scene::Camera());
  return scene;
}

std::string mesh_digest(const scene::Mesh& mesh) {
  std::string bytes;
  const auto add = [&](const auto& values) {
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
  };
  add(mesh.positions), add(mesh.uvs), add(mesh.triangles);
  return files::sha256(bytes);
}

// One baking: what its steps share.
class Baking {
 public:
  Baking(const capture::Capture& capture, const scene::Scene& scene, const TextureBakeOptions& options,
         const std::filesystem::path& folder, const GoesOn& goes_on)
      : capture_(capture),
        options_(options),
        folder_(folder),
        work_(folder / "work"),
        goes_on_(goes_on),
        frames_(capture),
        scene_(unlit(scene)),
        world_(scene_, plan::plan_of(scene_, 0)),
        instance_(instance_of(scene_, options.object)) {}

  TextureBake run();

 private:
  std::size_t channels() const { return options_.bake.channels == Channels::kRgb ? 3 : 1; }
  std::size_t texels() const { return unwrapped_.pixels.size(); }
  const capture::Variant& variant() const { return capture_.variants[options_.variant]; }
  const scene::Instance& object() const { return scene_.instances[instance_]; }
  bool has_frame(std::size_t camera, std::size_t light) const {
    return frames_.frame(camera, light) != capture::kAbsent;
  }
  void ask(double share, const std::string& what) const {
    if (!goes_on_(share, what)) throw files::Interrupted();
  }
  void find_cameras_and_lights();
  std::string digest() const;
  void find_sights();
  void find_samples();
  LightSamples samples_of(std::size_t i, std::vector<capture::CameraLayers>& layers,
                          const std::vector<LitLevels>& lit) const;
  std::vector<LitLevels> find_lit() const;
  Basis choose();
  void solve(const Basis& basis);
  void write(const TileSolve& solve, const std::vector<double>& largest);

  const capture::Capture& capture_;
  const TextureBakeOptions& options_;
  std::filesystem::path folder_, work_;
  const GoesOn& goes_on_;
  capture::FrameTable frames_;
  scene::Scene scene_;
  world::World world_;
  scene::Index instance_;

  std::vector<std::size_t> cameras_, lights_;
  glm::dvec3 middle_{0};  // of the object
  std::vector<double> irradiance_;
  double mean_irradiance_ = 1;
  Unwrapped unwrapped_;
  TexelSurface surface_;
  std::vector<CameraSight> sights_;
  std::vector<std::uint32_t> candidates_;
  std::vector<LightFile> samples_;
  std::string digest_;
  TextureBake out_;
};

void Baking::find_cameras_and_lights() {
  for (std::size_t camera = 0; camera < capture_.cameras.size(); ++camera) {
    if (!options_.cameras.empty() &&
        std::find(options_.cameras.begin(), options_.cameras.end(), camera) == options_.cameras.end())
      continue;
    for (std::size_t light = 0; light < capture_.lights.size(); ++light)
      if (has_frame(camera, light) && capture::has_place(capture_.lights[light])) {
        cameras_.push_back(camera);
        break;
      }
  }
  for (std::size_t light = 0; light < capture_.lights.size(); ++light)
    if (capture::has_place(capture_.lights[light]) &&
        std::any_of(cameras_.begin(), cameras_.end(), [&](std::size_t camera) { return has_frame(camera, light); }))
      lights_.push_back(light);
  if (lights_.empty())
    throw files::UsageError(
        "no camera has a photograph under a light whose direction is known; `likeness olat calibrate` finds "
        "directions, "
        "`likeness olat check` says what is missing");
  for (const std::size_t camera : cameras_)
    for (const std::size_t light : lights_)
      if (has_frame(camera, light) &&
          !std::filesystem::exists(capture::render_file(capture_, variant(), camera, light)))
        throw files::UsageError("variant " + files::in_quotes(variant().id) + " has no render of camera " +
                                files::in_quotes(capture_.cameras[camera].id) + " under light " +
                                files::in_quotes(capture_.lights[light].id) + "; `likeness olat render " +
                                capture_.root.string() + " --scene " + options_.scene_file + " --variant " +
                                variant().id + "` makes it");
}

// Of all that decides a light's samples and a tile's coefficients. Photographs by name, size and time: their bytes are
// hashed when they are read.
std::string Baking::digest() const {
  const capture::CaptureTexts texts = capture::texts_of(capture_);
  std::string text = "texture bake 1\n" + texts.cameras + texts.lights + texts.frames + variant().pattern + "\n";
  const auto add = [&](const std::filesystem::path& file) {
    if (file.empty()) return;
    std::error_code error;
    text += file.string() + " " + std::to_string(std::filesystem::file_size(file, error)) + " " +
            std::to_string(std::filesystem::last_write_time(file, error).time_since_epoch().count()) + "\n";
  };
  const auto put = [&](double value) { text += files::number_text(value) + "\n"; };
  for (const std::size_t camera : cameras_) {
    for (const capture::Layer layer : {capture::Layer::kMask, capture::Layer::kFlatField})
      add(capture::layer_file(capture_, camera, layer));
    for (const std::size_t light : lights_)
      if (has_frame(camera, light)) {
        add(capture::photo_file(capture_, capture_.frames[frames_.frame(camera, light)]));
        add(capture::render_file(capture_, variant(), camera, light));
      }
  }
  text += out_.bake.channels == Channels::kRgb ? "rgb\n" : "luminance\n";
  text += render_command::digest_of(scene_, 0) + "\n" + mesh_digest(scene_.meshes[object().mesh]) + "\n";
  const BakeOptions& b = options_.bake;
  for (const double value :
       {static_cast<double>(instance_), static_cast<double>(options_.resolution), static_cast<double>(b.channels),
        static_cast<double>(b.lobes), static_cast<double>(b.most_lobes), static_cast<double>(b.dominant),
        b.is_exact ? 1.0 : 0.0, b.floor, static_cast<double>(b.seed)})
    put(value);
  weight::Settings settings = options_.weights.settings;
  for (std::size_t i = 0; i < weight::kWeights.size(); ++i) {
    put(options_.weights.is_on[i] ? 1 : 0);
    for (const weight::SettingRow& row : weight::kWeights[i].settings)
      if (!row.name.empty()) put(row.value(settings));
  }
  return files::sha256(text);
}

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
  out.weights.resize(texels()), out.residuals.resize(texels() * channels()), out.photos.resize(candidates_.size());
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
        planes[c - begin] = planes_of(capture_, variant(), cameras_[c], lights_[i], layers[c], sights_[c].picture,
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
            out.photos[static_cast<std::size_t>(candidate - candidates_.begin())] += w * look.photo;
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
  for (std::size_t k = 0; k < candidates_.size(); ++k)
    if (out.weights[candidates_[k]] > 0) out.photos[k] /= out.weights[candidates_[k]];
  return out;
}

void Baking::find_samples() {
  const auto file_of = [&](std::size_t i) { return work_ / numbered("light", i); };
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

glm::dmat3 model_from_world(const scene::Instance& instance) {
  return glm::inverse(glm::dmat3(instance.world_from_object));
}

Basis Baking::choose() {
  Sampled sampled;
  for (const glm::dvec3& d : out_.census.to_lights)
    sampled.to_lights.push_back(glm::normalize(model_from_world(object()) * d));
  if (options_.bake.is_exact) return exact_basis(sampled.to_lights);
  const std::size_t lights = lights_.size(), count = candidates_.size();
  // Of the candidates those that most lights say something of. What is not known counts as no residual.
  std::vector<float> residuals(count * lights), photos(count * lights);
  std::vector<std::size_t> known(count, 0), order(count);
  std::vector<float> weight(1), residual(channels());
  for (std::size_t i = 0; i < lights; ++i) {
    const std::vector<float> shown = samples_[i].photos();
    for (std::size_t k = 0; k < count; ++k) {
      samples_[i].read(candidates_[k], weight, residual);
      const glm::dvec3 p(surface_.positions[candidates_[k]]);
      const double irradiance = capture::shine_of(capture_.lights[lights_[i]], p).irradiance;
      if (!(weight[0] > 0 && irradiance > 0)) continue;
      const auto scale = static_cast<float>(mean_irradiance_ / irradiance);
      const float e = channels() == 1 ? residual[0]
                                      : static_cast<float>(weight::luminance({residual[0], residual[1], residual[2]}));
      residuals[k * lights + i] = e * scale, photos[k * lights + i] = shown[k] * scale, ++known[k];
    }
  }
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return known[a] > known[b]; });
  for (std::size_t k = 0; k < std::min(kTexelsToChooseBy, count) && known[order[k]] > 0; ++k) {
    const auto first = static_cast<std::ptrdiff_t>(order[k] * lights),
               last = first + static_cast<std::ptrdiff_t>(lights);
    sampled.residuals.insert(sampled.residuals.end(), residuals.begin() + first, residuals.begin() + last);
    sampled.photos.insert(sampled.photos.end(), photos.begin() + first, photos.begin() + last);
  }
  if (sampled.residuals.empty()) return {};
  if (options_.bake.lobes > 0) {
    out_.ladder = {choose_basis(sampled, options_.bake.lobes)};
    return out_.ladder[0].basis;
  }
  out_.ladder = ladder(sampled, options_.bake.most_lobes, [&](double share) { ask(share, "choosing lobes"); });
  out_.chosen = chosen_of(out_.ladder);
  return out_.ladder[out_.chosen].basis;
}

void Baking::solve(const Basis& basis) {
  baked::Bake& bake = out_.bake;
  bake.basis = basis, bake.channels = options_.bake.channels;
  const std::size_t lobes = basis.lobes.size();
  bake.kept = options_.bake.dominant > 0 ? std::min(options_.bake.dominant, lobes) : lobes;
  if (options_.is_float && static_cast<std::uintmax_t>(4 * channels() * lobes) *
                                   static_cast<std::uintmax_t>(options_.resolution) *
                                   static_cast<std::uintmax_t>(options_.resolution) >
                               kMostFloatBytes)
    throw files::UsageError("--float needs " + std::to_string(channels() * lobes) + " planes of " +
                            std::to_string(options_.resolution) + " x " + std::to_string(options_.resolution) +
                            " in memory; leave it out, or ask for fewer lobes or texels");
  const TileSolve tiles{capture_, surface_,      lights_,    samples_,  model_from_world(object()),
                        basis,    bake.channels, bake.floor, bake.kept, mean_irradiance_,
                        digest_};
  const Clock::time_point begin = Clock::now();
  std::vector<double> largest(channels() * lobes, 0.0);
  double plain = 0, left = 0, samples = 0, unlit = 0;
  for (std::size_t tile = 0; tile < tiles.tiles(); ++tile) {
    ask(static_cast<double>(tile) / static_cast<double>(tiles.tiles()), "solving texels");
    const std::filesystem::path file = work_ / numbered("tile", tile);
    const bool is_there = std::filesystem::exists(file);
    const TileSums sums = solve_tile(tiles, tile, file);
    out_.kept_tiles += is_there ? 1 : 0;
    plain += sums.plain, left += sums.left, samples += sums.samples, unlit += sums.unlit;
    for (std::size_t k = 0; k < largest.size(); ++k) largest[k] = std::max(largest[k], sums.largest[k]);
  }
  out_.solving_s = seconds_since(begin);
  out_.plain_rms = std::sqrt(plain / std::max(samples, 1.0)), out_.left_rms = std::sqrt(left / std::max(samples, 1.0));
  out_.census.unlit = static_cast<std::size_t>(unlit) - out_.census.unseen;
  out_.census.lobes = lobes, out_.census.is_free = options_.bake.is_exact, out_.census.plain_rms = out_.plain_rms;
  write(tiles, largest);
}

void Baking::write(const TileSolve& tiles, const std::vector<double>& largest) {
  ask(0, "writing pictures");
  baked::StoredBake head{out_.bake, {}, options_.resolution, options_.resolution, {}};
  std::vector<std::vector<std::uint8_t>> known;
  for (std::size_t tile = 0; tile < tiles.tiles(); ++tile) {
    known.push_back(known_of(tiles, tile, work_ / numbered("tile", tile)));
    for (std::size_t t = 0; t < known.back().size(); ++t)
      if (known.back()[t] != 0) head.pixels.push_back(unwrapped_.pixels[tile * kTileTexels + t]);
  }
  const auto gathered = [&](const auto& values_of, auto out) {
    for (std::size_t tile = 0; tile < tiles.tiles(); ++tile) {
      const auto values = values_of(tiles, tile, work_ / numbered("tile", tile));
      for (std::size_t t = 0; t < values.size(); ++t)
        if (known[tile][t] != 0) out.push_back(values[t]);
    }
    return out;
  };
  baked::PlaneSource source;
  source.multipliers = largest;
  source.coefficients = [&](std::size_t plane) {
    ask(static_cast<double>(plane) / static_cast<double>(tiles.planes()), "writing pictures");
    return gathered([&](const auto&... at) { return plane_of(at..., plane); }, std::vector<float>());
  };
  source.lobes = [&](std::size_t place) {
    return gathered([&](const auto&... at) { return lobes_of(at..., place); }, std::vector<std::uint8_t>());
  };
  baked::About& about = head.about;
  about.capture = capture_.name, about.space = baked::Space::kTexture;
  about.scene = options_.scene_file, about.object = object().name;
  about.scene_sha256 = render_command::digest_of(scene_, 0);
  about.mesh_sha256 = mesh_digest(scene_.meshes[object().mesh]);
  about.inputs = options_.inputs;
  const Inputs of_capture = inputs_of_capture(capture_, cameras_);
  about.inputs.insert(about.inputs.end(), of_capture.begin(), of_capture.end());
  for (const LightFile& file : samples_)
    about.inputs.insert(about.inputs.end(), file.inputs().begin(), file.inputs().end());
  about.metrics = {{"render_rms", out_.plain_rms}, {"realis_rms", out_.left_rms}};
  if (!out_.ladder.empty()) about.metrics.emplace_back("held_out_rms", out_.ladder[out_.chosen].held_out);
  write_property_maps(world_, instance_, unwrapped_, folder_);
  baked::write_bake(folder_, head, source, options_.is_float);
  std::filesystem::remove_all(work_);
}

TextureBake Baking::run() {
  must_stream(options_.weights);
  find_cameras_and_lights();
  find_sights();
  digest_ = digest();
  out_.texels = texels(), out_.lights = lights_.size(), out_.cameras = cameras_.size();
  // A tile's file has at most as many lobes as the search may end with.
  const std::size_t most = options_.bake.is_exact    ? lights_.size()
                           : options_.bake.lobes > 0 ? options_.bake.lobes
                                                     : std::min(options_.bake.most_lobes, 4 * lights_.size());
  const std::size_t kept = options_.bake.dominant > 0 ? std::min(options_.bake.dominant, most) : most;
  out_.work_bytes = lights_.size() * bytes_of_light(texels(), channels(), candidates_.size()) +
                    texels() * (1 + kept * (1 + 4 * channels()));
  std::filesystem::create_directories(work_);
  std::uintmax_t there = 0;
  for (const auto& entry : std::filesystem::directory_iterator(work_)) there += entry.file_size();
  const std::uintmax_t pictures = static_cast<std::uintmax_t>(texels()) * channels() * kept * 2;
  must_have_room(folder_, out_.work_bytes + pictures, std::filesystem::space(work_).available + there);
  const Clock::time_point begin = Clock::now();
  find_samples();
  out_.reading_s = seconds_since(begin);
  solve(choose());
  return std::move(out_);
}

}  // namespace

void must_have_room(const std::filesystem::path& folder, std::uintmax_t needed, std::uintmax_t free) {
  if (free >= needed) return;
  const auto text = [](std::uintmax_t bytes) {
    std::array<char, 32> out{};
    std::snprintf(out.data(), out.size(), "%.1f GB", static_cast<double>(bytes) / 1e9);
    return std::string(out.data());
  };
  throw files::UsageError(folder.string() + ": the bake needs " + text(needed) + " there while it lasts, and " +
                          text(free) + " are free; --out names another disk, --resolution fewer texels");
}

TextureBake bake_texture(const capture::Capture& capture, const scene::Scene& scene, const TextureBakeOptions& options,
                         const std::filesystem::path& folder, const GoesOn& goes_on) {
  if (options.resolution < 1 || options.resolution > kMostResolution)
    throw files::UsageError("--resolution = " + std::to_string(options.resolution) + " is outside [1, " +
                            std::to_string(kMostResolution) + "]");
  return Baking(capture, scene, options, folder, goes_on).run();
}

}  // namespace likeness::realis
