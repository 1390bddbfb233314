#include "render/bloom/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include <Eigen/Dense>
#include <tbb/parallel_for.h>

#include "render/bloom/apply.h"
#include "render/bloom/fourier.h"
#include "render/bloom/rings.h"

namespace likeness::bloom {
namespace {

constexpr double kFirstScale = 0.6, kScaleGrowth = 1.15;
constexpr int kFolds = 4;
// The errors of rings are not believed below this share of their light: lenses are no exact sums of kernels.
constexpr double kLeastError = 1e-4;

// A component by its family and the logarithm of its scale in steps of the dictionary.
struct Shape {
  Family family = Family::kGaussian;
  double step = 0;
  double scale() const { return kFirstScale * std::pow(kScaleGrowth, step); }
};

struct Channel {
  RingMeans data;
  std::vector<double> error;                              // of each ring's mean
  Eigen::VectorXd direct;                                 // the source itself
  std::array<std::vector<Eigen::VectorXd>, 2> scattered;  // by family and step: the source under that kernel
};

struct Problem {
  Rings rings;
  std::vector<std::size_t> used;  // rings that have pixels
  std::array<Channel, 3> channels;
  int steps = 0;
  bool is_direct_seen = true;
};

// The rings of a component of any scale: a cubic through the four nearest entries of the dictionary.
Eigen::VectorXd column_of(const Channel& channel, const Shape& shape) {
  const auto& table = channel.scattered[static_cast<std::size_t>(shape.family)];
  const auto last = static_cast<double>(table.size() - 1);
  const double at = std::clamp(shape.step, 0.0, last);
  const auto i = static_cast<std::size_t>(std::min(std::floor(at), last - 1));
  const double t = at - static_cast<double>(i);
  const Eigen::VectorXd &b = table[i], &c = table[i + 1];
  const Eigen::VectorXd a = i > 0 ? table[i - 1] : Eigen::VectorXd(2 * b - c);
  const Eigen::VectorXd d = i + 2 < table.size() ? table[i + 2] : Eigen::VectorXd(2 * c - b);
  return b + 0.5 * t * ((c - a) + t * ((2 * a - 5 * b + 4 * c - d) + t * (3 * (b - c) + d - a)));
}

// Weighted columns and data of one channel over some rings.
struct System {
  Eigen::MatrixXd columns;
  Eigen::VectorXd data;
};
System system_of(const Problem& problem, std::size_t c, const std::vector<Shape>& shapes,
                 const std::vector<std::size_t>& rings) {
  const Channel& channel = problem.channels[c];
  const Eigen::Index first = problem.is_direct_seen ? 1 : 0, rows = static_cast<Eigen::Index>(rings.size());
  System out{Eigen::MatrixXd(rows, first + static_cast<Eigen::Index>(shapes.size())), Eigen::VectorXd(rows)};
  std::vector<Eigen::VectorXd> all;
  if (problem.is_direct_seen) all.push_back(channel.direct);
  for (const Shape& shape : shapes) all.push_back(column_of(channel, shape));
  for (Eigen::Index i = 0; i < rows; ++i) {
    const std::size_t ring = rings[static_cast<std::size_t>(i)];
    out.data[i] = channel.data.mean[ring] / channel.error[ring];
    for (std::size_t k = 0; k < all.size(); ++k)
      out.columns(i, static_cast<Eigen::Index>(k)) = all[k][static_cast<Eigen::Index>(ring)] / channel.error[ring];
  }
  return out;
}

// Non-negative least squares by trying each set of columns: there are seven at most.
Eigen::VectorXd nonnegative(const System& system) {
  const Eigen::Index count = system.columns.cols();
  const Eigen::MatrixXd normal = system.columns.transpose() * system.columns;
  const Eigen::VectorXd right = system.columns.transpose() * system.data;
  Eigen::VectorXd best = Eigen::VectorXd::Zero(count);
  double least = 0;  // of w' N w - 2 w' b; nothing at all is 0
  for (unsigned set = 1; set < 1u << count; ++set) {
    std::vector<Eigen::Index> in;
    for (Eigen::Index k = 0; k < count; ++k)
      if (set >> k & 1u) in.push_back(k);
    const Eigen::MatrixXd part = normal(in, in);
    const Eigen::VectorXd size = part.diagonal().cwiseSqrt().cwiseMax(1e-300);
    const Eigen::MatrixXd scaled = size.cwiseInverse().asDiagonal() * part * size.cwiseInverse().asDiagonal();
    const Eigen::VectorXd w =
        size.cwiseInverse().asDiagonal() * scaled.ldlt().solve(size.cwiseInverse().asDiagonal() * right(in));
    if (!w.allFinite() || w.minCoeff() < 0) continue;
    const double value = w.dot(part * w) - 2 * w.dot(right(in));
    if (value >= least) continue;
    least = value;
    best.setZero();
    best(in) = w;
  }
  return best;
}

double misfit_of(const Problem& problem, const std::vector<Shape>& shapes, const std::vector<std::size_t>& rings) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const System system = system_of(problem, c, shapes, rings);
    sum += (system.columns * nonnegative(system) - system.data).squaredNorm();
  }
  return sum;
}

// Scales one after another by ever shorter steps.
void refine(const Problem& problem, std::vector<Shape>& shapes, const std::vector<std::size_t>& rings) {
  double least = misfit_of(problem, shapes, rings);
  for (double step = 1.5; step > 2e-3; step *= 0.6) {
    for (int round = 0; round < 6; ++round) {
      bool moved = false;
      for (Shape& shape : shapes)
        for (const double by : {-step, step}) {
          const double before = shape.step;
          shape.step = std::clamp(before + by, 0.0, static_cast<double>(problem.steps - 1));
          const double value = misfit_of(problem, shapes, rings);
          if (value < least) least = value, moved = true;
          else shape.step = before;
        }
      if (!moved) break;
    }
  }
}

// One component more: the entry of the dictionary that helps most, then all scales anew.
void extend(const Problem& problem, std::vector<Shape>& shapes, const std::vector<std::size_t>& rings) {
  double least = std::numeric_limits<double>::infinity();
  Shape best;
  shapes.emplace_back();
  for (const FamilyRow& row : kFamilies)
    for (int step = 0; step < problem.steps; step += 2) {
      shapes.back() = {row.family, static_cast<double>(step)};
      if (const double value = misfit_of(problem, shapes, rings); value < least) least = value, best = shapes.back();
    }
  shapes.back() = best;
  refine(problem, shapes, rings);
}

// The dictionary: two kernels share a transform as its real and imaginary part.
void scatter_sources(Problem& problem, const std::array<std::vector<double>, 3>& sources, const FitOptions& options) {
  const int radius = problem.rings.side - 1,
            size = fast_size(problem.rings.side + radius);  // as far as across the square
  std::vector<Square> spectra;
  for (std::size_t c = 0; c < 3; ++c) {
    Square square(size);
    for (int y = 0; y < problem.rings.side; ++y)
      for (int x = 0; x < problem.rings.side; ++x)
        square(x, y) = sources[c][static_cast<std::size_t>(y) * static_cast<std::size_t>(problem.rings.side) +
                                  static_cast<std::size_t>(x)];
    transform(square, false);
    spectra.push_back(std::move(square));
  }
  for (Channel& channel : problem.channels)
    for (auto& table : channel.scattered) table.resize(static_cast<std::size_t>(problem.steps));
  std::mutex telling;
  double done = 0;
  tbb::parallel_for(0, problem.steps, [&](int step) {
    const double scale = Shape{Family::kGaussian, static_cast<double>(step)}.scale();
    Square kernels(size);
    add_kernel(kernels, sampled(Family::kGaussian, scale, radius), radius, 1);
    add_kernel(kernels, sampled(Family::kCauchy, scale, radius), radius, {0, 1});
    transform(kernels, false);
    for (std::size_t c = 0; c < 3; ++c) {
      Square both(size);
      for (std::size_t i = 0; i < both.at.size(); ++i) both.at[i] = spectra[c].at[i] * kernels.at[i];
      transform(both, true);
      for (std::size_t family = 0; family < 2; ++family) {
        std::vector<double> square;
        square.reserve(problem.rings.of_pixel.size());
        for (int y = 0; y < problem.rings.side; ++y)
          for (int x = 0; x < problem.rings.side; ++x)
            square.push_back(family == 0 ? both(x, y).real() : both(x, y).imag());
        const RingMeans means = means_of(problem.rings, square);
        problem.channels[c].scattered[family][static_cast<std::size_t>(step)] =
            Eigen::Map<const Eigen::VectorXd>(means.mean.data(), static_cast<Eigen::Index>(means.mean.size()));
      }
    }
    const std::lock_guard lock(telling);
    if (options.tell) options.tell(0.8 * ++done / problem.steps);
  });
}

Trial trial_of(const Problem& problem, const std::vector<Shape>& shapes) {
  std::vector<double> terms;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    std::vector<std::size_t> fitted, held;
    for (std::size_t i = 0; i < problem.used.size(); ++i)
      (i % kFolds == fold ? held : fitted).push_back(problem.used[i]);
    if (held.empty() || fitted.empty()) continue;
    std::vector<Shape> own = shapes;
    refine(problem, own, fitted);
    for (std::size_t c = 0; c < 3; ++c) {
      const System from = system_of(problem, c, own, fitted), at = system_of(problem, c, own, held);
      const Eigen::VectorXd rest = at.columns * nonnegative(from) - at.data;
      for (const double value : rest) terms.push_back(value * value);
    }
  }
  Trial trial{static_cast<int>(shapes.size()), 0, 0};
  for (const double term : terms) trial.held_out += term / static_cast<double>(terms.size());
  for (const double term : terms) trial.held_out_error += std::pow(term - trial.held_out, 2);
  trial.held_out_error = std::sqrt(trial.held_out_error) / static_cast<double>(terms.size());
  return trial;
}

// Weights and scales at once: the inverse of J'J, whose columns are the components of each channel and the derivatives by
// the common scales. Returns the variances of the scales' steps, then of each channel's columns.
Eigen::VectorXd variances_of(const Problem& problem, const std::vector<Shape>& shapes,
                             const std::array<Eigen::VectorXd, 3>& weights) {
  const auto scales = static_cast<Eigen::Index>(shapes.size()), columns = weights[0].size(), first = columns - scales;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(scales + 3 * columns, scales + 3 * columns);
  for (std::size_t c = 0; c < 3; ++c) {
    const System system = system_of(problem, c, shapes, problem.used);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(system.columns.rows(), normal.cols());
    for (Eigen::Index k = 0; k < scales; ++k) {
      std::vector<Shape> low = shapes, high = shapes;
      low[static_cast<std::size_t>(k)].step -= 0.05, high[static_cast<std::size_t>(k)].step += 0.05;
      jacobian.col(k) = weights[c][first + k] *
                        (system_of(problem, c, high, problem.used).columns.col(first + k) -
                         system_of(problem, c, low, problem.used).columns.col(first + k)) /
                        0.1;
    }
    for (Eigen::Index k = 0; k < columns; ++k)
      if (weights[c][k] > 0) jacobian.col(scales + static_cast<Eigen::Index>(c) * columns + k) = system.columns.col(k);
    normal += jacobian.transpose() * jacobian;
  }
  const Eigen::VectorXd size = normal.diagonal().cwiseSqrt().unaryExpr([](double v) { return v > 0 ? v : 1.0; });
  Eigen::MatrixXd scaled = size.cwiseInverse().asDiagonal() * normal * size.cwiseInverse().asDiagonal();
  for (Eigen::Index i = 0; i < scaled.rows(); ++i)
    if (scaled(i, i) == 0) scaled(i, i) = 1;
  scaled.diagonal().array() += 1e-12;
  return (scaled.inverse().diagonal().array() / size.array().square()).matrix();
}

// Of one pixel, over its ring's mean: pooled over neighbouring rings where a ring has few pixels.
double relative_deviation(const RingMeans& of, const std::vector<double>& level, std::size_t ring) {
  constexpr double kEnough = 60;
  double sum = 0, freedom = 0;
  for (std::size_t reach = 0; freedom < kEnough && reach < level.size(); ++reach)
    for (const std::size_t i : {ring - reach, ring + reach}) {
      if (i >= level.size() || of.pixels[i] < 2 || level[i] == 0 || (reach == 0 && freedom > 0)) continue;
      sum += (of.pixels[i] - 1) * std::pow(of.deviation[i] / level[i], 2);
      freedom += of.pixels[i] - 1;
    }
  return freedom > 0 ? std::sqrt(sum / freedom) : 0;
}

void take_errors(Problem& problem, const std::array<RingMeans, 3>& of) {
  for (std::size_t c = 0; c < 3; ++c) {
    Channel& channel = problem.channels[c];
    const std::vector<double>& level = channel.data.mean;
    double brightest = 0;
    for (const double mean : level) brightest = std::max(brightest, std::abs(mean));
    channel.error.resize(level.size());
    for (std::size_t i = 0; i < channel.error.size(); ++i)
      channel.error[i] = std::hypot(relative_deviation(of[c], level, i) * std::abs(level[i]) /
                                        std::sqrt(std::max(1.0, of[c].pixels[i])),
                                    kLeastError * std::abs(level[i]), 1e-12 * brightest) +
                         1e-300;
  }
}

Problem problem_of(const image::Picture& source, const image::Picture& glare, const FitOptions& options, Fit& fit) {
  if (source.width != glare.width || source.height != glare.height)
    throw std::invalid_argument("is " + std::to_string(source.width) + " x " + std::to_string(source.height) +
                                " and the other " + std::to_string(glare.width) + " x " + std::to_string(glare.height) +
                                "; both must be of one size");
  Problem problem;
  problem.rings = rings_about(source, options.radius);
  fit.clip = options.clip ? options.clip : clip_of(glare);
  for (int y = 0; y < problem.rings.side; ++y)
    for (int x = 0; x < problem.rings.side; ++x) {
      int& ring = problem.rings.of_pixel[static_cast<std::size_t>(y) * static_cast<std::size_t>(problem.rings.side) +
                                         static_cast<std::size_t>(x)];
      bool is_bad = false;
      for (const float value : glare.at(problem.rings.left + x, problem.rings.top + y))
        is_bad |= !std::isfinite(value) || (fit.clip && static_cast<double>(value) >= *fit.clip);
      if (is_bad && ring >= 0) ring = -1, ++fit.clipped;
    }
  double whole = 0, seen = 0;
  std::array<std::vector<double>, 3> sources;
  for (std::size_t c = 0; c < 3; ++c) {
    sources[c] = square_of(problem.rings, source, c);
    problem.channels[c].data = means_of(problem.rings, square_of(problem.rings, glare, c));
    const RingMeans direct = means_of(problem.rings, sources[c]);
    problem.channels[c].direct =
        Eigen::Map<const Eigen::VectorXd>(direct.mean.data(), static_cast<Eigen::Index>(direct.mean.size()));
    for (std::size_t i = 0; i < direct.mean.size(); ++i) seen += direct.mean[i] * direct.pixels[i];
    for (const double value : sources[c]) whole += value;
  }
  fit.is_direct_seen = problem.is_direct_seen = seen > 0.05 * whole;
  for (std::size_t i = 0; i < problem.rings.count(); ++i)
    if (problem.channels[0].data.pixels[i] > 0) problem.used.push_back(i);
  if (problem.used.size() < 8)
    throw std::invalid_argument("leaves " + std::to_string(problem.used.size()) +
                                " rings that are not clipped; 8 are needed");
  problem.steps = 2 + static_cast<int>(std::log(0.5 * problem.rings.side / kFirstScale) / std::log(kScaleGrowth));
  scatter_sources(problem, sources, options);
  take_errors(problem, {problem.channels[0].data, problem.channels[1].data, problem.channels[2].data});
  return problem;
}

// The kernel of a solution, its sums made 1.
Kernel kernel_from(const Problem& problem, const std::vector<Shape>& shapes,
                   const std::array<Eigen::VectorXd, 3>& weights, Fit& fit) {
  Kernel kernel{problem.rings.side - 1, {0, 0, 0}, {}};
  for (const Shape& shape : shapes) kernel.components.push_back({shape.family, shape.scale(), {}, 0, {}});
  const Eigen::Index first = problem.is_direct_seen ? 1 : 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double sum = weights[c].sum(), total = problem.is_direct_seen ? (sum > 0 ? sum : 1) : std::max(1.0, sum);
    fit.scale[c] = problem.is_direct_seen ? sum : 1;
    double scattered = 0;
    for (std::size_t k = 0; k < shapes.size(); ++k)
      scattered += kernel.components[k].weight[c] = weights[c][first + static_cast<Eigen::Index>(k)] / total;
    kernel.direct[c] = std::max(0.0, 1 - scattered);
  }
  return kernel;
}

}  // namespace

std::optional<double> clip_of(const image::Picture& glare) {
  float largest = 0;
  std::size_t times = 0;
  for (const float value : glare.rgb) {
    if (!std::isfinite(value) || value < largest) continue;
    times = value > largest ? 1 : times + 1;
    largest = value;
  }
  return times >= 4 && largest > 0 ? std::optional<double>(static_cast<double>(largest)) : std::nullopt;
}

Fit fit_kernel(const image::Picture& source, const image::Picture& glare, const FitOptions& options) {
  Fit fit;
  Problem problem = problem_of(source, glare, options, fit);
  const auto solved = [&](const std::vector<Shape>& shapes) {
    std::array<Eigen::VectorXd, 3> weights;
    for (std::size_t c = 0; c < 3; ++c) weights[c] = nonnegative(system_of(problem, c, shapes, problem.used));
    return weights;
  };
  // First by the scatter within rings, then by the scatter about the first fit, which knows that rings are not flat.
  std::vector<Shape> first;
  for (int k = 0; k < std::min(2, options.most); ++k) extend(problem, first, problem.used);
  const Kernel rough = kernel_from(problem, first, solved(first), fit);
  std::array<RingMeans, 3> about;
  const Applied under = apply(source, rough);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> rest = square_of(problem.rings, glare, c);
    const std::vector<double> model = square_of(problem.rings, under.picture, c);
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= fit.scale[c] * model[i];
    about[c] = means_of(problem.rings, rest);
  }
  take_errors(problem, about);
  if (options.tell) options.tell(0.85);

  std::vector<std::vector<Shape>> found;
  std::vector<Shape> shapes;
  for (int k = 0; k < options.most; ++k) {
    extend(problem, shapes, problem.used);
    found.push_back(shapes);
    fit.trials.push_back(trial_of(problem, shapes));
    if (options.tell) options.tell(0.85 + 0.15 * (k + 1) / options.most);
  }
  const auto best = std::min_element(fit.trials.begin(), fit.trials.end(),
                                     [](const Trial& a, const Trial& b) { return a.held_out < b.held_out; });
  const double enough = best->held_out + best->held_out_error;
  const auto chosen =
      std::find_if(fit.trials.begin(), fit.trials.end(), [&](const Trial& t) { return t.held_out <= enough; });
  shapes = found[static_cast<std::size_t>(chosen - fit.trials.begin())];
  std::sort(shapes.begin(), shapes.end(), [](const Shape& a, const Shape& b) { return a.scale() < b.scale(); });

  const std::array<Eigen::VectorXd, 3> weights = solved(shapes);
  fit.kernel = kernel_from(problem, shapes, weights, fit);
  const double freedom = 3 * static_cast<double>(problem.used.size()) - 3 * static_cast<double>(weights[0].size()) -
                         static_cast<double>(shapes.size());
  fit.misfit = misfit_of(problem, shapes, problem.used) / std::max(1.0, freedom);
  const Eigen::VectorXd variance = variances_of(problem, shapes, weights) * std::max(1.0, fit.misfit);
  const auto scales = static_cast<Eigen::Index>(shapes.size());
  for (Eigen::Index k = 0; k < scales; ++k) {
    Component& component = fit.kernel.components[static_cast<std::size_t>(k)];
    component.scale_error = component.scale * std::log(kScaleGrowth) * std::sqrt(variance[k]);
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Index column =
          scales + static_cast<Eigen::Index>(c) * weights[c].size() + (problem.is_direct_seen ? 1 : 0) + k;
      const double total = fit.scale[c] > 0 ? fit.scale[c] : 1;
      // What is known of the total is what is known of the light that stays.
      const double of_total = problem.is_direct_seen ? component.weight[c] * std::sqrt(variance[column - 1 - k]) : 0;
      component.weight_error[c] = std::hypot(std::sqrt(variance[column]), of_total) / total;
    }
  }
  for (const std::size_t ring : problem.used) fit.radius.push_back(problem.rings.radius[ring]);
  for (std::size_t c = 0; c < 3; ++c) {
    const System system = system_of(problem, c, shapes, problem.used);
    const Eigen::VectorXd model = system.columns * weights[c];
    for (std::size_t i = 0; i < problem.used.size(); ++i) {
      const std::size_t ring = problem.used[i];
      fit.glare[c].push_back(problem.channels[c].data.mean[ring]);
      fit.error[c].push_back(problem.channels[c].error[ring]);
      fit.source[c].push_back(problem.channels[c].direct[static_cast<Eigen::Index>(ring)]);
      fit.model[c].push_back(model[static_cast<Eigen::Index>(i)] * problem.channels[c].error[ring]);
    }
  }
  return fit;
}

}  // namespace likeness::bloom
