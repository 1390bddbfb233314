#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "brdf/cost/ladder.h"
#include "brdf/subsurface/random_walk.h"
#include "render/files/interrupt.h"

namespace likeness::cost {
namespace {

// An output of an evaluator for one input, in double.
double evaluated(std::string_view name, double input, std::size_t output) {
  const catalog::Entry* entry = catalog::find(name);
  if (entry == nullptr)
    throw std::logic_error("the cost page names an evaluator that is not there: " + std::string(name));
  std::vector<double> out(entry->output_count);
  std::vector<double*> columns;
  for (double& x : out) columns.push_back(&x);
  const catalog::Column<double> in{&input, true};
  entry->in_double.from_inputs(entry->tables(), &in, columns.data(), 1);
  return out[output];
}

void set_part(const double* d, Inputs& in) { in.set("u", d[0]), in.set("s", 1); }

// The profile at all distances from the same walks: rings of 5 % to both sides, as random_walk_profile has them. Where
// rings overlap, they are put together of the pieces between all their edges.
std::vector<double> walked(const std::vector<double>& distances, double alpha, std::int64_t walks, std::uint64_t seed) {
  constexpr double kWidth = 0.05;
  std::vector<double> edges;
  for (const double r : distances) edges.insert(edges.end(), {r * (1 - kWidth), r * (1 + kWidth)});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  constexpr std::int64_t kAtOnce = 100000;  // then Ctrl-C is heard
  std::vector<double> reflectance(edges.size() - 1);
  for (std::int64_t done = 0; done < walks; done += kAtOnce) {
    if (files::interrupted()) throw files::Interrupted{};
    const std::int64_t now = std::min(kAtOnce, walks - done);
    const auto part = brdf::random_walk_profile({.alpha = alpha, .g = 0, .eta = 1}, brdf::Incidence::kPencil, edges,
                                                now, seed + std::uint64_t(done / kAtOnce));
    for (std::size_t i = 0; i < reflectance.size(); ++i)
      reflectance[i] += part.reflectance[i] * double(now) / double(walks);
  }
  std::vector<double> values;
  for (const double r : distances) {
    double light = 0, area = 0;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      if (edges[i] < r * (1 - kWidth) || edges[i + 1] > r * (1 + kWidth)) continue;
      const double piece = (edges[i + 1] - edges[i]) * (edges[i + 1] + edges[i]);
      light += reflectance[i] * piece, area += piece;
    }
    values.push_back(light / area);
  }
  return values;
}

}  // namespace

Family diffusion_inverse_family() {
  Family family;
  family.name = "diffusion_inverse";
  family.title = "Subsurface: the distance for a part of the light";
  family.text =
      "The inverse of the cumulative distribution of Burley's profile, with which a filter places its samples. The "
      "talk "
      "(SIGGRAPH 2018) takes Halley's method; there is a closed form.";
  family.distribution = "u uniform in [0, 1), one in five logarithmic towards 0 or 1 to 1e-6; s = 1";
  family.draw_names = {"u"};
  family.draw = [](Random& random, double* draw) {
    const double choice = random.uniform(), near = std::pow(10.0, random.uniform(-6, -1));
    draw[0] = choice < 0.1 ? near : choice < 0.2 ? 1 - near : random.uniform();
  };
  for (const char* steps : {"1", "2", "3", "4"}) {
    family.rungs.push_back({.label = "Halley, " + std::string(steps) + (*steps == '1' ? " step" : " steps"),
                            .evaluator = "burley_icdf_halley_" + std::string(steps),
                            .inputs = set_part});
  }
  family.rungs.push_back(
      {.label = "closed form", .evaluator = "burley_icdf", .inputs = set_part, .is_reference = true});
  return family;
}

Family diffusion_profile_family() {
  // Distances are mean free paths. What Burley's fit and the Gaussians know of the medium is its albedo.
  constexpr double kAlpha = 0.95;
  const double albedo = evaluated("random_walk_albedo", kAlpha, 0), s = evaluated("burley_shape", albedo, 0);
  const auto profile = [=](const double* d, Inputs& in) { in.set("r", d[0]), in.set("s", s), in.set("A", albedo); };
  Family family;
  family.name = "diffusion_profile";
  family.title = "Subsurface: the light that leaves at a distance";
  family.text =
      "Reflectance profile of a half space that scatters isotropically (single-scattering albedo 0.95, no boundary), "
      "light along the normal at one point. The reference is a random walk of four million paths, of which each "
      "distance "
      "takes those that leave within 5 %. Each form that is itself a random walk has paths of its own. The Gaussians "
      "were fitted to Burley's profile, not to the walk.";
  family.distribution = "distance logarithmic from 0.1 to 5 mean free paths";
  family.draw_names = {"r"};
  family.draw = [](Random& random, double* draw) { draw[0] = 0.1 * std::pow(50.0, random.uniform()); };
  family.draws = 24;
  family.negligible = 1e-3;
  family.energy_name = "energy";
  family.energy_weight = [](const double* d) { return d[0] * d[0]; };  // r dr, for draws even in ln r
  for (const char* count : {"1", "2", "4"}) {
    family.rungs.push_back({.label = std::string(count) + (*count == '1' ? " Gaussian and a point" : " Gaussians"),
                            .evaluator = "gaussian_profile_" + std::string(count),
                            .inputs = profile});
  }
  family.rungs.push_back({.label = "Burley", .evaluator = "burley_profile", .inputs = profile});
  for (const int paths : {100, 2000, 20000}) {
    const auto walk = [=](const double* d, Inputs& in) {
      in.set("r", d[0]), in.set("alpha", kAlpha), in.set("walks", paths), in.set("seed", 5);
    };
    family.rungs.push_back({.label = "random walk, " + std::to_string(paths) + " paths",
                            .evaluator = "random_walk_profile",
                            .inputs = walk,
                            .note = "paths for each distance anew"});
  }
  family.estimates = [=](const std::vector<double>& distances, double effort) {
    const auto walks = std::int64_t(std::max(2e4, 2e6 * effort));
    return std::array{walked(distances, kAlpha, walks, 1000), walked(distances, kAlpha, walks, 2000)};
  };
  return family;
}

}  // namespace likeness::cost
