#include "realis/report/leave_one_out.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include <Eigen/Core>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "realis/bake_file.h"
#include "realis/baseline/baseline.h"
#include "realis/from_capture.h"
#include "realis/mixes.h"
#include "realis/terminator.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"

namespace likeness::realis {
namespace {

using Color = std::array<float, 3>;
using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

constexpr std::size_t kRenderBytes = 5;  // base color and normal
constexpr double kPeakShare = 0.999, kNoiseShare = 1e-3;

// What it takes to add up `numbers` of a texel [ns].
double ns_of(std::size_t numbers) {
  constexpr std::size_t kTexels = 2048;
  const std::vector<float> kept(kTexels * numbers, 0.25f), values(numbers, 0.5f);
  double best = HUGE_VAL;
  volatile float sink = 0;
  for (int repeat = 0; repeat < 9; ++repeat) {
    const auto begin = Clock::now();
    float sum = 0;
    for (std::size_t t = 0; t < kTexels; ++t)
      sum += Eigen::Map<const Eigen::VectorXf>(kept.data() + t * numbers, static_cast<Eigen::Index>(numbers))
                 .dot(Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(numbers)));
    sink = sum;
    best = std::min(best, seconds_since(begin));
  }
  static_cast<void>(sink);
  return 1e9 * best / kTexels;
}

double luminance(const Color& c) {
  return 0.2126 * static_cast<double>(c[0]) + 0.7152 * static_cast<double>(c[1]) + 0.0722 * static_cast<double>(c[2]);
}

struct Plan {
  bool is_mixed;
  std::size_t count, dominant;  // of mixes or lobes
  Channels channels = Channels::kLuminance;
  baked::Bits bits = baked::Bits::kEight;
};

class Worker {
 public:
  Worker(const capture::Capture& capture, std::size_t camera, const StudyOptions& options, const GoesOn& goes_on)
      : capture_(capture), camera_(camera), options_(options), goes_on_(goes_on) {}

  Study study() {
    read();
    try {
      add("render", Family::kRender, kRenderBytes, [&](std::size_t i) {
        std::vector<Color> out(subject().texels());
        const Subject& s = folds_[fold_of(i)];
        for (std::size_t t = 0; t < out.size(); ++t)
          for (std::size_t c = 0; c < 3; ++c)
            out[t][c] = std::max(s.render[s.samples_of(t) + i][c], s.least_of(t, i, c));
        return out;
      });
      for (const RelighterRow& row : kRelighters)
        for (const bool is_lrgb : {true, false})
          if (!is_lrgb || row.terms > 0) add_baseline(row, is_lrgb);
      for (const Plan& plan : plans()) add_realis(plan);
      study_.basis = basis(std::min<std::size_t>(32, 4 * lights()), 0);
    } catch (const files::Interrupted&) {
      study_.is_complete = false;
    }
    return std::move(study_);
  }

 private:
  const Subject& subject() const { return study_.subject; }
  std::size_t lights() const { return subject().lights.size(); }
  // Lights of a list often stand in rows: every eighth would be a whole row.
  std::size_t fold_of(std::size_t light) const { return shuffled_[light] % study_.folds; }
  std::vector<std::size_t> lights_of(std::size_t fold) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < lights(); ++i)
      if (fold_of(i) == fold) out.push_back(i);
    return out;
  }
  void ask(double share, std::string_view what) const {
    if (!goes_on_(share, what)) throw files::Interrupted();
  }

  std::vector<Plan> plans() const {
    using enum Channels;
    using enum baked::Bits;
    std::vector<Plan> out;
    const std::size_t others = lights() - 1;
    for (const std::size_t k : {4, 8, 14, 24}) out.push_back({true, k, 0, kLuminance, kFour});
    for (const std::size_t k : {2, 4, 6, 7, 8, 12, 14, 16, 22, 31, 43, 64, 96}) out.push_back({true, k, 0});
    for (const std::size_t k : {8, 32}) out.push_back({false, k, 0});
    out.push_back({false, 32, 8});
    if (options_.with_rgb) {
      for (const std::size_t k : {4, 8, 14, 31, 64}) out.push_back({true, k, 0, kRgb});
      // No more bytes than the photographs take, with color and normal.
      if (lights() > 3) out.push_back({true, lights() - 2, 0, kRgb});
      out.push_back({false, 32, 8, kRgb});
    }
    // More mixes than lights there cannot be, nor more lobes than four scales of all lights.
    std::erase_if(out,
                  [&](const Plan& p) { return p.count > (p.is_mixed ? others : 4 * others) || p.count > kMostLobes; });
    return out;
  }

  void read() {
    const Renderer none = [&](std::size_t) -> Rendered {
      return {image::Picture(capture_.cameras[camera_].width, capture_.cameras[camera_].height), {}};
    };
    const Subject all = read_subject(capture_, camera_, none, {}, goes_on_);
    if (all.lights.size() < 2)
      throw files::UsageError("leaving a light out needs photographs under at least 2 lights; there is 1");
    const std::size_t most = options_.texels == 0 ? kMostTexels : std::min(options_.texels, kMostTexels);
    int stride = 1;
    while (all.texels() > most * static_cast<std::size_t>(stride) * static_cast<std::size_t>(stride)) ++stride;
    study_.subject = on_grid(all, stride);
    study_.stride = stride, study_.texels_of_all = all.texels();
    study_.capture = capture_.name, study_.camera = capture_.cameras[camera_].id;
    for (const std::size_t light : all.lights) study_.light_ids.push_back(capture_.lights[light].id);
    if (subject().texels() == 0) throw files::UsageError("no pixel is inside the mask");
    study_.folds = options_.variant                  ? std::min(options_.folds, all.lights.size())
                   : all.lights.size() <= kFewLights ? all.lights.size()
                                                     : std::min(options_.folds, all.lights.size());

    shuffled_.resize(all.lights.size());
    std::iota(shuffled_.begin(), shuffled_.end(), std::size_t{0});
    std::mt19937_64 random(options_.seed);
    for (std::size_t i = shuffled_.size(); i > 1; --i) std::swap(shuffled_[i - 1], shuffled_[random() % i]);

    std::vector<float> values;
    for (std::size_t i = 0; i < subject().photo.size(); ++i)
      if (subject().weight[i] > 0) values.insert(values.end(), subject().photo[i].begin(), subject().photo[i].end());
    study_.peak = quantile_of(std::move(values), kPeakShare);
    if (!(study_.peak > 0)) throw files::UsageError("the photographs are black");
    study_.noise = kNoiseShare * study_.peak;
    if (camera_ < capture_.noise_floor.size()) {
      const glm::dvec3 floor = capture_.noise_floor[camera_];
      if (const double mean = (floor.x + floor.y + floor.z) / 3; mean > 0)
        study_.noise = mean, study_.is_noise_measured = true;
    }

    folds_.assign(study_.folds, study_.subject);
    for (std::size_t f = 0; f < study_.folds; ++f) {
      std::optional<capture_fit::Fit> fit;
      if (!options_.variant) {
        capture_fit::Options fitting;
        fitting.seed = options_.seed;
        for (const std::size_t i : lights_of(f)) fitting.leave_out.push_back(subject().lights[i]);
        fit = capture_fit::fit_capture(capture_, camera_, fitting, [&](double share, std::string_view) {
          return goes_on_((static_cast<double>(f) + share) / static_cast<double>(study_.folds),
                          "fitting without a light");
        });
      }
      relight(folds_[f],
              fit ? renders_of_fit(capture_, *fit) : renders_of_variant(capture_, camera_, *options_.variant));
      if (fit) {
        face(folds_[f], *fit);
        soften(folds_[f], terminator_of(without(folds_[f], lights_of(f))));
      }
    }
    study_.subject = folds_[0];
  }

  void relight(Subject& s, const Renderer& renderer) const {
    tbb::parallel_for(std::size_t{0}, s.lights.size(), [&](std::size_t i) {
      const Rendered rendered = renderer(s.lights[i]);
      for (std::size_t t = 0; t < s.texels(); ++t) {
        for (std::size_t c = 0; c < 3; ++c) s.render[s.samples_of(t) + i][c] = rendered.light.rgb[3 * s.pixels[t] + c];
        if (!rendered.cosine.empty()) s.cosine[s.samples_of(t) + i] = rendered.cosine[s.pixels[t]];
      }
    });
  }

  void finish(Row row) {
    row.errors = errors_of(row.predicted, subject(), study_.peak, study_.noise);
    for (std::size_t i = 0; i < lights(); ++i)
      row.by_light.push_back(
          errors_of(row.predicted[i], photo_of(subject(), i), weight_of(subject(), i), study_.peak, study_.noise));
    study_.rows.push_back(std::move(row));
  }

  template <class Predict>
  Row& add(const std::string& name, Family family, std::size_t bytes, const Predict& predict) {
    Row row;
    row.name = name, row.family = family, row.bytes = bytes;
    for (std::size_t i = 0; i < lights(); ++i) {
      ask(static_cast<double>(i) / static_cast<double>(lights()), name);
      row.predicted.push_back(predict(i));
    }
    finish(std::move(row));
    return study_.rows.back();
  }

  // x right, y up, z to the camera.
  std::vector<glm::dvec3> in_camera(std::span<const glm::dvec3> directions) const {
    const glm::dmat3 turn(capture_.cameras[camera_].world_from_camera);
    std::vector<glm::dvec3> out;
    for (const glm::dvec3& d : directions) {
      const glm::dvec3 seen = d * turn;  // its transpose from the left
      out.emplace_back(seen.x, -seen.y, -seen.z);
    }
    return out;
  }

  void add_baseline(const RelighterRow& kind, bool is_lrgb) {
    const std::vector<glm::dvec3> directions = in_camera(subject().to_lights);
    const std::string name = std::string(kind.name) + (is_lrgb ? " LRGB" : kind.terms > 0 ? " RGB" : "");
    const std::size_t numbers = kind.terms > 0 ? kind.terms * (is_lrgb ? 1 : 3) : 3 * lights();
    Row& row = add(name, Family::kBaseline, bytes_of(kind, lights(), is_lrgb), [&](std::size_t left) {
      std::vector<glm::dvec3> others = directions;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(left));
      std::vector<double> weights = Baseline(kind.relighter, others).weights(directions[left]);
      weights.insert(weights.begin() + static_cast<std::ptrdiff_t>(left), 0.0);
      std::vector<Color> out(subject().texels());
      for (std::size_t t = 0; t < out.size(); ++t) {
        const std::size_t first = subject().samples_of(t);
        std::array<double, 3> value{}, sum{};
        double light = 0, all = 0;
        for (std::size_t i = 0; i < lights(); ++i) {
          if (i == left) continue;
          const Color& photo = subject().photo[first + i];
          const double y = luminance(photo), received = subject().irradiance_of(i);
          light += weights[i] * y / received, all += y;
          for (std::size_t c = 0; c < 3; ++c)
            value[c] += weights[i] * static_cast<double>(photo[c]) / received, sum[c] += static_cast<double>(photo[c]);
        }
        for (std::size_t c = 0; c < 3; ++c)
          out[t][c] = static_cast<float>(subject().irradiance_of(left) *
                                         (is_lrgb ? (all > 0 ? light * sum[c] / all : 0) : value[c]));
      }
      return out;
    });
    row.ns = ns_of(numbers);
    if (kind.terms == 0) return;
    const auto terms = static_cast<Eigen::Index>(kind.terms), count = static_cast<Eigen::Index>(lights());
    const Eigen::MatrixXf inverse = Eigen::MatrixXf::Constant(terms, count, 0.5f);
    const Eigen::MatrixXf photos =
        Eigen::MatrixXf::Constant(count, static_cast<Eigen::Index>(subject().texels() * (is_lrgb ? 1 : 3)), 0.25f);
    const auto begin = Clock::now();
    const Eigen::MatrixXf found = inverse * photos;
    row.bake_seconds = (found(0, 0) > 0 ? seconds_since(begin) : 0) * of_all();
  }

  double of_all() const { return static_cast<double>(study_.texels_of_all) / static_cast<double>(subject().texels()); }

  // Lobes of a fold, found once.
  const Basis& basis(std::size_t lobes, std::size_t fold) {
    auto [at, is_new] = bases_.try_emplace(lobes);
    if (is_new) {
      at->second.resize(study_.folds);
      const auto begin = Clock::now();
      tbb::parallel_for(std::size_t{0}, study_.folds, [&](std::size_t f) {
        BakeOptions options;
        options.lobes = lobes, options.floor = options_.floor, options.seed = options_.seed;
        at->second[f] =
            bake(without(folds_[f], lights_of(f)), options, [](double, std::string_view) { return true; }).basis;
      });
      choosing_[lobes] = seconds_since(begin) / static_cast<double>(study_.folds);
    }
    return at->second[fold];
  }

  // Mixes without a light.
  const Mixes& mixes(std::size_t left) {
    mixes_.resize(lights());
    if (!mixes_[left]) {
      const auto begin = Clock::now();
      const Subject others = without(folds_[fold_of(left)], std::span(&left, 1));
      mixes_[left].emplace(others, prior_length(others, options_.floor, options_.seed), options_.floor, options_.seed);
      choosing_mixes_ += seconds_since(begin) / static_cast<double>(lights());
    }
    return *mixes_[left];
  }

  static std::string name_of(const Plan& plan) {
    return "render + " + (plan.dominant > 0 ? std::to_string(plan.dominant) + " of " : "") +
           std::to_string(plan.count) + (plan.is_mixed ? " mixes" : " lobes") +
           (plan.channels == Channels::kRgb ? " RGB" : " luminance") +
           (plan.bits == baked::Bits::kFour ? ", 4 bit" : "");
  }

  static std::string words_of(const Plan& plan) {
    return (plan.is_mixed ? "--mixes " : "--lobes ") + std::to_string(plan.count) +
           (plan.dominant > 0 ? " --dominant " + std::to_string(plan.dominant) : "") +
           (plan.bits == baked::Bits::kFour ? " --bits 4" : "") + (plan.channels == Channels::kRgb ? " --rgb" : "");
  }

  void add_realis(const Plan& plan) {
    const std::string name = name_of(plan);
    ask(0, name);
    std::vector<std::vector<Color>> exact(lights());
    double spent = 0;
    std::size_t numbers = 0, stored = 0;
    BakeOptions options;
    options.channels = plan.channels, options.dominant = plan.dominant, options.floor = options_.floor;
    options.bits = plan.bits;
    Row& row = add(name, Family::kRealis, 0, [&](std::size_t left) {
      const Subject& s = folds_[fold_of(left)];
      const Basis functions = plan.is_mixed ? mixes(left).first(plan.count) : basis(plan.count, fold_of(left));
      const auto begin = Clock::now();
      const Bake baked = bake_with(without(s, std::span(&left, 1)), functions, options,
                                   [](double, std::string_view) { return !files::interrupted(); });
      spent += seconds_since(begin);
      numbers = std::max(numbers, baked.kept * baked.channel_count());
      stored = std::max(stored, bytes_of_texel(baked));
      exact[left] = predicted(s, baked, left);
      return predicted(s, quantised(baked), left);
    });
    row.exact = errors_of(exact, subject(), study_.peak, study_.noise);
    row.bytes = stored + kRenderBytes;
    row.bake_words = words_of(plan);
    row.ns = ns_of(numbers);
    row.bake_seconds =
        (plan.is_mixed ? choosing_mixes_ : choosing_[plan.count]) + spent / static_cast<double>(lights()) * of_all();
  }

  static std::vector<Color> predicted(const Subject& s, const baked::Bake& baked, std::size_t light) {
    const Residual residual(baked, s.to_lights[light]);
    std::vector<Color> out(s.texels());
    for (std::size_t t = 0; t < s.texels(); ++t) {
      const std::size_t at = s.samples_of(t) + light;
      const auto e = residual.at(t, static_cast<double>(s.cosine[at]));
      for (std::size_t c = 0; c < 3; ++c)
        out[t][c] = std::max(static_cast<float>(static_cast<double>(s.render[at][c]) + s.irradiance_of(light) * e[c]),
                             s.least_of(t, light, c));
    }
    return out;
  }

  const capture::Capture& capture_;
  std::size_t camera_;
  const StudyOptions& options_;
  const GoesOn& goes_on_;
  Study study_;
  std::vector<Subject> folds_;
  std::vector<std::size_t> shuffled_;  // positions of lights
  std::map<std::size_t, std::vector<Basis>> bases_;
  std::map<std::size_t, double> choosing_;
  std::vector<std::optional<Mixes>> mixes_;  // without each light
  double choosing_mixes_ = 0;
};

}  // namespace

const Row* winner_over(const Study& study, const Row& baseline) {
  const Row* best = nullptr;
  for (const Row& row : study.rows) {
    if (row.family != Family::kRealis || row.bytes > baseline.bytes) continue;
    if (row.errors.psnr <= baseline.errors.psnr || row.errors.stops_95 >= baseline.errors.stops_95) continue;
    if (best == nullptr || row.errors.stops_95 < best->errors.stops_95) best = &row;
  }
  return best;
}

Study leave_one_out(const capture::Capture& capture, std::size_t camera, const StudyOptions& options,
                    const GoesOn& goes_on) {
  return Worker(capture, camera, options, goes_on).study();
}

}  // namespace likeness::realis
