#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "render/scene/read_scene.h"
#include "tests/render/scene/small_files.h"

// Two million triangles from a file in memory to a scene, checked and mended: --benchmark_filter=ReadMesh
namespace likeness::scene {
namespace {

constexpr int kSide = 1000;  // squares; two triangles each
constexpr std::size_t kVertices = std::size_t{kSide + 1} * (kSide + 1), kTriangles = std::size_t{2} * kSide * kSide;

// The vertex of column i and row j: position, normal, texture coordinates.
std::array<float, 8> vertex(int i, int j) {
  const float u = static_cast<float>(i) / kSide, v = static_cast<float>(j) / kSide;
  return {u, 0.05f * std::sin(9 * u) * std::cos(7 * v), v, 0, 1, 0, u, v};
}

template <class Visit>
void for_each_triangle(Visit&& visit) {
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const auto at = static_cast<std::uint32_t>(j * (kSide + 1) + i);
      visit(at, at + kSide + 1, at + 1);
      visit(at + 1, at + kSide + 1, at + kSide + 2);
    }
}

std::string large_glb() {
  std::string bytes;
  for_each_triangle([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t i : {a, b, c}) test::put(bytes, i);
  });
  std::string views, accessors;
  std::size_t offset = 0;
  const auto add = [&](std::size_t size, const std::string& accessor) {
    views += (views.empty() ? "" : ", ") + ("{\"buffer\": 0, \"byteOffset\": " + std::to_string(offset)) +
             ", \"byteLength\": " + std::to_string(size) + "}";
    accessors += (accessors.empty() ? "" : ", ") + accessor;
    offset += size;
  };
  add(bytes.size(), "{\"bufferView\": 0, \"componentType\": 5125, \"type\": \"SCALAR\", \"count\": " +
                        std::to_string(3 * kTriangles) + "}");
  int view = 0;
  for (const auto& [first, count] : {std::pair{0u, 3u}, {3u, 3u}, {6u, 2u}}) {
    for (int j = 0; j <= kSide; ++j)
      for (int i = 0; i <= kSide; ++i)
        for (std::size_t k = first; k < first + count; ++k) test::put(bytes, vertex(i, j)[k]);
    add(4 * count * kVertices, "{\"bufferView\": " + std::to_string(++view) +
                                   ", \"componentType\": 5126, \"type\": \"VEC" + std::to_string(count) +
                                   "\", \"count\": " + std::to_string(kVertices) + "}");
  }
  return test::glb(
      "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{\"mesh\": 0}], \"meshes\": [{\"primitives\": [{\"indices\": 0, "
      "\"attributes\": {\"POSITION\": 1, \"NORMAL\": 2, \"TEXCOORD_0\": 3}}]}], \"accessors\": [" +
          accessors + "], \"bufferViews\": [" + views + "], \"buffers\": [{\"byteLength\": " + std::to_string(offset) +
          "}]}",
      bytes);
}

std::string large_ply() {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(kVertices) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"})
    out += std::string("property float ") + name + "\n";
  out += "element face " + std::to_string(kTriangles) + "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i)
      for (const float x : vertex(i, j)) test::put(out, x);
  for_each_triangle([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    test::put(out, std::uint8_t{3});
    for (const std::uint32_t i : {a, b, c}) test::put(out, i);
  });
  return out;
}

void read(benchmark::State& state, const std::string& name, const std::string& bytes) {
  const test::Files files{{name, bytes}};
  const Access access = test::access_of(files);
  for (auto _ : state) {
    const Scene scene = scene_of_mesh(name, access);
    if (scene.meshes.at(0).triangles.size() != kTriangles) state.SkipWithError("triangles are missing");
  }
  state.counters["triangles/s"] = benchmark::Counter(double(kTriangles), benchmark::Counter::kIsIterationInvariantRate);
}

void ReadMeshGlb(benchmark::State& state) { read(state, "a.glb", large_glb()); }
void ReadMeshPly(benchmark::State& state) { read(state, "a.ply", large_ply()); }
BENCHMARK(ReadMeshGlb)->Unit(benchmark::kMillisecond);
BENCHMARK(ReadMeshPly)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace likeness::scene
