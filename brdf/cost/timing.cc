#include "brdf/cost/timing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <limits>
#include <numeric>
#include <random>

#ifdef __linux__
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

#include "brdf/catalog/catalog.h"
#include "brdf/cost/peak.h"

namespace likeness::cost {
namespace {

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// Instructions and cycles of this thread in user space; reads NaN where the kernel offers none.
class Counters {
 public:
  Counters() {
#ifdef __linux__
    instructions_ = open(PERF_COUNT_HW_INSTRUCTIONS, -1);
    if (instructions_ >= 0) cycles_ = open(PERF_COUNT_HW_CPU_CYCLES, instructions_);
#endif
  }
  Counters(const Counters&) = delete;
  Counters& operator=(const Counters&) = delete;
  ~Counters() {
#ifdef __linux__
    if (cycles_ >= 0) close(cycles_);
    if (instructions_ >= 0) close(instructions_);
#endif
  }
  bool available() const { return instructions_ >= 0 && cycles_ >= 0; }
  std::array<double, 2> read() const {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return available() ? std::array{value(instructions_), value(cycles_)} : std::array{none, none};
  }

 private:
#ifdef __linux__
  static int open(std::uint64_t event, int group) {
    perf_event_attr attributes{};
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.size = sizeof attributes;
    attributes.config = event;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    return static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, group, 0));
  }
  static double value(int counter) {
    std::uint64_t count = 0;
    if (::read(counter, &count, sizeof count) != sizeof count) return std::numeric_limits<double>::quiet_NaN();
    return double(count);
  }
#else
  static double value(int) { return std::numeric_limits<double>::quiet_NaN(); }
#endif
  int instructions_ = -1, cycles_ = -1;
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double at = share * double(values.size() - 1);
  const std::size_t low = std::size_t(at), high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - double(low)) * (values[high] - values[low]);
}

struct Readings {
  std::vector<double> ns, instructions, cycles;
};

// How many calls take about `seconds`.
std::size_t calls_for(const Task& task, double seconds) {
  const double first = cpu_seconds();
  task.run();  // tables are made, caches filled
  if (cpu_seconds() - first > 8 * seconds) return 1;
  std::size_t calls = 1;
  for (;;) {
    const double start = cpu_seconds();
    for (std::size_t i = 0; i < calls; ++i) task.run();
    const double took = cpu_seconds() - start;
    if (took >= seconds / 4 || calls >= (std::size_t(1) << 30)) {
      return std::max<std::size_t>(1, std::size_t(double(calls) * seconds / std::max(took, 1e-9)));
    }
    calls *= took > seconds / 64 ? 4 : 16;
  }
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
  return "unknown processor";
}

}  // namespace

std::vector<Timing> time_interleaved(const std::vector<Task>& tasks, int repeats, double seconds,
                                     const std::function<void(double)>& progress) {
  const Counters counters;
  std::vector<std::size_t> calls(tasks.size()), order(tasks.size());
  std::vector<Readings> readings(tasks.size());
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    calls[i] = calls_for(tasks[i], seconds);
    if (progress) progress(0.2 * double(i + 1) / double(tasks.size()));
  }
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::mt19937_64 engine(1);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    std::shuffle(order.begin(), order.end(), engine);
    for (std::size_t done = 0; done < order.size(); ++done) {
      const std::size_t i = order[done];
      const auto before = counters.read();
      const double start = cpu_seconds();
      for (std::size_t k = 0; k < calls[i]; ++k) tasks[i].run();
      const double took = cpu_seconds() - start;
      const auto after = counters.read();
      const double evaluations = double(calls[i]) * double(tasks[i].evaluations);
      readings[i].ns.push_back(1e9 * took / evaluations);
      readings[i].instructions.push_back((after[0] - before[0]) / evaluations);
      readings[i].cycles.push_back((after[1] - before[1]) / evaluations);
      if (progress) progress(0.2 + 0.8 * (repeat + double(done + 1) / double(order.size())) / repeats);
    }
  }
  std::vector<Timing> timings;
  for (const Readings& r : readings) {
    timings.push_back({quantile(r.ns, 0.5), quantile(r.ns, 0.25), quantile(r.ns, 0.75), quantile(r.instructions, 0.5),
                       quantile(r.cycles, 0.5)});
  }
  return timings;
}

Machine machine() {
  const Peak peak = peak_of(catalog::instruction_set());
  const std::vector<Task> tasks{{peak.multiply_adds, peak.multiply_adds_a_call},
                                {peak.exponentials, peak.values_a_call}};
  const auto timings = time_interleaved(tasks, 5, 0.01, {});
  return {processor_name(), std::string(catalog::instruction_set()), 2 / timings[0].ns, 1 / timings[1].ns,
          Counters().available()};
}

}  // namespace likeness::cost
