#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>
#include <glm/geometric.hpp>

#include "render/ray/offset.h"
#include "render/ray/tracer.h"
#include "render/reference/reference.h"
#include "render/runtime/pipeline.h"
#include "render/world/camera.h"
#include "tests/benchmark/bumpy.h"

// Rays through our Tracer beside the same rays through Embree itself, on one mesh, and the two integrators on it.
//
//     render_benchmark --benchmark_filter=Rays --benchmark_repetitions=5 --benchmark_enable_random_interleaving=true
//
// One thread. items_per_second: rays, or camera samples.
namespace likeness {
namespace {

using benchmark_scene::bumpy, benchmark_scene::kSide;

// The scene, its rays and what they meet.
struct Setting {
  scene::Scene scene = bumpy();
  world::World world{scene, plan::plan_of(scene), false};
  std::vector<ray::Ray> primary, shadow;
  std::vector<ray::Hit> hits;
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene raw = rtcNewScene(device);

  Setting() {
    const world::Camera camera(scene.cameras[0]);
    for (int ty = 0; ty < kSide; ty += runtime::kTileHeight)
      for (int tx = 0; tx < kSide; tx += runtime::kTileWidth)
        for (int y = ty; y < ty + runtime::kTileHeight; ++y)
          for (int x = tx; x < tx + runtime::kTileWidth; ++x)
            primary.push_back(camera.ray({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}));
    hits.resize(primary.size());
    world.tracer.closest(primary, hits);
    const glm::vec3 light(2, 4, 3);
    for (std::size_t i = 0; i < primary.size(); ++i) {
      if (!hits[i].is_some()) continue;
      const glm::vec3 at = primary[i].origin + hits[i].distance * primary[i].direction;
      glm::vec3 n = glm::normalize(hits[i].normal);
      if (glm::dot(n, primary[i].direction) > 0) n = -n;
      const glm::vec3 way = light - at;
      const float distance = glm::length(way);
      shadow.push_back({ray::beside(at, n), 0, way / distance, distance});
    }
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
      const scene::Mesh& mesh = scene.meshes[m];
      RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* p = static_cast<float*>(
          rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()));
      for (const glm::vec3& v : mesh.positions) *p++ = v.x, *p++ = v.y, *p++ = v.z;
      auto* t = static_cast<unsigned*>(
          rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
      for (const auto& corners : mesh.triangles)
        for (const unsigned corner : corners) *t++ = corner;
      rtcCommitGeometry(g);
      rtcAttachGeometry(raw, g);
      rtcReleaseGeometry(g);
    }
    rtcSetSceneBuildQuality(raw, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(raw);
  }
};
Setting& setting() {
  static Setting s;
  return s;
}

void RaysEmbreePrimary8(benchmark::State& state) {
  Setting& s = setting();
  for (auto _ : state) {
    double sum = 0;
    for (std::size_t i = 0; i < s.primary.size(); i += 8) {
      alignas(32) int valid[8];
      alignas(32) RTCRayHit8 packet;
      for (unsigned k = 0; k < 8; ++k) {
        const ray::Ray& r = s.primary[i + k];
        valid[k] = -1;
        packet.ray.org_x[k] = r.origin.x, packet.ray.org_y[k] = r.origin.y, packet.ray.org_z[k] = r.origin.z;
        packet.ray.dir_x[k] = r.direction.x, packet.ray.dir_y[k] = r.direction.y, packet.ray.dir_z[k] = r.direction.z;
        packet.ray.tnear[k] = 0, packet.ray.tfar[k] = ray::kFar, packet.ray.mask[k] = ~0u, packet.ray.flags[k] = 0;
        packet.ray.time[k] = 0, packet.ray.id[k] = k, packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
      }
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
      rtcIntersect8(valid, s.raw, &context, &packet);
      for (unsigned k = 0; k < 8; ++k) sum += packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID ? 0 : 1;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(s.primary.size()));
}
BENCHMARK(RaysEmbreePrimary8)->Unit(benchmark::kMillisecond);

void RaysEmbreePrimary1(benchmark::State& state) {
  Setting& s = setting();
  for (auto _ : state) {
    double sum = 0;
    for (const ray::Ray& r : s.primary) {
      RTCRayHit q{};
      q.ray = {r.origin.x, r.origin.y, r.origin.z, 0, r.direction.x, r.direction.y, r.direction.z, 0,
               ray::kFar,  ~0u,        0,          0};
      q.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcIntersect1(s.raw, &context, &q);
      sum += q.hit.geomID == RTC_INVALID_GEOMETRY_ID ? 0 : 1;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(s.primary.size()));
}
BENCHMARK(RaysEmbreePrimary1)->Unit(benchmark::kMillisecond);

void RaysEmbreeShadow8(benchmark::State& state) {
  Setting& s = setting();
  const std::size_t whole = s.shadow.size() / 8 * 8;
  for (auto _ : state) {
    double sum = 0;
    for (std::size_t i = 0; i < whole; i += 8) {
      alignas(32) int valid[8];
      alignas(32) RTCRay8 packet;
      for (unsigned k = 0; k < 8; ++k) {
        const ray::Ray& r = s.shadow[i + k];
        valid[k] = -1;
        packet.org_x[k] = r.origin.x, packet.org_y[k] = r.origin.y, packet.org_z[k] = r.origin.z;
        packet.dir_x[k] = r.direction.x, packet.dir_y[k] = r.direction.y, packet.dir_z[k] = r.direction.z;
        packet.tnear[k] = 0, packet.tfar[k] = r.far, packet.mask[k] = ~0u, packet.flags[k] = 0;
        packet.time[k] = 0, packet.id[k] = k;
      }
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
      rtcOccluded8(valid, s.raw, &context, &packet);
      for (unsigned k = 0; k < 8; ++k) sum += packet.tfar[k] < 0 ? 1 : 0;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(whole));
}
BENCHMARK(RaysEmbreeShadow8)->Unit(benchmark::kMillisecond);

void RaysTracerPrimary(benchmark::State& state) {
  Setting& s = setting();
  std::array<ray::Hit, runtime::kTilePixels> hits;
  for (auto _ : state) {
    double sum = 0;
    for (std::size_t i = 0; i < s.primary.size(); i += hits.size()) {
      s.world.tracer.closest(std::span(s.primary).subspan(i, hits.size()), hits);
      for (const ray::Hit& hit : hits) sum += hit.is_some() ? 1 : 0;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(s.primary.size()));
}
BENCHMARK(RaysTracerPrimary)->Unit(benchmark::kMillisecond);

void RaysTracerPrimaryOneByOne(benchmark::State& state) {
  Setting& s = setting();
  for (auto _ : state) {
    double sum = 0;
    for (const ray::Ray& r : s.primary) sum += s.world.tracer.closest(r).is_some() ? 1 : 0;
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(s.primary.size()));
}
BENCHMARK(RaysTracerPrimaryOneByOne)->Unit(benchmark::kMillisecond);

void RaysTracerShadow(benchmark::State& state) {
  Setting& s = setting();
  std::array<std::uint8_t, runtime::kTilePixels> is_occluded;
  const std::size_t whole = s.shadow.size() / is_occluded.size() * is_occluded.size();
  for (auto _ : state) {
    double sum = 0;
    for (std::size_t i = 0; i < whole; i += is_occluded.size()) {
      s.world.tracer.occluded(std::span(s.shadow).subspan(i, is_occluded.size()), is_occluded);
      for (const std::uint8_t o : is_occluded) sum += o;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(whole));
}
BENCHMARK(RaysTracerShadow)->Unit(benchmark::kMillisecond);

// Camera samples of the path tracer and of a frame, on the threads given.
void RenderPath(benchmark::State& state) {
  Setting& s = setting();
  reference::Options options;
  options.samples = 1, options.threads = static_cast<int>(state.range(0));
  for (auto _ : state) {
    reference::Film film(kSide, kSide, false);
    reference::render(s.world, options, film, [](const auto&) { return true; });
    benchmark::DoNotOptimize(film.least_samples());
  }
  state.SetItemsProcessed(state.iterations() * kSide * kSide);
}
BENCHMARK(RenderPath)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void RenderFrame(benchmark::State& state) {
  Setting& s = setting();
  const runtime::Pipeline pipeline(s.world);
  std::vector<runtime::PassTime> times, sums;
  for (auto _ : state) {
    benchmark::DoNotOptimize(pipeline.frame(0, {}, static_cast<int>(state.range(0)), &times).rgb.data());
    if (sums.empty()) sums = times;
    else
      for (std::size_t i = 0; i < times.size(); ++i) sums[i].seconds += times[i].seconds;
  }
  for (const auto& t : sums)
    state.counters[std::string(t.name) + "_ms_per_Mpx"] =
        1e3 * t.seconds / static_cast<double>(state.iterations()) / (kSide * kSide * 1e-6);
  state.SetItemsProcessed(state.iterations() * kSide * kSide);
}
BENCHMARK(RenderFrame)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace likeness
