#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "datasets_synthetic/material.h"
#include "fit/coordinates.h"
#include "fit/fit.h"
#include "fit/kernel_loops.h"
#include "fit/samples.h"

// What a fit costs: whole materials from file to parameters and metrics, and the loop inside.
//
//     likeness_benchmark --benchmark_filter=Fit --benchmark_repetitions=5 --benchmark_enable_random_interleaving=true
//
// Measured files come from the folder that LIKENESS_MATERIALS names; without it, from one synthetic MERL table.
// Fit's time is the CPU time of all threads: load (from a warm page cache), preparation, every tier with all its
// starts, uncertainties, baselines and the metrics of all of them.
namespace likeness::fit {
namespace {

brdf::Callisto<double> plastic() {
  brdf::Callisto<double> m;
  m.base_color = {0.4, 0.15, 0.1};
  m.roughness = 0.25;
  m.diffuse_fresnel = 3;
  m.retroreflection = 2;
  m.dual_specular_opacity = 0.3;
  return m;
}

std::string synthetic_table() {
  using namespace datasets_synthetic;
  return make({plastic(), grid_of(measured::Format::kMerl, 0, 0), {}, 1}).bytes;
}

std::vector<std::filesystem::path> measured_files() {
  std::vector<std::filesystem::path> files;
  if (const char* folder = std::getenv("LIKENESS_MATERIALS"))
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.is_regular_file()) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

void fit_once(benchmark::State& state, const std::filesystem::path& file, const std::string& bytes) {
  double error = 0, log = 0;
  for (auto _ : state) {
    const auto material = file.empty() ? measured::parse(bytes, "synthetic.binary") : measured::read(file);
    const Result result = fit_material(*material, file.stem().string(), Options{});
    error = result.best.metrics.slice_error_pct;
    log = result.best.metrics.slice_log_rms;
  }
  state.counters["slice_error_pct"] = error;
  state.counters["slice_log_rms"] = log;
}

const bool kFitsRegistered = [] {
  const auto add = [](const std::string& name, const std::filesystem::path& file, const std::string& bytes) {
    benchmark::RegisterBenchmark(("Fit/" + name).c_str(),
                                 [file, bytes](benchmark::State& s) { fit_once(s, file, bytes); })
        ->MeasureProcessCPUTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  };
  for (const auto& file : measured_files()) add(file.stem().string(), file, {});
  if (measured_files().empty()) add("synthetic", {}, synthetic_table());
  return true;
}();

// The normal equations of the standard slice, 5741 samples: Callisto by short Jets and the chain rule, against one Jet
// over all channels as the other models use, both on the baseline instruction set.
using Batch = xsimd::batch<double, xsimd::default_arch>;

template <auto Loop>
void NormalEquations(benchmark::State& state) {
  const auto material = measured::parse(synthetic_table(), "synthetic.binary");
  const Options options;
  const SampleSet samples = sample_set(*material, slice_points(*material, options.cut_deg), options, Reading::kStored);
  const std::vector<double> channels = folded(plastic());
  const auto in = samples.exact.input(0, channels.data(), true, 0, samples.exact.padded());
  double loss = 0;
  for (auto _ : state) {
    KernelOutput out{};
    Loop(in, out);
    loss = out.loss;
  }
  if (!(loss < 1e-9)) state.SkipWithError("the loss of a table against its own parameters is not 0");
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples.exact.count()));
}
BENCHMARK(NormalEquations<&loops::CallistoLoop<Batch>::run>)
    ->Name("NormalEquations/short Jets")
    ->Unit(benchmark::kMillisecond);
BENCHMARK(NormalEquations<&loops::run_model<brdf::Callisto, Batch>>)
    ->Name("NormalEquations/one Jet")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace likeness::fit
