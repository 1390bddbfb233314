#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/capture/capture_fit.h"
#include "realis/bake.h"
#include "realis/subject.h"
#include "render/capture/capture.h"

// How well light that nobody photographed is foretold: every light of a capture is left out once, and its photograph is
// compared with what is made of all others.
namespace likeness::realis {

struct StudyOptions {
  std::size_t texels = 2000;             // at most, on an even grid of the picture; 0: kMostTexels
  std::size_t folds = 8;                 // of lights for what is refitted seldom; kFewLights or fewer: one each
  std::optional<std::size_t> variant{};  // renders that are there; absent: of fits of the photographs
  bool with_rgb = true;
  double floor = 0.4;
  std::uint64_t seed = 1;
};
inline constexpr std::size_t kMostTexels = 20000, kFewLights = 24;

enum class Family : unsigned char { kRender, kBaseline, kRealis };
inline constexpr std::array<std::string_view, 3> kFamilies{"render", "baseline", "realis"};

struct Errors {
  double psnr = 0;                        // [dB], of the study's peak
  double stops_median = 0, stops_95 = 0;  // |log2((prediction + noise) / (photo + noise))| [stop]
};

struct Row {
  std::string name;
  Family family = Family::kRender;
  std::string bake_words;       // of Realis: the words of `likeness realis bake CAPTURE` that bake all lights so
  std::size_t bytes = 0;        // of a texel; for a render 3 of color and 2 of normal are among them
  Errors errors;                // as stored: 8 bit coefficients of Realis; floats of baselines, which favours those
  std::optional<Errors> exact;  // of Realis: with coefficients that are not rounded
  std::vector<Errors> by_light;
  double bake_seconds = 0;  // of all texels, extrapolated from those of the grid
  double ns = 0;            // to add up the numbers of a texel; the render is not in it
  std::vector<std::vector<std::array<float, 3>>> predicted;  // of each light, each texel
};

struct Study {
  std::string capture, camera;
  Subject subject;  // texels of the grid; renders of the first fold
  std::vector<std::string> light_ids;
  std::size_t texels_of_all = 0, folds = 0;
  int stride = 1;              // of the grid [pixel]
  double peak = 0, noise = 0;  // [the photographs' unit]
  bool is_noise_measured = false, is_complete = true;
  std::vector<Row> rows;
  Basis basis;  // an example to look at: of 32 lobes, all lights of the first fold's others
};

// Nothing that a prediction is made of has seen its light: base colors, material, estimated normals and lobes are found
// fold by fold (without the light and those of its fold), coefficients light by light. Where `goes_on` says no, rows that
// are finished are kept and the study is not complete. Throws as read_subject() and fit_capture() do.
Study leave_one_out(const capture::Capture& capture, std::size_t camera, const StudyOptions& options,
                    const GoesOn& goes_on);

// The subject without some lights (positions in Subject::lights).
Subject without(const Subject& subject, std::span<const std::size_t> lights);
// The subject on every stride-th pixel of every stride-th line.
Subject on_grid(const Subject& subject, int stride);

Errors errors_of(std::span<const std::array<float, 3>> predicted, std::span<const std::array<float, 3>> photo,
                 std::span<const float> weight, double peak, double noise);

// Of all lights of a subject, light by light.
Errors errors_of(std::span<const std::vector<std::array<float, 3>>> predicted, const Subject& subject, double peak,
                 double noise);
// Samples of a light, texel by texel.
std::vector<std::array<float, 3>> photo_of(const Subject& subject, std::size_t light);
std::vector<float> weight_of(const Subject& subject, std::size_t light);
// The value that `share` of the numbers are below; 0 of none.
double quantile_of(std::vector<float> values, double share);

// The row of Realis with the least stops_95 among those that take no more bytes than a baseline and are nearer in both
// measures; absent: the baseline is not beaten.
const Row* winner_over(const Study& study, const Row& baseline);

// `relight` is the page, beside this one, on which a bake is relit; empty: there is none.
std::string page_of(const Study& study, const std::string& relight);
std::string csv_of(const Study& study);
std::string json_of(const Study& study);
std::string table_of(const Study& study);

}  // namespace likeness::realis
