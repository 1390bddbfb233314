#include <algorithm>
#include <cmath>

#include "render/cost/statistics.h"
#include "render/cost/study.h"

namespace likeness::scene_cost {

Row::Timing Row::timing(bool of_cpu) const {
  std::vector<double> values;
  for (const Reading& r : readings) values.push_back(of_cpu ? r.cpu_ms : r.wall_ms);
  return {median(values), quantile(values, 0.25), quantile(values, 0.75)};
}

std::string name_of(const Study& study, const Row& row) { return name_of(study, row, nullptr); }

std::string name_of(const Study& study, const Row& row, const Levels* usual) {
  if (row.is_path_tracer) return "path tracer, " + std::to_string(row.samples) + " spp";
  std::string out;
  for (std::size_t i = 0; i < kSettingCount; ++i) {
    if (!study.matters[i] || (usual != nullptr && (*usual)[i] == row.levels[i])) continue;
    const runtime::SettingRow& setting = runtime::kSettings[i];
    std::string level(setting.levels[row.levels[i]]), label(setting.label);
    if (level == "1" && label.ends_with('s')) label.pop_back();  // 1 pt, 4 pts
    out += out.empty() ? "" : ", ";
    out += std::to_string(setting.work(row.levels[i])) == level ? level + " " + label : label + " " + level;
  }
  return out;
}

void find_dominated(Study& study) {
  for (Row& row : study.rows) {
    row.dominated_by.clear();
    if (row.is_path_tracer) continue;
    const Row::Timing mine = row.timing(study.options.counts_cpu);
    double fastest = mine.low;
    for (const Row& other : study.rows) {
      if (other.is_path_tracer || &other == &row || other.errors.flip > row.errors.flip) continue;
      const Row::Timing theirs = other.timing(study.options.counts_cpu);
      if (theirs.high < fastest) fastest = theirs.high, row.dominated_by = name_of(study, other);
    }
  }
}

std::optional<Agreement> agreement_of(const Study& study) {
  std::vector<double> of_others, of_all;
  for (const Row& row : study.rows) {
    if (row.is_path_tracer) continue;
    of_all.push_back(std::abs(row.predicted_cpu_ms / row.timing(true).median - 1));
    if (!row.feeds_model) of_others.push_back(of_all.back());
  }
  const std::vector<double>& used = of_others.empty() ? of_all : of_others;
  if (used.empty()) return {};
  return Agreement{median(used), quantile(used, 1), used.size(), !of_others.empty()};
}

std::optional<std::size_t> choice_of(const Study& study, const Budget& budget) {
  std::optional<std::size_t> best;
  std::pair<double, double> least;
  for (std::size_t i = 0; i < study.rows.size(); ++i) {
    const Row& row = study.rows[i];
    if (row.is_path_tracer) continue;
    const double ms = row.timing(study.options.counts_cpu).median, flip = row.errors.flip;
    if ((budget.ms && ms > *budget.ms) || (budget.flip && flip > *budget.flip)) continue;
    const auto order = budget.flip ? std::pair(ms, flip) : std::pair(flip, ms);
    if (!best || order < least) best = i, least = order;
  }
  return best;
}

std::vector<Candidate> promising(std::vector<Candidate> all, std::size_t few, double slack) {
  std::sort(all.begin(), all.end(),
            [](const Candidate& a, const Candidate& b) { return std::pair(a.ms, a.error) < std::pair(b.ms, b.error); });
  if (all.size() <= few) return all;
  std::vector<Candidate> kept;
  std::vector<double> over;  // the least error at no more time
  double least = HUGE_VAL;
  for (const Candidate& c : all) {
    least = std::min(least, c.error);
    if (c.error <= slack * least) kept.push_back(c), over.push_back(c.error / least);
  }
  if (kept.size() <= few) return kept;
  std::vector<double> sorted = over;
  std::sort(sorted.begin(), sorted.end());
  const double most = sorted[few - 1];
  std::vector<Candidate> out;
  for (std::size_t i = 0; i < kept.size() && out.size() < few; ++i)
    if (over[i] <= most) out.push_back(kept[i]);
  return out;
}

Levels best_within(const TimeModel& model, const bool (&matters)[kSettingCount], double longest_ms) {
  Levels levels;
  for (std::size_t i = 0; i < kSettingCount; ++i)
    levels[i] =
        matters[i] ? runtime::kSettings[i].levels.size() - 1 : runtime::kSettings[i].level_of(runtime::Settings{});
  while (model.predict(levels) > longest_ms) {
    std::size_t highest = kSettingCount;
    for (std::size_t i = 0; i < kSettingCount; ++i)
      if (matters[i] && levels[i] > 0 && runtime::kSettings[i].work(levels[i]) > 0 &&
          (highest == kSettingCount || levels[i] >= levels[highest]))
        highest = i;
    if (highest == kSettingCount) break;
    --levels[highest];
  }
  return levels;
}

}  // namespace likeness::scene_cost
