#include "tools/python/watched_run.h"

#include <chrono>
#include <exception>
#include <thread>
#include <utility>

#include "tools/python/without_gil.h"

namespace reeb::python {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{40};

const char* name_of(ComputeProgress::Phase phase) {
  switch (phase) {
    case ComputeProgress::Phase::kSpool:
      return "copy";
    case ComputeProgress::Phase::kFinalization:
      return "finalization";
    case ComputeProgress::Phase::kReorder:
      return "reorder";
    case ComputeProgress::Phase::kReeb:
      return "reeb";
    case ComputeProgress::Phase::kHierarchy:
      break;
  }
  return "hierarchy";
}

}  // namespace

void WatchedRun::tell(const char* phase, std::uint64_t done, std::uint64_t total, std::uint64_t triangles) {
  const std::lock_guard lock(mutex_);
  told_ = {phase, done, total, triangles};
}

void WatchedRun::tell(const ComputeProgress& progress) {
  tell(name_of(progress.phase), progress.done, progress.total, progress.triangles);
}

// REQUIRES: the GIL is held.
void WatchedRun::pass_on() {
  if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
  if (callback_.is_none()) return;
  Told told;
  {
    const std::lock_guard lock(mutex_);
    std::swap(told, told_);
  }
  if (told.phase != nullptr) callback_(told.phase, told.done, told.total, told.triangles);
}

void WatchedRun::run(const std::function<void()>& work) {
  std::exception_ptr failure, raised;
  {
    const WithoutGil released;
    std::thread worker([&] {
      try {
        work();
      } catch (...) {
        failure = std::current_exception();
      }
      const std::lock_guard lock(mutex_);
      ended_ = true;
      over_.notify_all();
    });
    const auto wait = [this] {
      std::unique_lock lock(mutex_);
      return over_.wait_for(lock, kBetweenLooks, [this] { return ended_; });
    };
    while (!wait()) {
      if (WithoutGil::is_awaited()) stop_.store(true, std::memory_order_relaxed);
      if (interrupted()) continue;
      const pybind11::gil_scoped_acquire held;
      try {
        pass_on();
      } catch (...) {
        raised = std::current_exception();
        stop_.store(true, std::memory_order_relaxed);
      }
    }
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (failure) std::rethrow_exception(failure);
  pass_on();
}

}  // namespace reeb::python
