#pragma once

#include <array>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "olat/metric/metric.h"

namespace likeness::olat_compare {

// What is known of a pair beside its metrics.
struct PairFacts {
  std::array<double, 3> gain_ev{};
  double weight = 0;
  std::size_t clipped = 0;
};

// Results that an earlier run found, by a key that stands for everything they depend on. A text file to which lines are
// added, one a result: a run that is ended loses at most the line that it was writing. Lines that are not whole are left
// out; so is a file of another version, or of more than 256 MB. May be used from several threads.
class Cache {
 public:
  explicit Cache(const std::string& file);  // empty: remembers nothing

  std::optional<metric::Summary> find(const std::string& key, metric::Metric metric) const;
  std::optional<PairFacts> find(const std::string& key) const;
  void add(const std::string& key, metric::Metric metric, const metric::Summary& summary);
  void add(const std::string& key, const PairFacts& facts);

 private:
  void append(const std::string& name, const std::string& values);
  std::string file_;
  std::map<std::string, std::string> lines_;  // "key metric" to the numbers
  mutable std::mutex mutex_;
};

}  // namespace likeness::olat_compare
