#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>

#include "fit/coordinates.h"
#include "fit/fit.h"
#include "fit/hand_sets.h"
#include "fit/metrics.h"
#include "fit/objective.h"
#include "render/files/files.h"
#include "tests/fit/known_materials.h"

namespace likeness::fit {
namespace {

using brdf::Tier;
namespace fs = std::filesystem;

// The default fit of one of the six; made once.
const Result& default_fit(const std::string& material) {
  static std::map<std::string, Result> made;
  const auto found = made.find(material);
  if (found != made.end()) return found->second;
  return made[material] = fit_material(*measured::read(test::decoded(material)), material, Options{});
}

bool have_decoded() { return fs::exists(test::decoded(test::kSix[0])); }

const Candidate& labelled(const Result& r, std::string_view label) {
  for (const Candidate& c : r.baselines)
    if (c.label == label) return c;
  throw std::logic_error("no baseline " + std::string(label));
}

// What the talk's authors set by hand, on the table's own definition: values of the nearest bin, the model at the
// linear bin centres of the slice. spec/fit.md prints two and three digits.
TEST(HandSets, ReproduceTheTableOfNumbersToBeat) {
  if (!have_decoded()) GTEST_SKIP() << test::kNoDecoded;
  struct Row {
    const char* material;
    double disney_pct, disney_log, callisto_pct, callisto_log;
  };
  const Row rows[] = {{"black-soft-plastic", 6.70, .014, 3.19, .009},    {"yellow-phenolic", 3.26, .047, 2.33, .113},
                      {"yellow-plastic", 3.12, .011, 3.81, .019},        {"light-red-paint", 2.13, .006, 8.40, .022},
                      {"specular-red-phenolic", 3.00, .105, 2.79, .034}, {"two-layer-silver", 6.23, .088, 15.35, .109}};
  for (const Row& row : rows) {
    const auto material = measured::read(test::decoded(row.material));
    const auto errors = [&](const brdf::AnyBrdf& model) {
      double shown = 0, log = 0, count = 0;
      for (int h = 0; h < 90; ++h)
        for (int d = 0; d < 90; ++d) {
          constexpr double kDegree = std::numbers::pi / 180;
          const auto g = brdf::geometry_at((h + 0.5) * kDegree, (d + 0.5) * kDegree, std::numbers::pi / 2);
          measured::Rgb f;
          if (g.cos_i < std::cos(80 * kDegree) || !material->evaluate(g.to_light, g.to_view, f)) continue;
          const auto value = std::visit([&](const auto& m) { return m.eval(g); }, model);
          const double pair[3][2] = {{f.r, value.r}, {f.g, value.g}, {f.b, value.b}};
          for (const auto& [a, b] : pair) {
            shown += std::pow(std::min(a, 1.0) - std::min(b, 1.0), 2);
            log += std::pow(std::log1p(a * g.cos_i) - std::log1p(b * g.cos_i), 2);
            ++count;
          }
        }
      return std::pair{100 * std::sqrt(shown / count), std::sqrt(log / count)};
    };
    const auto hand = hand_set_of(row.material);
    ASSERT_TRUE(hand) << row.material;
    const auto disney = errors(hand->disney), callisto = errors(hand->callisto);
    // The reported metrics have the same reading beside their own.
    const Metrics reported = slice_metrics(slice_points(*material, 80), hand->callisto);
    EXPECT_NEAR(reported.slice_error_pct_at_grid, callisto.first, 1e-9);
    EXPECT_NEAR(reported.slice_log_rms_at_grid, callisto.second, 1e-9);
    EXPECT_NEAR(disney.first, row.disney_pct, 0.0051) << row.material;  // half of the printed digit
    EXPECT_NEAR(disney.second, row.disney_log, 0.00051) << row.material;
    EXPECT_NEAR(callisto.first, row.callisto_pct, 0.0051) << row.material;
    EXPECT_NEAR(callisto.second, row.callisto_log, 0.00051) << row.material;
  }
}

TEST(HandSets, AreFoundByAnySpellingOfTheTenNames) {
  EXPECT_TRUE(hand_set_of("light-red-paint"));
  EXPECT_TRUE(hand_set_of("Light Red Paint"));
  EXPECT_FALSE(hand_set_of("light-red"));
  EXPECT_FALSE(hand_set_of(""));
}

TEST(Accuracy, MeetsItsTargetsOnTheSixWithDefaultOptions) {
  if (!have_decoded()) GTEST_SKIP() << test::kNoDecoded;
  double slice = 0, log = 0;
  for (const std::string& name : test::kSix) {
    const Result& r = default_fit(name);
    const Metrics& m = r.best.metrics;
    slice += m.slice_error_pct / 6;
    log += m.slice_log_rms / 6;
    ASSERT_TRUE(r.hand_set) << name;
    EXPECT_LE(m.slice_log_rms, r.hand_set->metrics.slice_log_rms) << name;
    EXPECT_LE(m.slice_log_rms, r.hand_set_disney->metrics.slice_log_rms) << name;
    EXPECT_LE(m.slice_log_rms, labelled(r, "Lambert + GGX").metrics.slice_log_rms) << name;
    EXPECT_LE(m.slice_log_rms, labelled(r, "Disney 2012").metrics.slice_log_rms) << name;
    std::printf("%-22s %.3f %% / %.4f\n", name.c_str(), m.slice_error_pct, m.slice_log_rms);
  }
  std::printf("mean                   %.3f %% / %.4f\n", slice, log);
  EXPECT_LE(slice, 1.8);  // the issue's
  EXPECT_LE(log, 0.014);  // the issue's
}

void expect_nested(const Result& r) {
  const double base = labelled(r, "Callisto, base tier").loss, plain = labelled(r, "Lambert + GGX").loss,
               advanced = labelled(r, "Callisto, advanced tier").loss;
  EXPECT_LE(r.best.loss, advanced);
  EXPECT_LE(advanced, base);
  EXPECT_LE(base, plain);
}

TEST(Nested, ARicherTierIsNeverWorseOnRealMaterials) {
  if (!have_decoded()) GTEST_SKIP() << test::kNoDecoded;
  for (const std::string& name : test::kSix) {
    SCOPED_TRACE(name);
    expect_nested(default_fit(name));
  }
  for (const char* name : {"yellow-plastic", "two-layer-silver"}) {
    SCOPED_TRACE(std::string(name) + ", cuberoot");
    Options options;
    options.loss = Loss::kCubeRoot;
    expect_nested(fit_material(*measured::read(test::decoded(name)), name, options));
  }
}

TEST(Nested, ARicherTierIsNeverWorseOnOtherFormats) {
  bool any = false;
  for (const char* path : {"mbsdf/carpaint_blue.mbsdf", "rgl/satin_rosaline_rgb.bsdf"}) {
    const fs::path file = test::shared_file(path);
    if (!fs::exists(file)) continue;
    any = true;
    const auto material = measured::read(file);
    for (const Loss loss : {Loss::kLog, Loss::kCubeRoot}) {
      SCOPED_TRACE(path);
      Options options;
      options.loss = loss;
      options.starts = 4;  // the chain must hold however poor the search is
      expect_nested(fit_material(*material, "other", options));
    }
  }
  if (!any) GTEST_SKIP() << "no " << test::shared_file("") << ": the shared data is not beside this checkout";
}

TEST(Nested, ARicherTierIsNeverWorseOnSyntheticMaterialsHoweverFewTheStarts) {
  brdf::Callisto<double> lambert_ggx;
  lambert_ggx.base_color = {0.6, 0.2, 0.1};
  lambert_ggx.roughness = 0.3;
  brdf::Callisto<double> brightening;  // a terminator below 0: the half of the box that the other sign's search leaves
  brightening.smooth_terminator = -0.6;
  brdf::Disney2012<double> disney;
  disney.sheen = 1;
  disney.clearcoat = 1;
  const brdf::AnyBrdf models[] = {lambert_ggx, brightening, disney,
                                  datasets_synthetic::drawn(brdf::Callisto<double>{}, 3),
                                  brdf::BurleyDiffuse<double>{}};
  for (const brdf::AnyBrdf& model : models)
    for (const Loss loss : {Loss::kLog, Loss::kCubeRoot})
      for (const int starts : {1, 3}) {
        if (starts > 1 && loss != Loss::kLog) continue;
        SCOPED_TRACE(std::string(brdf::kModelNames[model.index()]) + ", " + std::to_string(starts) + " starts");
        Options options;
        options.loss = loss;
        options.starts = starts;
        expect_nested(fit_material(test::Evaluated(model), "synthetic", options));
      }
}

// The loss that a candidate reports is the loss of the parameters that it reports.
TEST(Nested, ReportedLossesAreThoseOfTheReportedParameters) {
  const test::Evaluated material(datasets_synthetic::drawn(brdf::Callisto<double>{}, 5));
  const Result r = fit_material(material, "synthetic", Options{.starts = 2});
  const auto slice = slice_points(material, 80);
  const SampleSet samples = test::samples_of(material, slice);
  const auto check_one = [&](const Candidate& c) {
    const double loss = exact_loss(samples, c.brdf.index(), folded(c.brdf));
    EXPECT_NEAR(c.loss, loss, 1e-9 * loss + 1e-25) << c.label;  // a tint is a quotient: some 1e-16 of a value
  };
  check_one(r.best);
  for (const Candidate& c : r.baselines) check_one(c);
}

}  // namespace
}  // namespace likeness::fit
