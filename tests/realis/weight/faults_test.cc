#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "datasets_synthetic/capture.h"
#include "realis/bake.h"
#include "realis/from_capture.h"
#include "realis/weigh.h"
#include "tests/render/temporary_folder.h"

// Each weight against its fault, on captures of which the truth is known: false residual is what the bake of the faulty capture
// says more or less than that of the clean one, rms over texels and lights, with the weight off and on.
namespace likeness::realis {
namespace {

using datasets_synthetic::CaptureFaults;
using datasets_synthetic::CaptureOptions;

bool always(double, std::string_view) { return true; }

// The default material, and one that is rougher and brighter at grazing light: what a clean capture has to be baked for.
brdf::AnyBrdf real_surface() {
  brdf::Callisto<double> out;
  out.base_color = brdf::Rgb<double>(0.55, 0.5, 0.45);
  out.diffuse_fresnel = 0.6, out.retroreflection = 0.5;
  return brdf::AnyBrdf(out);
}

capture::Capture made(const std::filesystem::path& folder, const brdf::AnyBrdf& surface, const CaptureFaults& faults,
                      bool has_pairs = false) {
  CaptureOptions options;
  options.has_pairs = has_pairs;
  options.folder = folder;
  options.width = options.height = 64, options.lights = 24;
  options.has_floats = true, options.brdf = surface, options.faults = faults;
  return datasets_synthetic::make_capture(options).capture;
}

class Weights : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    brdf::Callisto<double> plain;
    plain.base_color = brdf::Rgb<double>(0.5, 0.5, 0.5);
    rendered_ = std::make_unique<capture::Capture>(made(folder_->path() / "rendered", brdf::AnyBrdf(plain), {}));
    clean_ = std::make_unique<Subject>(subject_of("clean", {}));
    basis_ = std::make_unique<Basis>(bake(*clean_, {.lobes = 16}, always).basis);
  }
  static void TearDownTestSuite() { basis_.reset(), clean_.reset(), rendered_.reset(), folder_.reset(); }

  static Subject subject_of(const char* name, const CaptureFaults& faults, bool has_pairs = false) {
    const capture::Capture photographed = made(folder_->path() / name, real_surface(), faults, has_pairs);
    return read_subject(photographed, 0, renders_of_variant(*rendered_, 0, 0), {}, always);
  }
  static Subject weighed(Subject s, const weight::Choice& choice) {
    weigh(*rendered_, {}, choice, false, s);
    return s;
  }
  static weight::Choice only(const char* name, const weight::Settings& settings = {}) {
    const std::vector<std::string> names{name};
    return weight::choice_of(names, {}, {}, settings);
  }

  // What a bake adds to each sample [luminance].
  static std::vector<double> baked(const Subject& s) {
    const Bake bake = bake_with(s, *basis_, {}, always);
    std::vector<double> out(s.photo.size());
    for (std::size_t l = 0; l < s.lights.size(); ++l) {
      const Residual residual(bake, s.to_lights[l]);
      for (std::size_t t = 0; t < s.texels(); ++t)
        out[s.samples_of(t) + l] = residual.at(t, static_cast<double>(s.cosine[s.samples_of(t) + l]))[0];
    }
    return out;
  }
  static double rms(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
  }

  // The share of the false residual that a weight takes away; printed.
  static double removed(const char* name, const char* fault, const Subject& faulty, weight::Settings settings = {}) {
    const std::vector<double> truth = baked(*clean_);
    const double off = rms(baked(faulty), truth), on = rms(baked(weighed(faulty, only(name, settings))), truth);
    const Subject w = weighed(faulty, only(name, settings));
    double left = 0, all = 0;
    for (std::size_t i = 0; i < faulty.photo.size(); ++i) {
      const double d = weight::luminance(faulty.photo[i]) - weight::luminance(clean_->photo[i]);
      all += d * d;
      left += d * d * static_cast<double>(w.weight[i]) * static_cast<double>(w.weight[i]);
    }
    std::printf("%-9s %-34s false residual %.6f -> %.6f: %5.1f %% removed (of the samples' own %5.1f %%)\n", name,
                fault, off, on, 100 * (1 - on / off), 100 * (1 - std::sqrt(left / all)));
    return 1 - on / off;
  }

  static std::unique_ptr<test::TemporaryFolder> folder_;
  static std::unique_ptr<capture::Capture> rendered_;
  static std::unique_ptr<Subject> clean_;
  static std::unique_ptr<Basis> basis_;  // of the clean capture, for all: what differs is what samples say
};
std::unique_ptr<test::TemporaryFolder> Weights::folder_;
std::unique_ptr<capture::Capture> Weights::rendered_;
std::unique_ptr<Subject> Weights::clean_;
std::unique_ptr<Basis> Weights::basis_;

TEST_F(Weights, OfShadowsTakeAwayWhatACasterThatIsElsewhereAdds) {
  CaptureFaults faults;
  for (const double offset : {0.01, 0.02, -0.03}) {
    faults.shadow_offset_m = offset;
    const std::string name = "caster " + std::to_string(offset) + " m aside";
    EXPECT_GT(removed("shadow", name.c_str(), subject_of("shadow", faults)), 0.8) << offset;
  }
}

TEST_F(Weights, OfForeignObjectsTakeAwayAnObject) {
  CaptureFaults faults;
  faults.objects = {{5, 0.3}, {17, 0.15}};
  EXPECT_GT(removed("foreign", "two objects", subject_of("object", faults)), 0.8);
}

TEST_F(Weights, OfSpecularResidueTakeAwayAHighlight) {
  CaptureFaults faults;
  for (const double residue : {0.05, 0.5}) {
    faults.residue = residue;
    const std::string name = "residue " + std::to_string(residue);
    EXPECT_GT(removed("specular", name.c_str(), subject_of("residue", faults)), 0.8) << residue;
  }
}

// Through crossed polarizers a highlight is measured: also one that is too weak to be told from what the surface does.
TEST_F(Weights, OfSpecularResidueAreMeasuredByPolarizedPairs) {
  CaptureFaults faults;
  faults.read_noise = 0.1, faults.full_well = 20000;
  const Subject clean = subject_of("pairs", faults, true);
  ASSERT_EQ(clean.crossed.size(), clean.photo.size());
  const std::vector<double> truth = baked(*clean_);
  const double noise = rms(baked(clean), truth);  // what the noise alone makes of the bake, which no weight takes away
  for (const double residue : {0.02, 0.05, 0.5}) {
    faults.residue = residue;
    const std::string name = "residue " + std::to_string(residue) + ", pairs";
    const Subject faulty = subject_of("pairs", faults, true);
    const double off = rms(baked(faulty), truth), on = off * (1 - removed("specular", name.c_str(), faulty));
    EXPECT_LT(std::sqrt(std::max(on * on - noise * noise, 0.0)), 0.2 * off) << residue << ", noise alone: " << noise;
  }
  EXPECT_TRUE(subject_of("no_pairs", faults).crossed.empty());
}

// Clipped samples are marked by whoever reads the frames; here they are taken back first, and the level is told.
TEST_F(Weights, OfTheSensorTakeAwayClippingAndLostBlack) {
  CaptureFaults faults;
  faults.clip = 0.1;
  Subject clipped = subject_of("clipped", faults);
  EXPECT_TRUE(std::any_of(clipped.weight.begin(), clipped.weight.end(), [](float w) { return w == 0; }));
  std::fill(clipped.weight.begin(), clipped.weight.end(), 1.0f);
  weight::Settings settings;
  settings.clipped.clip = 0.0999;
  EXPECT_GT(removed("clipped", "clipped at 0.1", clipped, settings), 0.8);
}

TEST_F(Weights, OfTheSensorTakeAwayDeadPixels) {
  CaptureFaults faults;
  faults.dead = 0.01;
  EXPECT_GT(removed("black", "1 % of dead pixels", subject_of("dead", faults)), 0.8);
}

TEST_F(Weights, CostACleanCaptureNothing) {
  const std::vector<double> plain = baked(*clean_);
  const double clean = rms(plain, std::vector<double>(plain.size()));
  for (const weight::Row& row : weight::kWeights) {
    if (row.make == nullptr) continue;
    const Subject s = weighed(*clean_, only(std::string(row.name).c_str()));
    const double changed = rms(baked(s), plain) / clean;
    const Bake bake = realis::bake(s, {.lobes = 16}, always), before = realis::bake(*clean_, {.lobes = 16}, always);
    std::size_t touched = 0;
    for (const float w : s.weight) touched += w < 1;
    std::printf("%-9s clean: %.3f %% changed, %.2f %% of samples touched, held out %.6f (without %.6f)\n",
                std::string(row.name).c_str(), 100 * changed,
                100 * static_cast<double>(touched) / static_cast<double>(s.weight.size()), bake.ladder[0].held_out,
                before.ladder[0].held_out);
    if (!row.is_default) continue;  // off because it does cost something
    EXPECT_LT(changed, 0.01) << row.name;
    EXPECT_LE(bake.ladder[0].held_out, 1.01 * before.ladder[0].held_out) << row.name;
  }
}

}  // namespace
}  // namespace likeness::realis
