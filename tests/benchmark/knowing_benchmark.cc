#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <vector>

#include <benchmark/benchmark.h>
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "render/reference/reference.h"
#include "render/world/world.h"
#include "tests/benchmark/bumpy.h"
#include "tests/benchmark/lean.h"

// What it costs to know more than a scene needs: the path tracer beside one that was compiled for nothing but the
// scene's model and light (lean.h), on one thread, in turn. InRooms: its surfaces, its light and its model are functions
// that are called, as ours are; Inlined: all of it is one function. OurSurfaces, OurModels, OurLights: InRooms with one
// part after the other replaced by ours, so that each line's difference to the one before says what that part costs.
//
//     render_benchmark --benchmark_filter=Knowing
//
// time: the median over the rounds of our CPU time over the other's; time_low and time_high: its quartiles. instructions:
// the same of instructions in the process (0: the system does not count them). difference: the largest between the two
// pictures over the mean; they are the same work only if it is 0 or nearly so.
namespace likeness {
namespace {

constexpr std::array<std::uint32_t, 3> kPasses{1, 2,
                                               4};  // samples that a pixel has after each, as in reference::render()

// Instructions that this thread executes outside the kernel.
class Instructions {
 public:
  Instructions() {
    perf_event_attr attributes{};
    attributes.type = PERF_TYPE_HARDWARE, attributes.size = sizeof attributes;
    attributes.config = PERF_COUNT_HW_INSTRUCTIONS, attributes.exclude_kernel = 1, attributes.exclude_hv = 1;
    file_ = static_cast<int>(::syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
  }
  Instructions(const Instructions&) = delete;
  Instructions& operator=(const Instructions&) = delete;
  ~Instructions() {
    if (file_ >= 0) ::close(file_);
  }
  double so_far() const {
    std::uint64_t count = 0;
    return file_ >= 0 && ::read(file_, &count, sizeof count) == sizeof count ? static_cast<double>(count) : 0.0;
  }

 private:
  int file_ = -1;
};

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

void compare(benchmark::State& state, const scene::Scene& scene, const world::World& world,
             const std::function<void(reference::Film&)>& lean) {
  constexpr int kRounds = 15;
  const scene::Camera& camera = scene.cameras[0];
  const Instructions instructions;
  const auto full = [&](reference::Film& film) {
    reference::Options options;
    options.samples = kPasses.back(), options.threads = 1;
    reference::render(world, options, film, [](const auto&) { return true; });
  };
  struct Cost {
    double seconds = 0, instructions = 0;
    image::Picture picture;
  };
  const auto cost_of = [&](const std::function<void(reference::Film&)>& render) {
    reference::Film film(camera.width, camera.height, false);
    Cost cost;
    cost.seconds = -cpu_seconds(), cost.instructions = -instructions.so_far();
    render(film);
    cost.seconds += cpu_seconds(), cost.instructions += instructions.so_far();
    cost.picture = film.picture();
    return cost;
  };
  for (auto _ : state) {
    std::vector<double> time, count;
    double difference = 0;
    for (int round = 0; round < kRounds; ++round) {
      Cost a, b;
      if (round % 2 == 0) a = cost_of(full), b = cost_of(lean);
      else b = cost_of(lean), a = cost_of(full);
      time.push_back(a.seconds / b.seconds);
      count.push_back(b.instructions > 0 ? a.instructions / b.instructions : 0);
      double mean = 0, most = 0;
      for (std::size_t i = 0; i < a.picture.rgb.size(); ++i) {
        mean += b.picture.rgb[i];
        most = std::max(most, std::abs(static_cast<double>(a.picture.rgb[i]) - b.picture.rgb[i]));
      }
      difference = std::max(difference, most * static_cast<double>(a.picture.rgb.size()) / mean);
    }
    state.counters["time"] = quantile(time, 0.5);
    state.counters["time_low"] = quantile(time, 0.25), state.counters["time_high"] = quantile(time, 0.75);
    state.counters["instructions"] = quantile(count, 0.5);
    state.counters["difference"] = difference;
  }
}

template <template <class> class How>
void KnowingLambertAndPointLight(benchmark::State& state) {
  scene::Scene scene = benchmark_scene::bumpy();
  scene.cameras[0] = runtime::test::camera_at({0, 1.2f, 4}, {0, 0.4f, 0}, 45, 256, 256);
  scene.materials[0].brdf = brdf::Lambert<double>{};
  const world::World world(scene, plan::plan_of(scene));
  const auto& light = std::get<scene::PointLight>(scene.lights[0].shape);
  const lean::TrianglesAndPointLight only{world, light.position, light.intensity};
  const world::Camera camera(scene.cameras[0]);
  compare(state, scene, world, [&](reference::Film& film) {
    for (const std::uint32_t end : kPasses) lean::render<How>(only, {}, camera, end, film);
  });
}
BENCHMARK_TEMPLATE(KnowingLambertAndPointLight, lean::InRooms)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK_TEMPLATE(KnowingLambertAndPointLight, lean::Inlined)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK_TEMPLATE(KnowingLambertAndPointLight, lean::OurSurfaces)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK_TEMPLATE(KnowingLambertAndPointLight, lean::OurModels)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK_TEMPLATE(KnowingLambertAndPointLight, lean::OurLights)->Iterations(1)->Unit(benchmark::kSecond);

template <template <class> class How>
void KnowingGgxAndEnvironment(benchmark::State& state) {
  scene::Scene scene;
  scene.cameras.push_back(runtime::test::camera_at({0, 0, 4}, {0, 0, 0}, 35, 256, 256));
  brdf::Ggx<double> ggx;
  ggx.roughness = 0.4;
  runtime::test::add_sphere(scene, runtime::test::add_material(scene, ggx), {0, 0, 0}, 1);
  scene.environment = scene::Environment{};
  scene.environment->scale = glm::vec3(1);
  const world::World world(scene, plan::plan_of(scene));
  const lean::SphereAndEnvironment only{world, {0, 0, 0}, glm::vec3(1), 1};
  brdf::Ggx<float> model;
  model.roughness = 0.4f;
  const world::Camera camera(scene.cameras[0]);
  compare(state, scene, world, [&](reference::Film& film) {
    for (const std::uint32_t end : kPasses) lean::render<How>(only, model, camera, end, film);
  });
}
BENCHMARK_TEMPLATE(KnowingGgxAndEnvironment, lean::InRooms)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK_TEMPLATE(KnowingGgxAndEnvironment, lean::Inlined)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK_TEMPLATE(KnowingGgxAndEnvironment, lean::OurSurfaces)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK_TEMPLATE(KnowingGgxAndEnvironment, lean::OurModels)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace likeness
