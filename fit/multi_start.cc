#include "fit/multi_start.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fit/cpu_clock.h"

namespace likeness::fit {

namespace {

using Eigen::VectorXd;

// A number in [0, 1) for a start and a parameter: the same on every machine.
double drawn(int start, std::string_view name) {
  std::uint64_t x = 0xcbf29ce484222325;  // FNV-1a of the name, mixed with the start
  for (const char c : name) x = (x ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  x += 0x9e3779b97f4a7c15 * static_cast<std::uint64_t>(start + 1);
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

// Where a search begins, and the box it stays in. A product whose channels must share a sign (the terminator's) is
// searched in the half of the box that has the start's sign.
struct Begin {
  VectorXd x, low, high;
};

Begin whole_box(const Coordinates& coordinates) {
  const auto n = static_cast<Eigen::Index>(coordinates.size());
  Begin b{VectorXd(n), VectorXd(n), VectorXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    b.low[i] = coordinates.variables[i].low;
    b.high[i] = coordinates.variables[i].high;
  }
  return b;
}

void keep_sign(const Coordinates& coordinates, bool positive, Begin& b) {
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (!coordinates.variables[i].signed_scale) continue;
    const auto at = static_cast<Eigen::Index>(i);
    (positive ? b.low[at] : b.high[at]) = 0;
  }
}

Begin drawn_begin(const SampleSet& samples, const Coordinates& coordinates, int start) {
  Begin b = whole_box(coordinates);
  keep_sign(coordinates, start % 2 == 0, b);
  const double level[3] = {samples.diffuse_level.r, samples.diffuse_level.g, samples.diffuse_level.b};
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const Coordinate& v = coordinates.variables[i];
    const auto at = static_cast<Eigen::Index>(i);
    const double u = drawn(start, v.name), low = std::max(v.start_low, b.low[at]),
                 high = std::min(v.start_high, b.high[at]);
    if (v.reflectance && v.color >= 0) b.x[at] = std::min(level[v.color] * (0.5 + u), 0.95);
    else if (v.logarithmic) b.x[at] = std::max(low, 1e-3) * std::pow(high / std::max(low, 1e-3), u);
    else b.x[at] = low + (high - low) * u;
  }
  return b;
}

Minimiser minimiser(const SampleSet& samples, const Coordinates& coordinates, const Begin& begin, Fineness fineness,
                    int iterations, double tolerance, const std::function<bool()>& stop) {
  return {.evaluate = [&, fineness](const VectorXd& x) { return objective(samples, coordinates, x, fineness); },
          .low = begin.low,
          .high = begin.high,
          .iterations = iterations,
          .tolerance = tolerance,
          .stop = stop};
}

struct Searched {
  Begin begin;
  int start = -1;
  double loss = 0;
  std::vector<Step> steps;
  int evaluations = 0;
  double cpu_seconds = 0;
};

Searched from(const Begin& begin, int start) {
  Searched s;
  s.begin = begin;
  s.start = start;
  return s;
}

// One leg of a search: from where the last ended.
void go_on(const SampleSet& samples, const Coordinates& coordinates, Fineness fineness, int iterations,
           double tolerance, const std::function<bool()>& stop, Searched& s) {
  const double began = thread_cpu_seconds();
  const auto out = minimiser(samples, coordinates, s.begin, fineness, iterations, tolerance, stop).from(s.begin.x);
  s.begin.x = out.x;
  s.loss = out.at_x.loss;
  s.evaluations += out.evaluations;
  if (fineness != Fineness::kCoarse)
    for (const Step& step : out.steps) s.steps.push_back({static_cast<int>(s.steps.size()), step.loss});
  s.cpu_seconds += thread_cpu_seconds() - began;
}

template <class F>
void in_parallel(std::size_t count, F&& body) {
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, count, body); });
}

bool same_place(const VectorXd& a, const VectorXd& b, const Begin& box) {
  const VectorXd width = (box.high - box.low).cwiseMax(1e-9).cwiseMin(4.0);
  return ((a - b).cwiseQuotient(width)).cwiseAbs().maxCoeff() < 1e-2;
}

}  // namespace

Optimum minimise(const SampleSet& samples, const Coordinates& coordinates, const MultiStart& how) {
  std::vector<Searched> drawn_searches(static_cast<std::size_t>(how.starts));
  in_parallel(drawn_searches.size(), [&](std::size_t i) {
    Searched& s = drawn_searches[i];
    s.start = static_cast<int>(i);
    s.begin = drawn_begin(samples, coordinates, s.start);
    go_on(samples, coordinates, Fineness::kCoarse, 60, 1e-4, how.stop, s);
  });

  Optimum best;
  for (const Searched& s : drawn_searches) {
    best.start_losses.push_back(s.loss);
    best.evaluations += s.evaluations;
    best.cpu_seconds += s.cpu_seconds;
  }

  // The best few, at different places, and each warm start in each half of the box that holds it.
  std::vector<Searched> finals;
  std::vector<std::size_t> order(drawn_searches.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return drawn_searches[a].loss < drawn_searches[b].loss; });
  for (const std::size_t i : order) {
    if (static_cast<int>(finals.size()) >= how.finished) break;
    const Searched& s = drawn_searches[i];
    if (std::ranges::none_of(finals, [&](const Searched& f) { return same_place(f.begin.x, s.begin.x, s.begin); }))
      finals.push_back(from(s.begin, s.start));
  }
  for (const std::vector<double>& warm : how.warm) {
    const std::vector<double> at = coordinates.at_channels(warm);
    double lowest = 0, highest = 0;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      if (coordinates.variables[i].signed_scale) {
        lowest = std::min(lowest, at[i]);
        highest = std::max(highest, at[i]);
      }
    for (const bool positive : {true, false}) {
      if (positive ? lowest < 0 : highest > 0) continue;
      Begin b = whole_box(coordinates);
      keep_sign(coordinates, positive, b);
      b.x = Eigen::Map<const VectorXd>(at.data(), static_cast<Eigen::Index>(at.size()));
      finals.push_back(from(b, -1));
    }
  }

  // In single precision first, which is twice as fast; the two best of them exactly, and the winner to the end.
  in_parallel(finals.size(),
              [&](std::size_t i) { go_on(samples, coordinates, Fineness::kSingle, 35, 2e-4, how.stop, finals[i]); });
  std::ranges::stable_sort(finals, {}, &Searched::loss);
  in_parallel(std::min<std::size_t>(finals.size(), 2),
              [&](std::size_t i) { go_on(samples, coordinates, Fineness::kExact, 12, 1e-5, how.stop, finals[i]); });
  if (how.stop && how.stop()) throw Interrupted{};
  const auto winner = finals.size() > 1 && finals[1].loss < finals[0].loss ? finals.begin() + 1 : finals.begin();
  go_on(samples, coordinates, Fineness::kExact, 40, 1e-6, how.stop, *winner);
  for (const Searched& s : finals) {
    best.evaluations += s.evaluations;
    best.cpu_seconds += s.cpu_seconds;
  }
  if (how.stop && how.stop()) throw Interrupted{};
  const VectorXd& x = winner->begin.x;
  best.channels = coordinates.channels_at({x.data(), x.data() + x.size()});
  best.loss = winner->loss;
  best.steps = winner->steps;
  best.best_start = winner->start;
  return best;
}

}  // namespace likeness::fit
