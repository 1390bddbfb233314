#include "realis/ablation/ablation.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <glm/geometric.hpp>

#include "realis/from_capture.h"
#include "realis/weigh.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"

namespace likeness::realis {
namespace {

using datasets_synthetic::CaptureOptions;
using datasets_synthetic::Random;

double between(Random& draw, double low, double high) { return low + (high - low) * draw.uniform(); }
double either(Random& draw, double a) { return draw.chance(0.5) ? a : -a; }
std::size_t one_of(Random& draw, std::size_t count) {
  return static_cast<std::size_t>(draw.uniform() * static_cast<double>(count));
}

constexpr double kReadNoise = 5;   // [electron]
constexpr double kTouched = 5e-3;  // of the brightest, from which on a sample is touched
constexpr std::size_t kLobes = 24;
constexpr std::size_t kEveryHeldOut = 4;  // lights

// What is photographed: rougher and brighter at grazing light than what is rendered.
brdf::AnyBrdf real_surface() {
  brdf::Callisto<double> out;
  out.base_color = brdf::Rgb<double>(0.65, 0.58, 0.45);
  out.retroreflection = 2, out.roughness = 0.6;
  return brdf::AnyBrdf(out);
}
brdf::AnyBrdf rendered_surface() {
  brdf::Callisto<double> out;
  out.base_color = brdf::Rgb<double>(0.5, 0.5, 0.5);
  return brdf::AnyBrdf(out);
}

struct Seen {
  Subject subject;
  std::vector<glm::dvec3> normals;
};

class Bench {
 public:
  Bench(const AblationOptions& options, std::size_t lights)
      : options_(options), lights_(lights), rendered_(made("rendered", rendered_surface(), 0, nullptr)) {
    normal_picture_ = capture::read_normals(rendered_, 0);
    for (std::size_t l = 0; l < lights; ++l) truth_.push_back({});
    const capture::Capture truth = made("truth", real_surface(), 0, nullptr);
    for (std::size_t l = 0; l < lights; ++l) truth_[l] = capture::read_render(truth, truth.variants[0], 0, l);
    remove("truth");
  }
  ~Bench() { remove("rendered"); }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  // Photographs with the noise of the seed, and a fault.
  capture::Capture made(const char* name, const brdf::AnyBrdf& surface, std::uint64_t seed, const Fault* fault) const {
    CaptureOptions o;
    o.folder = options_.folder / name;
    o.width = o.height = options_.side, o.lights = static_cast<int>(lights_);
    o.has_floats = true, o.brdf = surface, o.seed = seed;
    if (seed > 0 && options_.full_well > 0) o.faults.full_well = options_.full_well, o.faults.read_noise = kReadNoise;
    if (fault != nullptr) {
      Random draw(seed, static_cast<std::uint64_t>(fault - kFaults.data()));
      fault->plant(o, draw);
    }
    return datasets_synthetic::make_capture(o).capture;
  }
  capture::Capture photographed(std::uint64_t seed, const Fault* fault) const {
    return made("photographed", real_surface(), seed, fault);
  }
  void remove(const char* name) const { std::filesystem::remove_all(options_.folder / name); }

  Subject read(const capture::Capture& photographed, std::span<const std::size_t> leave_out) const {
    const auto always = [](double, std::string_view) { return !files::interrupted(); };
    return read_subject(photographed, 0, renders_of_variant(rendered_, 0, 0), leave_out, always);
  }
  void weigh(const capture::Capture& photographed, const weight::Choice& choice, Subject& s) const {
    realis::weigh(photographed, normal_picture_, choice, false, s);
  }
  std::vector<std::size_t> held_out(std::uint64_t seed) const {
    std::vector<std::size_t> out;
    for (std::size_t l = seed % kEveryHeldOut; l < lights_; l += kEveryHeldOut) out.push_back(l);
    return out;
  }

  static Bake baked(const Subject& s) {
    return bake(s, {.lobes = kLobes, .by_stops = false},
                [](double, std::string_view) { return !files::interrupted(); });
  }

  static Bake baked(const Subject& s, const Basis& basis) {
    return bake_with(s, basis, {}, [](double, std::string_view) { return !files::interrupted(); });
  }

  glm::dvec3 normal_of(std::uint32_t pixel) const {
    const float* n = normal_picture_.rgb.data() + 3 * std::size_t{pixel};
    return {n[0], n[1], n[2]};
  }

  // What a bake adds, as light of irradiance 1: of each texel the directions, which are those of the lights and those in
  // the middle between each of them and its nearest. 0 below the horizon.
  std::vector<float> added(const Subject& s, const Bake& bake) const {
    std::vector<glm::dvec3> directions = s.to_lights;
    for (std::size_t i = 0; i < s.to_lights.size(); ++i) {
      double nearest = -2;
      std::size_t other = i;
      for (std::size_t k = 0; k < s.to_lights.size(); ++k)
        if (const double c = glm::dot(s.to_lights[i], s.to_lights[k]); k != i && c > nearest) nearest = c, other = k;
      if (other != i) directions.push_back(glm::normalize(s.to_lights[i] + s.to_lights[other]));
    }
    std::vector<float> out(s.texels() * directions.size());
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const Residual residual(bake, directions[d]);
      for (std::size_t t = 0; t < s.texels(); ++t) {
        const double cosine = glm::dot(normal_of(s.pixels[t]), directions[d]);
        if (cosine > 0) out[t * directions.size() + d] = static_cast<float>(residual.at(t, cosine)[0]);
      }
    }
    return out;
  }

  // Against photographs of lights that were left out, without fault and noise.
  double held_out_error(const capture::Capture& photographed, const weight::Choice& choice, std::uint64_t seed) const {
    const std::vector<std::size_t> out = held_out(seed);
    Subject s = read(photographed, out);
    weigh(photographed, choice, s);
    const Bake b = baked(s);
    double sum = 0;
    std::size_t count = 0;
    for (const std::size_t l : out) {
      const capture::Shine shine = capture::shine_of(rendered_.lights[l], glm::dvec3(0));
      const image::Picture render = capture::read_render(rendered_, rendered_.variants[0], 0, l);
      const Residual residual(b, shine.to_light);
      for (std::size_t t = 0; t < s.texels(); ++t) {
        const double cosine = glm::dot(normal_of(s.pixels[t]), shine.to_light);
        if (!(cosine > 0)) continue;
        const std::size_t at = 3 * std::size_t{s.pixels[t]};
        const auto light = [&](const image::Picture& p) {
          return weight::luminance({p.rgb[at], p.rgb[at + 1], p.rgb[at + 2]});
        };
        const double x = light(truth_[l]) - light(render) - residual.at(t, cosine)[0];
        sum += x * x, ++count;
      }
    }
    return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
  }

 private:
  const AblationOptions& options_;
  const std::size_t lights_;
  capture::Capture rendered_;
  image::Picture normal_picture_;
  std::vector<image::Picture> truth_;
};

weight::Choice none() {
  weight::Choice out;
  out.is_on.fill(false);
  return out;
}
weight::Choice only(std::string_view name) {
  const std::vector<std::string> names{std::string(name)};
  return name.empty() ? weight::Choice() : weight::choice_of(names, {}, {});
}

double root_mean_square(std::span<const float> a, std::span<const float> b, std::span<const std::uint8_t> texels) {
  double sum = 0;
  std::size_t count = 0;
  const std::size_t each = texels.empty() ? 0 : a.size() / texels.size();
  for (std::size_t t = 0; t < texels.size(); ++t) {
    if (texels[t] == 0) continue;
    for (std::size_t i = t * each; i < (t + 1) * each; ++i) {
      const double d = static_cast<double>(a[i]) - (b.empty() ? 0.0 : static_cast<double>(b[i]));
      sum += d * d;
    }
    count += each;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

// Readers mark clipped samples; that is what the weight of that name is, so it is taken back where it is off.
void unmark(Subject& s) { std::fill(s.weight.begin(), s.weight.end(), 1.0f); }

void plant_objects(CaptureOptions& o, Random& draw) {
  const std::size_t count = std::max<std::size_t>(1, static_cast<std::size_t>(o.lights) / 16);
  for (std::size_t i = 0; i < count; ++i)
    o.faults.objects.push_back({one_of(draw, static_cast<std::size_t>(o.lights)), between(draw, 0.12, 0.35),
                                between(draw, 0.3, 0.7), between(draw, 0.3, 0.7), between(draw, 0.4, 2)});
}

}  // namespace

const std::array<Fault, 10> kFaults{{
    {"shift", "",
     [](CaptureOptions& o, Random& d) {
       o.faults.shift_x = either(d, between(d, 0.3, 1.5)), o.faults.shift_y = either(d, between(d, 0.3, 1.5));
     },
     "photographs are 0.3 to 1.5 pixels aside, both ways"},
    {"gain", "",
     [](CaptureOptions& o, Random& d) {
       o.faults.gains = {{one_of(d, static_cast<std::size_t>(o.lights)), either(d, between(d, 0.3, 1))}};
     },
     "one light is 0.3 to 1 stop off"},
    {"shadow", "shadow",
     [](CaptureOptions& o, Random& d) { o.faults.shadow_offset_m = either(d, between(d, 0.008, 0.03)); },
     "the caster is 8 to 30 mm aside"},
    {"weak highlight", "specular", [](CaptureOptions& o, Random& d) { o.faults.residue = between(d, 0.03, 0.1); },
     "3 to 10 % of a lobe of GGX, alpha 0.2"},
    {"strong highlight", "specular", [](CaptureOptions& o, Random& d) { o.faults.residue = between(d, 0.2, 1); },
     "20 to 100 % of it"},
    {"noise", "",
     [](CaptureOptions& o, Random& d) { o.faults.full_well = between(d, 500, 2000), o.faults.read_noise = 10; },
     "a full well of 500 to 2000 electrons"},
    {"clipped", "clipped", [](CaptureOptions& o, Random& d) { o.faults.clip = between(d, 0.08, 0.12); },
     "the sensor is full at 0.08 to 0.12"},
    {"dark", "black", [](CaptureOptions& o, Random& d) { o.faults.dark = between(d, 0.01, 0.03); },
     "light below 0.01 to 0.03 is lost"},
    {"dead pixels", "black", [](CaptureOptions& o, Random& d) { o.faults.dead = between(d, 0.002, 0.02); },
     "0.2 to 2 % of the pixels are always 0"},
    {"object", "foreign", plant_objects, "a disc before the subject under one of 16 lights"},
}};

Ablation ablate(const AblationOptions& options, const GoesOn& goes_on) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < kFaults.size(); ++i)
    if (options.faults.empty() ||
        std::find(options.faults.begin(), options.faults.end(), kFaults[i].name) != options.faults.end())
      chosen.push_back(i);
  for (const std::string& name : options.faults) {
    if (std::any_of(kFaults.begin(), kFaults.end(), [&](const Fault& f) { return f.name == name; })) continue;
    std::array<std::string_view, kFaults.size()> names;
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = kFaults[i].name;
    const std::string near = files::nearest_name(name, names.data(), names.size());
    throw files::UsageError("--fault " + files::in_quotes(name) + " is none" +
                            (near.empty() ? "" : "; did you mean " + files::in_quotes(near) + "?"));
  }
  Ablation out;
  const std::size_t all = options.lights.size() * options.seeds;
  std::size_t done = 0;
  for (const std::size_t lights : options.lights) {
    const Bench bench(options, lights);
    for (std::size_t seed = options.first_seed; seed < options.first_seed + options.seeds; ++seed, ++done) {
      const auto tell = [&](std::size_t part) {
        const double share =
            (static_cast<double>(done) + static_cast<double>(part) / static_cast<double>(chosen.size() + 1)) /
            static_cast<double>(all);
        if (!goes_on(share, std::to_string(lights) + " lights")) throw files::Interrupted();
      };
      tell(0);
      const capture::Capture other = bench.photographed(seed + 500, nullptr);
      const Subject noisy = bench.read(other, {});
      const std::vector<float> with_other_noise = bench.added(noisy, Bench::baked(noisy));
      const capture::Capture photographed = bench.photographed(seed, nullptr);
      const Subject clean = bench.read(photographed, {});
      const Bake bake_of_clean = Bench::baked(clean);
      const std::vector<float> truth = bench.added(clean, bake_of_clean);
      const std::vector<std::uint8_t> every(clean.texels(), 1);
      const double size = root_mean_square(truth, {}, every), noise = root_mean_square(truth, with_other_noise, every);
      const double held_out_clean = bench.held_out_error(photographed, none(), seed);
      for (const weight::Row& row : weight::kWeights) {
        if (row.make == nullptr) continue;
        Cost cost{row.name, lights, seed};
        Subject s = clean;
        bench.weigh(photographed, only(row.name), s);
        for (const float w : s.weight) cost.touched += w < 1;
        cost.touched /= static_cast<double>(s.weight.size());
        cost.size = size, cost.noise = noise / size, cost.held_out_without = held_out_clean;
        if (cost.touched > 0) {
          cost.changed = root_mean_square(truth, bench.added(s, Bench::baked(s)), every) / size;
          cost.held_out_with = bench.held_out_error(photographed, only(row.name), seed);
        } else cost.held_out_with = held_out_clean;
        out.costs.push_back(cost);
      }
      double brightest = 0;
      for (const auto& c : clean.photo) brightest = std::max(brightest, weight::luminance(c));
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        tell(i + 1);
        const Fault& fault = kFaults[chosen[i]];
        const capture::Capture faulty = bench.photographed(seed, &fault);
        Subject s = bench.read(faulty, {});
        std::vector<std::uint8_t> touched(s.texels());
        for (std::size_t t = 0; t < s.texels(); ++t)
          for (std::size_t l = 0; l < lights; ++l)
            if (std::abs(weight::luminance(s.photo[t * lights + l]) - weight::luminance(clean.photo[t * lights + l])) >
                kTouched * brightest)
              touched[t] = 1;
        Trial trial{chosen[i], lights, seed};
        trial.touched =
            static_cast<double>(std::count(touched.begin(), touched.end(), 1)) / static_cast<double>(s.texels());
        Subject weighed = s;
        bench.weigh(faulty, only(fault.weight), weighed);
        if (fault.weight == "clipped") unmark(s);
        trial.false_residual = root_mean_square(truth, bench.added(s, Bench::baked(s)), touched);
        trial.left = root_mean_square(truth, bench.added(weighed, Bench::baked(weighed)), touched);
        trial.false_of_lobes = root_mean_square(truth, bench.added(s, Bench::baked(s, bake_of_clean.basis)), touched);
        trial.left_of_lobes =
            root_mean_square(truth, bench.added(weighed, Bench::baked(weighed, bake_of_clean.basis)), touched);
        trial.best = trial.false_residual;
        for (const double share : {1.0, 0.3, 0.1, 0.03, 0.01}) {
          Subject known = s;
          const double tolerance = share * kTouched * 10 * brightest;
          for (std::size_t at = 0; at < known.weight.size(); ++at) {
            const double d = (weight::luminance(s.photo[at]) - weight::luminance(clean.photo[at])) / tolerance;
            known.weight[at] = static_cast<float>(1 / (1 + d * d));
          }
          trial.best = std::min(trial.best, root_mean_square(truth, bench.added(known, Bench::baked(known)), touched));
        }
        trial.held_out_clean = held_out_clean;
        trial.held_out_without = bench.held_out_error(faulty, none(), seed);
        trial.held_out_with = bench.held_out_error(faulty, only(fault.weight), seed);
        out.trials.push_back(trial);
      }
      bench.remove("photographed");
    }
  }
  return out;
}

}  // namespace likeness::realis
