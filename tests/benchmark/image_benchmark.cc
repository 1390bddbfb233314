#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include <benchmark/benchmark.h>

#include "render/image/flip.h"
#include "render/image/light_error.h"
#include "render/view/view.h"

// What a picture costs after it is rendered, in CPU time of all threads for a megapixel:
//
//     likeness_benchmark --benchmark_filter=Image --benchmark_repetitions=5
namespace likeness::image {
namespace {

constexpr int kSide = 1024;

// Light over three decades, and a copy of it that is 10 % off.
struct Pair {
  Picture reference{kSide, kSide}, render{kSide, kSide};
  Pair() {
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
      state = state * 1664525u + 1013904223u;
      const float uniform = static_cast<float>(state >> 8) / 16777216.0f;
      reference.rgb[i] = 4 * uniform * uniform * uniform * uniform;
      render.rgb[i] = reference.rgb[i] * (0.9f + 0.2f * static_cast<float>(state >> 3 & 255) / 255);
    }
  }
};
const Pair& pair() {
  static const Pair kPair;
  return kPair;
}

void image_flip(benchmark::State& state) {
  const DisplayPicture reference = view::show(pair().reference, {}), render = view::show(pair().render, {});
  for (auto _ : state) benchmark::DoNotOptimize(flip(reference, render).mean);
}
BENCHMARK(image_flip)->Name("Image/flip")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void image_hdr_flip(benchmark::State& state) {
  int exposures = 0;
  for (auto _ : state) exposures = hdr_flip(pair().reference, pair().render).exposures;
  state.counters["exposures"] = exposures;
}
BENCHMARK(image_hdr_flip)->Name("Image/hdr_flip")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void image_relative_mse(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(relative_mse(pair().reference, pair().render).value);
}
BENCHMARK(image_relative_mse)->Name("Image/relative_mse")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void image_stops(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(error_in_stops(pair().reference, pair().render).p95);
}
BENCHMARK(image_stops)->Name("Image/error_in_stops")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void image_view(benchmark::State& state, const std::string& name) {
  scene::View asked;
  asked.name = name;
  const view::Shower shower(asked);
  for (auto _ : state) benchmark::DoNotOptimize(shower.show(pair().render).rgb.data());
}
BENCHMARK_CAPTURE(image_view, srgb, "srgb")
    ->Name("Image/view/srgb")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(image_view, gt, "gt")->Name("Image/view/gt")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(image_view, aces, "aces")
    ->Name("Image/view/aces")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace likeness::image
