#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "render/reference/reference.h"
#include "render/runtime/pipeline.h"
#include "render/world/camera.h"
#include "tests/benchmark/bumpy.h"

// How many times as fast two threads are as one: both integrators, beside what the machine gives two threads at all.
//
//     render_benchmark --benchmark_filter=Scaling
//
// Each round runs everything on one thread and on two, wall clock. NAME is the median over the rounds of the times as
// fast, NAME_low and NAME_high its quartiles; NAME_of_rays the median of it over that of the rays in the same round,
// which are traced in packets and do nothing else: 1 is as well as this machine can. `alu` is a loop without memory.
namespace likeness {
namespace {

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

struct Subject {
  std::string name;
  std::function<void(int threads)> run;
};

void add(double& sum, int steps) {
  double x = 0.5;
  for (int i = 0; i < steps; ++i) x = 3.7 * x * (1 - x);  // each step waits for the one before
  sum += x;
}

void Scaling(benchmark::State& state) {
  constexpr int kRounds = 9, kSteps = 20'000'000;
  using benchmark_scene::kSide;
  const scene::Scene scene = benchmark_scene::bumpy();
  const world::World world(scene, plan::plan_of(scene), false);
  const world::Camera camera(scene.cameras[0]);
  const runtime::Pipeline pipeline(world);
  const auto rays = [&](int threads) {
    constexpr int kWidth = runtime::kTileWidth, kHeight = runtime::kTileHeight, kColumns = kSide / kWidth;
    tbb::task_arena arena(threads);
    std::atomic<int> met = 0;
    const auto tile = [&](int index) {
      std::array<ray::Ray, runtime::kTilePixels> in;
      std::array<ray::Hit, runtime::kTilePixels> out;
      for (int i = 0; i < runtime::kTilePixels; ++i) {
        const int x = index % kColumns * kWidth + i % kWidth, y = index / kColumns * kHeight + i / kWidth;
        in[static_cast<std::size_t>(i)] = camera.ray({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
      }
      world.tracer.closest(in, out);
      return static_cast<int>(std::count_if(out.begin(), out.end(), [](const ray::Hit& h) { return h.is_some(); }));
    };
    const auto range = [&](const tbb::blocked_range<int>& tiles) {
      int sum = 0;
      for (int repeat = 0; repeat < 6; ++repeat)
        for (int i = tiles.begin(); i < tiles.end(); ++i) sum += tile(i);
      met += sum;
    };
    arena.execute([&] { tbb::parallel_for(tbb::blocked_range<int>(0, kColumns * (kSide / kHeight), 16), range); });
    benchmark::DoNotOptimize(met.load());
  };
  const std::vector<Subject> subjects{
      {"alu",
       [](int threads) {
         double a = 0, b = 0;
         std::thread other([&] { add(b, threads == 2 ? kSteps : 0); });
         add(a, threads == 2 ? kSteps : 2 * kSteps);
         other.join();
         benchmark::DoNotOptimize(a + b);
       }},
      {"rays", rays},
      {"path",
       [&](int threads) {
         reference::Options options;
         options.samples = 1, options.threads = threads;
         reference::Film film(kSide, kSide, false);
         reference::render(world, options, film, [](const auto&) { return true; });
         benchmark::DoNotOptimize(film.least_samples());
       }},
      {"frame", [&](int threads) { benchmark::DoNotOptimize(pipeline.frame(0, {}, threads).rgb.data()); }},
  };
  for (auto _ : state) {
    std::vector<std::vector<double>> faster(subjects.size());
    for (int round = 0; round < kRounds; ++round)
      for (std::size_t i = 0; i < subjects.size(); ++i) {
        // Which comes first changes: a machine that slows down is not taken for bad scaling.
        std::array<double, 3> took{};
        for (const int threads : {1 + round % 2, 2 - round % 2})
          took[static_cast<std::size_t>(threads)] = seconds_of([&] { subjects[i].run(threads); });
        faster[i].push_back(took[1] / took[2]);
      }
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      const std::string& name = subjects[i].name;
      state.counters[name] = quantile(faster[i], 0.5);
      state.counters[name + "_low"] = quantile(faster[i], 0.25),
                            state.counters[name + "_high"] = quantile(faster[i], 0.75);
      if (i < 2) continue;
      std::vector<double> share;
      for (int round = 0; round < kRounds; ++round)
        share.push_back(faster[i][static_cast<std::size_t>(round)] / faster[1][static_cast<std::size_t>(round)]);
      state.counters[name + "_of_rays"] = quantile(share, 0.5);
    }
  }
}
BENCHMARK(Scaling)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace likeness
