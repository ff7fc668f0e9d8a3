#include "engine/methods/table_cache.h"

#include <chrono>

namespace cyanometer {

std::shared_ptr<const Tables> TableCache::find_or_make(
    const std::string& key, const std::function<std::shared_ptr<const Tables>()>& make) {
  if (auto place = places_.find(key); place != places_.end()) {
    entries_.splice(entries_.begin(), entries_, place->second);
    return place->second->tables;
  }
  std::shared_ptr<const Tables> tables = timed(make);
  // While they were made, a more urgent frame may have made the same.
  if (auto place = places_.find(key); place != places_.end()) return place->second->tables;
  std::size_t bytes = tables->bytes() + key.size();
  if (bytes > most_bytes_) return tables;
  make_room(bytes);
  entries_.push_front({key, tables});
  places_[key] = entries_.begin();
  bytes_ += bytes;
  return tables;
}

std::shared_ptr<const Tables> TableCache::timed(
    const std::function<std::shared_ptr<const Tables>()>& make) {
  struct Stopwatch {
    TableCache& cache;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    explicit Stopwatch(TableCache& c) : cache(c) { ++cache.making_; }
    ~Stopwatch() {
      if (--cache.making_ > 0) return;
      cache.making_ms_ +=
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
              .count();
    }
  } stopwatch(*this);
  return make();
}

void TableCache::clear() {
  entries_.clear();
  places_.clear();
  bytes_ = 0;
}

void TableCache::make_room(std::size_t bytes) {
  while (!entries_.empty() && bytes_ + bytes > most_bytes_) {
    const Entry& oldest = entries_.back();
    bytes_ -= oldest.tables->bytes() + oldest.key.size();
    places_.erase(oldest.key);
    entries_.pop_back();
  }
}

}  // namespace cyanometer
