#include "realis/texture/tiles.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numeric>

#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "realis/solve.h"
#include "render/baked/bake_file.h"
#include "render/capture/sight.h"
#include "render/files/files.h"

namespace likeness::realis {
namespace {

// A tile's file: the digest (64 characters), four sums and the largest coefficients as doubles; a byte a texel (1: known);
// coefficients as floats, plane by plane; of a sparse bake the lobes, a byte each, place by place.
struct Layout {
  std::size_t largest, count, known, coefficients, lobes, end;
  Layout(const TileSolve& s, std::size_t tile) {
    largest = s.channel_count() * s.basis.size(), count = s.count_of(tile);
    known = 64 + sizeof(double) * (4 + largest);
    coefficients = known + (count + 3) / 4 * 4;
    lobes = coefficients + sizeof(float) * count * s.planes();
    end = lobes + (s.is_sparse() ? count * s.kept : 0);
  }
};

std::string read_bytes(const std::filesystem::path& file, std::size_t first, std::size_t count) {
  std::string out(count, '\0');
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(first));
  if (!in.read(out.data(), static_cast<std::streamsize>(count))) out.clear();
  return out;
}

TileSums sums_of(const std::string& head) {
  std::vector<double> numbers((head.size() - 64) / sizeof(double));
  std::memcpy(numbers.data(), head.data() + 64, numbers.size() * sizeof(double));
  TileSums out{numbers[0], numbers[1], numbers[2], numbers[3], {}};
  out.largest.assign(numbers.begin() + 4, numbers.end());
  return out;
}

// One thread's.
struct Work {
  Solver solver;
  std::vector<double> weights, residuals, coefficients, values;
  std::vector<glm::dvec3> directions;
};

// Of each texel of a tile.
struct Errors {
  double plain = 0, left = 0, samples = 0;
};

}  // namespace

TileSums solve_tile(const TileSolve& s, std::size_t tile, const std::filesystem::path& file) {
  const Layout layout(s, tile);
  std::error_code error;
  if (std::filesystem::file_size(file, error) == layout.end && !error)
    if (const std::string head = read_bytes(file, 0, layout.known); head.substr(0, 64) == s.digest)
      return sums_of(head);

  const std::size_t lights = s.lights.size(), lobes = s.basis.size(), channels = s.channel_count();
  const std::size_t count = layout.count, first = tile * kTileTexels;
  std::vector<float> weights(lights * count), residuals(lights * channels * count);
  for (std::size_t i = 0; i < lights; ++i)
    s.samples[i].read(first, std::span(weights).subspan(i * count, count),
                      std::span(residuals).subspan(i * channels * count, channels * count));

  const bool is_near = std::any_of(s.lights.begin(), s.lights.end(),
                                   [&](std::size_t light) { return capture::is_near(s.capture.lights[light]); });
  tbb::enumerable_thread_specific<Work> works([&] {
    Work w{Solver(s.basis),
           std::vector<double>(lights),
           std::vector<double>(lights * channels),
           std::vector<double>(lobes * channels),
           {},
           std::vector<glm::dvec3>(lights)};
    if (is_near) return w;
    for (std::size_t i = 0; i < lights; ++i)
      w.directions[i] =
          glm::normalize(s.model_from_world * capture::shine_of(s.capture.lights[s.lights[i]], glm::dvec3(0)).to_light);
    w.solver.aim(w.directions), w.values = values(s.basis, w.directions);
    return w;
  });

  std::vector<std::uint8_t> known(count);
  std::vector<float> coefficients(count * channels * lobes);  // texel by texel
  std::vector<Errors> errors(count);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 64), [&](const auto& range) {
    Work& w = works.local();
    for (std::size_t t = range.begin(); t < range.end(); ++t) {
      const glm::dvec3 position(s.surface.positions[first + t]), normal(s.surface.normals[first + t]);
      for (std::size_t i = 0; i < lights; ++i) {
        w.weights[i] = 0;
        const float weight = weights[i * count + t];
        const capture::Shine shine = capture::shine_of(s.capture.lights[s.lights[i]], position);
        if (is_near) w.directions[i] = glm::normalize(s.model_from_world * shine.to_light);
        if (!(weight > 0 && shine.irradiance > 0)) continue;
        const double received = std::max(glm::dot(normal, shine.to_light), s.floor) * shine.irradiance;
        const double relative = received / s.mean_irradiance;
        w.weights[i] = static_cast<double>(weight) * relative * relative;
        for (std::size_t c = 0; c < channels; ++c) {
          const auto e = static_cast<double>(residuals[(i * channels + c) * count + t]);
          w.residuals[c * lights + i] = e / received;
          errors[t].plain += e * e;
        }
        errors[t].samples += static_cast<double>(channels);
        known[t] = 1;
      }
      if (known[t] == 0 || lobes == 0) continue;
      if (is_near) w.solver.aim(w.directions), w.values = values(s.basis, w.directions);
      w.solver.solve_kept(s.kept, w.weights, w.residuals, w.coefficients);
      for (std::size_t k = 0; k < lobes * channels; ++k)
        coefficients[t * lobes * channels + k] = static_cast<float>(w.coefficients[k]);
      for (std::size_t i = 0; i < lights; ++i) {
        if (!(w.weights[i] > 0)) continue;
        const double received =
            std::sqrt(w.weights[i] / static_cast<double>(weights[i * count + t])) * s.mean_irradiance;
        for (std::size_t c = 0; c < channels; ++c) {
          const double e = std::inner_product(w.values.begin() + static_cast<std::ptrdiff_t>(i * lobes),
                                              w.values.begin() + static_cast<std::ptrdiff_t>((i + 1) * lobes),
                                              w.coefficients.begin() + static_cast<std::ptrdiff_t>(c * lobes), 0.0);
          const double left = (w.residuals[c * lights + i] - e) * received;
          errors[t].left += left * left;
        }
      }
    }
  });

  TileSums sums;
  sums.largest.assign(layout.largest, 0.0);
  std::vector<std::uint8_t> which(s.is_sparse() ? count * s.kept : 0);
  std::vector<float> planes(count * s.planes());
  for (std::size_t t = 0; t < count; ++t) {
    sums.plain += errors[t].plain, sums.left += lobes == 0 ? errors[t].plain : errors[t].left;
    sums.samples += errors[t].samples, sums.unlit += known[t] == 0 ? 1 : 0;
    const std::span<const float> of(coefficients.data() + t * channels * lobes, channels * lobes);
    for (std::size_t k = 0; k < of.size(); ++k)
      sums.largest[k] = std::max(sums.largest[k], static_cast<double>(std::abs(of[k])));
    std::vector<std::uint8_t> kept;
    if (s.is_sparse()) kept = baked::kept_lobes(of, channels, s.kept);
    for (std::size_t k = 0; k < s.kept; ++k) {
      const std::size_t lobe = s.is_sparse() ? kept[k] : k;
      if (s.is_sparse()) which[k * count + t] = kept[k];
      for (std::size_t c = 0; c < channels; ++c) planes[(c * s.kept + k) * count + t] = of[c * lobes + lobe];
    }
  }
  files::WholeFile out(file);
  const auto append = [&](const auto& values) {
    out.append({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])});
  };
  out.append(s.digest);
  append(std::array{sums.plain, sums.left, sums.samples, sums.unlit});
  append(sums.largest);
  known.resize(layout.coefficients - layout.known);
  append(known), append(planes), append(which);
  out.commit();
  return sums;
}

namespace {

std::vector<std::uint8_t> bytes_at(const std::filesystem::path& file, std::size_t first, std::size_t count) {
  const std::string bytes = read_bytes(file, first, count);
  if (bytes.size() != count)
    throw files::InputError(file.string() + ": cannot be read any more; begin anew with --out, or remove it");
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::vector<std::uint8_t> known_of(const TileSolve& s, std::size_t tile, const std::filesystem::path& file) {
  const Layout layout(s, tile);
  return bytes_at(file, layout.known, layout.count);
}

std::vector<float> plane_of(const TileSolve& s, std::size_t tile, const std::filesystem::path& file,
                            std::size_t plane) {
  const Layout layout(s, tile);
  std::vector<float> out(layout.count);
  read_floats(file, layout.coefficients + sizeof(float) * layout.count * plane, out);
  return out;
}

std::vector<std::uint8_t> lobes_of(const TileSolve& s, std::size_t tile, const std::filesystem::path& file,
                                   std::size_t place) {
  const Layout layout(s, tile);
  return bytes_at(file, layout.lobes + layout.count * place, layout.count);
}

}  // namespace likeness::realis
