#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

#include "olat/view/half_picture.h"

namespace likeness::olat_view {

// Pictures that were made, up to a number of bytes: the one that nobody asked for the longest goes first. A picture that
// two threads ask for at once is made once. At most kMakers are made at the same time, so that what is not counted yet is
// bounded too.
class Cache {
 public:
  using Entry = std::shared_ptr<const HalfPicture>;
  static constexpr int kMakers = 3;  // a pair, and one that is made ahead of time

  explicit Cache(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  // Throws what `make` throws, to all that wait for it; the next one who asks tries again. `make` must not ask the cache.
  Entry find(const std::string& key, const std::function<HalfPicture()>& make);
  // What is kept of it, or null.
  Entry kept(const std::string& key);

  std::size_t bytes() const;
  std::size_t most_bytes() const { return most_bytes_; }

 private:
  struct Making {
    bool done = false;
    Entry entry;
    std::exception_ptr error;
  };
  void keep(const std::string& key, const Entry& entry);  // under the lock

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t bytes_ = 0;
  int makers_ = 0;
  std::list<std::pair<std::string, Entry>> recent_;  // the last used first
  std::unordered_map<std::string, std::list<std::pair<std::string, Entry>>::iterator> places_;
  std::unordered_map<std::string, std::shared_ptr<Making>> making_;
};

}  // namespace likeness::olat_view
