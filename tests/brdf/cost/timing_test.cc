#include <cmath>

#include <gtest/gtest.h>

#include "brdf/cost/timing.h"

namespace likeness::cost {
namespace {

// A chain of multiply-adds, each of which waits for the one before.
Task chain(int length, std::size_t evaluations = 1) {
  return {[=] {
            volatile double factor = 0.999;
            const double f = factor;
            double x = 1;
            for (int i = 0; i < length; ++i) x = x * f + 0.5;
            volatile double kept = x;
            static_cast<void>(kept);
          },
          evaluations};
}

TEST(Timing, MoreWorkTakesLongerInProportion) {
  const auto t = time_interleaved({chain(2000), chain(20000)}, 9, 0.001, {});
  const double ratio = t[1].ns / t[0].ns;
  EXPECT_TRUE(ratio > 6 && ratio < 16) << ratio;  // 10; other work on the machine moves both alike
}

TEST(Timing, IsPerEvaluation) {
  const auto t = time_interleaved({chain(4000), chain(4000, 8)}, 9, 0.001, {});
  const double ratio = t[0].ns / t[1].ns;
  EXPECT_TRUE(ratio > 5 && ratio < 13) << ratio;  // 8
}

TEST(Timing, GivesQuartilesAroundTheMedian) {
  for (const Timing& t : time_interleaved({chain(500), chain(5000)}, 7, 0.0005, {})) {
    EXPECT_GT(t.ns_low, 0);
    EXPECT_LE(t.ns_low, t.ns);
    EXPECT_LE(t.ns, t.ns_high);
  }
}

TEST(Timing, CountsInstructionsWhereTheMachineDoes) {
  const auto t = time_interleaved({chain(2000), chain(20000)}, 5, 0.0005, {});
  if (std::isnan(t[0].instructions)) GTEST_SKIP() << "this machine offers no counters to read";
  EXPECT_NEAR(t[1].instructions / t[0].instructions, 10, 1);  // but for what surrounds the loop
}

TEST(Timing, TellsHowFarItIsAndStopsWhenThatThrows) {
  double last = 0;
  time_interleaved({chain(100), chain(200)}, 3, 0.0002, [&](double share) {
    EXPECT_GE(share, last);
    last = share;
  });
  EXPECT_DOUBLE_EQ(last, 1);
  struct Stop {};
  int told = 0;
  EXPECT_THROW(time_interleaved({chain(100)}, 1000, 0.001,
                                [&](double) {
                                  if (++told == 3) throw Stop{};
                                }),
               Stop);
  EXPECT_EQ(told, 3);
}

}  // namespace
}  // namespace likeness::cost
