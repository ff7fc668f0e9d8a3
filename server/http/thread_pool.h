// Threads that wait for clients: cheap, many, started when they are first needed.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace cyanometer {

/// One task, one thread, so that no connection waits behind another that is idle.
class ThreadPool {
 public:
  using Task = std::function<void()>;
  /// @param nice  added to the threads' nice values: how far they stand back where processors
  ///              are short
  ThreadPool(std::size_t most_threads, int nice) : most_threads_(most_threads), nice_(nice) {}
  /// False where all threads are taken.
  bool start(const Task& task);
  /// For the next thread that becomes free.
  void queue(Task task);
  /// Returns when every task has ended.
  void shutdown();

 private:
  bool add_thread();
  void work();

  std::size_t most_threads_;
  int nice_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Task> tasks_;
  std::vector<std::thread> threads_;
  std::size_t idle_ = 0;
  bool stopping_ = false;
};

}  // namespace cyanometer
