#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

#include "realis/choose.h"
#include "realis/texture/baking.h"
#include "realis/texture/property_maps.h"
#include "render/baked/bake_file.h"
#include "render/baked/format.h"
#include "render/capture/sight.h"
#include "render/command/scene_digest.h"

// From what cameras say of texels to the files of the bake.
namespace likeness::realis {
namespace {

constexpr std::size_t kTexelsToChooseBy = 512;

}  // namespace

Basis Baking::choose() {
  Sampled sampled;
  for (const glm::dvec3& d : out_.census.to_lights) sampled.to_lights.push_back(glm::normalize(model_from_world() * d));
  if (options_.bake.is_exact) return exact_basis(sampled.to_lights);
  const std::size_t lights = lights_.size(), count = candidates_.size();
  // Of the candidates those that most lights say something of. What is not known counts as no residual.
  std::vector<float> residuals(count * lights), photos(count * lights);
  std::vector<std::size_t> known(count, 0), order(count);
  for (std::size_t i = 0; i < lights; ++i) {
    const std::vector<float> said = samples_[i].candidates();
    for (std::size_t k = 0; k < count; ++k) {
      const glm::dvec3 p(surface_.positions[candidates_[k]]);
      const double irradiance = capture::shine_of(capture_.lights[lights_[i]], p).irradiance;
      if (!(said[3 * k] > 0 && irradiance > 0)) continue;
      const auto scale = static_cast<float>(mean_irradiance_ / irradiance);
      residuals[k * lights + i] = said[3 * k + 1] * scale, photos[k * lights + i] = said[3 * k + 2] * scale, ++known[k];
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
  const std::size_t lobes = basis.size();
  bake.kept = options_.bake.dominant > 0 ? std::min(options_.bake.dominant, lobes) : lobes;
  const TileSolve tiles{capture_,   surface_,  lights_,          samples_, model_from_world(), basis, bake.channels,
                        bake.floor, bake.kept, mean_irradiance_, digest_};
  const auto begin = std::chrono::steady_clock::now();
  std::vector<double> largest(channels() * lobes, 0.0);
  double plain = 0, left = 0, samples = 0, unlit = 0;
  for (std::size_t tile = 0; tile < tiles.tiles(); ++tile) {
    ask(static_cast<double>(tile) / static_cast<double>(tiles.tiles()), "solving texels");
    const std::filesystem::path file = work_file("tile", tile);
    const bool is_there = std::filesystem::exists(file);
    const TileSums sums = solve_tile(tiles, tile, file);
    out_.kept_tiles += is_there ? 1 : 0;
    plain += sums.plain, left += sums.left, samples += sums.samples, unlit += sums.unlit;
    for (std::size_t k = 0; k < largest.size(); ++k) largest[k] = std::max(largest[k], sums.largest[k]);
  }
  out_.solving_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
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
    known.push_back(known_of(tiles, tile, work_file("tile", tile)));
    for (std::size_t t = 0; t < known.back().size(); ++t)
      if (known.back()[t] != 0) head.pixels.push_back(unwrapped_.pixels[tile * kTileTexels + t]);
  }
  const auto gathered = [&](const auto& values_of, auto out) {
    for (std::size_t tile = 0; tile < tiles.tiles(); ++tile) {
      const auto values = values_of(tiles, tile, work_file("tile", tile));
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
  about.mesh_sha256 = mesh_digest();
  about.inputs = options_.inputs;
  const Inputs of_capture = inputs_of_capture(capture_, cameras_);
  about.inputs.insert(about.inputs.end(), of_capture.begin(), of_capture.end());
  for (const LightFile& file : samples_)
    about.inputs.insert(about.inputs.end(), file.inputs().begin(), file.inputs().end());
  about.metrics = {{"render_rms", out_.plain_rms}, {"realis_rms", out_.left_rms}};
  if (!out_.ladder.empty()) about.metrics.emplace_back("held_out_rms", out_.ladder[out_.chosen].held_out);
  std::filesystem::remove(folder_ / baked::kBakeFile);  // of a bake that these maps are not of
  write_property_maps(world_, instance_, unwrapped_, folder_);
  // A picture of floats has a plane at least.
  baked::write_bake(folder_, head, source, options_.is_float && tiles.planes() > 0);
  std::filesystem::remove_all(work_);
}

}  // namespace likeness::realis
