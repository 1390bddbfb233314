#include "olat/view/cache.h"

namespace likeness::olat_view {

Cache::Entry Cache::find(const std::string& key, const std::function<HalfPicture()>& make) {
  std::unique_lock lock(mutex_);
  if (const auto at = places_.find(key); at != places_.end()) {
    recent_.splice(recent_.begin(), recent_, at->second);
    return at->second->second;
  }
  if (const auto at = making_.find(key); at != making_.end()) {
    const std::shared_ptr<Making> making = at->second;
    changed_.wait(lock, [&] { return making->done; });
    if (making->error) std::rethrow_exception(making->error);
    return making->entry;
  }
  const auto making = std::make_shared<Making>();
  making_[key] = making;
  changed_.wait(lock, [&] { return makers_ < kMakers; });
  ++makers_;
  lock.unlock();
  try {
    making->entry = std::make_shared<const HalfPicture>(make());
  } catch (...) {
    making->error = std::current_exception();
  }
  lock.lock();
  making->done = true;
  --makers_;
  making_.erase(key);
  if (making->entry) keep(key, making->entry);
  changed_.notify_all();
  if (making->error) std::rethrow_exception(making->error);
  return making->entry;
}

Cache::Entry Cache::kept(const std::string& key) {
  const std::lock_guard lock(mutex_);
  const auto at = places_.find(key);
  if (at == places_.end()) return nullptr;
  recent_.splice(recent_.begin(), recent_, at->second);
  return at->second->second;
}

void Cache::keep(const std::string& key, const Entry& entry) {
  if (entry->bytes() > most_bytes_) return;  // larger than all: handed out, not kept
  recent_.emplace_front(key, entry);
  places_[key] = recent_.begin();
  bytes_ += entry->bytes();
  while (bytes_ > most_bytes_) {
    bytes_ -= recent_.back().second->bytes();
    places_.erase(recent_.back().first);
    recent_.pop_back();
  }
}

std::size_t Cache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace likeness::olat_view
