#include "server/http/thread_pool.h"

#include <sys/resource.h>
#include <unistd.h>

#include <utility>

namespace cyanometer {
namespace {

/// Linux keeps a nice value for each thread.
void stand_back(int nice) {
  const auto thread = static_cast<id_t>(::gettid());
  ::setpriority(PRIO_PROCESS, thread, ::getpriority(PRIO_PROCESS, thread) + nice);
}

}  // namespace

bool ThreadPool::start(const Task& task) {
  const std::lock_guard lock(mutex_);
  if (tasks_.size() >= idle_ && !add_thread()) return false;
  tasks_.push_back(task);
  wake_.notify_one();
  return true;
}

void ThreadPool::queue(Task task) {
  const std::lock_guard lock(mutex_);
  tasks_.push_back(std::move(task));
  wake_.notify_one();
}

bool ThreadPool::add_thread() {
  if (threads_.size() >= most_threads_) return false;
  try {
    threads_.emplace_back([this] { work(); });
    return true;
  } catch (const std::system_error&) {
    return false;  // the system has no further thread for this process
  }
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
