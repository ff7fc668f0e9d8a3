// Tables that methods keep between requests, under all that they depend on, within a bound of
// memory. Tables are made on the device's one thread, so of many requests that want the same
// the first makes it and the others find it.
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>

namespace cyanometer {

/// What is kept: a method's own class behind this.
class Tables {
 public:
  virtual ~Tables() = default;
  /// What they hold of the device's and the host's memory.
  virtual std::size_t bytes() const = 0;
};

class TableCache {
 public:
  explicit TableCache(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// The tables under `key`, made by `make` where there are none. Those used longest ago are
  /// given up when there is too much; ones that are too large by themselves are returned, not
  /// kept. `key` begins with the name of what makes them.
  template <class T>
  std::shared_ptr<const T> get(const std::string& key,
                               const std::function<std::shared_ptr<const T>()>& make) {
    return std::static_pointer_cast<const T>(find_or_make(key, make));
  }

  /// Gives up all of them; who still holds one keeps it.
  void clear();

  std::size_t bytes() const { return bytes_; }
  /// Time spent in making tables so far, ms.
  double making_ms() const { return making_ms_; }
  std::size_t count() const { return entries_.size(); }

 private:
  struct Entry {
    std::string key;
    std::shared_ptr<const Tables> tables;
  };
  using Entries = std::list<Entry>;  // used last first

  std::shared_ptr<const Tables> find_or_make(
      const std::string& key, const std::function<std::shared_ptr<const Tables>()>& make);
  std::shared_ptr<const Tables> timed(
      const std::function<std::shared_ptr<const Tables>()>& make);
  void make_room(std::size_t bytes);

  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  double making_ms_ = 0;
  int making_ = 0;  ///< tables may be made from other tables
  Entries entries_;
  std::unordered_map<std::string, Entries::iterator> places_;
};

/// The tables of one frame, which has them until it gives them up: what the cache is too small
/// to keep is made once, and not for every tile.
class TablesInUse {
 public:
  TablesInUse(TableCache& cache) : cache_(cache) {}

  /// As the cache's. Tables from which others are made are the cache's alone.
  template <class T>
  std::shared_ptr<const T> get(const std::string& key,
                               const std::function<std::shared_ptr<const T>()>& make) {
    if (auto held = held_.find(key); held != held_.end())
      return std::static_pointer_cast<const T>(held->second);
    const bool outermost = !making_;
    auto tables = cache_.get<T>(key, [&] {
      const Making scope(making_);
      return make();
    });
    if (outermost) held_[key] = tables;
    return tables;
  }

  void give_up() { held_.clear(); }

 private:
  struct Making {
    bool &making, before;
    explicit Making(bool& m) : making(m), before(std::exchange(m, true)) {}
    ~Making() { making = before; }
    Making(const Making&) = delete;
  };

  TableCache& cache_;
  bool making_ = false;
  std::unordered_map<std::string, std::shared_ptr<const Tables>> held_;
};

}  // namespace cyanometer
