#include "brdf/catalog/catalog.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "brdf/catalog/families.h"

namespace likeness::catalog {

namespace {

constexpr const char* kVariable = "LIKENESS_INSTRUCTION_SET";

using WideLoops = void (*)(Loops<float>*);

WideLoops wide_loops(const Family& family, std::string_view set) {
  return set == "avx512" ? family.avx512 : set == "avx2" ? family.avx2 : family.baseline;
}

std::string_view chosen_set() {
  const auto sets = instruction_sets();
  const char* asked = std::getenv(kVariable);
  if (asked == nullptr || *asked == '\0') return sets.back();
  if (const auto at = std::find(sets.begin(), sets.end(), asked); at != sets.end()) return *at;
  std::string known;
  for (const std::string_view set : sets) known += (known.empty() ? "" : ", ") + std::string(set);
  throw std::invalid_argument(std::string(kVariable) + " = " + asked + " is not a set this processor has: " + known +
                              "; unset it to use the fastest");
}

std::vector<Entry> make_entries() {
  std::vector<Entry> entries;
  for (const Family& family : families()) {
    const std::size_t first = entries.size();
    family.append(entries);
    std::vector<Loops<float>> loops(entries.size() - first);
    wide_loops(family, instruction_set())(loops.data());
    for (std::size_t i = 0; i < loops.size(); ++i) {
      Entry& entry = entries[first + i];
      entry.in_batches = entry.one_by_one ? entry.in_float : loops[i];
    }
  }
  return entries;
}

}  // namespace

std::vector<std::string_view> instruction_sets() {
  std::vector<std::string_view> sets{"baseline"};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    sets.push_back("avx2");
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
      sets.push_back("avx512");
  }
#endif
  return sets;
}

std::string_view instruction_set() {
  static const std::string_view chosen = chosen_set();
  return chosen;
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = make_entries();
  return all;
}

const Entry* find(std::string_view name) {
  const auto& all = entries();
  const auto at = std::find_if(all.begin(), all.end(), [&](const Entry& entry) { return entry.name == name; });
  return at == all.end() ? nullptr : &*at;
}

Loops<float> loops_in(std::string_view set, std::string_view name) {
  for (const Family& family : families()) {
    std::vector<Entry> entries;
    family.append(entries);
    std::vector<Loops<float>> loops(entries.size());
    wide_loops(family, set)(loops.data());
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (entries[i].name == name) return loops[i];
  }
  return {};
}

}  // namespace likeness::catalog
