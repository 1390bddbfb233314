#include "datasets_synthetic/material.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <nlohmann/json.hpp>

#include "datasets_synthetic/random.h"
#include "fit/measured/mbsdf.h"
#include "render/files/files.h"
#include "render/material/material_file.h"
#include "render/material/parameters.h"

namespace likeness::datasets_synthetic {
namespace {

using measured::Format;
using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr std::size_t kSamples = 20 * 20 * 30;  // of the grid below

Material plain() {
  brdf::Callisto<double> callisto;
  callisto.base_color = {0.5, 0.2, 0.1};
  callisto.roughness = 0.3;
  return {callisto, grid_of(Format::kMbsdf, 20, 30), {}, 7};
}

struct Faulty {
  Table clean, table;
  Counts counts;
};
Faulty with(const Faults& faults, std::uint64_t seed = 7) {
  const Material m = plain();
  Faulty out{tabulate(m.brdf, m.grid), tabulate(m.brdf, m.grid), {}};
  out.counts = apply(faults, m.brdf, seed, out.table);
  return out;
}

std::size_t count(const Table& table, State state) {
  return static_cast<std::size_t>(std::count(table.state.begin(), table.state.end(), state));
}

// 4 sigma of a binomial; the seed is fixed, so a failure is a change of the code and not bad luck.
void expect_share(std::size_t found, double share, std::size_t of) {
  const double n = double(of);
  EXPECT_NEAR(double(found), share * n, 4 * std::sqrt(n * share * (1 - share)));
}

TEST(Random, IsTheSameOnEveryMachine) {
  Random random(1, 2);
  // The engine's output is fixed by the C++ standard; the pinned values hold the seeding and the scaling still.
  const double first = random.uniform(), second = random.uniform();
  Random again(1, 2), other_stream(1, 3), other_seed(2, 2);
  EXPECT_EQ(again.uniform(), first);
  EXPECT_EQ(again.uniform(), second);
  EXPECT_NE(other_stream.uniform(), first);
  EXPECT_NE(other_seed.uniform(), first);
  EXPECT_EQ(first, 0x1.890848c0bde33p-1);
  EXPECT_EQ(second, 0x1.d8d8cf3b42ab8p-2);
}

TEST(Random, NormalHasMeanZeroAndDeviationOne) {
  Random random(3, 0);
  constexpr int kDraws = 100'000;
  double sum = 0, squares = 0, fourth = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
    fourth += x * x * x * x;
  }
  EXPECT_NEAR(sum / kDraws, 0, 4 / std::sqrt(kDraws));            // 4 sigma of a mean
  EXPECT_NEAR(squares / kDraws, 1, 4 * std::sqrt(2.0 / kDraws));  // of a variance
  EXPECT_NEAR(fourth / kDraws, 3, 4 * std::sqrt(96.0 / kDraws));  // of the fourth moment: E x^8 - 9 = 96
}

TEST(Faults, NoneLeaveTheTableAsItWas) {
  const Faulty made = with({});
  EXPECT_EQ(bytes_of(made.table), bytes_of(made.clean));
  EXPECT_EQ(made.counts.measured, kSamples);
}

TEST(Faults, SharesAreMetAndCountedAsTheFileHasThem) {
  const Faulty made = with({.invalid = 0.25, .nan = 0.01, .negative = 0.05});
  expect_share(made.counts.invalid, 0.25, kSamples);
  expect_share(made.counts.nan, 0.01 * 0.75, kSamples);              // what is not measured cannot be NaN
  expect_share(made.counts.negative, 0.05 * 0.75 * 0.99, kSamples);  // nor negative what is either
  EXPECT_EQ(made.counts.invalid, count(made.table, State::kInvalid));
  EXPECT_EQ(made.counts.nan, count(made.table, State::kNotFinite));
  EXPECT_EQ(made.counts.negative, count(made.table, State::kNegative));
  EXPECT_EQ(made.counts.measured, count(made.table, State::kMeasured));
  EXPECT_EQ(made.counts.invalid + made.counts.nan + made.counts.negative + made.counts.measured, kSamples);

  const auto coverage = measured::parse_mbsdf(bytes_of(made.table), "made")->coverage();
  EXPECT_EQ(coverage.not_finite, made.counts.nan);
  EXPECT_EQ(coverage.negative, made.counts.invalid);  // the reader drops a sample that is negative in all channels
  EXPECT_EQ(coverage.stored, kSamples);
}

TEST(Faults, EachHitsTheSameSamplesWhateverElseIsAskedFor) {
  const Faulty alone = with({.invalid = 0.2}), together = with({.invalid = 0.2, .nan = 0.3, .noise = 0.1});
  for (std::size_t i = 0; i < kSamples; ++i)
    ASSERT_EQ(alone.table.state[i] == State::kInvalid, together.table.state[i] == State::kInvalid) << i;
}

TEST(Faults, AnotherSeedHitsOtherSamples) {
  EXPECT_EQ(with({.invalid = 0.2}, 1).table.state, with({.invalid = 0.2}, 1).table.state);
  EXPECT_NE(with({.invalid = 0.2}, 1).table.state, with({.invalid = 0.2}, 2).table.state);
}

TEST(Faults, NoiseHasTheDeviationThatWasAskedFor) {
  const Faulty made = with({.noise = 0.1});
  double sum = 0, squares = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double relative = made.table.f[c][i] / made.clean.f[c][i] - 1;
      sum += relative;
      squares += relative * relative;
    }
  const double n = 3 * kSamples;
  EXPECT_NEAR(sum / n, 0, 4 * 0.1 / std::sqrt(n));                       // 4 sigma of a mean
  EXPECT_NEAR(std::sqrt(squares / n), 0.1, 4 * 0.1 / std::sqrt(2 * n));  // of a deviation
  EXPECT_EQ(made.counts.noise, kSamples);
}

TEST(Faults, NoiseByAngleGrowsAsTheRootOfTheCosine) {
  const Faulty made = with({.noise = 0.01, .noise_by_angle = true});
  for (const int i : {0, 10, 17}) {  // theta_i = theta_o = 2.25, 47.25 and 78.75 deg
    double squares = 0;
    for (int k = 0; k < 30; ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>((i * 20 + i) * 30 + k);
        squares += std::pow(made.table.f[c][at] / made.clean.f[c][at] - 1, 2);
      }
    const double expected = 0.01 / std::sqrt(std::cos((i + 0.5) * 4.5 * std::numbers::pi / 180));
    EXPECT_NEAR(std::sqrt(squares / 90), expected, 4 * expected / std::sqrt(180)) << i;  // 4 sigma of a deviation
  }
}

TEST(Faults, NoiseThatGoesBelowZeroIsCounted) {
  const Faulty made = with({.noise = 1});
  std::size_t below = 0;
  for (std::size_t i = 0; i < kSamples; ++i)
    below += std::min({made.table.f[0][i], made.table.f[1][i], made.table.f[2][i]}) < 0;
  EXPECT_EQ(made.counts.negative_by_noise, below);
  EXPECT_GT(below, 0u);
}

TEST(Faults, InvalidAboveAnAngleLeavesWhatIsBelowIt) {
  const Faulty made = with({.invalid_above = 60});
  std::size_t invalid = 0;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 30; ++k) {
        const bool above = (std::max(i, j) + 0.5) * 4.5 > 60;
        const auto at = static_cast<std::size_t>((i * 20 + j) * 30 + k);
        ASSERT_EQ(made.table.state[at] == State::kInvalid, above) << i << ' ' << j;
        invalid += above;
      }
  EXPECT_EQ(made.counts.invalid_above, invalid);
}

TEST(Faults, FlareIsAHaloAroundTheMirrorDirection) {
  const Faulty made = with({.flare = 0.02, .flare_angle = 10});
  const auto model = std::get<brdf::Callisto<double>>(plain().brdf);
  const double peak = model.eval({0, 0, 1}, {0, 0, 1}).g;
  std::size_t touched = 0, at = 0;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 30; ++k, ++at) {
        const double theta_h = std::acos(geometry_of(made.table.grid, i, j, k).cos_h) * 180 / std::numbers::pi;
        const double x = theta_h / 10, halo = x < 1 ? 0.02 * peak * (1 - x * x) * (1 - x * x) : 0;
        // 1e-9 of the peak: acos loses half the digits near 0, where the halo is flat.
        ASSERT_NEAR(made.table.f[1][at] - made.clean.f[1][at], halo, 1e-9 * peak);
        touched += x < 1;
      }
  EXPECT_EQ(made.counts.flare, touched);
  EXPECT_GT(touched, 0u);
}

TEST(Faults, ClippingBoundsEveryValueAndCountsTheSamples) {
  const Faulty made = with({.clip = 0.3});
  std::size_t above = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    bool any = false;
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(made.table.f[c][i], std::min(made.clean.f[c][i], 0.3));
      any |= made.clean.f[c][i] > 0.3;
    }
    above += any;
  }
  EXPECT_EQ(made.counts.clip, above);
  EXPECT_GT(above, 0u);
}

TEST(Material, HalfBinPutsTheMirrorPeakIntoTheFirstMerlBin) {
  Material m = plain();
  std::get<brdf::Callisto<double>>(m.brdf).roughness = 0.05;  // so sharp that the center of bin 0 lies below the peak
  m.grid = grid_of(Format::kMerl, 0, 0);
  m.faults.half_bin = true;
  const auto at = [](const std::string& bytes, std::size_t bin) {
    double value;
    std::memcpy(&value, bytes.data() + 12 + 8 * bin, 8);
    return value;
  };
  const double peak = std::get<brdf::Callisto<double>>(m.brdf).eval({0, 0, 1}, {0, 0, 1}).r;
  EXPECT_NEAR(at(make(m).bytes, 0) / 1500, peak, 1e-12 * peak);  // rounding of the angles and of the scale
  m.faults.half_bin = false;
  EXPECT_LT(at(make(m).bytes, 0) / 1500, peak);
}

TEST(Material, TruncationCutsTheEndOnly) {
  Material m = plain();
  const std::string whole = make(m).bytes;
  m.faults.truncate = 100;
  EXPECT_EQ(make(m).bytes, whole.substr(0, whole.size() - 100));
  EXPECT_THROW(measured::parse_mbsdf(make(m).bytes, "made"), files::InputError);
  m.faults.truncate = whole.size();
  EXPECT_THROW(make(m), files::UsageError);
}

TEST(Material, DrawnParametersAreUsualAndBelongToTheSeed) {
  for (const std::string_view name : brdf::kModelNames) {
    brdf::AnyBrdf model;
    ASSERT_TRUE(brdf::model_of_name(name, model));
    const auto a = material::entries(drawn(model, 1)), b = material::entries(drawn(model, 1)),
               c = material::entries(drawn(model, 2));
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int k = 0; k < a[i].row.channels; ++k) {
        const auto channel = static_cast<std::size_t>(k);
        EXPECT_GE(a[i].value[channel], a[i].row.typical.low) << a[i].row.name;
        EXPECT_LE(a[i].value[channel], a[i].row.typical.high) << a[i].row.name;
        EXPECT_EQ(a[i].value[channel], b[i].value[channel]) << a[i].row.name;
        EXPECT_NE(a[i].value[channel], c[i].value[channel]) << a[i].row.name;
      }
  }
}

TEST(Material, ManifestAndMaterialFileAgreeWithTheFile) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("likeness_synthetic_material_test_" + std::to_string(getpid()));
  std::filesystem::remove_all(folder);
  Material m = plain();
  m.brdf = drawn(m.brdf, 5);
  m.faults = {.invalid = 0.25, .nan = 0.01, .noise = 0.1, .truncate = 10};
  const Json manifest = Json::parse(write(m, folder / "worn.mbsdf"));
  const std::string bytes = files::read_whole(folder / "worn.mbsdf", 100 << 20);
  EXPECT_EQ(bytes, make(m).bytes);
  EXPECT_EQ(manifest, Json::parse(files::read_whole(folder / "worn.truth.json", 1 << 20)));
  EXPECT_EQ(manifest["sha256"], files::sha256(bytes));
  EXPECT_EQ(manifest["bytes"], bytes.size());
  EXPECT_EQ(manifest["file"], "worn.mbsdf");
  EXPECT_EQ(manifest["seed"], 7);
  EXPECT_EQ(manifest["model"], "callisto");
  EXPECT_EQ(manifest["faults"]["invalid"]["setting"], 0.25);
  EXPECT_EQ(manifest["faults"]["invalid"]["samples"], make(m).counts.invalid);
  EXPECT_EQ(manifest["faults"]["nan"]["samples"], make(m).counts.nan);
  EXPECT_EQ(manifest["table"]["samples"], kSamples);

  const auto truth = material::entries(material::read_material(folder / "worn.material.json").brdf);
  const auto wanted = material::entries(m.brdf);
  ASSERT_EQ(manifest["parameters"].size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(truth[i].value, wanted[i].value);
    const Json& said = manifest["parameters"][std::string(wanted[i].row.name)];
    EXPECT_EQ(wanted[i].row.channels == 3 ? said[2].get<double>() : said.get<double>(),
              wanted[i].value[wanted[i].row.channels == 3 ? 2 : 0]);
  }
  for (const FaultRow& row : kFaults) EXPECT_THAT(manifest.dump(), HasSubstr("\"" + std::string(row.name) + "\":"));
  std::filesystem::remove_all(folder);
}

TEST(Material, ReplacesItsOwnFilesAndNoOthers) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("likeness_synthetic_overwrite_test_" + std::to_string(getpid()));
  std::filesystem::remove_all(folder);
  const Material m = plain();
  write(m, folder / "a.mbsdf");
  EXPECT_NO_THROW(write(m, folder / "a.mbsdf"));
  EXPECT_THROW(write(m, folder / "a.csv"), files::UsageError);  // a.truth.json is a.mbsdf's
  std::ofstream(folder / "real.mbsdf") << "measured with care";
  EXPECT_THROW(write(m, folder / "real.mbsdf"), files::UsageError);
  EXPECT_EQ(files::read_whole(folder / "real.mbsdf", 1000), "measured with care");
  std::ofstream(folder / "b.truth.json") << "{";
  EXPECT_THROW(write(m, folder / "b.mbsdf"), files::UsageError);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace likeness::datasets_synthetic
