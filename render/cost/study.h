#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/cost/errors.h"
#include "render/cost/time_model.h"
#include "render/world/world.h"

// What accuracy costs in time, on a scene: frames of the run-time pipeline at each level of each setting, and the path
// tracer at a few numbers of samples, against a reference.
namespace likeness::scene_cost {

struct Options {
  std::size_t camera = 0;
  std::uint32_t reference_samples = 256;  // a pixel
  std::filesystem::path reference_file;   // instead; linear light, of the size of the camera's picture
  int max_bounces = 64;                   // of the reference and of the path tracer
  int repeats = 5;
  int threads = 0;           // 0: one a core
  double longest_ms = 4000;  // CPU time of a frame: combinations that would take more are left out
  bool counts_cpu = false;   // what "time" is in plots, dominance and budgets: CPU time, else wall clock
};

// A way to make a frame, with what was measured of it.
struct Row {
  bool is_path_tracer = false;
  std::uint32_t samples = 0;           // a pixel, of the path tracer
  Levels levels{};                     // of the run-time pipeline
  bool in_ladder[kSettingCount] = {};  // a level of this setting, against the rest at best
  bool feeds_model = false;            // its passes are what predictions are made from

  struct Reading {
    double wall_ms = 0, cpu_ms = 0;
    std::vector<FrameTimes::Pass> wall_passes, cpu_passes;
  };
  std::vector<Reading> readings;
  Errors errors;  // of the first frame; the others are the same
  double predicted_wall_ms = 0, predicted_cpu_ms = 0;
  std::string dominated_by;  // another row of the pipeline that is no less exact by FLIP, and faster by more than the
                             // quartiles of both; empty: none is
  std::string shown_png, map_png;

  struct Timing {
    double median = 0, low = 0, high = 0;  // quartiles [ms]
  };
  Timing timing(bool of_cpu) const;  // at least one reading
};

struct Reference {
  std::string source;  // in words
  std::uint32_t samples = 0;
  std::optional<Errors> noise;  // its own, estimated
  double seconds = 0;
  image::Picture picture;
};

struct Machine {
  std::string processor;
  unsigned cores = 0;
};
Machine machine();

struct Study {
  Machine machine;
  Options options;
  std::string scene, camera, view;
  int width = 0, height = 0;
  double share_of_surfaces = 0;
  bool matters[kSettingCount] = {};
  Levels best{}, cheapest{};
  std::size_t left_out = 0;       // combinations beyond Options::longest_ms
  std::size_t not_promising = 0;  // that no model expected on the front
  Reference reference;
  std::optional<Errors> direct_only;  // of the path tracer with one bounce: light that the pipeline leaves out
  std::string reference_png, direct_png, direct_map_png;
  std::vector<Row> rows;               // with at least one reading
  std::vector<TimeModel::Part> parts;  // of the CPU time
  double frame_ms = 0;
  double seconds = 0;
  bool is_complete = false;
};

// "4 pts, 16 shadow, env maps": the settings that matter. "path tracer, 4 spp".
std::string name_of(const Study& study, const Row& row);
// Of those settings only the ones that are not as usual; empty if all are.
std::string name_of(const Study& study, const Row& row, const Levels* usual);

// `goes_on` is told the phase and the share of it that is done, and asked whether to go on; when it says no, what was
// measured so far is returned. Throws files::InputError for a reference that cannot be used.
Study run_study(const world::World& world, const Options& options,
                const std::function<bool(std::string_view phase, double share)>& goes_on);

// Marks the rows to which another is preferable.
void find_dominated(Study& study);

// The most and the middle of |predicted / measured - 1| of the CPU times of rows that did not feed the model; of all,
// if there are none. Empty: nothing was measured.
struct Agreement {
  double median = 0, worst = 0;
  std::size_t rows = 0;
  bool is_of_others = false;  // rows that did not feed the model
};
std::optional<Agreement> agreement_of(const Study& study);

struct Budget {
  std::optional<double> ms, flip;
};
// The row with the least FLIP that is fast enough, or the fastest that is exact enough; of equals the faster or the more
// exact. None: nothing keeps to the budget. The path tracer is not chosen.
std::optional<std::size_t> choice_of(const Study& study, const Budget& budget);

// Combinations that are worth a measurement: all if they are at most `few`, otherwise those whose predicted error is
// within `slack` of the least error at no more time, the most exact of them if they are still too many.
struct Candidate {
  Levels levels{};
  double ms = 0, error = 0;
};
std::vector<Candidate> promising(std::vector<Candidate> all, std::size_t few, double slack);

// The highest level of all settings that matter within a time: the highest of them is lowered (the later setting first)
// until a frame is predicted to take no more. Levels that are no numbers of rays stay at their best.
Levels best_within(const TimeModel& model, const bool (&matters)[kSettingCount], double longest_ms);

std::string table_of(const Study& study);
std::string csv_of(const Study& study);
std::string json_of(const Study& study);
std::string page_of(const Study& study);

}  // namespace likeness::scene_cost
