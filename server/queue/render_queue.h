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
  enum class Whose { all, client } whose;  ///< whose share is used up
  int retry_after_s;
  QueueFull(Whose whose_, int retry_after_s_);
};
/// There is no device to work on, and there will be none in this process.
struct DeviceUnavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// In order of turn, then of arrival.
using Place = std::pair<std::uint64_t, std::uint64_t>;

struct Job {
  std::string
      client;  ///< whose turn it takes: clients alternate, one client's jobs keep their order
  double expected_ms = 0;  ///< on the device, 0: unknown; much shorter jobs are done in between
  std::optional<Place> place = {};  ///< of a job that this one goes on from: is not refused
  std::size_t frame_bytes = 0;      ///< memory of the result, until the Ticket dies
  Watch watch = {};
  std::function<void(Engine&, const Watch&)> work = {};
};

/// What a job that was done leaves: keep it until the frame is encoded and freed.
struct Ticket {
  double queued_ms = 0;      ///< from entering to starting
  double given_away_ms = 0;  ///< since then, to shorter jobs
  Place place = {};
  std::shared_ptr<void> memory;
};

class RenderQueue {
 public:
  struct Options {
    EngineOptions engine = {};
    std::size_t capacity = 64;                       ///< jobs that wait
    std::size_t frame_bytes = std::size_t{2} << 30;  ///< of all frames alive at once
    std::function<void(const std::string& event)> log = [](const std::string&) {};
    bool warm = true;          ///< tests start sooner without
    EngineFaults faults = {};  ///< for tests: of the first device, once it is warm
  };
  /// Counted since the start.
  struct Counts {
    std::uint64_t done = 0, client_gone = 0, past_deadline = 0, device_lost = 0,
                  out_of_memory = 0, gave_way = 0;
    std::uint64_t& of(Cancelled::Reason reason) {
      return reason == Cancelled::Reason::deadline ? past_deadline : client_gone;
    }
  };
  struct DeviceUse {
    std::size_t bytes = 0;        ///< of its memory, now: frames that are being encoded too
    std::size_t table_bytes = 0;  ///< of those, in tables, as of the end of the last job
    KernelUse kernels;
  };

  /// Starts to make the engine, on the queue's own thread.
  explicit RenderQueue(Options options);
  /// Jobs that still wait are answered with DeviceUnavailable.
  ~RenderQueue();

  /// Waits until the job is done. Before the engine is ready that includes making it.
  /// @throws QueueFull, Cancelled, DeviceUnavailable, and what the work throws
  Ticket run(Job job);

  /// Whether a job of the client would be refused now.
  bool full_for(const std::string& client) const;
  /// @throws QueueFull as run would
  void require_place(const std::string& client);

  /// Counts so many bytes among those of the frames alive, until the handle dies.
  std::shared_ptr<void> hold(std::size_t bytes);

  bool ready() const { return ready_; }
  /// True once the device could not be brought back: the process must end.
  bool failed() const { return failed_; }
  /// The device in use. @pre ready() was true once
  DeviceDescription device() const;

  std::size_t depth() const;
  /// Whether a job is on the device, or holds it while its client has left.
  bool busy() const { return jobs_open_ > 0; }
  std::size_t capacity() const { return options_.capacity; }
  /// Of the places, those that one client may hold, so that some are left for the others.
  std::size_t share() const { return options_.capacity - options_.capacity / 4; }
  Counts counts() const;
  DeviceUse device_use() const;

 private:
  struct Entry;
  using Clock = std::chrono::steady_clock;
  using Waiting = std::map<Place, std::shared_ptr<Entry>>;
  std::shared_ptr<Entry> enter(Job job);
  std::optional<QueueFull::Whose> full(const std::string& client) const;
  void admit(const std::string& client);
  void wait(Entry& entry);
  void look_after_waiting();
  void withdraw(Entry& entry, Cancelled::Reason reason);
  void work();
  bool make_engine(std::string reason);
  void set_engine(std::unique_ptr<Engine> engine);
  /// Gives way to all that is known to take less, and ends when the queue does.
  void warm_up();
  std::shared_ptr<Entry> next();
  std::shared_ptr<Entry> much_shorter_than(const Entry& running);
  bool fits(const Entry& entry) const;
  Waiting::iterator next_that_fits();
  std::shared_ptr<void> count_alive(std::size_t bytes);
  void put(const std::shared_ptr<Entry>& entry);
  void remove(const Entry& entry);
  void forget_turns();
  void start(Entry& entry);
  void perform(const std::shared_ptr<Entry>& entry);
  void attempt(Entry& entry);
  void give_way(Entry& running);
  void replace_device(const std::string& reason);
  void count_loss(const std::string& reason);
  void fail(const std::string& reason);
  void finish(Entry& entry, std::exception_ptr error);
  int retry_after_s() const;

  Options options_;
  mutable std::mutex mutex_;
  std::condition_variable work_here_, someone_waits_;
  /// A client's n-th waiting job has its turn n rounds from now (start-time fair queueing with
  /// equal weights [Goyal, Vin and Cheng 1996]).
  Waiting waiting_;
  std::map<std::string, std::uint64_t> last_turn_;
  std::map<std::string, std::size_t> waiting_of_;  ///< jobs by client
  std::uint64_t turn_ = 0, arrivals_ = 0;
  std::size_t frame_bytes_alive_ = 0;
  std::deque<double> recent_ms_;
  double usual_ms_ = 0;  ///< their median
  Counts counts_;
  std::size_t table_bytes_ = 0;
  bool stopping_ = false;
  std::atomic<bool> ready_{false}, failed_{false};
  std::optional<DeviceDescription> device_;
  std::string failure_;
  int losses_in_a_row_ = 0;
  std::atomic<int> jobs_open_ = 0;  ///< on the device's thread, one within the other
  std::unique_ptr<Engine> engine_;  ///< the device's thread's; changes under the mutex
  std::thread thread_, caretaker_;
};

}  // namespace cyanometer
