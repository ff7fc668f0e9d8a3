// The one way to the device: a thread that owns the engine, and a bounded queue in fair order.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "engine/engine.h"

namespace cyanometer {

/// The queue has no room; the client may come back after so many seconds.
struct QueueFull : std::runtime_error {
  explicit QueueFull(int retry_after_s_);
  int retry_after_s;
};
/// There is no device to work on, and there will be none in this process.
struct DeviceUnavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Job {
  std::string
      client;  ///< whose turn it takes: clients alternate, one client's jobs keep their order
  bool quick = false;           ///< milliseconds of work: goes before all others
  std::size_t frame_bytes = 0;  ///< memory of the result, until the Ticket dies
  Watch watch = {};
  std::function<void(Engine&, const Watch&)> work = {};
};

/// What a job that was done leaves: keep it until the frame is encoded and freed.
struct Ticket {
  double queued_ms = 0;
  std::shared_ptr<void> memory;
};

class RenderQueue {
 public:
  struct Options {
    EngineOptions engine = {};
    std::size_t capacity = 64;                       ///< jobs that wait
    std::size_t frame_bytes = std::size_t{2} << 30;  ///< of all frames alive at once
    std::function<void(const std::string& event)> log = [](const std::string&) {};
  };
  /// Counted since the start.
  struct Counts {
    std::uint64_t done = 0, rejected = 0, client_gone = 0, past_deadline = 0, device_lost = 0;
    std::uint64_t& of(Cancelled::Reason reason) {
      return reason == Cancelled::Reason::deadline ? past_deadline : client_gone;
    }
  };

  /// Starts to make the engine, on the queue's own thread.
  explicit RenderQueue(Options options);
  /// Jobs that still wait are answered with DeviceUnavailable.
  ~RenderQueue();

  /// Waits until the job is done. Before the engine is ready that includes making it.
  /// @throws QueueFull, Cancelled, DeviceUnavailable, and what the work throws
  Ticket run(Job job);

  bool ready() const { return ready_; }
  /// True once the device could not be brought back: the process must end.
  bool failed() const { return failed_; }
  /// The device in use. @pre ready() was true once
  DeviceDescription device() const;

  std::size_t depth() const;
  std::size_t capacity() const { return options_.capacity; }
  Counts counts() const;

 private:
  struct Entry;
  using Clock = std::chrono::steady_clock;

  std::shared_ptr<Entry> enter(Job job);
  void wait(Entry& entry);
  void withdraw(Entry& entry, Cancelled::Reason reason);
  void work();
  bool make_engine(std::string reason);
  std::shared_ptr<Entry> next();
  void perform(Entry& entry);
  void fail(const std::string& reason);
  void finish(Entry& entry, std::exception_ptr error);
  int retry_after_s() const;

  Options options_;
  mutable std::mutex mutex_;
  std::condition_variable work_here_;
  /// In order of turn, then of arrival. A client's n-th waiting job has its turn n rounds from
  /// now (start-time fair queueing with equal weights [Goyal, Vin and Cheng 1996]).
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::shared_ptr<Entry>> waiting_;
  std::map<std::string, std::uint64_t> last_turn_;
  std::uint64_t turn_ = 0, arrivals_ = 0;
  std::size_t frame_bytes_alive_ = 0;
  std::deque<double> recent_ms_;
  Counts counts_;
  bool stopping_ = false;
  std::atomic<bool> ready_{false}, failed_{false};
  std::optional<DeviceDescription> device_;
  std::string failure_;
  int losses_in_a_row_ = 0;
  std::unique_ptr<Engine> engine_;
  std::thread thread_;
};

}  // namespace cyanometer
