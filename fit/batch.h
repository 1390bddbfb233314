#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "fit/report/overview.h"
#include "fit/result/result.h"

namespace likeness::fit {

// One measured file of a job, and the name its results go by.
struct Job {
  std::filesystem::path file;
  std::string name;  // unique within the batch
};

// The measured files that some paths name: files as they are, folders searched (with their subfolders) for .binary,
// .mbsdf, .bsdf and .csv, in the order of their names. Two files of one stem are told apart by their extension or
// folder. Throws files::InputError for a path that is absent or a folder without measured files.
std::vector<Job> jobs_of(const std::vector<std::string>& paths);

// How a batch goes on, told after every material. Called from one thread at a time.
struct BatchProgress {
  std::size_t done = 0, all = 0;  // materials, those taken over from an earlier run included
  std::size_t taken_over = 0, failed = 0;
  double seconds = 0;       // since the batch began
  double seconds_left = 0;  // by the mean of those fitted so far; NaN before the first
  std::string material;     // the one that has just ended
  std::string outcome;      // "1.32 % ..." or the error
};

struct BatchResult {
  std::vector<Result> results;  // of a single job; a batch writes its results and forgets them
  std::vector<OverviewRow> rows;
  std::vector<FailedFile> failed;
  std::size_t taken_over = 0;
  bool interrupted = false;
};

// Fits every job and writes into `out`: NAME.fit.json, NAME.material.json and NAME.html for each, and for more than
// one job index.html. Each file is whole or absent. What an earlier run finished (same input, options and version) is
// taken over; a file that cannot be used is listed and left behind. When stop() says so, what is finished stays,
// what is under way is dropped, and the overview of what there is is written. `begins` is told the models of a single
// job as their fits begin.
BatchResult run_batch(const std::vector<Job>& jobs, const Options& options, const std::filesystem::path& out,
                      const std::function<bool()>& stop, const std::function<void(const BatchProgress&)>& tell,
                      const std::function<void(const std::string&)>& begins = {});

}  // namespace likeness::fit
