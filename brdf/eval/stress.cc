#include "brdf/eval/stress.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <ctime>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "brdf/eval/draw.h"
#include "render/files/interrupt.h"

namespace likeness::eval {
namespace {

using catalog::Column;
using catalog::Entry;

constexpr std::size_t kBlock = 2048;                // rows
constexpr double kHalfUlp = 0x1p-24;                // of a float, relative
constexpr std::size_t kFirstBin = (1023 - 64) * 8;  // 2^-64

double cpu_seconds() {  // of this thread: what else the machine does is not the evaluator's
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::size_t bin_of(double error) {
  const std::size_t octaves = std::bit_cast<std::uint64_t>(error) >> 49;
  return std::clamp<std::size_t>(octaves, kFirstBin, kFirstBin + 1023) - kFirstBin;
}

// kBlock values of each input and output in N.
template <class N>
struct SweptColumns {
  std::vector<N> values;
  std::vector<Column<N>> in;
  std::vector<N*> to, out;

  SweptColumns(std::size_t inputs, std::size_t outputs, std::size_t rows) : values((inputs + outputs) * rows) {
    for (std::size_t i = 0; i < inputs; ++i) {
      in.push_back({values.data() + i * rows, false});
      to.push_back(values.data() + i * rows);
    }
    for (std::size_t i = 0; i < outputs; ++i) out.push_back(values.data() + (inputs + i) * rows);
  }
  SweptColumns(const SweptColumns&) = delete;
  SweptColumns& operator=(const SweptColumns&) = delete;
};

// The results of an evaluator, by channel.
struct Results {
  std::vector<std::string_view> names;
  std::vector<char> may_be_negative;
  explicit Results(const Entry& entry) {
    for (const brdf::Output& output : entry.outputs)
      for (int c = 0; c < output.channels; ++c) {
        names.push_back(output.name);
        may_be_negative.push_back(output.may_be_negative);
      }
  }
};

// What became of some rows, and what they cost [CPU s].
struct Part {
  std::vector<Swept> precisions;
  double seconds = 0;

  void add(const Part& next) {
    for (std::size_t i = 0; i < precisions.size(); ++i) precisions[i].add(next.precisions[i]);
    seconds += next.seconds;
  }
};

class Sweep {
 public:
  Sweep(const Entry& entry, const StressOptions& options)
      : entry_(entry),
        options_(options),
        stream_(stream_of(options.seed, entry.name)),
        draw_(entry.forms.front().inputs),
        results_(entry),
        tables_(entry.tables()) {}

  // Rows `first` to `last`, on all cores.
  Part rows(std::uint64_t first, std::uint64_t last) const {
    const std::uint64_t size = std::clamp<std::uint64_t>((last - first) / 16, 1, kBlock);
    const std::uint64_t blocks = (last - first + size - 1) / size;
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::uint64_t>(0, blocks), none(),
        [&](const tbb::blocked_range<std::uint64_t>& range, Part all) {
          for (std::uint64_t i = range.begin(); i < range.end(); ++i)
            all.add(one_block(first + i * size, std::min(last, first + (i + 1) * size)));
          return all;
        },
        [](Part a, const Part& b) {
          a.add(b);
          return a;
        });
  }

  Part none() const {
    Part part;
    part.precisions.emplace_back().precision = "double";
    if (options_.in_float) part.precisions.emplace_back().precision = "float";
    if (options_.in_batches && !entry_.one_by_one) part.precisions.emplace_back().precision = "batch";
    return part;
  }

  Part one_block(std::uint64_t first, std::uint64_t last) const {
    if (files::interrupted()) throw files::Interrupted{};
    const double block_began = cpu_seconds();
    const std::size_t inputs = draw_.count(), outputs = entry_.output_count;
    const auto rows = static_cast<std::size_t>(last - first);
    SweptColumns<float> single(inputs, outputs, rows);
    SweptColumns<double> exact(inputs, outputs, rows);
    for (std::size_t row = 0; row < rows; ++row) {
      Random random(stream_, first + row);
      draw_.row(random, single.to.data(), row);
    }
    for (std::size_t i = 0; i < inputs; ++i)
      for (std::size_t row = 0; row < rows; ++row) exact.to[i][row] = double{single.to[i][row]};

    Part part = none();
    double began = cpu_seconds();
    entry_.in_double.from_inputs(tables_, exact.in.data(), exact.out.data(), rows);
    part.precisions[0].seconds = cpu_seconds() - began;
    check(part.precisions[0], single, exact.out, rows);
    for (std::size_t k = 1; k < part.precisions.size(); ++k) {
      Swept& swept = part.precisions[k];
      const auto& loops = swept.precision == "batch" ? entry_.in_batches : entry_.in_float;
      began = cpu_seconds();
      loops.from_inputs(tables_, single.in.data(), single.out.data(), rows);
      swept.seconds = cpu_seconds() - began;
      check(swept, single, single.out, rows);
      compare(swept, single, exact, rows);
    }
    part.seconds = cpu_seconds() - block_began;
    return part;
  }

 private:
  static std::vector<float> inputs_of(const SweptColumns<float>& single, std::size_t row) {
    std::vector<float> inputs;
    for (const float* column : single.to) inputs.push_back(column[row]);
    return inputs;
  }

  // Counts what may not be.
  template <class N>
  void check(Swept& swept, const SweptColumns<float>& single, const std::vector<N*>& out, std::size_t rows) const {
    for (std::size_t row = 0; row < rows; ++row) {
      std::size_t worst = out.size();
      bool finite = true, negative = false;
      for (std::size_t o = 0; o < out.size(); ++o) {
        const N x = out[o][row];
        const bool bad_sign = x < N(0) && !results_.may_be_negative[o], bad = !std::isfinite(x);
        if ((bad || bad_sign) && worst == out.size()) worst = o;
        finite &= !bad;
        negative |= bad_sign && !bad;
      }
      if (worst == out.size()) continue;
      swept.not_finite += !finite;
      swept.negative += negative;
      if (swept.bad.inputs.empty())
        swept.bad = {1, results_.names[worst], static_cast<double>(out[worst][row]), 0, inputs_of(single, row)};
    }
  }

  bool is_compared(const SweptColumns<float>& single, std::size_t row) const {
    for (std::size_t i = 0; i < draw_.count(); ++i) {
      const float x = std::abs(single.to[i][row]);
      if (x > 0 && x < kLeastCompared && draw_.reaches_zero(i)) return false;
    }
    return true;
  }

  void compare(Swept& swept, const SweptColumns<float>& single, const SweptColumns<double>& exact,
               std::size_t rows) const {
    double most_ulps = kLeastUlps;
    std::vector<double> uncertain;
    for (std::size_t row = 0; row < rows; ++row) {
      if (!is_compared(single, row)) continue;
      double worst = 0, ulps_at_most = 0;
      std::size_t at = 0;
      bool comparable = true;
      for (std::size_t o = 0; o < single.out.size(); ++o) {
        const double got = double{single.out[o][row]}, want = exact.out[o][row];
        const double difference = std::abs(got - want), error = difference / std::max(std::abs(want), kErrorFloor);
        comparable &= std::isfinite(error);
        if (!(error > worst)) continue;
        worst = error;
        at = o;
        ulps_at_most = worst / kHalfUlp;
      }
      if (!comparable) continue;  // counted as not finite
      ++swept.compared;
      ++swept.histogram[bin_of(worst)];
      swept.over += worst > kErrorDemand;
      if (worst > swept.worst.value)
        swept.worst = {worst, results_.names[at], double{single.out[at][row]}, exact.out[at][row],
                       inputs_of(single, row)};
      if (ulps_at_most <= most_ulps) continue;  // whatever the inputs' share, it cannot be the most
      change_by_one_ulp(single, exact, row, uncertain);
      for (std::size_t o = 0; o < single.out.size(); ++o) {
        const double got = double{single.out[o][row]}, want = exact.out[o][row];
        const double ulps = std::abs(got - want) / (uncertain[o] + kHalfUlp * std::max(std::abs(want), kErrorFloor));
        if (!(ulps > most_ulps)) continue;
        most_ulps = ulps;
        swept.ulps = {ulps, results_.names[o], got, want, inputs_of(single, row)};
      }
    }
  }

  // For each result the sum of what one ulp of each input changes, in double.
  void change_by_one_ulp(const SweptColumns<float>& single, const SweptColumns<double>& exact, std::size_t row,
                         std::vector<double>& sum) const {
    const std::size_t inputs = draw_.count(), outputs = entry_.output_count;
    SweptColumns<double> moved(inputs, outputs, inputs);
    for (std::size_t i = 0; i < inputs; ++i)
      for (std::size_t k = 0; k < inputs; ++k) moved.to[i][k] = exact.to[i][row];
    for (std::size_t i = 0; i < inputs; ++i) moved.to[i][i] = double{draw_.beside(i, single.to[i][row])};
    entry_.in_double.from_inputs(tables_, moved.in.data(), moved.out.data(), inputs);
    sum.assign(outputs, 0);
    for (std::size_t o = 0; o < outputs; ++o)
      for (std::size_t k = 0; k < inputs; ++k) {
        const double change = std::abs(moved.out[o][k] - exact.out[o][row]);
        if (std::isfinite(change)) sum[o] += change;
      }
  }

  const Entry& entry_;
  const StressOptions& options_;
  std::uint64_t stream_;
  Draw draw_;
  Results results_;
  const void* tables_;
};

}  // namespace

double Swept::quantile(double share) const {
  std::uint64_t all = 0, below = 0;
  for (const std::uint64_t count : histogram) all += count;
  for (std::size_t i = 0; i < histogram.size(); ++i) {
    below += histogram[i];
    if (static_cast<double>(below) >= share * static_cast<double>(all) && below > 0)
      return i == 0 ? 0
                    : std::min(worst.value, std::bit_cast<double>(static_cast<std::uint64_t>(i + 1 + kFirstBin) << 49));
  }
  return 0;
}

void Swept::add(const Swept& next) {
  not_finite += next.not_finite;
  negative += next.negative;
  compared += next.compared;
  over += next.over;
  seconds += next.seconds;
  if (bad.inputs.empty()) bad = next.bad;
  if (next.worst.value > worst.value) worst = next.worst;
  if (next.ulps.value > ulps.value) ulps = next.ulps;
  for (std::size_t i = 0; i < histogram.size(); ++i) histogram[i] += next.histogram[i];
}

bool Stressed::sound() const {
  return std::all_of(precisions.begin(), precisions.end(),
                     [](const Swept& s) { return s.not_finite == 0 && s.negative == 0; });
}

Stressed stress(const Entry& entry, const StressOptions& options, void (*tell)(std::string_view, double)) {
  const Sweep sweep(entry, options);
  Part all = sweep.none();
  const double budget = kCostLimit * static_cast<double>(options.rows);
  constexpr double kWave = 0.3;  // [CPU s] between two looks at the clock
  std::uint64_t done = 0, wave = 2;
  while (done < options.rows && all.seconds < budget) {
    const Part part = sweep.rows(done, std::min(options.rows, done + wave));
    done = std::min(options.rows, done + wave);
    all.add(part);
    const double cost = all.seconds / static_cast<double>(done);
    wave =
        static_cast<std::uint64_t>(std::clamp(std::min(kWave, budget - all.seconds) / cost, 1.0, 4.0 * double(done)));
    if (tell != nullptr)
      tell(entry.name, std::max(static_cast<double>(done) / static_cast<double>(options.rows), all.seconds / budget));
  }
  return {&entry, done, std::move(all.precisions)};
}

}  // namespace likeness::eval
