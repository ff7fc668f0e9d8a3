#include "server/http/thread_pool.h"

#include <sys/resource.h>
#include <unistd.h>

#include <utility>

namespace cyanometer {
namespace {

thread_local bool overloaded_here = false;

/// Linux keeps a nice value for each thread.
void stand_back(int nice) {
  const auto thread = static_cast<id_t>(::gettid());
  ::setpriority(PRIO_PROCESS, thread, ::getpriority(PRIO_PROCESS, thread) + nice);
}

}  // namespace

bool ThreadPool::overloaded() { return overloaded_here; }

void ThreadPool::enqueue(std::function<void()> task) {
  std::unique_lock lock(mutex_);
  if (tasks_.size() < idle_) {
    tasks_.push_back(std::move(task));
    wake_.notify_one();
    return;
  }
  if (threads_.size() < most_threads_) {
    try {
      threads_.emplace_back([this] { work(); });
      tasks_.push_back(std::move(task));
      return;
    } catch (const std::system_error&) {
      // The system has no further thread for this process: as where there are enough.
    }
  }
  lock.unlock();
  overloaded_here = true;
  task();
  overloaded_here = false;
}

void ThreadPool::shutdown() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  for (auto& thread : threads_) thread.join();
  threads_.clear();
}

void ThreadPool::work() {
  if (nice_ != 0) stand_back(nice_);
  std::unique_lock lock(mutex_);
  for (;;) {
    ++idle_;
    wake_.wait(lock, [&] { return stopping_ || !tasks_.empty(); });
    --idle_;
    if (tasks_.empty()) return;
    const auto task = std::exchange(tasks_.front(), nullptr);
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
}

}  // namespace cyanometer
