#include "realis/report/leave_one_out.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>

#include <Eigen/Core>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "realis/bake_file.h"
#include "realis/baseline/baseline.h"
#include "realis/from_capture.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"

namespace likeness::realis {
namespace {

using Color = std::array<float, 3>;
using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

constexpr std::size_t kRenderBytes = 5;  // base color and normal
constexpr double kPeakShare = 0.999, kNoiseShare = 1e-3;

double quantile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto at = std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return static_cast<double>(values[at]);
}

// Of samples that can be trusted.
class Sum {
 public:
  Sum(double peak, double noise) : peak_(peak), noise_(noise) {}
  void add(std::span<const Color> predicted, std::span<const Color> photo, std::span<const float> weight) {
    for (std::size_t t = 0; t < predicted.size(); ++t) {
      if (!(weight[t] > 0)) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const double a = std::max(static_cast<double>(predicted[t][c]), 0.0);
        const double b = std::max(static_cast<double>(photo[t][c]), 0.0);
        squares_ += (a - b) * (a - b);
        stops_.push_back(static_cast<float>(std::abs(std::log2((a + noise_) / (b + noise_)))));
      }
    }
  }
  Errors errors() {
    if (stops_.empty()) return {};
    const double mean = squares_ / static_cast<double>(stops_.size());
    constexpr double kExact = 1e-20;  // of the peak's square: 200 dB
    return {-10 * std::log10(std::max(mean / (peak_ * peak_), kExact)), quantile(stops_, 0.5), quantile(stops_, 0.95)};
  }

 private:
  double peak_, noise_, squares_ = 0;
  std::vector<float> stops_;
};

std::vector<Color> photo_of(const Subject& s, std::size_t light) {
  std::vector<Color> out(s.texels());
  for (std::size_t t = 0; t < s.texels(); ++t) out[t] = s.photo[s.samples_of(t) + light];
  return out;
}
std::vector<float> weight_of(const Subject& s, std::size_t light) {
  std::vector<float> out(s.texels());
  for (std::size_t t = 0; t < s.texels(); ++t) out[t] = s.weight[s.samples_of(t) + light];
  return out;
}

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
  std::size_t lobes, dominant;
  Channels channels;
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
        for (std::size_t t = 0; t < out.size(); ++t) out[t] = s.render[s.samples_of(t) + i];
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
  std::size_t fold_of(std::size_t light) const { return light % study_.folds; }
  std::vector<std::size_t> lights_of(std::size_t fold) const {
    std::vector<std::size_t> out;
    for (std::size_t i = fold; i < lights(); i += study_.folds) out.push_back(i);
    return out;
  }
  void ask(double share, std::string_view what) const {
    if (!goes_on_(share, what)) throw files::Interrupted();
  }

  std::vector<Plan> plans() const {
    std::vector<Plan> out;
    for (const std::size_t k : {2, 4, 6, 8, 12, 16, 24, 31, 43, 64, 96, 192})
      out.push_back({k, 0, Channels::kLuminance});
    out.push_back({32, 8, Channels::kLuminance});
    if (options_.with_rgb) {
      for (const std::size_t k : {2, 4, 8, 10, 14, 31}) out.push_back({k, 0, Channels::kRgb});
      out.push_back({32, 8, Channels::kRgb});
    }
    // More lobes than four scales of all lights there cannot be.
    std::erase_if(out, [&](const Plan& p) { return p.lobes > 4 * (lights() - 1) || p.lobes > kMostLobes; });
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

    std::vector<float> values;
    for (std::size_t i = 0; i < subject().photo.size(); ++i)
      if (subject().weight[i] > 0) values.insert(values.end(), subject().photo[i].begin(), subject().photo[i].end());
    study_.peak = quantile(values, kPeakShare);
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

  Errors total(const std::vector<std::vector<Color>>& predicted) const {
    Sum sum(study_.peak, study_.noise);
    for (std::size_t i = 0; i < lights(); ++i) sum.add(predicted[i], photo_of(subject(), i), weight_of(subject(), i));
    return sum.errors();
  }
  void finish(Row row) {
    row.errors = total(row.predicted);
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
    const auto begin = Clock::now();
    const auto terms = static_cast<Eigen::Index>(kind.terms), count = static_cast<Eigen::Index>(lights());
    const Eigen::MatrixXf inverse = Eigen::MatrixXf::Constant(terms, count, 0.5f);
    const Eigen::MatrixXf photos =
        Eigen::MatrixXf::Constant(count, static_cast<Eigen::Index>(subject().texels() * (is_lrgb ? 1 : 3)), 0.25f);
    const auto product_begin = Clock::now();
    const Eigen::MatrixXf found = inverse * photos;
    static_cast<void>(begin);
    row.bake_seconds = (found(0, 0) > 0 ? seconds_since(product_begin) : 0) * of_all();
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

  void add_realis(const Plan& plan) {
    const bool is_rgb = plan.channels == Channels::kRgb;
    std::string name = "render + " +
                       (plan.dominant > 0 ? std::to_string(plan.dominant) + " of " + std::to_string(plan.lobes)
                                          : std::to_string(plan.lobes)) +
                       " lobes " + (is_rgb ? "RGB" : "luminance");
    ask(0, name);
    std::vector<std::vector<Color>> exact(lights());
    double spent = 0;
    std::size_t numbers = 0, stored = 0;
    BakeOptions options;
    options.channels = plan.channels, options.dominant = plan.dominant, options.floor = options_.floor;
    Row& row = add(name, Family::kRealis, 0, [&](std::size_t left) {
      const Subject& s = folds_[fold_of(left)];
      const Basis& lobes = basis(plan.lobes, fold_of(left));
      const auto begin = Clock::now();
      const Bake baked = bake_with(without(s, std::span(&left, 1)), lobes, options,
                                   [](double, std::string_view) { return !files::interrupted(); });
      spent += seconds_since(begin);
      numbers = std::max(numbers, baked.kept * baked.channel_count());
      stored = std::max(stored, bytes_of_texel(baked));
      exact[left] = predicted(s, baked, left);
      return predicted(s, quantised(baked), left);
    });
    row.exact = total(exact);
    row.bytes = stored + kRenderBytes;
    row.ns = ns_of(numbers);
    row.bake_seconds = choosing_[plan.lobes] + spent / static_cast<double>(lights()) * of_all();
  }

  static std::vector<Color> predicted(const Subject& s, const baked::Bake& baked, std::size_t light) {
    const Residual residual(baked, s.to_lights[light]);
    std::vector<Color> out(s.texels());
    for (std::size_t t = 0; t < s.texels(); ++t) {
      const std::size_t at = s.samples_of(t) + light;
      const auto e = residual.at(t, static_cast<double>(s.cosine[at]));
      for (std::size_t c = 0; c < 3; ++c)
        out[t][c] =
            static_cast<float>(std::max(static_cast<double>(s.render[at][c]) + s.irradiance_of(light) * e[c], 0.0));
    }
    return out;
  }

  const capture::Capture& capture_;
  std::size_t camera_;
  const StudyOptions& options_;
  const GoesOn& goes_on_;
  Study study_;
  std::vector<Subject> folds_;
  std::map<std::size_t, std::vector<Basis>> bases_;
  std::map<std::size_t, double> choosing_;
};

}  // namespace

Subject without(const Subject& s, std::span<const std::size_t> lights) {
  Subject out;
  out.camera = s.camera, out.width = s.width, out.height = s.height, out.pixels = s.pixels;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < s.lights.size(); ++i) {
    if (std::find(lights.begin(), lights.end(), i) != lights.end()) continue;
    kept.push_back(i);
    out.lights.push_back(s.lights[i]), out.to_lights.push_back(s.to_lights[i]);
    if (!s.irradiance.empty()) out.irradiance.push_back(s.irradiance[i]);
  }
  for (std::size_t t = 0; t < s.texels(); ++t)
    for (const std::size_t i : kept) {
      const std::size_t at = s.samples_of(t) + i;
      out.photo.push_back(s.photo[at]), out.render.push_back(s.render[at]);
      out.cosine.push_back(s.cosine[at]), out.weight.push_back(s.weight[at]);
    }
  return out;
}

Subject on_grid(const Subject& s, int stride) {
  Subject out;
  out.camera = s.camera, out.width = s.width, out.height = s.height;
  out.lights = s.lights, out.to_lights = s.to_lights, out.irradiance = s.irradiance;
  for (std::size_t t = 0; t < s.texels(); ++t) {
    const int x = static_cast<int>(s.pixels[t]) % s.width, y = static_cast<int>(s.pixels[t]) / s.width;
    if (x % stride != stride / 2 || y % stride != stride / 2) continue;
    out.pixels.push_back(s.pixels[t]);
    for (std::size_t at = s.samples_of(t); at < s.samples_of(t + 1); ++at) {
      out.photo.push_back(s.photo[at]), out.render.push_back(s.render[at]);
      out.cosine.push_back(s.cosine[at]), out.weight.push_back(s.weight[at]);
    }
  }
  return out;
}

Errors errors_of(std::span<const Color> predicted, std::span<const Color> photo, std::span<const float> weight,
                 double peak, double noise) {
  Sum sum(peak, noise);
  sum.add(predicted, photo, weight);
  return sum.errors();
}

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
