// Work that can be interrupted by Ctrl-C, and whose progress Python sees.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>

#include "tools/library/compute.h"

namespace reeb::python {

// Python's signals are handled by the thread that called it, and callbacks of a run come from any thread. So the work
// is done in a thread of its own, and the calling thread waits: it looks for signals and calls `progress`, several
// times a second.
class WatchedRun {
 public:
  // `progress`: None, or called as progress(phase, done, total, triangles).
  explicit WatchedRun(pybind11::object progress) : callback_(std::move(progress)) {}

  // Does the work without the GIL. If a signal or `progress` raises, the work is interrupted, and what was raised is
  // thrown when it has ended; else what the work throws.
  // REQUIRES: the GIL is held.
  void run(const std::function<void()>& work);

  // What the work asks and tells; any thread may.
  bool interrupted() const { return stop_.load(std::memory_order_relaxed); }
  void tell(const char* phase, std::uint64_t done, std::uint64_t total, std::uint64_t triangles);
  void tell(const ComputeProgress& progress);

 private:
  struct Told {
    const char* phase = nullptr;
    std::uint64_t done = 0, total = 0, triangles = 0;
  };

  void pass_on();

  pybind11::object callback_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable over_;
  bool ended_ = false;
  Told told_;  // the latest; of no phase if it was passed on
};

}  // namespace reeb::python
