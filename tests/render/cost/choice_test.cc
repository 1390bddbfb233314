#include <gtest/gtest.h>

#include "tests/render/cost/toy_study.h"

namespace likeness::scene_cost {
namespace {

using test::row;
using test::toy_study;

TEST(Budget, OfTimeTakesTheMostExactThatIsFastEnough) {
  const Study s = toy_study();
  EXPECT_EQ(choice_of(s, {39.9, {}}), 1u) << "not row 2, which is slower and less exact";
  EXPECT_EQ(choice_of(s, {40, {}}), 3u) << "the limit is within";
  EXPECT_EQ(choice_of(s, {1e9, {}}), 3u) << "not the path tracer";
  EXPECT_EQ(choice_of(s, {0.99, {}}), std::nullopt);
}

TEST(Budget, OfErrorTakesTheFastestThatIsExactEnough) {
  const Study s = toy_study();
  EXPECT_EQ(choice_of(s, {{}, 0.5}), 0u);
  EXPECT_EQ(choice_of(s, {{}, 0.3}), 1u) << "not row 2, which is exact enough but slower";
  EXPECT_EQ(choice_of(s, {{}, 0.1}), 3u);
  EXPECT_EQ(choice_of(s, {{}, 0.09}), std::nullopt) << "the path tracer is not chosen";
}

TEST(Budget, CountsTheTimeThatTheStudyCounts) {
  Study s = toy_study();
  s.options.counts_cpu = true;  // twice the wall clock here
  EXPECT_EQ(choice_of(s, {7.9, {}}), 0u);
  EXPECT_EQ(choice_of(s, {8, {}}), 1u);
}

TEST(Budget, OfEqualsTakesTheBetter) {
  Study s = toy_study();
  s.rows = {row({1, 0, 0}, 5, 0.2), row({0, 0, 0}, 4, 0.2), row({0, 1, 0}, 4, 0.1)};
  EXPECT_EQ(choice_of(s, {{}, 0.2}), 2u) << "as fast as another, more exact";
  s.rows.pop_back();
  EXPECT_EQ(choice_of(s, {10, {}}), 1u) << "as exact as another, faster";
}

TEST(Dominance, NeedsMoreThanTheQuartilesAndNoLessExactness) {
  Study s = toy_study();
  find_dominated(s);
  EXPECT_EQ(s.rows[0].dominated_by, "");
  EXPECT_EQ(s.rows[1].dominated_by, "");
  EXPECT_EQ(s.rows[2].dominated_by, "4 pts, 1 shadow");
  EXPECT_EQ(s.rows[3].dominated_by, "");
  s.rows[1] = row({1, 0, 0}, 9.3, 0.2);  // quartiles 8.8 to 9.8 and 9.5 to 10.5 overlap
  find_dominated(s);
  EXPECT_EQ(s.rows[2].dominated_by, "");
  s.rows[1] = row({1, 0, 0}, 4, 0.31);
  find_dominated(s);
  EXPECT_EQ(s.rows[2].dominated_by, "") << "faster, but less exact";
}

TEST(Agreement, IsThatOfRowsThatDidNotFeedTheModel) {
  Study s = toy_study();
  for (Row& r : s.rows) r.predicted_cpu_ms = 1.2 * r.timing(true).median;
  s.rows[0].feeds_model = true, s.rows[0].predicted_cpu_ms = s.rows[0].timing(true).median;
  s.rows[1].predicted_cpu_ms = 0.5 * s.rows[1].timing(true).median;
  const auto of_others = agreement_of(s);
  ASSERT_TRUE(of_others);
  EXPECT_EQ(of_others->rows, 3u) << "nor the path tracer";
  EXPECT_TRUE(of_others->is_of_others);
  EXPECT_NEAR(of_others->median, 0.2, 1e-12);
  EXPECT_NEAR(of_others->worst, 0.5, 1e-12);
  for (Row& r : s.rows) r.feeds_model = true;
  EXPECT_EQ(agreement_of(s)->rows, 4u) << "of all, if there are no others";
  EXPECT_FALSE(agreement_of(s)->is_of_others);
  s.rows.clear();
  EXPECT_FALSE(agreement_of(s));
}

TEST(Promising, IsAllOfFew) {
  const std::vector<Candidate> all{{{0, 0, 0}, 2, 5}, {{1, 0, 0}, 1, 1}};
  EXPECT_EQ(promising(all, 2, 1).size(), 2u);
}

TEST(Promising, IsWhatIsNearTheFront) {
  std::vector<Candidate> all;
  for (std::size_t i = 0; i < 5; ++i) {
    const double ms = static_cast<double>(1 << i), error = 1 / ms;
    all.push_back({{i, 0, 0}, ms, error});
    all.push_back({{i, 1, 0}, 1.1 * ms, 1.2 * error});  // near
    all.push_back({{i, 2, 0}, 1.2 * ms, 1.9 * error});  // far
  }
  const std::vector<Candidate> kept = promising(all, 12, 1.3);
  EXPECT_EQ(kept.size(), 10u);
  for (const Candidate& c : kept) EXPECT_LT(c.levels[1], 2u);
  const std::vector<Candidate> fewer = promising(all, 5, 1.3);
  ASSERT_EQ(fewer.size(), 5u);
  for (const Candidate& c : fewer) EXPECT_EQ(c.levels[1], 0u) << "those on the front itself";
}

TEST(BestWithin, LowersTheHighestLevelsAndOnlyThoseThatMatter) {
  std::vector<FrameTimes> frames;
  for (std::size_t level = 0; level < 5; ++level)  // a ray takes 1 ms, visibility nothing
    frames.push_back({{0, level, 0}, static_cast<double>(1 << (2 * level)), {{"direct", double(1 << (2 * level))}}});
  const TimeModel model(frames);
  EXPECT_EQ(best_within(model, {true, true}, 1e9), (Levels{4, 4, 0, 3, 1}));
  EXPECT_EQ(best_within(model, {true, true}, 4096), (Levels{3, 3, 0, 3, 1}));
  EXPECT_EQ(best_within(model, {true, true}, 4095), (Levels{3, 2, 0, 3, 1})) << "the later setting first";
  EXPECT_EQ(best_within(model, {true}, 1e9), (Levels{4, 1, 0, 3, 1})) << "what does not matter keeps its default";
  EXPECT_EQ(best_within(model, {true, true}, 0), (Levels{0, 0, 0, 3, 1})) << "nothing is cheaper";
}

}  // namespace
}  // namespace likeness::scene_cost
