#include "server/queue/render_queue.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cyanometer {
namespace {

constexpr int most_repairs_in_a_row = 3;
constexpr std::size_t recent_jobs = 64;

double ms_between(std::chrono::steady_clock::time_point from,
                  std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
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

QueueFull::QueueFull(int retry_after_s_)
    : std::runtime_error("the render queue is full"), retry_after_s(retry_after_s_) {}

struct RenderQueue::Entry {
  Job job;
  std::pair<std::uint64_t, std::uint64_t> place;
  Clock::time_point entered = Clock::now();
  Ticket ticket;
  enum class State { waiting, running, done } state = State::waiting;
  std::exception_ptr error;
  std::condition_variable finished;
};

RenderQueue::RenderQueue(Options options)
    : options_(std::move(options)), thread_([this] { work(); }) {}

RenderQueue::~RenderQueue() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_here_.notify_all();
  thread_.join();
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
  const std::lock_guard lock(mutex_);
  if (failed_ || stopping_) throw DeviceUnavailable(failure_);
  if (waiting_.size() >= options_.capacity) {
    ++counts_.rejected;
    throw QueueFull(retry_after_s());
  }
  std::uint64_t turn = turn_;
  if (!entry->job.quick) {
    auto& last = last_turn_[entry->job.client];
    last = turn = std::max(last, turn_) + 1;
  }
  entry->place = {turn, arrivals_++};
  waiting_.emplace(entry->place, entry);
  work_here_.notify_all();
  return entry;
}

void RenderQueue::wait(Entry& entry) {
  const auto& watch = entry.job.watch;
  std::unique_lock lock(mutex_);
  while (entry.state != Entry::State::done) {
    // A running job looks after itself between tiles; a waiting one is looked after from here.
    constexpr auto glance = std::chrono::milliseconds(30);
    entry.finished.wait_for(lock, glance);
    if (entry.state != Entry::State::waiting) continue;
    if (Clock::now() >= watch.deadline) {
      withdraw(entry, Cancelled::Reason::deadline);
    } else if (watch.gone()) {
      withdraw(entry, Cancelled::Reason::client_gone);
    }
  }
}

void RenderQueue::withdraw(Entry& entry, Cancelled::Reason reason) {
  waiting_.erase(entry.place);
  ++counts_.of(reason);
  entry.error = std::make_exception_ptr(Cancelled(reason));
  entry.state = Entry::State::done;
  work_here_.notify_all();
}

void RenderQueue::work() {
  if (!make_engine("")) return;
  while (const auto entry = next()) {
    perform(*entry);
    if (failed_) return;
  }
  fail("the server stops");
}

bool RenderQueue::make_engine(std::string reason) {
  while (losses_in_a_row_ <= most_repairs_in_a_row) {
    try {
      engine_.reset();
      engine_ = std::make_unique<Engine>(options_.engine);
      engine_->warm();
      const std::lock_guard lock(mutex_);
      device_ = engine_->device();
      ready_ = true;
      return true;
    } catch (const DeviceLost& lost) {
      ++losses_in_a_row_;
      reason = lost.what();
    } catch (const std::exception& error) {
      reason = error.what();
      break;
    }
  }
  fail(reason);
  return false;
}

std::shared_ptr<RenderQueue::Entry> RenderQueue::next() {
  std::unique_lock lock(mutex_);
  const auto fits = [&](const Entry& entry) {
    return frame_bytes_alive_ == 0 ||
           frame_bytes_alive_ + entry.job.frame_bytes <= options_.frame_bytes;
  };
  work_here_.wait(lock, [&] {
    return stopping_ || (!waiting_.empty() && fits(*waiting_.begin()->second));
  });
  if (stopping_) return nullptr;
  const auto entry = waiting_.begin()->second;
  waiting_.erase(waiting_.begin());
  turn_ = std::max(turn_, entry->place.first);
  if (waiting_.empty()) last_turn_.clear();
  entry->state = Entry::State::running;
  entry->ticket.queued_ms = ms_between(entry->entered, Clock::now());
  const auto bytes = entry->job.frame_bytes;
  frame_bytes_alive_ += bytes;
  entry->ticket.memory = std::shared_ptr<void>(nullptr, [this, bytes](void*) {
    const std::lock_guard guard(mutex_);
    frame_bytes_alive_ -= bytes;
    work_here_.notify_all();
  });
  return entry;
}

void RenderQueue::perform(Entry& entry) {
  bool retried = false;
  for (;;) {
    try {
      entry.job.watch.check();
      const auto start = Clock::now();
      entry.job.work(*engine_, entry.job.watch);
      if (!entry.job.quick) {
        const std::lock_guard lock(mutex_);
        recent_ms_.push_back(ms_between(start, Clock::now()));
        if (recent_ms_.size() > recent_jobs) recent_ms_.pop_front();
      }
      losses_in_a_row_ = 0;
      return finish(entry, nullptr);
    } catch (const DeviceLost& lost) {
      ready_ = false;
      {
        const std::lock_guard lock(mutex_);
        ++counts_.device_lost;
      }
      ++losses_in_a_row_;
      options_.log(std::string("device lost: ") + lost.what());
      const bool again = make_engine(lost.what());
      if (!again || retried) {
        return finish(entry, std::make_exception_ptr(DeviceUnavailable(lost.what())));
      }
      retried = true;
    } catch (...) {
      return finish(entry, std::current_exception());
    }
  }
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
}

int RenderQueue::retry_after_s() const {
  std::vector<double> times(recent_ms_.begin(), recent_ms_.end());
  if (times.empty()) return 1;
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::ranges::nth_element(times, middle);
  const double seconds = *middle * static_cast<double>(waiting_.size() + 1) / 1000;
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

RenderQueue::Counts RenderQueue::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace cyanometer
