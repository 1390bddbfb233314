#include "fit/batch.h"

#include <unistd.h>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>

#include "fit/cpu_clock.h"
#include "fit/fit.h"
#include "fit/report/report.h"
#include "fit/result_file.h"
#include "render/files/files.h"
#include "render/material/material_file.h"

namespace likeness::fit {

namespace {

namespace fs = std::filesystem;

bool is_measured(const fs::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension == ".binary" || extension == ".mbsdf" || extension == ".bsdf" || extension == ".csv";
}

std::string percent(double value) {
  std::ostringstream out;
  out.precision(3);
  out << value << " %";
  return out.str();
}

// Said before anything is fitted. Nothing is made: a refused input leaves no folder.
void require_writable(const fs::path& out) {
  fs::path there = fs::absolute(out);
  std::error_code cause;
  while (!fs::exists(there, cause) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, cause) || access(there.c_str(), W_OK) != 0)
    throw files::UsageError("--out " + out.string() + " cannot be written: " + there.string() +
                            (fs::is_directory(there, cause) ? " is not writable" : " is not a folder") +
                            "; name a folder that can");
}

// What one job leaves behind: a row of the overview, or why there is none.
struct Outcome {
  std::optional<OverviewRow> row;
  std::optional<Result> result;
  std::string error;
  bool taken_over = false;
};

struct Batch {
  const Options& options;
  const fs::path& out;
  const std::function<bool()>& stop;
  const std::function<void(const std::string&)>& begins;
  bool keep_results;

  Outcome run(const Job& job) const {
    double began = thread_cpu_seconds();
    std::string bytes = files::read_whole(job.file, measured::kLargestFile);
    const std::string hash = files::sha256(bytes);
    const std::unique_ptr<measured::Material> material = measured::parse(std::move(bytes), job.file.string());
    material->source = job.file.string();
    const double load = thread_cpu_seconds() - began;

    Outcome outcome;
    const fs::path base = out / job.name;
    const fs::path result_file = base.string() + ".fit.json", report_file = base.string() + ".html";
    std::error_code missing;
    if (!keep_results && fs::exists(report_file, missing) &&
        fs::exists(base.string() + std::string(material::kExtension), missing)) {
      outcome.row = finished_row(result_file, hash, options);
      outcome.taken_over = outcome.row.has_value();
    }
    if (!outcome.taken_over) {
      Result result = fit_material(*material, job.name, options, stop, begins);
      result.sha256 = hash;
      result.timing.load += load;
      began = thread_cpu_seconds();
      const std::string report = report_html(result, *material);
      result.timing.report = thread_cpu_seconds() - began;
      // The result file last: it is what says that the others are there.
      files::write_whole(report_file, report);
      material::write_material(base.string() + std::string(material::kExtension), {result.material, result.best.brdf});
      files::write_whole(result_file, result_json(result));
      outcome.row = OverviewRow{result.material, result.best.label, result.best.metrics, result.pattern, {}, {}};
      if (keep_results) outcome.result = std::move(result);
    }
    if (!keep_results) {
      outcome.row->thumbnail_png = slice_thumbnail(*material, options.cut_deg);
      outcome.row->report_href = job.name + ".html";
    }
    return outcome;
  }
};

}  // namespace

std::vector<Job> jobs_of(const std::vector<std::string>& paths) {
  std::vector<fs::path> found;
  for (const std::string& path : paths) {
    std::error_code error;
    if (fs::is_directory(path, error)) {
      std::vector<fs::path> inside;
      for (const auto& entry :
           fs::recursive_directory_iterator(path, fs::directory_options::skip_permission_denied, error))
        if (entry.is_regular_file(error) && is_measured(entry.path())) inside.push_back(entry.path());
      if (inside.empty())
        throw files::InputError(path +
                                ": a folder without measured files; expected .binary, .mbsdf, .bsdf or .csv in it");
      std::ranges::sort(inside);
      found.insert(found.end(), inside.begin(), inside.end());
    } else if (fs::exists(path, error)) {
      found.emplace_back(path);
    } else {
      throw files::InputError(path + ": no such file or folder; expected a measured material or a folder of them");
    }
  }
  // The shortest name that tells each file apart: stem, file name, then the whole path with its separators replaced.
  const auto name = [](const fs::path& file, int length) {
    if (length == 0) return file.stem().string();
    if (length == 1) return file.filename().string();
    std::string whole = file.lexically_normal().string();
    std::ranges::replace(whole, '/', '_');
    return whole;
  };
  std::vector<Job> jobs;
  for (const fs::path& file : found) {
    if (std::ranges::any_of(jobs, [&](const Job& j) { return j.file == file; })) continue;
    int length = 0;
    while (length < 2 &&
           std::ranges::count_if(found, [&](const fs::path& f) { return name(f, length) == name(file, length); }) > 1)
      ++length;
    jobs.push_back({file, name(file, length)});
  }
  return jobs;
}

BatchResult run_batch(const std::vector<Job>& jobs, const Options& options, const fs::path& out,
                      const std::function<bool()>& stop, const std::function<void(const BatchProgress&)>& tell,
                      const std::function<void(const std::string&)>& begins) {
  check(options);
  require_writable(out);
  const std::function<void(const std::string&)> nobody;
  const tbb::global_control threads(
      tbb::global_control::max_allowed_parallelism,
      options.threads > 0 ? static_cast<std::size_t>(options.threads) : tbb::this_task_arena::max_concurrency());
  using Clock = std::chrono::steady_clock;
  const auto began = Clock::now();
  const Batch batch{options, out, stop, jobs.size() == 1 ? begins : nobody, jobs.size() == 1};
  std::vector<Outcome> outcomes(jobs.size());
  std::mutex telling;
  BatchProgress progress;
  progress.all = jobs.size();

  const auto told = [&](const Job& job, const Outcome& o) {
    const std::lock_guard lock(telling);
    ++progress.done;
    progress.taken_over += o.taken_over;
    progress.failed += !o.row;
    progress.seconds = std::chrono::duration<double>(Clock::now() - began).count();
    const std::size_t fitted = progress.done - progress.taken_over;
    progress.seconds_left = fitted == 0 ? std::numeric_limits<double>::quiet_NaN()
                                        : progress.seconds / static_cast<double>(fitted) *
                                              static_cast<double>(progress.all - progress.done);
    progress.material = job.name;
    progress.outcome = !o.row         ? o.error
                       : o.taken_over ? "taken over from an earlier run"
                                      : "slice error " + percent(o.row->metrics.slice_error_pct);
    if (tell) tell(progress);
  };

  // One material a task: they differ in cost, and no more of them than threads are in memory at once.
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, jobs.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          if (stop && stop()) return;
          try {
            outcomes[i] = batch.run(jobs[i]);
          } catch (const Interrupted&) {
            return;
          } catch (const files::InputError& error) {
            outcomes[i].error = error.what();
          }
          told(jobs[i], outcomes[i]);
        }
      },
      tbb::simple_partitioner());

  BatchResult result;
  result.interrupted = stop && stop();
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    Outcome& o = outcomes[i];
    if (o.result) result.results.push_back(std::move(*o.result));
    if (o.row) result.rows.push_back(std::move(*o.row));
    if (!o.error.empty()) result.failed.push_back({jobs[i].file.string(), o.error});
    result.taken_over += o.taken_over;
  }
  if (jobs.size() > 1) files::write_whole(out / "index.html", overview_html(result.rows, result.failed));
  return result;
}

}  // namespace likeness::fit
