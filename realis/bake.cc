#include "realis/bake.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "realis/mixes.h"
#include "realis/solve.h"
#include "render/files/interrupt.h"

namespace likeness::realis {
namespace {

constexpr std::size_t kTexelsToChooseBy = 512;

double luminance(const std::array<float, 3>& c) {
  return 0.2126 * static_cast<double>(c[0]) + 0.7152 * static_cast<double>(c[1]) + 0.0722 * static_cast<double>(c[2]);
}

// photo - render; 0 where the photo says nothing.
double error_of(const Subject& s, std::size_t sample, Channels channels, std::size_t channel) {
  if (!(s.weight[sample] > 0)) return 0;
  if (channels == Channels::kLuminance) return luminance(s.photo[sample]) - luminance(s.render[sample]);
  return static_cast<double>(s.photo[sample][channel]) - static_cast<double>(s.render[sample][channel]);
}

double mean_irradiance(const Subject& s) {
  double sum = 0;
  for (std::size_t i = 0; i < s.lights.size(); ++i) sum += s.irradiance_of(i);
  return s.lights.empty() ? 1 : sum / static_cast<double>(s.lights.size());
}

// Texels of which half of the lights can be trusted, in a random order that the seed decides; of all if there are none.
Sampled sampled_of(const Subject& s, std::uint64_t seed, bool by_stops) {
  Sampled out;
  out.to_lights = s.to_lights;
  std::vector<std::size_t> order(s.texels());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937_64 random(seed);
  const std::size_t lights = s.lights.size();
  const double mean = mean_irradiance(s);
  bool is_weighed = false;
  std::size_t taken = 0;
  for (std::size_t i = 0; i < order.size() && taken < kTexelsToChooseBy; ++i) {
    std::swap(order[i], order[i + random() % (order.size() - i)]);
    const std::size_t first = s.samples_of(order[i]);
    const std::span weights(s.weight.data() + first, lights);
    if (std::accumulate(weights.begin(), weights.end(), 0.0) < 0.5 * static_cast<double>(lights)) continue;
    for (std::size_t k = 0; k < lights; ++k) {
      const double share = mean / s.irradiance_of(k), photo = luminance(s.photo[first + k]);
      out.residuals.push_back(static_cast<float>(error_of(s, first + k, Channels::kLuminance, 0) * share));
      if (by_stops) out.photos.push_back(weights[k] > 0 ? static_cast<float>(photo * share) : 0.0f);
      out.weights.push_back(weights[k]);
      is_weighed |= weights[k] < 1;
    }
    ++taken;
  }
  if (!is_weighed) out.weights.clear();
  return out;
}

}  // namespace

Bake bake(const Subject& subject, const BakeOptions& options, const GoesOn& goes_on) {
  if (options.is_exact) return bake_with(subject, exact_basis(subject.to_lights), options, goes_on);
  if (options.mixes > 0) {
    const Mixes mixes(subject, prior_length(subject, options.floor, options.seed), options.floor, options.seed);
    return bake_with(subject, mixes.first(options.mixes), options, goes_on);
  }
  std::vector<Choice> choices;
  std::size_t chosen = 0;
  const Sampled sampled = sampled_of(subject, options.seed, options.by_stops);
  if (options.lobes > 0) {
    choices = {choose_basis(sampled, options.lobes)};
  } else {
    choices = ladder(sampled, options.most_lobes, [&](double share) {
      if (!goes_on(share, "choosing lobes")) throw files::Interrupted();
    });
    chosen = chosen_of(choices);
  }
  Bake out = bake_with(subject, choices.empty() ? Basis{} : choices[chosen].basis, options, goes_on);
  out.ladder = std::move(choices), out.chosen = chosen;
  return out;
}

Bake bake_with(const Subject& subject, Basis basis, const BakeOptions& options, const GoesOn& goes_on) {
  Bake out;
  out.basis = std::move(basis), out.channels = options.channels, out.floor = options.floor, out.bits = options.bits;
  if (!out.basis.mix.empty() && out.bits == baked::Bits::kEight) out.bits = baked::Bits::kEightSquared;
  const std::size_t lobes = out.basis.size(), lights = subject.lights.size(), channels = out.channel_count();
  out.kept = options.dominant > 0 ? std::min(options.dominant, lobes) : lobes;
  out.coefficients.assign(subject.texels() * channels * lobes, 0.0f);
  if (lobes == 0) return out;

  struct Work {
    Solver solver;
    std::vector<double> weights, residuals, coefficients;
  };
  tbb::enumerable_thread_specific<Work> works([&] {
    Work w{Solver(out.basis), std::vector<double>(lights), std::vector<double>(channels * lights),
           std::vector<double>(channels * lobes)};
    w.solver.aim(subject.to_lights);
    return w;
  });
  const double mean = mean_irradiance(subject);
  constexpr std::size_t kAtOnce = 4096;
  for (std::size_t begin = 0; begin < subject.texels(); begin += kAtOnce) {
    if (!goes_on(static_cast<double>(begin) / static_cast<double>(subject.texels()), "baking"))
      throw files::Interrupted();
    tbb::parallel_for(begin, std::min(begin + kAtOnce, subject.texels()), [&](std::size_t texel) {
      Work& w = works.local();
      const std::size_t first = subject.samples_of(texel);
      for (std::size_t i = 0; i < lights; ++i) {
        const double cosine = std::max(static_cast<double>(subject.cosine[first + i]), options.floor);
        const double received = cosine * subject.irradiance_of(i), relative = received / mean;
        w.weights[i] = static_cast<double>(subject.weight[first + i]) * relative * relative;
        for (std::size_t c = 0; c < channels; ++c)
          w.residuals[c * lights + i] = error_of(subject, first + i, options.channels, c) / received;
      }
      w.solver.solve_kept(out.kept, w.weights, w.residuals, w.coefficients);
      float* to = out.coefficients.data() + texel * channels * lobes;
      for (std::size_t k = 0; k < channels * lobes; ++k) to[k] = static_cast<float>(w.coefficients[k]);
    });
  }
  return out;
}

Residual::Residual(const baked::Bake& bake, const glm::dvec3& to_light)
    : bake_(bake), values_(values(bake.basis, std::span(&to_light, 1))) {}

std::array<double, 3> Residual::at(std::size_t texel, double cosine) const {
  const std::size_t lobes = values_.size(), channels = bake_.channel_count();
  std::array<double, 3> out{};
  const float* c = bake_.coefficients.data() + texel * channels * lobes;
  for (std::size_t k = 0; k < channels; ++k)
    out[k] = std::inner_product(values_.begin(), values_.end(), c + k * lobes, 0.0) * std::max(cosine, bake_.floor);
  if (channels == 1) out[1] = out[2] = out[0];
  return out;
}

}  // namespace likeness::realis
