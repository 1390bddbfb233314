#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "brdf/callisto.h"
#include "brdf/catalog/catalog.h"
#include "brdf/cost/peak.h"
#include "brdf/cost/timing.h"
#include "brdf/evaluator.h"
#include "tests/benchmark/counted.h"

// How near the batched entry point of Callisto, full tier, RGB, two lobes, comes to what its arithmetic allows here.
//
//     likeness_benchmark --benchmark_filter=Throughput --benchmark_repetitions=9
//
// Everything is measured side by side in one process (brdf/cost/timing.h). The allowed time is the sum of the counted
// operations (tests/benchmark/counted.h), each at the rate that this machine reaches in a loop of nothing else.
namespace likeness::brdf {
namespace {

constexpr std::size_t kRows = 512;  // all columns together stay in the L2 cache

template <class N>
struct Block {
  std::vector<std::vector<N>> in, out;
  std::vector<catalog::Column<N>> columns;
  std::vector<N*> results;
};

// Directions over the hemisphere, and for each row a material of its own within the usual values.
std::vector<std::vector<double>> random_rows() {
  std::mt19937_64 engine(5);
  const auto uniform = [&](double low, double high) { return low + (high - low) * double(engine() >> 11) * 0x1p-53; };
  std::vector<std::vector<double>> rows(kRows);
  for (auto& row : rows) {
    for (int i = 0; i < 2; ++i) {
      const double z = uniform(0.02, 1), r = std::sqrt(1 - z * z), phi = uniform(0, 6.283185307179586);
      row.insert(row.end(), {r * std::cos(phi), r * std::sin(phi), z});
    }
    for (const Parameter& p : Callisto<double>::kParameters)
      for (int c = 0; c < p.channels; ++c) row.push_back(uniform(p.typical.low, p.typical.high));
  }
  return rows;
}

// `one_material`: the parameters of the first row hold for all of them, as in a draw call.
template <class N>
std::shared_ptr<Block<N>> block_of(const std::vector<std::vector<double>>& rows, bool one_material) {
  auto block = std::make_shared<Block<N>>();
  block->in.assign(rows[0].size(), std::vector<N>(kRows));
  block->out.assign(3, std::vector<N>(kRows));
  for (std::size_t k = 0; k < rows[0].size(); ++k) {
    for (std::size_t i = 0; i < kRows; ++i) block->in[k][i] = N(rows[i][k]);
    block->columns.push_back({block->in[k].data(), one_material && k >= 6});
  }
  for (auto& column : block->out) block->results.push_back(column.data());
  return block;
}

template <class N>
cost::Task task_of(const catalog::Loops<N>& loops, const std::shared_ptr<Block<N>>& block) {
  return {[=] { loops.from_inputs(nullptr, block->columns.data(), block->results.data(), kRows); }, kRows};
}

Counts counted(const std::vector<std::vector<double>>& rows) {
  Counted::counts = {};
  std::vector<Counted> in;
  for (const double x : rows[0]) in.push_back(Counted(x));
  Counted out[3];
  evaluate_inputs<Surface<Callisto>, Lit<Vectors, Callisto<double>>>(nullptr, in.data(), out);
  return Counted::counts;
}

void Throughput(benchmark::State& state, bool one_material) {
  const auto rows = random_rows();
  const catalog::Entry& entry = *catalog::find("callisto");
  const Counts counts = counted(rows);
  const cost::Peak peak = cost::peak_of(catalog::instruction_set());
  const std::vector<cost::Task> tasks{task_of(entry.in_batches, block_of<float>(rows, one_material)),
                                      task_of(entry.in_double, block_of<double>(rows, one_material)),
                                      {peak.multiply_adds, peak.multiply_adds_a_call},
                                      {peak.exponentials, peak.values_a_call},
                                      {peak.logarithms, peak.values_a_call},
                                      {peak.divisions, peak.values_a_call},
                                      {peak.roots, peak.values_a_call}};
  double batch = 0, scalar = 0, allowed = 0;
  for (auto _ : state) {
    const auto t = cost::time_interleaved(tasks, 9, 0.003, {});
    batch = t[0].ns, scalar = t[1].ns;
    allowed = double(counts.basic) * t[2].ns + double(counts.exponentials) * t[3].ns +
              double(counts.logarithms) * t[4].ns + double(counts.divisions) * t[5].ns + double(counts.roots) * t[6].ns;
  }
  state.counters["ns"] = batch;
  state.counters["allowed_ns"] = allowed;
  state.counters["share_of_allowed"] = allowed / batch;
  state.counters["times_scalar_double"] = scalar / batch;
  state.counters["basic"] = double(counts.basic);
  state.counters["exp_log"] = double(counts.exponentials + counts.logarithms);
  state.counters["div_sqrt"] = double(counts.divisions + counts.roots);
  state.SetLabel(std::string(catalog::instruction_set()));
}
BENCHMARK_CAPTURE(Throughput, a_material_for_each_row, false)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Throughput, one_material, true)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace likeness::brdf
