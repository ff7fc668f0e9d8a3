// Equal work that is asked for by several at once is done once: by the first, for all of them.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/queue/render_queue.h"

namespace cyanometer {

template <class Value>
class SingleFlight {
 public:
  struct Landed {
    std::shared_ptr<const Value> value;
    bool joined = false;  ///< another one did the work
  };

  /// What `make` returns, or throws, for the key. It is given a watch that is gone when all who
  /// wait are; who leaves earlier frees nobody else's work. The deadline and the share of the
  /// queue are the first one's: others, who may have more of them, begin again.
  /// @throws Cancelled by `watch`, and what `make` throws
  Landed get(const std::string& key, const Watch& watch,
             const std::function<Value(const Watch&)>& make) {
    for (;;) {
      const auto [flight, first] = board(key, watch);
      if (first) return {fly(key, *flight, watch, make), false};
      if (auto value = wait(*flight, watch)) return {value, true};
    }
  }

 private:
  struct Flight {
    std::mutex mutex;
    std::condition_variable landed;
    std::vector<const Watch*> passengers;
    bool done = false;
    std::shared_ptr<const Value> value;
    std::exception_ptr error;

    bool deserted() {
      const std::lock_guard lock(mutex);
      for (const Watch* each : passengers) {
        if (!each->gone()) return false;
      }
      return true;
    }
  };

  std::pair<std::shared_ptr<Flight>, bool> board(const std::string& key, const Watch& watch) {
    const std::lock_guard lock(mutex_);
    auto& flight = flights_[key];
    const bool first = !flight;
    if (first) flight = std::make_shared<Flight>();
    const std::lock_guard inner(flight->mutex);
    flight->passengers.push_back(&watch);
    return {flight, first};
  }

  std::shared_ptr<const Value> fly(const std::string& key, Flight& flight, const Watch& watch,
                                   const std::function<Value(const Watch&)>& make) {
    Watch shared = watch;
    shared.gone = [&flight] { return flight.deserted(); };
    std::shared_ptr<const Value> value;
    std::exception_ptr error;
    try {
      value = std::make_shared<const Value>(make(shared));
    } catch (...) {
      error = std::current_exception();
    }
    {
      const std::lock_guard lock(mutex_);
      flights_.erase(key);
    }
    {
      const std::lock_guard lock(flight.mutex);
      flight.done = true;
      flight.value = value;
      flight.error = error;
    }
    flight.landed.notify_all();
    if (error) std::rethrow_exception(error);
    return value;
  }

  /// Null where it ended for the sake of the first one alone.
  std::shared_ptr<const Value> wait(Flight& flight, const Watch& watch) {
    constexpr auto glance = std::chrono::milliseconds(30);
    std::unique_lock lock(flight.mutex);
    while (!flight.done) {
      flight.landed.wait_for(lock, glance);
      if (flight.done) break;
      try {
        watch.check();
      } catch (const Cancelled&) {
        std::erase(flight.passengers, &watch);
        throw;
      }
    }
    if (!flight.error) return flight.value;
    try {
      std::rethrow_exception(flight.error);
    } catch (const Cancelled&) {
      watch.check();
    } catch (const QueueFull&) {
      watch.check();
    }
    return nullptr;
  }

  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Flight>> flights_;
};

}  // namespace cyanometer
