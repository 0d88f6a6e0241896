// Turns of two threads (libreeb/port/ring_turns.h).
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>

#include "libreeb/port/ring_turns.h"

namespace reeb::ooc {

// Who waits for a slot is woken when half of them are of use, so that it does not wait again at once.
class ThreadTurns : public RingTurns {
 public:
  bool filled() override {
    std::unique_lock lock(mutex_);
    ++full_;
    if (user_waits_ && full_ >= kSlots / 2) changed_.notify_all();
    if (full_ == kSlots) wait(lock, kSlots / 2);
    return !is_stopped_;
  }
  std::size_t full() override { return full_; }
  bool wait_until_used(std::size_t most) override {
    std::unique_lock lock(mutex_);
    if (full_ > most) wait(lock, most);
    return !is_stopped_;
  }
  void close() override {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    changed_.notify_all();
  }

  bool next() override {
    std::unique_lock lock(mutex_);
    if (full_ == 0) {
      user_waits_ = true;
      changed_.wait(lock, [this] { return full_ >= kSlots / 2 || (filler_waits_ && full_ != 0) || is_closed_; });
      user_waits_ = false;
    }
    return full_ != 0;
  }
  void used() override {
    const std::lock_guard lock(mutex_);
    --full_;
    if (filler_waits_ && full_ <= awaited_) changed_.notify_all();
  }
  void stop() override {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
    changed_.notify_all();
  }

  void lock() override { alone_.lock(); }
  void unlock() override { alone_.unlock(); }

 private:
  void wait(std::unique_lock<std::mutex>& lock, std::size_t most) {
    awaited_ = most;
    filler_waits_ = true;
    if (user_waits_) changed_.notify_all();
    changed_.wait(lock, [this] { return full_ <= awaited_ || is_stopped_; });
    filler_waits_ = false;
  }

  std::mutex mutex_, alone_;
  std::condition_variable changed_;
  std::atomic<std::size_t> full_ = 0;  // slots; is changed under mutex_
  std::size_t awaited_ = 0;            // no more full slots than this, while the filler waits
  bool user_waits_ = false, filler_waits_ = false, is_closed_ = false, is_stopped_ = false;
};

}  // namespace reeb::ooc
