#include "brdf/cost/study.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>
#include <memory>
#include <stdexcept>

namespace likeness::cost {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostRows = 1024;  // of a timed block: all columns stay in the L1 or L2 cache

const catalog::Entry& entry_of(const Rung& rung) {
  if (const catalog::Entry* entry = catalog::find(rung.evaluator)) return *entry;
  throw std::logic_error("the cost page names an evaluator that is not there: " + rung.evaluator);
}

// A block of rows of one form, evaluated at every call.
template <class N>
Task task_of(const catalog::Entry& entry, const catalog::Loops<N>& loops, const std::vector<std::vector<N>>& columns,
             std::size_t rows) {
  struct State {
    std::vector<catalog::Column<N>> in;
    std::vector<std::vector<N>> results;
    std::vector<N*> out;
  };
  auto state = std::make_shared<State>();
  for (const auto& column : columns) state->in.push_back({column.data(), false});
  state->results.assign(entry.output_count, std::vector<N>(rows));
  for (auto& column : state->results) state->out.push_back(column.data());
  const void* tables = entry.tables();
  return {[=] { loops.from_inputs(tables, state->in.data(), state->out.data(), rows); }, rows};
}

double seconds_of(const Task& task) {
  const auto start = std::chrono::steady_clock::now();
  task.run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// So many rows that one call takes about the time of a reading: one, of a random walk; of cheap forms, the whole block.
std::size_t rows_for(const catalog::Entry& entry, const Columns& columns, double seconds, std::size_t available) {
  const std::size_t most = std::min(kMostRows, available);
  std::size_t rows = 1;
  double took = seconds_of(task_of(entry, entry.in_float, columns.of_float, 1));
  while (rows < most && took < seconds / 8) {
    rows = std::min(most, rows * 8);
    took = seconds_of(task_of(entry, entry.in_float, columns.of_float, rows));
  }
  return rows;
}

// Against what the errors of a family are taken.
std::vector<double> reference_of(FamilyResult& result, const Draws& draws, const std::vector<Columns>& columns,
                                 double effort) {
  const Family& family = result.family;
  if (family.estimates) {
    const auto [a, b] = family.estimates(draws.rows, effort);
    std::vector<double> mean(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) mean[i] = 0.5 * (a[i] + b[i]);
    result.noise = accuracy_of(family, draws, a, mean).rms;  // from the mean, each is off by half their difference
    return mean;
  }
  const auto at = std::find_if(family.rungs.begin(), family.rungs.end(), [](const Rung& r) { return r.is_reference; });
  if (at == family.rungs.end()) throw std::logic_error("the family " + family.name + " has no reference");
  return values_of(*at, entry_of(*at), draws, columns[std::size_t(at - family.rungs.begin())], Precision::kDouble);
}

// The shares of a family's draws that a user may ask for end here.
std::size_t draws_for(const Family& family, double scale) {
  const std::size_t least = std::min<std::size_t>(64, family.draws);
  return std::max(least, std::size_t(double(family.draws) * scale));
}

}  // namespace

std::vector<Family> chosen_families(const std::vector<std::string>& names) {
  std::vector<Family> all = families();
  if (names.empty()) return all;
  std::vector<Family> chosen;
  for (const std::string& name : names) {
    const auto at = std::find_if(all.begin(), all.end(), [&](const Family& f) { return f.name == name; });
    if (at == all.end()) {
      std::string known;
      for (const Family& f : all) known += (known.empty() ? "" : ", ") + f.name;
      throw std::invalid_argument("there is no family '" + name + "'; there are " + known);
    }
    chosen.push_back(*at);
  }
  return chosen;
}

void find_dominated(FamilyResult& result) {
  const auto& rungs = result.family.rungs;
  for (std::size_t p = 0; p < 3; ++p)
    for (std::size_t i = 0; i < rungs.size(); ++i)
      for (std::size_t k = 0; k < rungs.size(); ++k) {
        Cell& a = result.cells[i][p];
        const Cell& b = result.cells[k][p];
        if (i == k || a.one_by_one || b.one_by_one || !a.dominated_by.empty()) continue;
        if (b.timing.ns_high < a.timing.ns_low && b.accuracy.rms <= a.accuracy.rms) a.dominated_by = rungs[k].label;
      }
}

Study run_study(const Options& options, const std::function<void(const std::string&, double)>& progress) {
  Study study;
  study.options = options;
  const std::clock_t start = std::clock();
  const std::vector<Family> chosen = chosen_families(options.families);
  study.machine = machine();

  // Errors first; the columns stay for the timing.
  std::vector<std::vector<Columns>> columns(chosen.size());
  std::vector<Task> tasks;
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    const Family& family = chosen[f];
    const double share = 0.4 * double(f) / double(chosen.size());
    if (progress) progress("errors: " + family.title, share);
    FamilyResult result{family, draws_for(family, options.draws_scale), 0, {}};
    const Draws draws = draws_of(family, result.draws);
    for (const Rung& rung : family.rungs) columns[f].push_back(columns_of(family, rung, entry_of(rung), draws));
    const auto reference = reference_of(result, draws, columns[f], std::min(1.0, options.draws_scale));
    for (std::size_t i = 0; i < family.rungs.size(); ++i) {
      const catalog::Entry& entry = entry_of(family.rungs[i]);
      if (progress) progress("errors: " + family.title + ", " + family.rungs[i].label, share);
      const Columns& c = columns[f][i];
      const std::size_t rows = rows_for(entry, c, options.seconds, result.draws);
      std::array<Cell, 3> cells;
      for (const Precision p : {Precision::kDouble, Precision::kFloat, Precision::kBatch}) {
        Cell& cell = cells[std::size_t(p)];
        cell.one_by_one = p == Precision::kBatch && entry.one_by_one;
        if (cell.one_by_one) {
          cell.accuracy = cells[std::size_t(Precision::kFloat)].accuracy;
          cell.timing = {kNone, kNone, kNone, kNone, kNone};
          continue;
        }
        cell.accuracy = accuracy_of(family, draws, values_of(family.rungs[i], entry, draws, c, p), reference);
        tasks.push_back(p == Precision::kDouble  ? task_of(entry, entry.in_double, c.of_double, rows)
                        : p == Precision::kFloat ? task_of(entry, entry.in_float, c.of_float, rows)
                                                 : task_of(entry, entry.in_batches, c.of_float, rows));
      }
      result.cells.push_back(std::move(cells));
    }
    study.families.push_back(std::move(result));
  }

  const auto timings = time_interleaved(tasks, options.repeats, options.seconds, [&](double share) {
    if (progress) progress("times, " + std::to_string(tasks.size()) + " of them interleaved", 0.4 + 0.6 * share);
  });
  std::size_t at = 0;
  for (FamilyResult& result : study.families) {
    for (auto& cells : result.cells)
      for (Cell& cell : cells)
        if (!cell.one_by_one) cell.timing = timings[at++];
    find_dominated(result);
  }
  study.seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  return study;
}

}  // namespace likeness::cost
