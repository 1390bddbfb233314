#include "render/cost/study.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <numeric>
#include <random>
#include <thread>

#include "render/files/files.h"
#include "render/image/read.h"
#include "render/image/write.h"
#include "render/reference/reference.h"
#include "render/runtime/pipeline.h"

namespace likeness::scene_cost {
namespace {

constexpr std::size_t kFew = 30;       // combinations that are measured at most, besides the ladders
constexpr double kSlack = 1.3;         // of predicted errors
constexpr int kWidestThumbnail = 400;  // [pixel]
constexpr std::uint32_t kReferenceSeed = 0x5eed0000u, kOtherHalfSeed = 0x5eed0001u, kDirectSeed = 0x5eed0002u;

using GoesOn = std::function<bool(std::string_view, double)>;

double wall_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

std::string small_png(const image::DisplayPicture& picture) {
  return image::png_bytes(reduced(picture, kWidestThumbnail));
}

// A picture by the path tracer; its samples a pixel, fewer than asked for if it was stopped.
std::uint32_t trace(const world::World& world, const Options& options, std::uint32_t samples, std::uint32_t seed,
                    int bounces, const std::function<bool(double)>& goes_on, image::Picture& out) {
  const scene::Camera& camera = world.scene.cameras[options.camera];
  reference::Options o;
  o.camera = options.camera, o.samples = samples, o.seed = seed, o.max_bounces = bounces, o.threads = options.threads;
  reference::Film film(camera.width, camera.height, false);
  double share = 0;
  reference::render(world, o, film, [&](const reference::Progress& p) {
    if (p.share >= 0) share = p.share;
    return !goes_on || goes_on(share);
  });
  out = film.picture();
  return film.least_samples();
}

class Measurement {
 public:
  Measurement(const world::World& world, const Options& options, const GoesOn& goes_on)
      : world_(world), options_(options), goes_on_(goes_on), pipeline_(world) {
    const scene::Camera& camera = world.scene.cameras[options.camera];
    study_.machine = machine();
    study_.options = options;
    study_.scene = world.scene.name, study_.camera = camera.name, study_.view = world.scene.view.name;
    study_.width = camera.width, study_.height = camera.height;
    for (std::size_t i = 0; i < kSettingCount; ++i) study_.matters[i] = runtime::kSettings[i].matters(world.plan);
  }

  Study run() {
    const double start = wall_ms();
    study_.is_complete = make_reference() && measure();
    conclude();
    study_.seconds = 1e-3 * (wall_ms() - start);
    return std::move(study_);
  }

 private:
  bool make_reference() {
    Reference& r = study_.reference;
    const double start = wall_ms();
    image::Picture half;
    if (!options_.reference_file.empty()) {
      r.picture = image::read_picture(options_.reference_file);
      if (r.picture.width != study_.width || r.picture.height != study_.height)
        throw files::InputError(options_.reference_file.string() + ": " + std::to_string(r.picture.width) + " x " +
                                std::to_string(r.picture.height) + " pixels; the camera's picture has " +
                                std::to_string(study_.width) + " x " + std::to_string(study_.height) +
                                " (--size changes that)");
      r.source = "the file " + options_.reference_file.filename().string();
    } else {
      const std::uint32_t samples = std::max(options_.reference_samples / 2, 1u);
      const std::string phase = "reference";
      image::Picture other;
      const std::uint32_t a = trace(
          world_, options_, samples, kReferenceSeed, options_.max_bounces,
          [&](double share) { return goes_on_(phase, share / 2); }, half);
      std::uint32_t b = 0;
      if (a == samples)
        b = trace(
            world_, options_, samples, kOtherHalfSeed, options_.max_bounces,
            [&](double share) { return goes_on_(phase, 0.5 + share / 2); }, other);
      r.picture = half;
      if (b == samples)
        for (std::size_t i = 0; i < half.rgb.size(); ++i) r.picture.rgb[i] = 0.5f * (half.rgb[i] + other.rgb[i]);
      r.samples = b == samples ? 2 * samples : a;
      r.source = "path tracer, " + std::to_string(r.samples) + " samples a pixel, at most " +
                 std::to_string(options_.max_bounces) + (options_.max_bounces == 1 ? " bounce" : " bounces");
      if (b < samples) return false;
    }
    r.seconds = 1e-3 * (wall_ms() - start);
    judge_.emplace(r.picture, mask_of(world_, options_.camera), world_.scene.view);
    study_.share_of_surfaces = judge_->share_of_surfaces();
    study_.reference_png = small_png(judge_->shown());
    // The mean of two halves is as far from one of them as it is, on the average, from the truth.
    if (!half.rgb.empty()) r.noise = judge_->judge(half).errors;
    if (options_.max_bounces > 1) {
      image::Picture direct;
      const std::uint32_t done = trace(
          world_, options_, options_.reference_samples, kDirectSeed, 1,
          [&](double share) { return goes_on_("reference, direct light", share); }, direct);
      if (done < options_.reference_samples) return false;
      const Judge::Verdict verdict = judge_->judge(direct);
      study_.direct_only = verdict.errors;
      study_.direct_png = small_png(verdict.shown), study_.direct_map_png = small_png(error_picture(verdict.map));
    }
    return true;
  }

  Row::Reading frame(const Levels& levels, image::Picture& picture) const {
    std::vector<runtime::PassTime> passes;
    Row::Reading reading;
    const double wall = wall_ms(), cpu = cpu_ms();
    picture = pipeline_.frame(options_.camera, settings_of(levels), options_.threads, &passes);
    reading.cpu_ms = cpu_ms() - cpu, reading.wall_ms = wall_ms() - wall;
    for (const runtime::PassTime& p : passes) {
      reading.wall_passes.push_back({std::string(p.name), 1e3 * p.seconds});
      reading.cpu_passes.push_back({std::string(p.name), 1e3 * p.cpu_seconds});
    }
    return reading;
  }

  void read(Row& row) {
    image::Picture picture;
    Row::Reading reading;
    if (row.is_path_tracer) {
      const double wall = wall_ms(), cpu = cpu_ms();
      const std::uint32_t done = trace(
          world_, options_, row.samples, 0, options_.max_bounces, [&](double) { return goes_on_(phase_, share_); },
          picture);
      if (done < row.samples) return;  // stopped
      reading.cpu_ms = cpu_ms() - cpu, reading.wall_ms = wall_ms() - wall;
    } else {
      reading = frame(row.levels, picture);
    }
    row.readings.push_back(std::move(reading));
    if (row.readings.size() > 1) return;
    const Judge::Verdict verdict = judge_->judge(picture);
    row.errors = verdict.errors;
    row.shown_png = small_png(verdict.shown), row.map_png = small_png(error_picture(verdict.map));
  }

  // Frames of one point a pixel, level by level as long as they are short, tell what the others will take. Levels that are
  // no numbers of rays are all read: nothing tells one from another.
  TimeModel calibrate() {
    std::vector<FrameTimes> frames;
    image::Picture picture;
    const auto one = [&](const Levels& levels) {
      const Row::Reading r = frame(levels, picture);
      frames.push_back({levels, r.cpu_ms, r.cpu_passes});
      return r.cpu_ms;
    };
    frame(study_.cheapest, picture);  // fills caches, wakes threads
    for (std::size_t s = 0; s < kSettingCount; ++s) {
      if (s == kPixelSamples || !study_.matters[s]) continue;
      Levels levels = study_.cheapest;
      for (; levels[s] < runtime::kSettings[s].levels.size(); ++levels[s])
        if (!goes_on_("calibration", 0) ||
            (one(levels) > options_.longest_ms / 16 && runtime::kSettings[s].work(levels[s]) > 0))
          break;
    }
    if (frames.empty()) one(study_.cheapest);
    return TimeModel(frames);
  }

  Row& add(const Levels& levels) {
    for (Row& row : study_.rows)
      if (!row.is_path_tracer && row.levels == levels) return row;
    study_.rows.emplace_back().levels = levels;
    return study_.rows.back();
  }

  void add_ladders(const TimeModel& model) {
    for (const Levels& rest : {study_.best, study_.cheapest})
      for (std::size_t s = 0; s < kSettingCount; ++s) {
        if (!study_.matters[s]) continue;
        Levels levels = rest;
        for (std::size_t level = 0; level < runtime::kSettings[s].levels.size(); ++level) {
          levels[s] = level;
          if (level > rest[s] && model.predict(levels) > options_.longest_ms) continue;
          Row& row = add(levels);
          row.feeds_model = true;
          row.in_ladder[s] |= rest == study_.best;
        }
      }
    constexpr std::uint32_t kMostLadderSamples = 64;
    for (std::uint32_t samples = 1; samples <= kMostLadderSamples; samples *= 4) {
      if (options_.reference_file.empty() && samples > options_.reference_samples) break;
      Row& row = study_.rows.emplace_back();
      row.is_path_tracer = true, row.samples = samples;
    }
  }

  void add_combinations() {
    std::vector<FrameTimes> frames;
    std::vector<ErrorModel::Measured> errors;
    for (const Row& row : study_.rows) {
      if (row.is_path_tracer || row.readings.empty()) continue;
      const Row::Reading& r = row.readings.front();
      frames.push_back({row.levels, r.cpu_ms, r.cpu_passes});
      errors.push_back({row.levels, row.errors.relmse});
    }
    const TimeModel times(frames);
    const ErrorModel model(errors);
    std::vector<Candidate> all;
    Levels levels = study_.cheapest;
    const std::function<void(std::size_t)> each = [&](std::size_t s) {
      if (s == kSettingCount) {
        const double ms = times.predict(levels);
        if (ms > options_.longest_ms && levels != study_.best) ++study_.left_out;
        else all.push_back({levels, ms, model.predict(levels)});
        return;
      }
      if (!study_.matters[s]) return each(s + 1);
      for (std::size_t level = 0; level < runtime::kSettings[s].levels.size(); ++level) levels[s] = level, each(s + 1);
      levels[s] = study_.cheapest[s];
    };
    each(0);
    std::erase_if(all, [&](const Candidate& c) {
      return std::any_of(study_.rows.begin(), study_.rows.end(),
                         [&](const Row& row) { return !row.is_path_tracer && row.levels == c.levels; });
    });
    const std::vector<Candidate> chosen = promising(all, kFew, kSlack);
    study_.not_promising = all.size() - chosen.size();
    for (const Candidate& c : chosen) add(c.levels);
  }

  // Reads rows until each has `count` readings, round by round in drawn order.
  bool read_all(std::string phase, int count) {
    phase_ = std::move(phase);
    double total = 0, done = 0;
    const auto cost = [](const Row& row) { return row.readings.empty() ? 1.0 : row.readings.front().cpu_ms; };
    const auto wants = [&](const Row& row) {
      const bool is_too_long = row.is_path_tracer && !row.readings.empty() && cost(row) > options_.longest_ms;
      return !is_too_long && row.readings.size() < static_cast<std::size_t>(count);
    };
    for (const Row& row : study_.rows)
      if (wants(row)) total += cost(row) * (count - static_cast<double>(row.readings.size()));
    std::vector<std::size_t> order(study_.rows.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (bool is_more = true; is_more;) {
      is_more = false;
      std::shuffle(order.begin(), order.end(), engine_);
      // Rows that lag behind catch up first, so that all rounds but the first hold all rows.
      std::size_t least = static_cast<std::size_t>(count);
      for (const Row& row : study_.rows)
        if (wants(row)) least = std::min(least, row.readings.size());
      for (const std::size_t i : order) {
        Row& row = study_.rows[i];
        if (!wants(row) || row.readings.size() > least) continue;
        share_ = total > 0 ? std::min(done / total, 1.0) : 0;
        if (!goes_on_(phase_, share_)) return false;
        done += cost(row);
        read(row);
        is_more = true;
      }
    }
    return goes_on_(phase_, 1);
  }

  bool measure() {
    for (std::size_t i = 0; i < kSettingCount; ++i)
      study_.cheapest[i] = study_.matters[i] ? 0 : runtime::kSettings[i].level_of(runtime::Settings{});
    const TimeModel model = calibrate();
    study_.best = best_within(model, study_.matters, options_.longest_ms);
    add_ladders(model);
    if (!read_all("levels one at a time", 1)) return false;
    add_combinations();
    return read_all("all combinations", options_.repeats);
  }

  void conclude() {
    std::erase_if(study_.rows, [](const Row& row) { return row.readings.empty(); });
    std::vector<FrameTimes> cpu, wall;
    for (const Row& row : study_.rows)
      if (row.feeds_model)
        for (const Row::Reading& r : row.readings) {
          cpu.push_back({row.levels, r.cpu_ms, r.cpu_passes});
          wall.push_back({row.levels, r.wall_ms, r.wall_passes});
        }
    const TimeModel of_cpu(cpu), of_wall(wall);
    for (Row& row : study_.rows)
      if (!row.is_path_tracer)
        row.predicted_cpu_ms = of_cpu.predict(row.levels), row.predicted_wall_ms = of_wall.predict(row.levels);
    study_.parts = of_cpu.parts(), study_.frame_ms = of_cpu.frame_ms();
    find_dominated(study_);
  }

  const world::World& world_;
  const Options& options_;
  const GoesOn& goes_on_;
  const runtime::Pipeline pipeline_;
  std::optional<Judge> judge_;
  std::mt19937_64 engine_{1};
  std::string phase_;
  double share_ = 0;
  Study study_;
};

}  // namespace

Machine machine() {
  Machine out{"unknown processor", std::thread::hardware_concurrency()};
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) {
      out.processor = line.substr(std::min(line.size(), line.find(':') + 2));
      break;
    }
  return out;
}

Study run_study(const world::World& world, const Options& options, const GoesOn& goes_on) {
  return Measurement(world, options, goes_on).run();
}

}  // namespace likeness::scene_cost
