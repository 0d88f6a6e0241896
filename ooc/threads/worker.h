// A thread that runs one task after the other, in parallel to its owner.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace reeb::ooc {

// The thread starts with the first task and is kept. Threads that are started for a few milliseconds each tend to run
// one after the other on the core of the thread that starts them, while another core is idle.
//
// THREADS: one owner.
class Worker {
 public:
  Worker() = default;
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  // Waits for the current task; an exception from it is lost.
  ~Worker() {
    if (!thread_.joinable()) return;
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  // Waits for the previous task, then starts this one. THROWS: as wait(), or that no thread can be started; then this
  // one is not started.
  void start(std::function<void()> task) {
    wait();
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    {
      const std::lock_guard lock(mutex_);
      task_ = std::move(task);
      busy_ = true;
    }
    changed_.notify_all();
  }

  // Returns once there is no task. THROWS: what the last task threw, once.
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !busy_; });
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }
  // The same, but calls poll() every few hundredths of a second. THROWS: what poll throws, too; the task goes on.
  template <class Poll>
  void wait(const Poll& poll) {
    constexpr auto kBetweenPolls = std::chrono::milliseconds(20);
    for (std::unique_lock lock(mutex_); !changed_.wait_for(lock, kBetweenPolls, [&] { return !busy_; });) {
      lock.unlock();
      poll();
      lock.lock();
    }
    wait();
  }

  // Runs the second function in the thread while it calls the first. THROWS: what they throw, when both have ended; if
  // both throw, what the second does.
  void do_both(const std::function<void()>& here, const std::function<void()>& elsewhere) {
    std::exception_ptr failure;
    start(elsewhere);
    try {
      here();
    } catch (...) {
      failure = std::current_exception();
    }
    wait();
    if (failure) std::rethrow_exception(failure);
  }

 private:
  void run() {
    for (std::unique_lock lock(mutex_);;) {
      changed_.wait(lock, [&] { return busy_ || ends_; });
      if (!busy_) return;
      lock.unlock();
      std::exception_ptr failure;
      try {
        task_();
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      failure_ = failure;
      busy_ = false;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> task_;
  std::exception_ptr failure_;
  bool busy_ = false, ends_ = false;
  std::thread thread_;
};

}  // namespace reeb::ooc
