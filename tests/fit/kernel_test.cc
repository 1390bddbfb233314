#include "fit/kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "fit/coordinates.h"
#include "fit/samples.h"

namespace likeness::fit {

Kernels kernels_baseline();
#ifdef __x86_64__
Kernels kernels_avx2();
Kernels kernels_avx512();
#endif

namespace {

using Channels = std::vector<double>;

// Every instruction set of this processor.
std::vector<Kernels> all_kernels() {
  std::vector<Kernels> out{kernels_baseline()};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) out.push_back(kernels_avx2());
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd"))
    out.push_back(kernels_avx512());
#endif
  return out;
}

struct Point {
  measured::Direction l, v;
  measured::Rgb f;
  double weight;
};

// 301 samples, which is no multiple of kLane: directions over the hemisphere down to 89 degrees, values 0 to 20.
std::vector<Point> points(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  const auto direction = [&] {
    const double theta = u(random) * 89 * std::numbers::pi / 180, phi = 2 * std::numbers::pi * u(random);
    return measured::Direction{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  const auto value = [&] { return 20 * std::pow(u(random), 4); };
  std::vector<Point> out;
  for (int i = 0; i < 301; ++i) out.push_back({direction(), direction(), {value(), value(), value()}, 0.1 + u(random)});
  return out;
}

template <class N>
SampleArrays<N> arrays_of(const std::vector<Point>& points, Loss loss) {
  SampleArrays<N> arrays(loss);
  for (const Point& p : points) arrays.add(p.l, p.v, p.f, p.weight);
  arrays.finish();
  return arrays;
}

// A model with every channel inside its usual range, so that none sits on a kink of its formula.
brdf::AnyBrdf drawn(std::size_t index, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0.05, 0.95);
  brdf::AnyBrdf model;
  brdf::model_of_name(brdf::kModelNames[index], model);
  std::visit(
      [&]<template <class> class M>(M<double>& m) {
        std::vector<double> channels;
        for (const brdf::Parameter& row : M<double>::kParameters)
          for (int c = 0; c < row.channels; ++c)
            channels.push_back(row.typical.low + (row.typical.high - row.typical.low) * u(random));
        m = brdf::model_from_channels<M, double>(channels.data());
      },
      model);
  return model;
}

// The residuals as docs/fit.md defines them, one after another, from the evaluator in double.
std::vector<double> residuals(const std::vector<Point>& points, std::size_t model, const Channels& folded, Loss loss) {
  std::vector<double> out;
  const brdf::AnyBrdf brdf = unfolded(model, folded);
  for (const Point& p : points) {
    const measured::Rgb g = std::visit([&](const auto& m) { return m.eval(p.l, p.v); }, brdf);
    const double pair[3][2] = {{p.f.r, g.r}, {p.f.g, g.g}, {p.f.b, g.b}}, w = std::sqrt(p.weight);
    for (const auto& [f, value] : pair) {
      if (loss == Loss::kLog) {
        out.push_back(w * (std::log1p(f * p.l.z) - std::log1p(value * p.l.z)));
        out.push_back(w * kShownWeight * (std::min(f, 1.0) - std::min(value, 1.0)));
      } else {
        out.push_back(w * (std::cbrt(f * p.l.z + kCubeRootOffset) - std::cbrt(value * p.l.z + kCubeRootOffset)));
      }
    }
  }
  return out;
}

double sum_of_squares(const std::vector<double>& r) {
  double sum = 0;
  for (const double x : r) sum += x * x;
  return sum;
}

// J by central differences, a column a channel; empty for an intensity that is folded into its tint.
std::vector<std::vector<double>> jacobian(const std::vector<Point>& points, std::size_t model, const Channels& channels,
                                          Loss loss) {
  std::vector<std::vector<double>> columns;
  for (std::size_t p = 0; p < channels.size(); ++p) {
    const double h = 1e-5 * std::max(1.0, std::abs(channels[p]));
    Channels up = channels, down = channels;
    up[p] += h;
    down[p] -= h;
    auto column = residuals(points, model, up, loss);
    const auto low = residuals(points, model, down, loss);
    for (std::size_t i = 0; i < column.size(); ++i) column[i] = (column[i] - low[i]) / (2 * h);
    columns.push_back(std::move(column));
  }
  return columns;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Channels that the kernel does not differentiate by: intensities, which stand at 1 beside their tints.
std::vector<bool> intensities(const brdf::AnyBrdf& model) {
  return std::visit(
      [](const auto& m) {
        std::vector<bool> out;
        for (const brdf::Parameter& row : m.kParameters) {
          bool tinted = false;
          for (const brdf::Parameter& other : m.kParameters) tinted = tinted || other.tints == row.name;
          for (int c = 0; c < row.channels; ++c) out.push_back(tinted);
        }
        return out;
      },
      model);
}

// Indices of the models that have a kernel.
std::vector<std::size_t> fitted() {
  std::vector<std::size_t> out;
  for (std::size_t model = 0; model < brdf::kModelNames.size(); ++model)
    if (brdf::kFittedModels[model]) out.push_back(model);
  return out;
}

TEST(Kernel, GradientAndCurvatureAreThoseOfTheResidualsForEveryModelAndLoss) {
  for (const std::size_t model : fitted())
    for (const Loss loss : {Loss::kLog, Loss::kCubeRoot})
      for (const unsigned seed : {1u, 2u, 3u}) {
        SCOPED_TRACE(std::string(brdf::kModelNames[model]) + (loss == Loss::kLog ? ", log, " : ", cuberoot, ") +
                     std::to_string(seed));
        const brdf::AnyBrdf brdf = drawn(model, seed);
        auto data = points(seed);
        // What is shown is clamped at 1, where a central difference sees half a slope.
        std::erase_if(data, [&](const Point& p) {
          const measured::Rgb g = std::visit([&](const auto& m) { return m.eval(p.l, p.v); }, brdf);
          return std::min({std::abs(g.r - 1), std::abs(g.g - 1), std::abs(g.b - 1)}) < 1e-3;
        });
        ASSERT_GT(data.size(), 290u);
        const auto arrays = arrays_of<double>(data, loss);
        const Channels channels = folded(brdf);
        const auto r = residuals(data, model, channels, loss);
        const auto columns = jacobian(data, model, channels, loss);
        const auto is_intensity = intensities(brdf);
        for (const Kernels& k : all_kernels()) {
          SCOPED_TRACE(k.instruction_set);
          KernelOutput out;
          k.evaluate_double(arrays.input(model, channels.data(), true, 0, arrays.padded()), out);
          EXPECT_NEAR(out.loss / sum_of_squares(r), 1, 1e-12);  // 301 x 6 roundings of 1e-16; padding adds nothing
          for (std::size_t p = 0; p < channels.size(); ++p) {
            if (is_intensity[p] && model == 0) {
              EXPECT_EQ(out.hessian[p][p], 0) << "channel " << p << " is folded away";
              continue;
            }
            const double norm = std::sqrt(dot(columns[p], columns[p]));
            // A central difference of step 1e-5 is good to 1e-10 of the third derivative and 1e-11 of rounding.
            EXPECT_NEAR(out.gradient[p], dot(columns[p], r), 2e-7 * norm * std::sqrt(sum_of_squares(r))) << p;
            for (std::size_t q = 0; q < channels.size(); ++q) {
              if (is_intensity[q] && model == 0) continue;
              const double scale = norm * std::sqrt(dot(columns[q], columns[q]));
              EXPECT_NEAR(out.hessian[p][q], dot(columns[p], columns[q]), 2e-7 * scale + 1e-14) << p << ", " << q;
              EXPECT_EQ(out.hessian[p][q], out.hessian[q][p]);
            }
          }
          KernelOutput bare;
          k.evaluate_double(arrays.input(model, channels.data(), false, 0, arrays.padded()), bare);
          EXPECT_NEAR(bare.loss / out.loss, 1, 1e-13);  // the same terms, multiplied in another order
        }
      }
}

TEST(Kernel, FloatIsDoubleToItsPrecision) {
  for (const std::size_t model : fitted())
    for (const Loss loss : {Loss::kLog, Loss::kCubeRoot}) {
      SCOPED_TRACE(std::string(brdf::kModelNames[model]) + (loss == Loss::kLog ? ", log" : ", cuberoot"));
      const auto data = points(7);
      const auto doubles = arrays_of<double>(data, loss);
      const auto floats = arrays_of<float>(data, loss);
      const Channels channels = folded(drawn(model, 7));
      for (const Kernels& k : all_kernels()) {
        KernelOutput want, got;
        k.evaluate_double(doubles.input(model, channels.data(), true, 0, doubles.padded()), want);
        k.evaluate_float(floats.input(model, channels.data(), true, 0, floats.padded()), got);
        EXPECT_NEAR(got.loss / want.loss, 1, 1e-5);  // 2^-24, times some hundred for cancellation in residuals
        for (std::size_t p = 0; p < channels.size(); ++p) {
          const double scale = std::sqrt(want.hessian[p][p]);
          EXPECT_NEAR(got.gradient[p], want.gradient[p], 1e-4 * scale * std::sqrt(want.loss)) << p;  // the same
          for (std::size_t q = 0; q < channels.size(); ++q)
            EXPECT_NEAR(got.hessian[p][q], want.hessian[p][q], 1e-4 * scale * std::sqrt(want.hessian[q][q])) << p << q;
        }
      }
    }
}

TEST(Kernel, InstructionSetsAgree) {
  const auto all = all_kernels();
  if (all.size() == 1) GTEST_SKIP() << "this processor has the baseline's instruction set alone";
  for (const std::size_t model : fitted()) {
    const auto data = points(11);
    const auto doubles = arrays_of<double>(data, Loss::kLog);
    const auto floats = arrays_of<float>(data, Loss::kLog);
    const brdf::AnyBrdf brdf = drawn(model, 11);
    const Channels channels = folded(brdf), plain = plain_channels(brdf);
    KernelOutput want, single;
    all[0].evaluate_double(doubles.input(model, channels.data(), true, 0, doubles.padded()), want);
    all[0].evaluate_float(floats.input(model, channels.data(), true, 0, floats.padded()), single);
    std::vector<float> values[4][3];
    for (std::size_t set = 0; set < all.size(); ++set) {
      SCOPED_TRACE(std::string(brdf::kModelNames[model]) + ", " + all[set].instruction_set);
      KernelOutput got;
      all[set].evaluate_double(doubles.input(model, channels.data(), true, 0, doubles.padded()), got);
      EXPECT_NEAR(got.loss / want.loss, 1, 1e-13);  // sums in another order and fused products: some 1e-16 each
      for (std::size_t p = 0; p < channels.size(); ++p)
        EXPECT_NEAR(got.hessian[p][p], want.hessian[p][p], 1e-12 * want.hessian[p][p]) << p;  // log and exp: 1e-15
      all[set].evaluate_float(floats.input(model, channels.data(), true, 0, floats.padded()), got);
      EXPECT_NEAR(got.loss / single.loss, 1, 2e-6);  // 2^-24 = 6e-8 a rounding, residuals cancel a few digits

      const auto in = floats.input(model, plain.data(), false, 0, floats.padded());
      for (auto& c : values[set]) c.resize(in.count);
      auto& f = values[set];
      all[set].values({{in.to_light[0], in.to_light[1], in.to_light[2]},
                       {in.to_view[0], in.to_view[1], in.to_view[2]},
                       in.count,
                       model,
                       plain.data(),
                       {f[0].data(), f[1].data(), f[2].data()}});
      for (std::size_t i = 0; i < data.size(); ++i) {
        const measured::Rgb g = std::visit([&](const auto& m) { return m.eval(data[i].l, data[i].v); }, brdf);
        EXPECT_NEAR(f[0][i] / g.r, 1, 1e-4) << i;  // float directions move a peak; 2e-5 where f is flat
        EXPECT_NEAR(f[2][i] / g.b, 1, 1e-4) << i;
      }
    }
  }
}

// Whatever lies in the padding, its weight of 0 removes it.
TEST(Kernel, PaddingContributesNothing) {
  for (const Kernels& k : all_kernels()) {
    const std::vector<double> up(kLane, 1), none(kLane, 0), garbage(kLane, 1e6);
    std::vector<double> weight(kLane, 0);
    const Channels channels = folded(brdf::Callisto<double>{});
    KernelInput<double> in{{none.data(), none.data(), up.data()},
                           {none.data(), none.data(), up.data()},
                           {garbage.data(), garbage.data(), garbage.data()},
                           {garbage.data(), garbage.data(), garbage.data()},
                           weight.data(),
                           kLane,
                           0,
                           Loss::kLog,
                           true,
                           channels.data()};
    KernelOutput out;
    k.evaluate_double(in, out);
    EXPECT_EQ(out.loss, 0);
    EXPECT_EQ(out.gradient[0], 0);
    weight[3] = 1;
    k.evaluate_double(in, out);
    EXPECT_GT(out.loss, 0);
    EXPECT_NE(out.gradient[0], 0);
  }
}

// The table's sums are those of a plain loop in double.
TEST(Kernel, TableSumsAreThoseOfItsDefinition) {
  const auto data = points(5);
  const auto floats = arrays_of<float>(data, Loss::kLog);
  for (const std::size_t model : fitted()) {
    const brdf::AnyBrdf brdf = drawn(model, 5);
    const Channels plain = plain_channels(brdf);
    std::vector<float> weight(floats.padded(), 0.0f);
    double squares = 0, flux = 0;
    for (std::size_t i = 0; i < data.size(); ++i) {
      weight[i] = static_cast<float>(data[i].weight);
      const measured::Rgb g = std::visit([&](const auto& m) { return m.eval(data[i].l, data[i].v); }, brdf);
      const double pair[3][2] = {{data[i].f.r, g.r}, {data[i].f.g, g.g}, {data[i].f.b, g.b}};
      for (const auto& [f, value] : pair) {
        const double r = std::log1p(f * data[i].l.z) - std::log1p(value * data[i].l.z);
        squares += data[i].weight * r * r;
      }
      flux += data[i].weight * g.g * data[i].l.z * data[i].v.z;
    }
    const auto in = floats.input(model, plain.data(), false, 0, floats.padded());
    for (const Kernels& k : all_kernels()) {
      TableOutput out;
      k.table({{in.to_light[0], in.to_light[1], in.to_light[2]},
               {in.to_view[0], in.to_view[1], in.to_view[2]},
               {in.target[0], in.target[1], in.target[2]},
               weight.data(),
               in.count,
               model,
               plain.data()},
              out);
      EXPECT_NEAR(out.log_squares / squares, 1, 1e-5) << brdf::kModelNames[model];  // float, see above
      EXPECT_NEAR(out.flux[1] / flux, 1, 1e-5) << brdf::kModelNames[model];
    }
  }
}

// At the ends of every range the sums stay finite: a search visits them.
TEST(Kernel, BoundsGiveFiniteSums) {
  const auto data = points(3);
  for (const std::size_t model : fitted()) {
    const auto rows = std::visit([](const auto& m) { return std::vector(m.kParameters.begin(), m.kParameters.end()); },
                                 drawn(model, 3));
    for (const bool high : {false, true})
      for (const Loss loss : {Loss::kLog, Loss::kCubeRoot}) {
        Channels channels;
        for (const brdf::Parameter& row : rows)
          channels.insert(channels.end(), static_cast<std::size_t>(row.channels),
                          high ? row.range.high : row.range.low);
        const auto arrays = arrays_of<float>(data, loss);
        for (const Kernels& k : all_kernels()) {
          KernelOutput out;
          k.evaluate_float(arrays.input(model, channels.data(), true, 0, arrays.padded()), out);
          EXPECT_TRUE(std::isfinite(out.loss)) << brdf::kModelNames[model] << (high ? " high" : " low");
          for (std::size_t p = 0; p < channels.size(); ++p)
            EXPECT_TRUE(std::isfinite(out.gradient[p]) && std::isfinite(out.hessian[p][p])) << p;
        }
      }
  }
}

}  // namespace
}  // namespace likeness::fit
