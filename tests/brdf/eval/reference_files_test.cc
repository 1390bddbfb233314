#include <iostream>
#include <map>

#include "brdf/catalog/catalog.h"
#include "tests/brdf/eval/program.h"

// Every table of shared/reference, computed with 40 digits, through the program.
namespace likeness::eval::test {
namespace {

// Quadratures: the demand is 1e-6.
const std::map<std::string, double> kInDouble{{"hair_far", 1e-6}, {"microfacet_diffuse", 1e-6}};

class ReferenceFiles : public Program {
 protected:
  void expect_within(const std::string& precision, double tolerance_of_others) {
    const fs::path shared = LIKENESS_SHARED_DIR "/reference";
    if (!fs::exists(shared)) GTEST_SKIP() << "no " << shared;
    int files = 0;
    for (const auto& entry : fs::directory_iterator(shared)) {
      const std::string model = entry.path().stem().string();
      if (entry.path().extension() != ".csv") continue;
      if (catalog::find(model) == nullptr) {
        std::cout << "left out: " << entry.path() << ": there is no model " << model << "\n";
        continue;
      }
      const auto quadrature = kInDouble.find(model);
      const double tolerance =
          precision == "double" && quadrature != kInDouble.end() ? quadrature->second : tolerance_of_others;
      const Ran ran = run(model + " --in '" + entry.path().string() + "' --precision " + precision + " --tolerance " +
                          std::to_string(tolerance * 1e12) + "e-12 --out out.csv");
      EXPECT_EQ(ran.exit_code, 0) << model << " in " << precision << ":\n" << ran.error;
      if (const auto at = ran.error.find("worst relative difference"); at != std::string::npos)
        std::cout << model << ": " << ran.error.substr(at, ran.error.find(" of ", at) - at) << "\n";
      ++files;
    }
    EXPECT_GT(files, 0);
  }
};

TEST_F(ReferenceFiles, AreMetInDouble) { expect_within("double", 1e-12); }
TEST_F(ReferenceFiles, AreMetInFloat) { expect_within("float", 2e-5); }
TEST_F(ReferenceFiles, AreMetInBatches) { expect_within("batch", 2e-5); }

}  // namespace
}  // namespace likeness::eval::test
