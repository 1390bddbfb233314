#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "brdf/cost/timing.h"
#include "brdf/realis.h"
#include "tests/brdf/realis/texels_in_set.h"

// What a texel's residual costs: eight dominant lobes of 32 that the asset has, each texel with lobes, bytes and a
// direction of its own.
//
//     likeness_benchmark --benchmark_filter=Realis
//
// Everything is measured side by side in one process (brdf/cost/timing.h): ns is the median of 41 readings, low and high
// their quartiles.
namespace likeness::brdf {
namespace {

constexpr std::size_t kTexels = 512;  // with directions and results some 16 KB: half of the L1 cache
constexpr std::size_t kLobes = 32;

struct Surface {
  RealisLobes lobes;
  std::vector<WindowedGaussian<float>> gaussians;
  std::vector<float> multipliers;
  std::vector<RealisTexel<1>> grey;
  std::vector<RealisTexel<3>> rgb;
  std::vector<float> x, y, z, u;
  std::vector<float> r = std::vector<float>(kTexels), g = r, b = r;
};
Surface surface() {
  std::mt19937_64 engine(5);
  const auto uniform = [&](double low, double high) { return low + (high - low) * double(engine() >> 11) * 0x1p-53; };
  const auto direction = [&] {
    const double z = uniform(-0.2, 1), side = std::sqrt(1 - z * z), phi = uniform(0, 6.283185307179586);
    return Vec3<float>(float(side * std::cos(phi)), float(side * std::sin(phi)), float(z));
  };
  Surface s;
  for (std::size_t k = 0; k < kLobes; ++k) {
    const Vec3<float> axis = direction();
    const float sharpness = float(uniform(2, 20)), multiplier = float(uniform(0.01, 0.2));
    s.lobes.place(k, axis, sharpness, multiplier);
    s.gaussians.push_back({{axis, sharpness, 1}});
    s.multipliers.push_back(multiplier);
  }
  for (std::size_t i = 0; i < kTexels; ++i) {
    RealisTexel<3> texel;
    for (std::size_t j = 0; j < kRealisDominant; ++j) {
      texel.lobes[j] = std::uint8_t(engine() % kLobes);
      for (auto& channel : texel.coefficients) channel[j] = std::uint8_t(1 + engine() % 255);
    }
    s.rgb.push_back(texel);
    s.grey.push_back({});
    s.grey.back().lobes = texel.lobes;
    s.grey.back().coefficients[0] = texel.coefficients[0];
    const Vec3<float> v = direction();
    s.x.push_back(v.x), s.y.push_back(v.y), s.z.push_back(v.z), s.u.push_back(float(uniform(0, 1)));
  }
  return s;
}
Surface& shared_surface() {
  static Surface s = surface();
  return s;
}

// With exponentials, one texel after the other.
void exact(Surface& s) {
  for (std::size_t i = 0; i < kTexels; ++i) {
    const Vec3<float> v(s.x[i], s.y[i], s.z[i]);
    float sum = 0;
    for (std::size_t j = 0; j < kRealisDominant; ++j) {
      const std::size_t k = s.grey[i].lobes[j];
      sum += decoded(float(s.grey[i].coefficients[0][j]), s.multipliers[k]) * s.gaussians[k].eval(v);
    }
    s.r[i] = sum;
  }
}
void scalar(Surface& s) {
  for (std::size_t i = 0; i < kTexels; ++i) s.r[i] = residual(s.lobes, s.grey[i], Vec3<float>(s.x[i], s.y[i], s.z[i]));
}
RealisTowards<> towards_of(const Surface& s) { return {s.lobes, Vec3<float>(s.x[0], s.y[0], s.z[0])}; }
void distant(Surface& s) {
  const RealisTowards<> towards = towards_of(s);
  for (std::size_t i = 0; i < kTexels; ++i) s.r[i] = residual(towards, s.grey[i]);
}
void two_of_eight(Surface& s) {
  for (std::size_t i = 0; i < kTexels; ++i)
    s.r[i] = jittered_residual(s.lobes, s.grey[i], Vec3<float>(s.x[i], s.y[i], s.z[i]), s.u[i], 2);
}
void grey(Surface& s, const TexelsInSet& set) {
  set.grey(s.lobes, s.grey.data(), s.x.data(), s.y.data(), s.z.data(), {s.r.data()}, kTexels);
}
void distant_grey(Surface& s, const TexelsInSet& set) {
  set.grey_towards(towards_of(s), s.grey.data(), {s.r.data()}, kTexels);
}
void rgb(Surface& s, const TexelsInSet& set) {
  set.rgb(s.lobes, s.rgb.data(), s.x.data(), s.y.data(), s.z.data(), {s.r.data(), s.g.data(), s.b.data()}, kTexels);
}

struct Way {
  const char* name;
  std::function<void(Surface&)> run;
};
std::vector<Way> ways() {
  std::vector<Way> all{{"exponentials, one by one", exact},
                       {"polynomials, one by one", scalar},
                       {"two of eight, drawn, one by one", two_of_eight},
                       {"one distant light, one by one", distant},
                       {"batches, baseline", [](Surface& s) { grey(s, texels_baseline()); }}};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    all.push_back({"batches, avx2", [](Surface& s) { grey(s, texels_avx2()); }});
    all.push_back({"one distant light, batches, avx2", [](Surface& s) { distant_grey(s, texels_avx2()); }});
    all.push_back({"batches, avx2, RGB", [](Surface& s) { rgb(s, texels_avx2()); }});
  }
#endif
  return all;
}

void Realis(benchmark::State& state) {
  Surface& s = shared_surface();
  std::vector<cost::Task> tasks;
  for (const Way& way : ways()) tasks.push_back({[&s, run = way.run] { run(s); }, kTexels});
  for (auto _ : state) {
    const auto timed = cost::time_interleaved(tasks, 41, 0.004, {});
    for (std::size_t i = 0; i < timed.size(); ++i) {
      const std::string name = ways()[i].name;
      state.counters[name + ", ns"] = timed[i].ns;
      state.counters[name + ", low"] = timed[i].ns_low;
      state.counters[name + ", high"] = timed[i].ns_high;
    }
  }
}
BENCHMARK(Realis)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace likeness::brdf
