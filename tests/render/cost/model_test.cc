#include <cmath>

#include <gtest/gtest.h>

#include "render/cost/time_model.h"

namespace likeness::scene_cost {
namespace {

// A frame that keeps to the sum: 5 ms, and for each point 2 ms, 0.5 ms, 0.1 + 0.3 a ray, and 0.4 (maps) or 0.7 a ray.
FrameTimes made_up(const Levels& levels) {
  const auto rays = [](std::size_t level) { return static_cast<double>(1 << (2 * level)); };
  const double points = rays(levels[0]);
  const double sky = levels[2] == 0 ? 0.4 : 0.7 * rays(levels[2] - 1);
  FrameTimes f{levels, 5, {{"visibility", 2 * points}, {"light lists", 0.5 * points}}};
  f.passes.push_back({"direct", points * (0.1 + 0.3 * rays(levels[1]))});
  f.passes.push_back({"environment", points * sky});
  for (const FrameTimes::Pass& p : f.passes) f.whole += p.ms;
  return f;
}

TEST(TimeModel, PredictsEveryCombinationFromOneAtATime) {
  std::vector<FrameTimes> frames;
  for (std::size_t level = 0; level < 5; ++level) {
    frames.push_back(made_up({level, 1, 1}));
    frames.push_back(made_up({2, level, 0}));
    frames.push_back(made_up({0, 3, level}));
  }
  const TimeModel model(frames);
  for (std::size_t p = 0; p < 5; ++p)
    for (std::size_t l = 0; l < 5; ++l)
      for (std::size_t e = 0; e < 5; ++e)
        EXPECT_NEAR(model.predict({p, l, e}) / made_up({p, l, e}).whole, 1, 1e-12) << p << l << e;
}

TEST(TimeModel, ReadsHigherLevelsOffTheLineOfTheLower) {
  const std::vector<FrameTimes> frames{made_up({0, 0, 0}), made_up({0, 1, 0}), made_up({0, 0, 1})};
  const TimeModel model(frames);
  // Both are linear in their rays; one level of rays is taken in proportion, which is what 0.7 a ray is.
  EXPECT_NEAR(model.predict({1, 4, 4}) / made_up({1, 4, 4}).whole, 1, 1e-12);
}

TEST(TimeModel, KeepsFramesOfOnePointApart) {
  FrameTimes one = made_up({0, 1, 0}), more = made_up({1, 1, 0}), other = made_up({0, 2, 0});
  one.passes[2].ms *= 0.5, one.whole -= one.passes[2].ms;  // direct
  const TimeModel model(std::vector{one, more, other});
  EXPECT_NEAR(model.predict({0, 1, 0}) / one.whole, 1, 1e-12);
  EXPECT_NEAR(model.predict({2, 1, 0}) / made_up({2, 1, 0}).whole, 1, 1e-12);
  EXPECT_NEAR(model.predict({1, 2, 0}) / made_up({1, 2, 0}).whole, 1, 1e-12) << "measured with one point only";
}

TEST(TimeModel, IsNotMovedByOneFrameThatWasDisturbed) {
  std::vector<FrameTimes> frames(5, made_up({0, 0, 0}));
  frames[2].whole *= 9;
  for (FrameTimes::Pass& p : frames[2].passes) p.ms *= 10;
  EXPECT_NEAR(TimeModel(frames).predict({0, 0, 0}) / made_up({0, 0, 0}).whole, 1, 1e-12);
}

TEST(FitNonNegative, FindsTheFactorsAndKeepsThemFromBelowZero) {
  const std::vector<std::vector<double>> rows{{1, 1, 0}, {1, 0.25, 0}, {1, 0.0625, 0}, {1, 0.25, 1}};
  std::vector<double> values;
  for (const auto& r : rows) values.push_back(0.5 * r[0] + 2 * r[1] + 0.125 * r[2]);
  const std::vector<double> x = fit_non_negative(rows, values);
  EXPECT_NEAR(x[0], 0.5, 1e-9);
  EXPECT_NEAR(x[1], 2, 1e-9);
  EXPECT_NEAR(x[2], 0.125, 1e-9);
  // 1 - 0.5 t: the best that is not negative has no t.
  const std::vector<double> falling = fit_non_negative({{1, 0}, {1, 1}}, {1, 0.5});
  EXPECT_EQ(falling[1], 0);
  EXPECT_GT(falling[0], 0.5);
  EXPECT_LT(falling[0], 1);
}

TEST(ErrorModel, FallsWithRaysToItsFloor) {
  std::vector<ErrorModel::Measured> measured;
  const auto truth = [](const Levels& l) {
    const double points = std::pow(4.0, double(l[0]));
    return 0.01 + (l[2] == 0 ? 0.02 : 0.0) + (0.1 + 0.4 / std::pow(4.0, double(l[1]))) / points +
           (l[2] == 0 ? 0.0 : 0.3 / (points * std::pow(4.0, double(l[2]) - 1)));
  };
  for (std::size_t i = 0; i < 5; ++i)
    for (const Levels& l : {Levels{i, 0, 0}, Levels{i, 2, 2}, Levels{0, i, 1}, Levels{1, 1, i}})
      measured.push_back({l, truth(l)});
  const ErrorModel model(measured);
  for (const Levels& l : {Levels{3, 3, 3}, Levels{4, 0, 1}, Levels{0, 4, 0}})
    EXPECT_NEAR(model.predict(l) / truth(l), 1, 1e-6);
}

}  // namespace
}  // namespace likeness::scene_cost
