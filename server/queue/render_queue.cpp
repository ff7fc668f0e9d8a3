#include "server/queue/render_queue.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/attention.h"

namespace cyanometer {
namespace {

constexpr int most_repairs_in_a_row = 3;
constexpr std::size_t recent_jobs = 64;
/// A running job gives way to those that take so much less than itself; with jobs within jobs
/// each a share of the one around it, few are ever open at once.
constexpr double shorter_by = 8;

double ms_between(std::chrono::steady_clock::time_point from,
                  std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

std::optional<Cancelled::Reason> cancelled_by(const std::exception_ptr& error) {
  if (!error) return std::nullopt;
  try {
    std::rethrow_exception(error);
  } catch (const Cancelled& cancelled) {
    return cancelled.reason;
  } catch (...) {
    return std::nullopt;
  }
}

}  // namespace

QueueFull::QueueFull(Whose whose_, int retry_after_s_)
    : std::runtime_error(whose_ == Whose::all ? "the render queue is full"
                                              : "the client's share of the queue is full"),
      whose(whose_),
      retry_after_s(retry_after_s_) {}

struct RenderQueue::Entry {
  Job job;
  Place place;
  Clock::time_point entered = Clock::now();
  Clock::time_point gives_way_after = {};
  Ticket ticket;
  enum class State { waiting, running, done } state = State::waiting;
  bool lost_device = false;
  std::exception_ptr error;
  std::condition_variable finished;

  /// Of the device, ms; infinite where nobody reckoned it.
  double cost() const {
    return job.expected_ms > 0 ? job.expected_ms : std::numeric_limits<double>::infinity();
  }
};

RenderQueue::RenderQueue(Options options)
    : options_(std::move(options)),
      thread_([this] { work(); }),
      caretaker_([this] { look_after_waiting(); }) {}

RenderQueue::~RenderQueue() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_here_.notify_all();
  someone_waits_.notify_all();
  thread_.join();
  caretaker_.join();
}

Ticket RenderQueue::run(Job job) {
  const auto entry = enter(std::move(job));
  wait(*entry);
  if (entry->error) std::rethrow_exception(entry->error);
  return std::move(entry->ticket);
}

std::shared_ptr<RenderQueue::Entry> RenderQueue::enter(Job job) {
  const auto entry = std::make_shared<Entry>();
  entry->job = std::move(job);
  const std::string& client = entry->job.client;
  const std::lock_guard lock(mutex_);
  if (failed_ || stopping_) throw DeviceUnavailable(failure_);
  if (entry->job.place) {
    entry->place = *entry->job.place;
  } else {
    admit(client);
    auto& last = last_turn_[client];
    last = std::max(last, turn_) + 1;
    entry->place = {last, arrivals_++};
  }
  put(entry);
  return entry;
}

std::optional<QueueFull::Whose> RenderQueue::full(const std::string& client) const {
  if (waiting_.size() >= options_.capacity) return QueueFull::Whose::all;
  const auto held = waiting_of_.find(client);
  const bool greedy = held != waiting_of_.end() && held->second >= share();
  return greedy ? std::optional(QueueFull::Whose::client) : std::nullopt;
}

void RenderQueue::admit(const std::string& client) {
  if (const auto whose = full(client)) throw QueueFull(*whose, retry_after_s());
}

bool RenderQueue::full_for(const std::string& client) const {
  const std::lock_guard lock(mutex_);
  return full(client).has_value();
}

void RenderQueue::require_place(const std::string& client) {
  const std::lock_guard lock(mutex_);
  admit(client);
}

void RenderQueue::put(const std::shared_ptr<Entry>& entry) {
  entry->state = Entry::State::waiting;
  waiting_.emplace(entry->place, entry);
  ++waiting_of_[entry->job.client];
  work_here_.notify_all();
  if (waiting_.size() == 1) someone_waits_.notify_one();
}

void RenderQueue::remove(const Entry& entry) {
  waiting_.erase(entry.place);
  const auto held = waiting_of_.find(entry.job.client);
  if (--held->second == 0) waiting_of_.erase(held);
}

void RenderQueue::wait(Entry& entry) {
  std::unique_lock lock(mutex_);
  entry.finished.wait(lock, [&] { return entry.state == Entry::State::done; });
}

/// A running job looks after itself between tiles; those that wait are looked after from here,
/// all by one thread: where the device is the processor itself, each that woke up to look for
/// itself would keep the device waiting.
void RenderQueue::look_after_waiting() {
  constexpr auto glance = std::chrono::milliseconds(50);
  std::unique_lock lock(mutex_);
  for (;;) {
    someone_waits_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
    someone_waits_.wait_for(lock, glance, [&] { return stopping_; });
    if (stopping_) return;
    for (auto next = waiting_.begin(); next != waiting_.end();) {
      const auto entry = (next++)->second;
      const Watch& watch = entry->job.watch;
      if (Clock::now() >= watch.deadline) {
        withdraw(*entry, Cancelled::Reason::deadline);
      } else if (watch.gone()) {
        withdraw(*entry, Cancelled::Reason::client_gone);
      }
    }
  }
}

void RenderQueue::withdraw(Entry& entry, Cancelled::Reason reason) {
  remove(entry);
  ++counts_.of(reason);
  entry.error = std::make_exception_ptr(Cancelled(reason));
  entry.state = Entry::State::done;
  entry.finished.notify_all();
  work_here_.notify_all();
}

void RenderQueue::work() {
  if (!make_engine("")) return;
  while (const auto entry = next()) {
    perform(entry);
    if (failed_) return;
  }
  fail("the server stops");
}

bool RenderQueue::make_engine(std::string reason) {
  while (losses_in_a_row_ <= most_repairs_in_a_row) {
    try {
      set_engine(nullptr);  // before the next one: there may be no room for two
      set_engine(std::make_unique<Engine>(options_.engine));
      if (options_.warm) warm_up();
      engine_->inject(std::exchange(options_.faults, {}));
      ready_ = true;
      return true;
    } catch (const DeviceLost& lost) {
      reason = lost.what();
      count_loss(reason);
    } catch (const std::exception& error) {
      reason = error.what();
      break;
    }
  }
  fail(reason);
  return false;
}

void RenderQueue::warm_up() {
  Entry unreckoned;
  Watch watch;
  watch.gone = [&] {
    give_way(unreckoned);
    const std::lock_guard lock(mutex_);
    return stopping_;
  };
  const Attention attention(watch);
  ++jobs_open_;
  try {
    engine_->warm(watch);
  } catch (const Cancelled&) {
    // Who still waits is served, and compiles what that needs.
  } catch (...) {
    --jobs_open_;
    throw;
  }
  --jobs_open_;
}

void RenderQueue::set_engine(std::unique_ptr<Engine> engine) {
  const std::lock_guard lock(mutex_);
  engine_.swap(engine);
  if (engine_) device_ = engine_->device();
  table_bytes_ = 0;
}

bool RenderQueue::fits(const Entry& entry) const {
  return entry.job.frame_bytes == 0 || frame_bytes_alive_ == 0 ||
         frame_bytes_alive_ + entry.job.frame_bytes <= options_.frame_bytes;
}

/// The next in turn; while that waits for memory, what needs none. Nothing that needs some: a
/// large frame would never see enough of it free.
RenderQueue::Waiting::iterator RenderQueue::next_that_fits() {
  const auto first = waiting_.begin();
  if (first == waiting_.end() || fits(*first->second)) return first;
  return std::ranges::find_if(
      waiting_, [](const auto& each) { return each.second->job.frame_bytes == 0; });
}

std::shared_ptr<RenderQueue::Entry> RenderQueue::next() {
  std::unique_lock lock(mutex_);
  work_here_.wait(lock, [&] { return stopping_ || next_that_fits() != waiting_.end(); });
  if (stopping_) return nullptr;
  const auto entry = next_that_fits()->second;
  turn_ = std::max(turn_, entry->place.first);
  start(*entry);
  forget_turns();
  return entry;
}

/// Those that are past say nothing any more; under load the queue may never be empty.
void RenderQueue::forget_turns() {
  if (waiting_.empty()) last_turn_.clear();
  if (last_turn_.size() <= 2 * options_.capacity) return;
  std::erase_if(last_turn_, [&](const auto& each) { return each.second <= turn_; });
}

std::shared_ptr<RenderQueue::Entry> RenderQueue::much_shorter_than(const Entry& running) {
  const std::lock_guard lock(mutex_);
  for (const auto& [place, waiting] : waiting_) {
    const auto entry = waiting;
    const double cost = entry->cost();
    if (std::isfinite(cost) && cost * shorter_by <= running.cost() && fits(*entry)) {
      start(*entry);
      ++counts_.gave_way;
      return entry;
    }
  }
  return nullptr;
}

void RenderQueue::start(Entry& entry) {
  remove(entry);
  entry.state = Entry::State::running;
  entry.ticket.place = entry.place;
  entry.ticket.queued_ms = ms_between(entry.entered, Clock::now());
  entry.ticket.memory = count_alive(entry.job.frame_bytes);
}

std::shared_ptr<void> RenderQueue::count_alive(std::size_t bytes) {
  frame_bytes_alive_ += bytes;
  return {nullptr, [this, bytes](void*) {
            const std::lock_guard guard(mutex_);
            frame_bytes_alive_ -= bytes;
            work_here_.notify_all();
          }};
}

std::shared_ptr<void> RenderQueue::hold(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  return count_alive(bytes);
}

void RenderQueue::give_way(Entry& running) {
  const auto start = Clock::now();
  if (start < running.gives_way_after) return;
  const auto shorter = much_shorter_than(running);
  if (!shorter) return;
  perform(shorter);
  const auto end = Clock::now();
  running.ticket.given_away_ms += ms_between(start, end);
  // Short jobs without end take half of the device from a long one, not all of it.
  running.gives_way_after = end + (end - start);
}

void RenderQueue::perform(const std::shared_ptr<Entry>& entry) {
  ++jobs_open_;
  std::exception_ptr error;
  std::optional<std::string> lost;
  try {
    attempt(*entry);
    losses_in_a_row_ = 0;
  } catch (const DeviceLost& loss) {
    lost = loss.what();
  } catch (...) {
    error = std::current_exception();
  }
  --jobs_open_;
  if (!lost) return finish(*entry, error);
  const bool again = !std::exchange(entry->lost_device, true);
  entry->ticket = {};
  if (again) {
    const std::lock_guard lock(mutex_);
    put(entry);
  }
  const auto give_up = [&] {
    if (!again) finish(*entry, std::make_exception_ptr(DeviceUnavailable(*lost)));
  };
  if (jobs_open_ > 0) {
    // The job around this one still holds parts of the engine, and has lost its device too.
    give_up();
    throw DeviceLost(*lost);
  }
  replace_device(*lost);
  give_up();
}

void RenderQueue::attempt(Entry& entry) {
  entry.job.watch.check();
  Watch watch = entry.job.watch;
  watch.gone = [this, &entry] {
    give_way(entry);
    return entry.job.watch.gone();
  };
  const Attention attention(watch);
  const auto start = Clock::now();
  try {
    entry.job.work(*engine_, watch);
  } catch (const OutOfDeviceMemory& none) {
    {
      const std::lock_guard lock(mutex_);
      ++counts_.out_of_memory;
    }
    options_.log(std::string("out of device memory, tables are given up: ") + none.what());
    engine_->forget_tables();
    entry.job.work(*engine_, watch);
  }
  const std::lock_guard lock(mutex_);
  table_bytes_ = engine_->tables().bytes;
  recent_ms_.push_back(ms_between(start, Clock::now()) - entry.ticket.given_away_ms);
  if (recent_ms_.size() > recent_jobs) recent_ms_.pop_front();
  usual_ms_ = median({recent_ms_.begin(), recent_ms_.end()});
}

void RenderQueue::replace_device(const std::string& reason) {
  ready_ = false;
  count_loss(reason);
  make_engine(reason);
}

void RenderQueue::count_loss(const std::string& reason) {
  {
    const std::lock_guard lock(mutex_);
    ++counts_.device_lost;
  }
  ++losses_in_a_row_;
  options_.log("device lost: " + reason);
}

void RenderQueue::finish(Entry& entry, std::exception_ptr error) {
  const auto cancelled = cancelled_by(error);
  const std::lock_guard lock(mutex_);
  if (!error) ++counts_.done;
  if (cancelled) ++counts_.of(*cancelled);
  entry.error = error;
  entry.state = Entry::State::done;
  entry.finished.notify_all();
}

void RenderQueue::fail(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  ready_ = false;
  failure_ = reason;
  if (!stopping_) {
    failed_ = true;
    options_.log("no device to work on: " + reason);
  }
  stopping_ = true;
  for (auto& [place, entry] : waiting_) {
    entry->error = std::make_exception_ptr(DeviceUnavailable(reason));
    entry->state = Entry::State::done;
    entry->finished.notify_all();
  }
  waiting_.clear();
  waiting_of_.clear();
}

int RenderQueue::retry_after_s() const {
  const double seconds = usual_ms_ * static_cast<double>(waiting_.size() + 1) / 1000;
  return static_cast<int>(std::clamp(std::ceil(seconds), 1.0, 3600.0));
}

DeviceDescription RenderQueue::device() const {
  const std::lock_guard lock(mutex_);
  return device_.value_or(DeviceDescription{});
}

std::size_t RenderQueue::depth() const {
  const std::lock_guard lock(mutex_);
  return waiting_.size();
}

RenderQueue::DeviceUse RenderQueue::device_use() const {
  const std::lock_guard lock(mutex_);
  if (!engine_) return {};
  return {engine_->device_bytes(), table_bytes_, engine_->kernels()};
}

RenderQueue::Counts RenderQueue::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace cyanometer
