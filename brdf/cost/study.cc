#include "brdf/cost/study.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <memory>
#include <stdexcept>

namespace likeness::cost {
namespace {

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

void find_dominated(FamilyResult& result) {
  const auto& rungs = result.family.rungs;
  for (std::size_t p = 0; p < 3; ++p)
    for (std::size_t i = 0; i < rungs.size(); ++i)
      for (std::size_t k = 0; k < rungs.size(); ++k) {
        const Cell &a = result.cells[i][p], &b = result.cells[k][p];
        const bool faster = b.timing.ns < a.timing.ns, no_worse = b.accuracy.rms <= a.accuracy.rms;
        if (i != k && faster && no_worse && result.cells[i][p].dominated_by.empty())
          result.cells[i][p].dominated_by = rungs[k].label;
      }
}

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

}  // namespace

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
    if (progress) progress("errors: " + family.title, 0.4 * double(f) / double(chosen.size()));
    FamilyResult result{family, std::max<std::size_t>(64, std::size_t(double(family.draws) * options.draws_scale)), {}};
    const Draws draws = draws_of(family, result.draws);
    for (const Rung& rung : family.rungs) columns[f].push_back(columns_of(family, rung, entry_of(rung), draws));
    const auto at =
        std::find_if(family.rungs.begin(), family.rungs.end(), [](const Rung& r) { return r.is_reference; });
    if (at == family.rungs.end()) throw std::logic_error("the family " + family.name + " has no reference");
    const auto reference =
        values_of(*at, entry_of(*at), draws, columns[f][std::size_t(at - family.rungs.begin())], Precision::kDouble);
    for (std::size_t i = 0; i < family.rungs.size(); ++i) {
      const catalog::Entry& entry = entry_of(family.rungs[i]);
      std::array<Cell, 3> cells;
      for (const Precision p : {Precision::kDouble, Precision::kFloat, Precision::kBatch}) {
        const auto values = values_of(family.rungs[i], entry, draws, columns[f][i], p);
        cells[std::size_t(p)].accuracy = accuracy_of(family, draws, values, reference);
      }
      const Columns& c = columns[f][i];
      const std::size_t rows = rows_for(entry, c, options.seconds, result.draws);
      tasks.push_back(task_of(entry, entry.in_double, c.of_double, rows));
      tasks.push_back(task_of(entry, entry.in_float, c.of_float, rows));
      tasks.push_back(task_of(entry, entry.in_batches, c.of_float, rows));
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
      for (Cell& cell : cells) cell.timing = timings[at++];
    find_dominated(result);
  }
  study.seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  return study;
}

}  // namespace likeness::cost
