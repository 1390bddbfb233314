#include <cmath>
#include <set>

#include <gmock/gmock.h>

#include "tests/brdf/cost/toy_study.h"

// What dominates what, and the whole measurement of every family, in small.
namespace likeness::cost {
namespace {

using testing::HasSubstr;

std::string dominator(const FamilyResult& result, std::size_t rung, Precision p) {
  return result.cells[rung][std::size_t(p)].dominated_by;
}

TEST(Dominated, IsAFormThatAnotherBeatsInTimeAndNotInError) {
  FamilyResult result = test::toy_family();
  find_dominated(result);
  EXPECT_EQ(dominator(result, 0, Precision::kBatch), "");
  EXPECT_EQ(dominator(result, 1, Precision::kBatch), "cheap, rough");
  EXPECT_EQ(dominator(result, 2, Precision::kBatch), "");
  EXPECT_EQ(dominator(result, 3, Precision::kDouble), "a \"table\"") << "the walk, where it has a time";
  EXPECT_EQ(dominator(result, 4, Precision::kDouble), "") << "the most exact";
}

TEST(Dominated, NeedsTheFasterOneToBeAsExact) {
  FamilyResult result = test::toy_family();
  result.cells[1][2] = test::cell(3, 0.2);  // as exact as the cheap one, and slower
  result.cells[2][2] = test::cell(5, 0.19999);
  find_dominated(result);
  EXPECT_EQ(dominator(result, 1, Precision::kBatch), "cheap, rough");
  EXPECT_EQ(dominator(result, 2, Precision::kBatch), "");
}

TEST(Dominated, IsNothingThatIsWithinTheSpread) {
  FamilyResult result = test::toy_family();
  result.cells[0][2] = test::cell(1, 0.2, 1.2);  // up to 2.2
  result.cells[1][2] = test::cell(3, 0.3, 1.0);  // from 2
  find_dominated(result);
  EXPECT_EQ(dominator(result, 1, Precision::kBatch), "");
}

TEST(Dominated, LeavesOutWhatHasNoBatches) {
  FamilyResult result = test::toy_family();
  result.cells[3][2] = test::one_by_one(0);
  result.cells[3][2].timing.ns = result.cells[3][2].timing.ns_high = 1e-3;
  find_dominated(result);
  EXPECT_EQ(dominator(result, 3, Precision::kBatch), "");
  EXPECT_EQ(dominator(result, 4, Precision::kBatch), "");
}

TEST(Study, RefusesAFamilyThatThereIsNotAndNamesThoseThatThereAre) {
  try {
    chosen_families({"hair", "fur"});
    FAIL() << "there is no fur";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("'fur'"));
    for (const Family& family : families()) EXPECT_THAT(error.what(), HasSubstr(family.name));
  }
  EXPECT_EQ(chosen_families({}).size(), families().size());
}

TEST(Families, NameEvaluatorsThatThereAreAndOneReference) {
  for (const Family& family : families()) {
    std::set<std::string> labels;
    int references = family.estimates ? 1 : 0;
    for (const Rung& rung : family.rungs) {
      EXPECT_NE(catalog::find(rung.evaluator), nullptr) << rung.evaluator;
      EXPECT_TRUE(labels.insert(rung.label).second) << rung.label << " is there twice";
      references += rung.is_reference;
    }
    EXPECT_EQ(references, 1) << family.name;
  }
}

// Every family once, with few draws and short readings.
const Study& small_study() {
  static const Study study = run_study({.families = {}, .repeats = 1, .seconds = 2e-4, .draws_scale = 0.02}, {});
  return study;
}
const FamilyResult& result_of(const std::string& family) {
  for (const FamilyResult& result : small_study().families)
    if (result.family.name == family) return result;
  throw std::logic_error(family);
}
double rms_of(const std::string& family, const std::string& label, Precision p) {
  const FamilyResult& result = result_of(family);
  for (std::size_t i = 0; i < result.cells.size(); ++i)
    if (result.family.rungs[i].label == label) return result.cells[i][std::size_t(p)].accuracy.rms;
  throw std::logic_error(label);
}

TEST(Study, MeasuresEveryFormOfEveryFamily) {
  ASSERT_EQ(small_study().families.size(), families().size());
  for (const FamilyResult& result : small_study().families) {
    ASSERT_EQ(result.cells.size(), result.family.rungs.size());
    for (std::size_t i = 0; i < result.cells.size(); ++i)
      for (std::size_t p = 0; p < 3; ++p) {
        const Cell& c = result.cells[i][p];
        SCOPED_TRACE(result.family.name + ", " + result.family.rungs[i].label + ", " + std::to_string(p));
        EXPECT_TRUE(std::isfinite(c.accuracy.rms));
        EXPECT_TRUE(std::isfinite(c.accuracy.worst));
        EXPECT_EQ(std::isfinite(c.accuracy.energy), bool(result.family.energy_weight));
        EXPECT_EQ(std::isnan(c.timing.ns), c.one_by_one);
        EXPECT_EQ(c.one_by_one, p == 2 && catalog::find(result.family.rungs[i].evaluator)->one_by_one);
        EXPECT_TRUE(c.one_by_one || c.timing.ns > 0);
        EXPECT_TRUE(!(result.family.rungs[i].is_reference && p == 0) || c.accuracy.rms == 0);
      }
  }
}

// 400 draws; docs/models/microfacet_diffuse.md has these numbers of 100 000.
TEST(Study, FindsTheDiffuseErrorsOfTheModelsPage) {
  EXPECT_NEAR(rms_of("diffuse", "Lambert", Precision::kBatch), 0.242, 0.03);
  EXPECT_NEAR(rms_of("diffuse", "Proxima", Precision::kBatch), 0.174, 0.03);
  EXPECT_NEAR(rms_of("diffuse", "our fit", Precision::kBatch), 0.102, 0.02);
  EXPECT_LT(rms_of("diffuse", "Callisto, fitted in alpha", Precision::kBatch), 0.09);  // 0.065
  EXPECT_LT(rms_of("diffuse", "3D table, three azimuths", Precision::kBatch), 0.002);  // 0.0009
}

TEST(Study, LaddersBecomeMoreExact) {
  const auto in = [](const char* family, const char* label) { return rms_of(family, label, Precision::kDouble); };
  EXPECT_LT(in("normal_length", "one step of Newton's method"), 0.1 * in("normal_length", "leading term"));
  EXPECT_LT(in("normal_length", "two steps"), 1e-3 * in("normal_length", "one step of Newton's method"));
  EXPECT_LT(in("tonemap", "table"), 1e-4);  // 1.34e-4 is the worst
  EXPECT_GT(in("tonemap", "table"), 1e-6);
  EXPECT_LT(in("realis", "polynomial of degree 3"), 2.8e-3);  // what windowed_decay() states
  EXPECT_LT(in("realis", "polynomial of degree 5"), 7.1e-6);
  EXPECT_LT(in("realis", "polynomial of degree 7"), 1.1e-8);
  EXPECT_LT(in("diffusion_inverse", "Halley, 4 steps"), in("diffusion_inverse", "Halley, 1 step"));
}

TEST(Study, ARandomReferenceIsNoReferenceOfItself) {
  const FamilyResult& result = result_of("diffusion_profile");
  EXPECT_GT(result.noise, 0.002);
  EXPECT_LT(result.noise, 0.2);
  // Walks of other seeds: 20 000 paths are off by some 5 %, never by rounding.
  for (const char* label : {"random walk, 100 paths", "random walk, 2000 paths", "random walk, 20000 paths"})
    EXPECT_GT(rms_of("diffusion_profile", label, Precision::kBatch), 0.01) << label;
}

TEST(Study, EndsWhenItsProgressThrows) {
  struct Stop {};
  EXPECT_THROW(run_study({.families = {"fresnel"}, .repeats = 100, .seconds = 1e-3, .draws_scale = 0.01},
                         [](const std::string&, double share) {
                           if (share > 0.5) throw Stop{};
                         }),
               Stop);
}

}  // namespace
}  // namespace likeness::cost
