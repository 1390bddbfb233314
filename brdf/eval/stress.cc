#include "brdf/eval/stress.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>

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

double seconds_since(std::chrono::steady_clock::time_point began) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

std::size_t bin_of(double error) {
  const std::size_t octaves = std::bit_cast<std::uint64_t>(error) >> 49;
  return std::clamp<std::size_t>(octaves, kFirstBin, kFirstBin + 1023) - kFirstBin;
}

// kBlock values of each input and output in N.
template <class N>
struct Columns {
  std::vector<N> values;
  std::vector<Column<N>> in;
  std::vector<N*> to, out;

  Columns(std::size_t inputs, std::size_t outputs, std::size_t rows) : values((inputs + outputs) * rows) {
    for (std::size_t i = 0; i < inputs; ++i) {
      in.push_back({values.data() + i * rows, false});
      to.push_back(values.data() + i * rows);
    }
    for (std::size_t i = 0; i < outputs; ++i) out.push_back(values.data() + (inputs + i) * rows);
  }
  Columns(const Columns&) = delete;
  Columns& operator=(const Columns&) = delete;
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

class Sweep {
 public:
  Sweep(const Entry& entry, const StressOptions& options, std::uint64_t rows)
      : entry_(entry),
        options_(options),
        rows_(rows),
        draw_(entry.forms.front().inputs),
        results_(entry),
        tables_(entry.tables()) {}

  std::vector<Swept> blocks(std::uint64_t first, std::uint64_t last) const {
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::uint64_t>(first, last), none(),
        [&](const tbb::blocked_range<std::uint64_t>& range, std::vector<Swept> all) {
          for (std::uint64_t block = range.begin(); block < range.end(); ++block) add(all, one_block(block));
          return all;
        },
        [](std::vector<Swept> a, const std::vector<Swept>& b) {
          add(a, b);
          return a;
        });
  }

  std::vector<Swept> none() const {
    std::vector<Swept> all(1);
    all[0].precision = "double";
    if (options_.in_float) all.emplace_back().precision = "float";
    if (options_.in_batches && !entry_.one_by_one) all.emplace_back().precision = "batch";
    return all;
  }

  static void add(std::vector<Swept>& all, const std::vector<Swept>& next) {
    for (std::size_t i = 0; i < all.size(); ++i) all[i].add(next[i]);
  }

  std::vector<Swept> one_block(std::uint64_t block) const {
    if (files::interrupted()) throw files::Interrupted{};
    const std::size_t inputs = draw_.count(), outputs = entry_.output_count;
    const std::size_t rows = static_cast<std::size_t>(std::min<std::uint64_t>(kBlock, rows_ - block * kBlock));
    Columns<float> single(inputs, outputs, kBlock);
    Columns<double> exact(inputs, outputs, kBlock);
    Random random(options_.seed, entry_.name, block);
    for (std::size_t row = 0; row < rows; ++row) draw_.row(random, single.to.data(), row);
    for (std::size_t i = 0; i < inputs; ++i)
      for (std::size_t row = 0; row < rows; ++row) exact.to[i][row] = double{single.to[i][row]};

    std::vector<Swept> all = none();
    auto began = std::chrono::steady_clock::now();
    entry_.in_double.from_inputs(tables_, exact.in.data(), exact.out.data(), rows);
    all[0].seconds = seconds_since(began);
    check(all[0], single, exact.out, rows);
    for (std::size_t k = 1; k < all.size(); ++k) {
      const auto& loops = all[k].precision == "batch" ? entry_.in_batches : entry_.in_float;
      began = std::chrono::steady_clock::now();
      loops.from_inputs(tables_, single.in.data(), single.out.data(), rows);
      all[k].seconds = seconds_since(began);
      check(all[k], single, single.out, rows);
      compare(all[k], single, exact, rows);
    }
    return all;
  }

 private:
  static std::vector<float> inputs_of(const Columns<float>& single, std::size_t row) {
    std::vector<float> inputs;
    for (const float* column : single.to) inputs.push_back(column[row]);
    return inputs;
  }

  // Counts what may not be.
  template <class N>
  void check(Swept& swept, const Columns<float>& single, const std::vector<N*>& out, std::size_t rows) const {
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

  void compare(Swept& swept, const Columns<float>& single, const Columns<double>& exact, std::size_t rows) const {
    double most_ulps = kLeastUlps;
    std::vector<double> uncertain;
    for (std::size_t row = 0; row < rows; ++row) {
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
  void change_by_one_ulp(const Columns<float>& single, const Columns<double>& exact, std::size_t row,
                         std::vector<double>& sum) const {
    const std::size_t inputs = draw_.count(), outputs = entry_.output_count;
    Columns<double> moved(inputs, outputs, inputs);
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
  std::uint64_t rows_;
  Draw draw_;
  Results results_;
  const void* tables_;
};

// CPU s that a row takes in all precisions together, drawing and comparing included.
double cost_of(const Entry& entry, const StressOptions& options) {
  constexpr std::uint64_t kFew = 8, kSome = 512;
  double seconds = 0;
  for (const std::uint64_t rows : {kFew, kSome}) {
    const Sweep pilot(entry, options, rows);
    pilot.one_block(0);  // warm
    const auto began = std::chrono::steady_clock::now();
    pilot.one_block(0);
    seconds = seconds_since(began) / static_cast<double>(rows);
    if (seconds > 100 * kCostLimit) break;
  }
  return seconds;
}

// How many rows an evaluator of that cost gets.
std::uint64_t affordable(std::uint64_t rows, double seconds_a_row) {
  for (double limit = kCostLimit; seconds_a_row > limit && rows > kBlock; limit *= 10) rows /= 10;
  return std::max<std::uint64_t>(rows, 1);
}

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
  Stressed result{&entry, options.rows, {}};
  result.rows = affordable(options.rows, cost_of(entry, options));
  const Sweep sweep(entry, options, result.rows);
  result.precisions = sweep.none();
  const std::uint64_t blocks = (result.rows + kBlock - 1) / kBlock;
  constexpr std::uint64_t kWave = 8;  // blocks between two looks at the clock
  for (std::uint64_t first = 0; first < blocks; first += kWave) {
    Sweep::add(result.precisions, sweep.blocks(first, std::min(blocks, first + kWave)));
    if (tell != nullptr)
      tell(entry.name, static_cast<double>(std::min(blocks, first + kWave)) / static_cast<double>(blocks));
  }
  return result;
}

}  // namespace likeness::eval
