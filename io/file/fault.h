// Faults on request: tests can make any system call of this layer fail, transfer less, or be interrupted.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>

namespace reeb::io {

enum class FileCall { kOpen, kRead, kWrite, kMap, kSync, kRename };

struct FileFault {
  int error = 0;                                                     // an errno: the call fails with it and is not made
  std::size_t most_bytes = std::numeric_limits<std::size_t>::max();  // limit for one read or write
};

// Called before each system call. THREADS: any number at once.
using FileFaultHook = std::function<FileFault(FileCall)>;

namespace detail {
inline std::atomic<const FileFaultHook*> fault_hook{nullptr};
}

// The fault for a call. Without a hook it costs a load and a branch that is never taken.
inline FileFault fault_for(FileCall call) {
  const FileFaultHook* const hook = detail::fault_hook.load(std::memory_order_acquire);
  if (hook == nullptr) [[likely]]
    return {};
  return (*hook)(call);
}

// Sets the hook of the process during its lifetime. REQUIRES: one at a time.
class ScopedFileFaults {
 public:
  explicit ScopedFileFaults(FileFaultHook hook) : hook_(std::move(hook)) { detail::fault_hook.store(&hook_); }
  ScopedFileFaults(const ScopedFileFaults&) = delete;
  ScopedFileFaults& operator=(const ScopedFileFaults&) = delete;
  ~ScopedFileFaults() { detail::fault_hook.store(nullptr); }

 private:
  FileFaultHook hook_;
};

}  // namespace reeb::io
