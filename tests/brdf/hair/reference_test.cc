#include <chrono>

#include "brdf/hair/evaluators.h"
#include "tests/brdf/evaluator_row.h"

namespace likeness::brdf {
namespace {

template <class S>
class HairReference : public ::testing::Test {};
TYPED_TEST_SUITE(HairReference, Kinds, KindNames);

TYPED_TEST(HairReference, LongitudinalTermIsThatOfTheFile) {
  const double worst = worst_against_file<HairMp, TypeParam>("hair_mp.csv", {});
  std::printf("worst %.2g\n", worst);
}
TYPED_TEST(HairReference, NearFieldIsThatOfTheFile) {
  const double worst = worst_against_file<HairNear, TypeParam>("hair_near.csv", {});
  std::printf("worst %.2g\n", worst);
}

TEST(HairReferenceOneByOne, FarFieldIsThatOfTheFile) {
  std::printf("worst %.2g\n", worst_against_file<HairFar, double>("hair_far.csv", {.in_double = 1e-6}));
  std::printf("worst %.2g\n", worst_against_file<HairFar, float>("hair_far.csv", {}));
}

}  // namespace
}  // namespace likeness::brdf
