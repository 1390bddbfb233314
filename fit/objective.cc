#include "fit/objective.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace likeness::fit {

namespace {

constexpr std::size_t kChunk = 1 << 16;  // samples a task: 20 ms, a multiple of kLane

void add(const KernelOutput& part, KernelOutput& sum) {
  sum.loss += part.loss;
  for (int p = 0; p < kMaxChannels; ++p) {
    sum.gradient[p] += part.gradient[p];
    for (int q = 0; q < kMaxChannels; ++q) sum.hessian[p][q] += part.hessian[p][q];
  }
}

KernelOutput evaluate(const KernelInput<float>& in) {
  KernelOutput out;
  kernels().evaluate_float(in, out);
  return out;
}
KernelOutput evaluate(const KernelInput<double>& in) {
  KernelOutput out;
  kernels().evaluate_double(in, out);
  return out;
}

// Sums over all samples; chunks may run on any thread and are added in their order.
template <class N>
KernelOutput sums(const SampleArrays<N>& samples, std::size_t model, const double* channels, bool derivatives,
                  bool scatter = false) {
  const std::size_t chunks = (samples.padded() + kChunk - 1) / kChunk;
  const auto chunk = [&](std::size_t i) {
    return evaluate(
        samples.input(model, channels, derivatives, i * kChunk, std::min((i + 1) * kChunk, samples.padded()), scatter));
  };
  if (chunks == 1) return chunk(0);
  std::vector<KernelOutput> parts(chunks);
  tbb::this_task_arena::isolate(
      [&] { tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t i) { parts[i] = chunk(i); }); });
  for (std::size_t i = 1; i < chunks; ++i) add(parts[i], parts[0]);
  return parts[0];
}

template <class N>
Quadratic in_variables(const SampleArrays<N>& samples, const Coordinates& coordinates, const Eigen::VectorXd& x,
                       bool scatter) {
  const std::vector<double> channels = coordinates.channels_at({x.data(), x.data() + x.size()});
  const KernelOutput sum = sums(samples, coordinates.model, channels.data(), true, scatter);
  const double scale = 1 / (3 * samples.weight_sum());
  const Eigen::Index n = x.size();
  Quadratic q{sum.loss * scale, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    for (const int c : coordinates.variables[i].channels) {
      q.gradient[i] += sum.gradient[c] * scale;
      for (Eigen::Index j = 0; j < n; ++j)
        for (const int d : coordinates.variables[j].channels) q.hessian(i, j) += sum.hessian[c][d] * scale;
    }
  }
  return q;
}

}  // namespace

Quadratic objective(const SampleSet& samples, const Coordinates& coordinates, const Eigen::VectorXd& x,
                    Fineness fineness, bool scatter) {
  if (fineness == Fineness::kCoarse) return in_variables(samples.coarse, coordinates, x, scatter);
  if (fineness == Fineness::kSingle) return in_variables(samples.single, coordinates, x, scatter);
  if (samples.table.count() > 0) return in_variables(samples.table, coordinates, x, scatter);
  return in_variables(samples.exact, coordinates, x, scatter);
}

double exact_loss(const SampleSet& samples, std::size_t model, const std::vector<double>& channels) {
  if (samples.table.count() > 0)
    return sums(samples.table, model, channels.data(), false).loss / (3 * samples.table.weight_sum());
  return sums(samples.exact, model, channels.data(), false).loss / (3 * samples.exact.weight_sum());
}

double residual_scale(const SampleSet& samples) {
  return 1 / (3 * (samples.table.count() > 0 ? samples.table.weight_sum() : samples.exact.weight_sum()));
}

std::size_t residual_count(const SampleSet& samples) {
  return 3 * (samples.table.count() > 0 ? samples.table.count() : samples.exact.count());
}

}  // namespace likeness::fit
